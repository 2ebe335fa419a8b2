#!/bin/sh
# emulate.sh ROOT [--if-built] - lays the emulated board out in ROOT/build/board: kernel (built once, kernel/build.sh), device tree, initramfs with the
# rover's own program. Prints that folder. The same files give the same initramfs, byte for byte. --if-built: exit code 77 where the
# kernel is not there yet.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
root=$1 target=$1/build/korebot
cache=${XDG_CACHE_HOME:-$HOME/.cache}/traction
kernel=$(sh "$here/kernel/build.sh" "$cache" ${2+"$2"})
board=$root/build/board
mkdir -p "$board"
work=$(mktemp -d "$board/making.XXXXXX")
trap 'rm -rf "$work"' EXIT
arm-linux-gnueabi-strip -o "$work/tractiond" "$target/firmware/app/tractiond" # as cpack does
arm-linux-gnueabi-strip -o "$work/init" "$target/emulate/board_init"
cat >"$work/list" <<LIST
dir /dev 0755 0 0
nod /dev/console 0600 0 0 c 5 1
dir /proc 0755 0 0
dir /run 0755 0 0
dir /sbin 0755 0 0
dir /sys 0755 0 0
file /init $work/init 0755 0 0
file /sbin/tractiond $work/tractiond 0755 0 0
LIST
touch -d @1704067200 "$work/init" "$work/tractiond" # the archive has the files' times
"$kernel/gen_init_cpio" -t 1704067200 "$work/list" | gzip -9n >"$work/initramfs"
for file in zImage versatile-pb.dtb; do ln -sf "$kernel/$file" "$board/$file"; done
mv "$work/initramfs" "$board/initramfs"
echo "$board"
