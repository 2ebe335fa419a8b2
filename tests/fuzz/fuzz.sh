#!/bin/sh
# libFuzzer on control_step with address and undefined-behaviour sanitizers. usage: fuzz.sh [SECONDS] [BUILD_FOLDER]
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
seconds=${1:-60}
out=${2:-$root/build/fuzz}
clang=$(command -v clang || command -v clang-14) || { echo "fuzz: skipped, needs clang with libFuzzer (apt: clang)"; exit 0; }
mkdir -p "$out/corpus"
printf 'int LLVMFuzzerTestOneInput(const char *d, unsigned long n);\nint LLVMFuzzerTestOneInput(const char *d, unsigned long n) { return d == 0 && n > 1; }\n' > "$out/try.c"
"$clang" -fsanitize=fuzzer,address,undefined "$out/try.c" -o "$out/try" > "$out/try.log" 2>&1 || {
  echo "fuzz: skipped, this clang has no libFuzzer or no sanitizers ($out/try.log; apt: libclang-rt-dev or libclang-rt-14-dev)"
  exit 0
}
cc -std=c11 -O2 -o "$out/template_gen" -I"$root" "$root/firmware/template/doppler_template_gen.c" "$root/firmware/template/radar_template.c" -lm
templates=
for radar in mdu1130 dj_radar_2 dj_radar_3 drs1000; do
  "$out/template_gen" $radar "$out/$radar.c"
  templates="$templates $out/$radar.c"
done
"$clang" -std=c11 -O1 -g -ffp-contract=off -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=all -I"$root" "$root"/firmware/core/*.c \
  $templates "$root/tests/fuzz/control_fuzz.c" -lm -o "$out/control_fuzz"
"$out/control_fuzz" -max_total_time="$seconds" -max_len=8192 -seed=1 -print_final_stats=1 -artifact_prefix="$out/" "$out/corpus" 2>&1 | tail -12
