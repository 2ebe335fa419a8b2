#!/bin/sh
# power_on.sh FOLDER [PORT] [idle | from-flash] - the board of flash_board.sh at the desk, in the foreground: its ssh server on PORT (2222) of this machine,
# its supervision link on the same of UDP, its console in FOLDER/console.txt, its host key in FOLDER/known. It ends as a plug is pulled. idle: no version is started.
# from-flash: no initramfs; its root file system is on nor.img, an image of traction flash --image --system, as where a boot loader starts a kernel.
set -eu
cd "$1"
port=${2:-2222}
echo "[127.0.0.1]:$port $(cut -d ' ' -f 1,2 host.pub)" >known
machine=versatilepb
! qemu-system-arm -M versatilepb,help 2>&1 | grep -q audiodev || machine=versatilepb,audiodev=none # from QEMU 9 on it has to be told
system='-initrd initramfs' words="rdinit=/sbin/network_init ${3-}"
[ "${3-}" != from-flash ] || system='' words='root=mtd0 rootfstype=jffs2 rw init=/sbin/network_init'
# shellcheck disable=SC2086 # two words or none
exec qemu-system-arm -M $machine -audiodev none,id=none -m 64 -nodefaults -display none -serial file:console.txt -kernel zImage -dtb versatile-pb.dtb \
    $system -append "console=ttyAMA0 quiet $words" -drive if=pflash,format=raw,file=nor.img \
    -nic "user,hostfwd=tcp:127.0.0.1:$port-:22,hostfwd=udp:127.0.0.1:$port-:14555"
