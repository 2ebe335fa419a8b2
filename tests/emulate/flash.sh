#!/bin/sh
# traction flash onto an emulated board with a NOR flash that keeps what was written when QEMU is killed: a real power cut, at several instants
# of an install, over a real ssh server (Debian's dropbear for armel), with the program that goes onto the rover.
# usage: flash.sh ROOT TRACTION WORK [--if-built] [CUTS]. Exit 77, in words, where something is missing.
set -eu
root=$1 traction=$2 work=$3 only=${4-} cuts=${5-8}
target=$root/build/korebot
cache=${XDG_CACHE_HOME:-$HOME/.cache}/traction
skip() { echo "flashed board: skipped: $*"; exit 77; }
for program in qemu-system-arm ssh ssh-keygen dropbearkey arm-linux-gnueabi-strip; do
    command -v $program >/dev/null 2>&1 || skip "no $program here"
done
[ -x "$target/firmware/flash/traction-slot" ] && [ -x "$target/firmware/app/tractiond" ] || skip "the board's programs are not built (ninja -C build/korebot tractiond traction_slot)"
nor=yes
if ! kernel=$(sh "$root/emulate/kernel/build_flash.sh" "$cache" $only); then
    nor=no # the slots in memory: all but the power cuts
    kernel=$(sh "$root/emulate/kernel/build.sh" "$cache" $only) || skip "no kernel is built; sh emulate/kernel/build_flash.sh $cache builds one"
fi
armel=$cache/armel-1
[ -z "$only" ] || [ -e "$armel/complete" ] || skip "its ssh server is not here; sh emulate/armel.sh $armel brings it"
sh "$root/emulate/armel.sh" "$armel" || skip "no ssh server for it"
rm -rf "$work"
mkdir -p "$work/image"
cd "$work"
work=$(pwd)
qemu= flashing=
trap '[ -z "$qemu$flashing" ] || kill -KILL $qemu $flashing 2>/dev/null || true' EXIT
fail() { echo "FAILED: $*"; for file in out err console.txt; do [ ! -s $file ] || { echo "--- $file"; tail -n 25 $file; }; done; exit 1; }

# --- keys, packages, image
"$traction" flash --new-key key >out
"$traction" flash --new-key other >out
ssh-keygen -q -t ed25519 -N '' -f id
dropbearkey -t ed25519 -f host_key >/dev/null 2>&1
arm-linux-gnueabi-strip -o tractiond "$target/firmware/app/tractiond"
arm-linux-gnueabi-strip -o image/traction-slot "$target/firmware/flash/traction-slot"
pack() { "$traction" flash --pack "$1" --key "${3-key}" --program tractiond --rover "$2" >out 2>err || fail "pack $1"; }
for n in 0 1 2; do pack p$n.tar lhomme_desages; done
sed 's/^duration_s.*/duration_s = 120.0/; s/^for_s = 22.0/for_s = 112.0/' "$root/scenarios/cruise.toml" >drive.toml
"$traction" simulate drive.toml --frames image/frames --out /dev/null >out 2>err || fail "frames of a long drive"
cat >image/init <<'INIT'
#!/bin/busybox sh
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
mount -t tmpfs tmpfs /run
mount -t jffs2 mtd0 /flash || mount -t tmpfs tmpfs /flash
ifconfig lo 127.0.0.1 up
ifconfig eth0 10.0.2.15 netmask 255.255.255.0 up
[ -e /flash/traction/key.pub ] || traction-slot --folder /flash/traction init --key /etc/rover.key.pub --rover Lhomme-Desages
dropbear -E -s -r /etc/dropbear/host_key
echo "board: up"
while :; do
    traction-slot --folder /flash/traction run --trial-seconds 60
    sleep 1
done
INIT
cat >image/default <<'DEFAULT'
STATE=/run
TRACTIOND_HAL=replay
TRACTIOND_OPTIONS='--realtime --log-budget 1'
TRACTIOND_ROVER=/frames
DEFAULT
echo 'root:x:0:0:root:/root:/bin/sh' >image/passwd
echo 'root:x:0:' >image/group
(
    for folder in dev proc sys run flash bin sbin etc etc/default etc/dropbear root root/.ssh lib lib/arm-linux-gnueabi usr usr/bin usr/sbin usr/lib usr/lib/arm-linux-gnueabi tmp; do
        mode=0755
        case $folder in root | root/.ssh) mode=0700 ;; esac
        echo "dir /$folder $mode 0 0"
    done
    echo 'nod /dev/console 0600 0 0 c 5 1'
    echo "file /init $work/image/init 0755 0 0"
    echo "file /usr/sbin/traction-slot $work/image/traction-slot 0755 0 0"
    echo "file /etc/default/tractiond $work/image/default 0644 0 0"
    echo "file /etc/passwd $work/image/passwd 0644 0 0"
    echo "file /etc/group $work/image/group 0644 0 0"
    echo "file /etc/rover.key.pub $work/key.pub 0644 0 0"
    echo "file /etc/dropbear/host_key $work/host_key 0600 0 0"
    echo "file /root/.ssh/authorized_keys $work/id.pub 0600 0 0"
    echo "file /frames $work/image/frames 0644 0 0"
    cd "$armel/root" || exit 1
    for file in bin/busybox usr/sbin/dropbear; do echo "file /$file $armel/root/$file 0755 0 0"; done
    find lib usr/lib \( -type f -o -type l \) -name '*.so*' | while read -r file; do
        if [ -L "$file" ]; then echo "slink /$file $(readlink "$file") 0777 0 0"; else echo "file /$file $armel/root/$file 0755 0 0"; fi
    done
    [ -e lib/ld-linux.so.3 ] || echo 'slink /lib/ld-linux.so.3 arm-linux-gnueabi/ld-linux.so.3 0777 0 0'
) >image/list
"$kernel/gen_init_cpio" -t 1704067200 image/list | gzip -9n >initramfs

