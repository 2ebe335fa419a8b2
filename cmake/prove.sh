#!/bin/sh
# Frama-C EVA over firmware/core: control_step, three ticks from reset, on any frame and any command. Run: ./traction prove
# Not-a-number is a value here, not an error: every law states what it does with it, so special floats are allowed.
# Exit 0: no alarm, or skipped because Frama-C is not packaged here; 1: alarms, listed.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/build/prove}
command -v frama-c > /dev/null || { echo "prove: skipped, needs frama-c (apt: frama-c-base)"; exit 0; }
mkdir -p "$out"
cc -std=c11 -O2 -o "$out/template_gen" "$root/firmware/template/doppler_template_gen.c" -lm
"$out/template_gen" mdu1130 "$out/template.c"
frama-c -eva -eva-precision "${PRECISION:-4}" -machdep gcc_x86_64 -c11 -cpp-extra-args="-I$root -std=c11" -main prove -warn-signed-overflow -warn-special-float none \
  -no-warn-signed-downcast -eva-no-alloc-returns-null "$root"/firmware/core/*.c "$out/template.c" "$root/tests/fuzz/prove.c" > "$out/log" 2>&1 || {
  tail -20 "$out/log"
  exit 1
}
grep -E "^\[eva:alarm\]" -A 2 "$out/log" | sed "s#$root/##" > "$out/alarms" || true
sed -n '/EVA:SUMMARY\|Analyzer summary\|====== ANALYSIS SUMMARY/,$p' "$out/log"
count=$(grep -c "^\[eva:alarm\]" "$out/log" || true)
echo "prove: $count alarms$([ "$count" = 0 ] || echo ", in $out/alarms")"
[ "$count" = 0 ]
