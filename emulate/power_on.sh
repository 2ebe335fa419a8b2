#!/bin/sh
# power_on.sh FOLDER [PORT] [idle] - the board of flash_board.sh at the desk, in the foreground: its ssh server on PORT (2222) of this machine,
# its console in FOLDER/console.txt, its host key in FOLDER/known. It ends as a plug is pulled. idle: no version is started.
set -eu
cd "$1"
port=${2:-2222}
echo "[127.0.0.1]:$port $(cut -d ' ' -f 1,2 host.pub)" >known
machine=versatilepb
! qemu-system-arm -M versatilepb,help 2>&1 | grep -q audiodev || machine=versatilepb,audiodev=none # from QEMU 9 on it has to be told
exec qemu-system-arm -M $machine -audiodev none,id=none -m 64 -nodefaults -display none -serial file:console.txt -kernel zImage -dtb versatile-pb.dtb \
    -initrd initramfs -append "console=ttyAMA0 quiet rdinit=/sbin/network_init ${3-}" -drive if=pflash,format=raw,file=nor.img \
    -nic "user,hostfwd=tcp:127.0.0.1:$port-:22"