# --- the board
dd if=/dev/zero bs=1M count=64 2>/dev/null | tr '\0' '\377' >nor.img # erased
port=$((20000 + $$ % 20000))
echo "[127.0.0.1]:$port $(dropbearkey -y -f host_key | grep '^ssh-ed25519' | cut -d ' ' -f 1,2)" >known
power_on() {
    : >console.txt
    qemu-system-arm -M versatilepb -m 64 -nodefaults -display none -serial file:console.txt -kernel "$kernel/zImage" -dtb "$kernel/versatile-pb.dtb" -initrd initramfs \
        -append 'console=ttyAMA0 quiet' -drive if=pflash,format=raw,file=nor.img -nic "user,hostfwd=tcp:127.0.0.1:$port-:22" >qemu.txt 2>&1 &
    qemu=$!
    waited=0
    until over --status >out 2>err; do
        grep -q 'Kernel panic' console.txt && fail "the board's kernel gave up"
        kill -0 "$qemu" 2>/dev/null || fail "QEMU ended: $(cat qemu.txt)"
        waited=$((waited + 1))
        [ $waited -lt 300 ] || fail "the board does not come up"
        sleep 1
    done
}
power_off() { # as a plug is pulled
    kill -KILL "$qemu" 2>/dev/null || true
    wait "$qemu" 2>/dev/null || true
    qemu=
}
over() { "$traction" flash --host 127.0.0.1 --port "$port" --known-hosts known --identity id --folder /flash/traction "$@"; }
flash() { # flash EXPECTED_CODE WORDS ARGUMENT...
    expected=$1 words=$2
    shift 2
    code=0
    over --wait 180 "$@" >out 2>err || code=$?
    [ "$code" -eq "$expected" ] || fail "flash $* ended with $code, expected $expected"
    grep -qF -- "$words" out err || fail "expected: $words"
}

power_on
began=$(date +%s)
flash 0 'the new version runs: confirmed 0' p0.tar
echo "$([ "$nor" = yes ] && echo 'NOR flash' || echo 'in memory'): an empty board was flashed in $(($(date +%s) - began)) s"
grep -q 'self-test passed' out || fail "no self-test on the board"
flash 0 'the new version runs: confirmed 1' p1.tar
flash 3 'number 0 is not above 1' p0.tar
sed 's/^name = .*/name = "Another"/' "$root/rovers/lhomme_desages.toml" >another.toml
pack another.tar another.toml
flash 3 'for the rover Another' another.tar
pack foreign.tar lhomme_desages other
flash 3 'this rover obeys the key' foreign.tar
head -c 700000 p2.tar >cut.tar
{ head -c 100000 p2.tar; printf 'x'; tail -c +100002 p2.tar; } >changed.tar
# what this side would refuse, too, is given to the board itself
for package in cut.tar changed.tar; do
    code=0
    ssh -T -o BatchMode=yes -o UserKnownHostsFile=known -i id -p "$port" root@127.0.0.1 traction-slot --folder /flash/traction install <$package >out 2>err || code=$?
    [ $code -eq 3 ] || fail "the board took $package: $code"
done
over --status >out 2>err || fail "no status"
grep -q 'number 1, .*good' out && grep -q '^a version runs' out || fail "version 1 does not run"

if [ "$nor" = no ]; then
    flash 0 'the new version runs: confirmed 2' p2.tar
    echo "flashed over ssh; power cuts: skipped, the kernel with a flash memory is not built (sh emulate/kernel/build_flash.sh $cache)"
    exit 0
fi

# --- the plug pulled at instants over a whole install, its self-test and its trial
began=$(date +%s%N)
over --dry-run p2.tar >out 2>err || fail "p2 would not be taken"
send_ms=$((($(date +%s%N) - began) / 1000000))
old=0 new=0 trial=0 i=0
while [ "$i" -lt "$cuts" ]; do
    i=$((i + 1))
    over --wait 1 p2.tar >flashing.txt 2>&1 &
    flashing=$!
    wait_ms=$((send_ms / 2 + 900 * i))
    sleep "$(printf '%d.%03d' $((wait_ms / 1000)) $((wait_ms % 1000)))"
    last=$(tail -n 1 flashing.txt)
    power_off
    kill "$flashing" 2>/dev/null || true
    wait "$flashing" 2>/dev/null || true
    flashing=
    power_on
    cat out >after.txt
    grep -q '^a version runs' out || { sleep 3; over --status >out 2>err; grep -q '^a version runs' out || fail "after cut $i ($last) nothing runs"; }
    grep -q 'number 1, ' out || fail "after cut $i the way back is lost"
    if grep -q 'on trial' out; then
        trial=$((trial + 1))
        ssh -T -o BatchMode=yes -o UserKnownHostsFile=known -i id -p "$port" root@127.0.0.1 traction-slot --folder /flash/traction return || fail "return"
    elif grep -q 'number 2, .*good' out; then new=$((new + 1)); break
    else old=$((old + 1)); fi
    echo "cut $i after $wait_ms ms ($last): $(grep -o 'number .*' after.txt | cut -c -60 | tr '\n' ';')"
done
echo "$i cuts: $old times the old version, $trial times the new one on trial, $new times the new one for good"
if [ "$new" -eq 0 ]; then flash 0 'the new version runs: confirmed 2' p2.tar; fi
power_off
power_on
grep -q 'number 2, .*good' out || fail "the last version does not run after a power cut"
echo "flashed over ssh, cut $i times, flashed again"
