#!/bin/sh
# Frama-C EVA over firmware/core, by induction over ticks (tests/fuzz/prove.c). Run: ./traction prove
# Not-a-number is a value here, not an error: every law states what it does with it, so special floats are allowed. Conversions to a
# narrower whole number are two's complement (gcc and clang define them). Everything else that C leaves undefined is an alarm.
# One run per question, each in a minute or less on an idle core: a tick per configuration and radar, with the contracts of tests/fuzz/prove.h
# in place of what is dear or holds by a relation; and each contract by itself.
# Exit 0: no alarm and every check proven, or skipped because Frama-C is not packaged here; 1: what is open is listed.
# usage: prove.sh [BUILD_FOLDER [ENTRY]...]
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/build/prove}
[ $# -lt 2 ] && set -- transform lean step railed_radar radar_dead block take_line without_lines outside default blind paper dj_radar_2 dj_radar_3 drs1000 || shift
command -v frama-c > /dev/null || { echo "prove: skipped, needs frama-c (apt: frama-c-base)"; exit 0; }
mkdir -p "$out"
cc -std=c11 -O2 -o "$out/template_gen" -I"$root" "$root/firmware/template/doppler_template_gen.c" "$root/firmware/template/radar_template.c" -lm
templates=
for radar in mdu1130 dj_radar_2 dj_radar_3 drs1000; do
  [ "$out/$radar.c" -nt "$root/firmware/template/radar_template.c" ] || "$out/template_gen" "$radar" "$out/$radar.c"
  templates="$templates $out/$radar.c"
done
core=
for file in "$root"/firmware/core/*.c; do
  case $(basename "$file") in
    safety.c | sense.c | doppler.c) ;; # in tests/fuzz/prove_*.c, with their contracts
    *) core="$core $file" ;;
  esac
done

# What a tick takes from the other runs; the last two are those of the transform.
contracts=radar_dead,take_line,watch_outside,without_lines,fft_power_about,fft_power_flat
counts=watch_span:8,learn_rest:24,count_values:24,ground_speed_remember:6,ground_speed_watch_radar:20,tick:40 # x + (x < most ? 1 : 0)
build=rover_parameters_reference:200,rover_parameters_scale:200 # loops over the parameters, followed to their end

frama-c -machdep gcc_x86_64 -c11 -cpp-extra-args="-I$root -std=c11" -warn-special-float none $core $templates "$root"/tests/fuzz/prove*.c -save "$out/parsed.sav" > "$out/log.parse" 2>&1 || {
  tail -20 "$out/log.parse"
  exit 1
}

# eva ENTRY EVA_OPTIONS...
eva() {
  entry=$1
  shift
  frama-c -load "$out/parsed.sav" -main "prove_$entry" -eva -eva-precision 0 -eva-plevel 512 -warn-signed-overflow -warn-special-float none -no-warn-signed-downcast \
    -eva-print-callstacks "$@" > "$out/log.$entry.new" 2>&1 || {
    tail -20 "$out/log.$entry.new"
    exit 1
  }
  mv "$out/log.$entry.new" "$out/log.$entry"
}

total=0
for entry in "$@"; do
  case $entry in
    transform) eva $entry -eva-precision 4 ;;
    radar_dead) eva $entry -eva-auto-loop-unroll 136 -eva-slevel-function "$build,radar_dead:400" ;;
    step) eva $entry -eva-auto-loop-unroll 136 -eva-slevel-function "$build,measure_wheel:20" ;;
    railed_radar) eva $entry -eva-auto-loop-unroll 136 -eva-slevel-function "$build,check_radar:150" ;;
    block) eva $entry -eva-auto-loop-unroll 136 -eva-use-spec $contracts -eva-slevel-function "$build,take:20" ;;
    without_lines) eva $entry -eva-min-loop-unroll 128 -eva-slevel-function "$build" ;;
    outside) eva $entry -eva-min-loop-unroll 4 -eva-auto-loop-unroll 136 -eva-use-spec take_line -eva-slevel-function "$build" ;;
    take_line | lean) eva $entry -eva-auto-loop-unroll 136 -eva-slevel-function "$build" ;;
    *) [ $entry = blind ] && domains="-eva-domains bitwise" || domains= # one bit of many that is not set
      eva $entry $domains -eva-auto-loop-unroll 136 -eva-use-spec $contracts \
      -eva-slevel-function "$build,sense_measure:20,doppler_missing:20,window_change_m_s:130,$counts" ;;
  esac
  grep -E "^\[eva:alarm\]" -A 4 "$out/log.$entry" | sed "s#$root/##" > "$out/alarms.$entry" || true
  count=$(grep -c "^\[eva:alarm\]" "$out/log.$entry" || true) # a check that is not proven is one too
  reached=$(sed -n 's/.*In these functions, //p' "$out/log.$entry")
  proven=$(sed -n 's/^ *Assertions *\([0-9]* valid\).*/\1/p' "$out/log.$entry")
  echo "prove_$entry: $count alarms, checks and contracts: ${proven:-none}, $reached"
  total=$((total + count))
done
[ "$total" = 0 ] || { echo "prove: $total alarms, in $out/alarms.*"; exit 1; }
echo "prove: 0 alarms"
