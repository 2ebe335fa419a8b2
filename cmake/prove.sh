#!/bin/sh
# Frama-C EVA over firmware/core, by induction over ticks (tests/fuzz/prove.c). Run: ./traction prove
# Not-a-number is a value here, not an error: every law states what it does with it, so special floats are allowed. Conversions to a
# narrower whole number are two's complement (gcc and clang define them). Everything else that C leaves undefined is an alarm.
# Exit 0: no alarm and every check proven, or skipped because Frama-C is not packaged here; 1: what is open is listed.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/build/prove}
command -v frama-c > /dev/null || { echo "prove: skipped, needs frama-c (apt: frama-c-base)"; exit 0; }
mkdir -p "$out"
cc -std=c11 -O2 -o "$out/template_gen" -I"$root" "$root/firmware/template/doppler_template_gen.c" "$root/firmware/template/radar_template.c" -lm
templates=
for radar in mdu1130 dj_radar_2 dj_radar_3 drs1000; do
  "$out/template_gen" "$radar" "$out/$radar.c"
  templates="$templates $out/$radar.c"
done
frama-c -eva -eva-precision "${PRECISION:-4}" -machdep gcc_x86_64 -c11 -cpp-extra-args="-I$root -std=c11" -main prove -warn-signed-overflow -warn-special-float none \
  -no-warn-signed-downcast -eva-print-callstacks "$root"/firmware/core/*.c $templates "$root/tests/fuzz/prove.c" > "$out/log" 2>&1 || {
  tail -20 "$out/log"
  exit 1
}
grep -E "^\[eva:alarm\]" -A 4 "$out/log" | sed "s#$root/##" > "$out/alarms" || true
sed -n '/====== ANALYSIS SUMMARY/,$p' "$out/log"
count=$(grep -c "^\[eva:alarm\]" "$out/log" || true) # a check that is not proven is one too
[ "$count" = 0 ] || { echo "prove: $count alarms, in $out/alarms"; exit 1; }
checks=$(grep -c "//@ check" "$root/tests/fuzz/prove.c")
grep -q "Assertions *$checks valid" "$out/log" || { echo "prove: not every check of prove.c was reached"; exit 1; }
echo "prove: 0 alarms, $checks checks proven"
