#!/bin/sh
# Instructions that the firmware executes on ARMv5TE (qemu-arm -cpu pxa255), code size and stack. usage: firmware_count.sh [BUILD_FOLDER]
# KISSFFT=<folder with kiss_fft.c and kiss_fftr.c, from Debian's source package kissfft> adds that peer to the table.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-$root/build/count}
mkdir -p "$out"
for tool in arm-linux-gnueabi-gcc qemu-arm cc; do
  command -v $tool > /dev/null || { echo "skipped: needs $tool (apt: gcc-arm-linux-gnueabi qemu-user)"; exit 0; }
done
cc -O2 -shared -fPIC -o "$out/libarm_count.so" "$root/tests/bench/arm_count/arm_count.c"
cc -O2 -o "$out/template_gen" "$root/firmware/template/doppler_template_gen.c" -lm
"$out/template_gen" mdu1130 "$out/template.c"
flags="-std=gnu11 -march=armv5te -mtune=xscale -marm -msoft-float -ffp-contract=off -I$root"
objects=
for file in "$root"/firmware/core/*.c "$out/template.c"; do
  object=$out/$(basename "$file" .c).o
  level="-O3"; [ "$(basename "$file")" = fft.c ] && level="-O3 -fno-schedule-insns"
  arm-linux-gnueabi-gcc $flags $level -fstack-usage -c "$file" -o "$object"
  objects="$objects $object"
done
peer=
if [ -n "${KISSFFT:-}" ]; then
  peer="-DWITH_KISSFFT=1 -DFIXED_POINT=16 -I$KISSFFT $KISSFFT/kiss_fft.c $KISSFFT/kiss_fftr.c"
else
  echo "KissFFT is left out: KISSFFT=<folder of Debian's source package kissfft> adds it"
fi
arm-linux-gnueabi-gcc $flags -O2 -static ${peer:--DWITH_KISSFFT=0} "$root/tests/bench/firmware_count.c" $objects -lm -o "$out/count"
address() { arm-linux-gnueabi-nm "$out/count" | awk -v name="$1" '$3 == name { print "0x" $1 }'; }
qemu-arm -cpu pxa255 -plugin "$out/libarm_count.so,begin=$(address count_begin),end=$(address count_end)" "$out/count" \
  > "$out/labels" 2> "$out/counts"
awk 'NR == FNR { count[NR] = $1; next } { label[FNR] = $0 }
  END { empty = count[1]
    for (i = 1; i <= length(count); i++) for (j = 0; j < 2; j++) { name = label[2 * i - 1 + j]
      if (j == 1 && name == label[2 * i - 1]) continue
      if (!(name in n)) order[++names] = name
      n[name]++; c = count[i] - empty; sum[name] += c; if (c > most[name]) most[name] = c }
    printf "%-44s %9s %9s\n", "executed ARM instructions", "mean", "worst"
    for (k = 2; k <= names; k++) printf "%-44s %9d %9d\n", order[k], sum[order[k]] / n[order[k]], most[order[k]] }' "$out/counts" "$out/labels"
arm-linux-gnueabi-size -t $objects | tail -1 | awk '{ print "code and constants " $1 " bytes, data " $2 + $3 " bytes" }'
cat "$out"/*.su | sort -k2 -n -r | awk -F'\t' 'NR <= 4 { n = split($1, part, ":"); printf "stack frame %-28s %5d bytes\n", part[n], $2 }'
