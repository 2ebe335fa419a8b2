#!/bin/sh
# Instructions that the firmware executes on ARMv5TE (qemu-arm -cpu pxa255), code size and stack. usage: firmware_count.sh [BUILD_FOLDER]
# KissFFT int16 is counted beside it, from the system's source package (kissfft_source.sh) or KISSFFT=<folder with kiss_fft.c>.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
out=${1:-$root/build/count}
mkdir -p "$out"
for tool in arm-linux-gnueabi-gcc qemu-arm cc; do
  command -v $tool > /dev/null || { echo "skipped: needs $tool (apt: gcc-arm-linux-gnueabi qemu-user)"; exit 0; }
done
cc -O2 -shared -fPIC -o "$out/libarm_count.so" "$root/tests/bench/arm_count/arm_count.c"
cc -O2 -o "$out/template_gen" -I"$root" "$root/firmware/template/doppler_template_gen.c" "$root/firmware/template/radar_template.c" -lm
templates=
for radar in mdu1130 dj_radar_2 dj_radar_3 drs1000; do
  "$out/template_gen" $radar "$out/template_$radar.c"
  templates="$templates $out/template_$radar.c"
done
flags="-std=gnu11 -march=armv5te -mtune=xscale -marm -msoft-float -ffp-contract=off -I$root"
objects=
for file in "$root"/firmware/core/*.c $templates; do
  object=$out/$(basename "$file" .c).o
  level="-O3"; [ "$(basename "$file")" = fft.c ] && level="-O3 -fno-schedule-insns"
  arm-linux-gnueabi-gcc $flags $level -fstack-usage -c "$file" -o "$object"
  objects="$objects $object"
done
peer=-DWITH_KISSFFT=0
kissfft=${KISSFFT:-$(sh "$root/tests/bench/kissfft_source.sh" "$out/kissfft" || true)}
if [ -n "$kissfft" ]; then
  for file in kiss_fft kiss_fftr; do # with the firmware's flags; with those of its fft.c it takes 6 % more
    arm-linux-gnueabi-gcc $flags -O3 -DFIXED_POINT=16 -DNDEBUG -I"$kissfft" -c "$kissfft/$file.c" -o "$out/$file.o"
  done
  peer="-DWITH_KISSFFT=1 -DFIXED_POINT=16 -I$kissfft $out/kiss_fft.o $out/kiss_fftr.o"
fi
arm-linux-gnueabi-gcc $flags -O2 -static "$root/tests/bench/firmware_count.c" $peer $objects -lm -o "$out/count"
arm-linux-gnueabi-gcc $flags -O2 -static "$root/tests/bench/fft_snr.c" $peer $objects -lm -o "$out/snr"
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
echo
qemu-arm -cpu pxa255 "$out/snr"
echo
arm-linux-gnueabi-size $objects | awk 'NR > 1 { all += $1; data += $2 + $3; if ($6 ~ /template_/) { beams += $1; if ($6 ~ /mdu1130/) beam = $1 } }
  END { print "code and constants " all - beams " bytes, four radars\047 templates " beams " bytes (the reference\047s " beam "), data " data " bytes" }'
measured=$(tail -n 1 "$out/labels")
bound=$(arm-linux-gnueabi-objdump -d --no-show-raw-insn "$out/count" | awk -v root=control_step -f "$root/tests/bench/stack_bound.awk")
echo "stack of a tick: $measured bytes in the worst of the ticks above; on no path more than $bound"
cat "$out"/*.su | sort -k2 -n -r | awk -F'\t' 'NR <= 4 { n = split($1, part, ":"); printf "stack frame %-28s %5d bytes\n", part[n], $2 }'
