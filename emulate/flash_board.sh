#!/bin/sh
# flash_board.sh ROOT TRACTION FOLDER [--if-built] - lays out in FOLDER an emulated board that is flashed as a rover is: kernel, device tree, and
# an initramfs with ssh server, shell, traction-slot and no tractiond: that comes by traction flash into the slots on its NOR flash (nor.img).
# The same system starts in two ways: rdinit=/sbin/network_init stands at the desk and is flashed (power_on.sh), rdinit=/init (board_init) drives in
# lockstep what its slots hold. --if-built: exit code 77 where kernel or ssh server are not there yet.
#
# FOLDER/system is that initramfs as a folder, for an image that boots from the flash memory (power_on.sh from-flash).
#
# What FOLDER has of these is kept, what it lacks is made: key and key.pub (whom it obeys), rover.name, id and id.pub (who may log in), host, host.pub
# and host_key (who it is), link.key (who may drive it, docs/supervision.md), default (/etc/default/tractiond), frames (what a version drives at the desk, where it has no world), nor.img.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
root=$1 target=$1/build/korebot traction=$2
mkdir -p "$3"
board=$(CDPATH='' cd -- "$3" && pwd)
cache=${XDG_CACHE_HOME:-$HOME/.cache}/traction
kernel=$(sh "$here/kernel/build.sh" "$cache" ${4+"$4"})
armel=$cache/armel-2
[ "${4-}" != --if-built ] || [ -e "$armel/complete" ] || exit 77
sh "$here/armel.sh" "$armel"
work=$(mktemp -d "$board/making.XXXXXX")
trap 'rm -rf "$work"' EXIT

# --- what is kept
[ -e "$board/key.pub" ] || "$traction" flash --new-key "$board/key" >"$work/said"
[ -e "$board/rover.name" ] || echo Lhomme-Desages >"$board/rover.name"
[ -e "$board/id.pub" ] || ssh-keygen -q -t ed25519 -N '' -C '' -f "$board/id"
# the supervision link's key; a build without the link has no --link either
[ -e "$board/link.key" ] || "$traction" drive --new-key "$board/link.key" >"$work/said" 2>&1 || rm -f "$board/link.key"
link=''
[ ! -e "$board/link.key" ] || link=' --link 0.0.0.0 --link-key /etc/link.key'
[ -e "$board/default" ] ||
    printf "STATE=/flash/state\nTRACTIOND_HAL=replay\nTRACTIOND_OPTIONS='--realtime --log-budget 4%s'\nTRACTIOND_ROVER=/frames\n" "$link" >"$board/default"
[ -e "$board/frames" ] || "$traction" simulate cruise --frames "$board/frames" --out /dev/null >"$work/said"
[ -e "$board/nor.img" ] || { dd if=/dev/zero bs=1M count=64 2>/dev/null | tr '\0' '\377' >"$work/nor.img"; mv "$work/nor.img" "$board/nor.img"; }
if [ ! -e "$board/host_key" ]; then
    # dropbear's own form of OpenSSH's key: "ssh-ed25519", then secret and public half in one, each with its length before it. OpenSSH's file
    # ends with the same name, the public half (4 + 32 bytes) and that string (4 + 64)
    ssh-keygen -q -t ed25519 -N '' -C '' -f "$board/host"
    sed '/^-/d' "$board/host" | base64 -d >"$work/host"
    at=$(grep -abo 'ssh-ed25519' "$work/host" | tail -n 1 | cut -d : -f 1)
    { printf '\000\000\000\013ssh-ed25519'; tail -c +$((at + 11 + 36 + 1)) "$work/host" | head -c 68; } >"$board/host_key"
fi

# --- the system
for file in emulate/board_init emulate/board_seed firmware/flash/traction-slot; do arm-linux-gnueabi-strip -o "$work/${file##*/}" "$target/$file"; done
head -c 64 /dev/urandom >"$work/seed"
echo 'root:x:0:0:root:/root:/bin/sh' >"$work/passwd"
echo 'root:x:0:' >"$work/group"
{
    for folder in dev proc sys run tmp flash bin sbin etc etc/default etc/dropbear root root/.ssh lib lib/arm-linux-gnueabi usr usr/bin usr/sbin usr/lib \
        usr/lib/arm-linux-gnueabi; do
        mode=0755
        case $folder in root | root/.ssh) mode=0700 ;; esac
        echo "dir /$folder $mode 0 0"
    done
    echo 'nod /dev/console 0600 0 0 c 5 1'
    echo "file /init $work/board_init 0755 0 0"
    echo "file /sbin/network_init $here/network_init 0755 0 0"
    echo "file /sbin/board_seed $work/board_seed 0755 0 0"
    echo "file /usr/sbin/traction-slot $work/traction-slot 0755 0 0"
    echo "file /etc/seed $work/seed 0600 0 0"
    for file in passwd group; do echo "file /etc/$file $work/$file 0644 0 0"; done
    echo "file /etc/default/tractiond $board/default 0644 0 0"
    echo "file /etc/rover.key.pub $board/key.pub 0644 0 0"
    echo "file /etc/rover.name $board/rover.name 0644 0 0"
    [ -z "$link" ] || echo "file /etc/link.key $board/link.key 0600 0 0"
    echo "file /etc/dropbear/host_key $board/host_key 0600 0 0"
    echo "file /root/.ssh/authorized_keys $board/id.pub 0600 0 0"
    echo "file /frames $board/frames 0644 0 0"
    for file in bin/busybox usr/sbin/dropbear; do echo "file /$file $armel/root/$file 0755 0 0"; done
    for word in '[' awk cat cut dirname echo grep hostname ifconfig ls mkdir mount ps rm sh sleep sync tail test umount; do echo "slink /bin/$word busybox 0777 0 0"; done
    (cd "$armel/root" && find lib usr/lib/arm-linux-gnueabi \( -type f -o -type l \) -name '*.so*') | while read -r file; do
        if [ -L "$armel/root/$file" ]; then echo "slink /$file $(readlink "$armel/root/$file") 0777 0 0"; else echo "file /$file $armel/root/$file 0755 0 0"; fi
    done
} >"$work/list"
# the same as a folder: a root file system for `traction flash --image --system` (its /dev/console is the image's to make)
while read -r kind path from mode _; do
    case $kind in
        dir) mkdir -p "$work/system$path" && chmod "$mode" "$work/system$path" ;;
        file) cp "$from" "$work/system$path" && chmod "$mode" "$work/system$path" ;;
        slink) ln -s "$from" "$work/system$path" ;;
    esac
done <"$work/list"
rm -rf "$board/system"
mv "$work/system" "$board/system"
"$kernel/gen_init_cpio" -t 1704067200 "$work/list" | gzip -9n >"$work/initramfs"
for file in zImage versatile-pb.dtb; do ln -sf "$kernel/$file" "$board/$file"; done
mv "$work/initramfs" "$board/initramfs"
