#!/bin/sh
# build.sh - the emulated board's kernel from Debian's kernel source package, once per configuration; prints the folder that has it.
# usage: build.sh CACHE_FOLDER [--if-built]. The folder's name holds a hash over all that goes in; what is there is not built again; with
# --if-built what is not there is not built, and the exit code is 77.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
cache=$1 only=${2-}
say() { printf 'traction: %s\n' "$*" >&2; }

archive=$(find /usr/src -maxdepth 1 -name 'linux-source-*.tar.xz' | sort -V | tail -n 1)
[ -n "$archive" ] || [ "$only" != --if-built ] || exit 77
[ -n "$archive" ] || { say "no kernel source in /usr/src; install the package linux-source"; exit 1; }
compiler=arm-linux-gnueabi-gcc
command -v $compiler >/dev/null 2>&1 || { say "no $compiler; install g++-arm-linux-gnueabi"; exit 1; }
package=$(basename "$archive" .tar.xz)
version=$(dpkg-query -W -f '${Version}' "$package" 2>/dev/null || stat -c %s "$archive")
hash=$({ echo "$package $version"; $compiler -dumpfullversion; cat "$here/board.config" "$here/traction_adc.c" "$here/build.sh"; } | sha256sum | cut -c 1-16)
board=$cache/board-$hash
if [ -s "$board/zImage" ]; then echo "$board"; exit 0; fi
[ "$only" != --if-built ] || exit 77

mkdir -p "$cache"
work=$(mktemp -d "$cache/building.XXXXXX")
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
began=$(date +%s)
say "building the emulated board's kernel from $package $version: about five minutes of one core, once; then it is in $board"
# sources of other machines and of graphics make the archive large; every Kconfig stays
tar -C "$work" -xf "$archive" --exclude='*/arch/x86/*.[chS]' --exclude='*/arch/powerpc/*.[chS]' --exclude='*/arch/mips/*.[chS]' --exclude='*/arch/arm64/boot/dts/*' \
    --exclude='*/drivers/gpu/drm/*.[ch]' --exclude='*/tools/testing/*' --exclude='*/sound/*.[ch]' --exclude='*/Documentation/*.rst'
tree=$work/$package
cp "$here/traction_adc.c" "$tree/drivers/iio/"
echo 'obj-y += traction_adc.o' >>"$tree/drivers/iio/Makefile"
# QEMU's flash memory (8.1.5, 9.0 and later) takes no buffered write of one word: it counts that as a programming error, and the driver waits for a
# status that never comes. A word that is one word's whole write is sent twice here, to the same place of the buffer: what is programmed is the same.
driver=$tree/drivers/mtd/chips/cfi_cmdset_0001.c
sed -i '/^static int __xipram do_write_buffer(/,/^}/ {
    s/\tmap_write(map, CMD(words), cmd_adr );/\tmap_write(map, CMD(words ? words : 1), cmd_adr);/
    s/^\(\t*\)map_write(map, datum, adr);/\1if (!words)\n\1\tmap_write(map, datum, adr);\n&/
}' "$driver"
[ "$(grep -c 'CMD(words ? words : 1), cmd_adr);\|if (!words)$' "$driver")" -eq 2 ] || { say "this kernel's $(basename "$driver") is another: the mend for QEMU's flash memory does not fit"; exit 1; }
export ARCH=arm CROSS_COMPILE=arm-linux-gnueabi- KBUILD_BUILD_TIMESTAMP='2024-01-01 00:00:00' KBUILD_BUILD_USER=traction KBUILD_BUILD_HOST=traction
run() { make -C "$tree" O="$work/made" "$@" >>"$work/log" 2>&1 || { tail -n 20 "$work/log" >&2; say "the kernel does not build ($package)"; exit 1; }; }
KCONFIG_ALLCONFIG="$here/board.config" run allnoconfig
sed '/^# --- only in some/,$d' "$here/board.config" | grep '^CONFIG_[A-Z0-9_]*=[y"]' | while read -r wanted; do
    grep -qxF "$wanted" "$work/made/.config" || { say "this kernel does not take $wanted"; exit 1; }
done
run -j "$(nproc)" zImage dtbs
mkdir "$work/board"
cp "$work/made/arch/arm/boot/zImage" "$work/made/usr/gen_init_cpio" "$work/board/"
find "$work/made/arch/arm/boot/dts" -name versatile-pb.dtb -exec cp {} "$work/board/" \;
[ -s "$work/board/versatile-pb.dtb" ] || { say "the kernel made no versatile-pb.dtb"; exit 1; }
echo "$package $version" >"$work/board/kernel.txt"
if ! mv "$work/board" "$board" 2>/dev/null && [ ! -s "$board/zImage" ]; then say "$board cannot be written"; exit 1; fi
say "built the kernel in $(($(date +%s) - began)) s"
echo "$board"
