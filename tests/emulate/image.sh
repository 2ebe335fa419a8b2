#!/bin/sh
# image.sh ROOT TRACTION WORK [--if-built] - traction flash --image, on the emulated board: a board whose NOR flash holds the image, and which has
# nothing else but its kernel, boots from it, runs the package's version, is flashed with the next and keeps it when its plug is pulled; the slots
# alone, under the system of emulate --desk; and in lockstep with a world the version drives as the simulation in process does.
set -eu
root=$1 traction=$2 work=$3 only=${4-} label='image'
. "$root/tests/emulate/desk.sh"
export TRACTION_ROOT="$root"

make_board
for n in 0 1; do pack p$n.tar --key key --program tractiond --rover lhomme_desages; done
image() { # image OUT PACKAGE OPTION...
    "$traction" flash "$2" --image "$1" --key key.pub --rover lhomme_desages --mount /flash --folder /flash/traction --size 65536 --json image.json \
        $(shift 2; echo "$@") >out 2>err || fail "image $1"
}
same_files() { # same_files SLOT PACKAGE: what is in the slot is what is in the package
    say_ssh "cd /flash/traction/$1 && cat manifest" >manifest.board || fail "no manifest on the board"
    tar xOf "$2" manifest | cmp -s - manifest.board || fail "slot $1 has another manifest than $2"
    for file in tractiond start rover.toml parameters; do
        say_ssh "cat /flash/traction/$1/$file" >file.board || fail "no $file on the board"
        tar xOf "$2" $file | cmp -s - file.board || fail "slot $1 has another $file than $2"
    done
}
runs() { # runs NUMBER SLOT: that version is good, its program runs and writes its log
    tries=0
    until over --status >out 2>err && grep -q "number $1, .*good" out && say_ssh ps 2>/dev/null | grep -q '[.]/tractiond'; do
        tries=$((tries + 1))
        [ $tries -lt 60 ] || fail "number $1 does not run"
        sleep 1
    done
    say_ssh 'for process in /proc/[0-9]*; do readlink $process/exe; done' 2>/dev/null >running || true
    grep -qx "/flash/traction/$2/tractiond" running || grep -qx "/traction/$2/tractiond" running || fail "the program that runs is not slot $2's: $(cat running)"
}

# --- kernel and image, nothing else: a first flash without ssh
image root.img p0.tar --system board/system
mv board/initramfs no_initramfs
cp root.img board/nor.img
power_on from-flash
grep -q 'board: up' board/console.txt || fail "the board does not say that it is up"
say_ssh busybox dmesg | grep -i 'jffs2' >jffs2.txt || fail "no word of JFFS2 in the kernel's log"
! grep -i 'crc\|error\|magic\|unknown\|empty flash\|inconsistent' jffs2.txt || fail "the kernel does not like the image"
runs 0 a
same_files a p0.tar
say_ssh mount | grep -q '^mtd0 on / type jffs2\|^/dev/root on / type jffs2\|on / type jffs2' || fail "the root file system is not the image"
echo 'a board with kernel and image alone boots, and runs version 0 of slot a; its files are the package'"'"'s'
flash 0 'the new version runs: confirmed 1' p1.tar
runs 1 b
power_off
power_on from-flash
runs 1 b
same_files b p1.tar
logs=$(say_ssh ls /flash/state/log | grep -c '[.]ulg')
[ "$logs" -ge 2 ] || fail "its starts left $logs logs on the flash memory"
power_off
mv no_initramfs board/initramfs
echo "flashed with version 1 over ssh, its plug pulled: it boots from the same flash memory and runs version 1 of slot b; $logs logs"

# --- the slots alone: whatever the board boots
image slots.img p0.tar
cp slots.img board/nor.img
power_on
runs 0 a
power_off
echo 'the slots alone, under the system of emulate --desk: version 0 runs'

# --- in lockstep with a world
cp slots.img board/nor.img
printf 'duration_s = 4.0\nseed = 3\n[ground]\nsoil = "sand"\n[[drive]]\nfor_s = 4.0\nmode = "platform_speed"\nspeed_m_s = 0.3\n' >drive.toml
"$traction" emulate drive.toml --board board --flash board/nor.img --keep kept --json drive.json >out 2>err || fail "drive"
grep -q '"equal_in_process": true' drive.json || fail "the trace is not that of the simulation"
tar xOf p0.tar parameters | cmp -s - kept/parameters.txt || fail "it drove with other numbers than the package's"
echo 'driven from the image in lockstep with a world: the trace is that of the simulation in process'
echo "$label: holds"
