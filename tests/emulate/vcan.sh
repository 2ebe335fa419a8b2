#!/bin/sh
# vcan.sh ROOT TRACTION TRACTIOND WORK [--fetch] - the rover's own program on x86 against `traction simulate --can vcan0`, on a kernel that has
# CAN: Debian's own, in QEMU, whose clock is its count of instructions (nobody outside is waited for), so that a loaded machine does not show. Drives recorded commands, then an
# operator's over the link; the log is converted. Exit 77, in words, where QEMU for x86 or the kernel is not there; --fetch: fetches the kernel
# (apt, unpacked beside the emulated board's, never into this system).
set -eu
root=$1 traction=$2 tractiond=$3 work=$4 fetch=${5-}
skip() { echo "vcan: SKIPPED, $*"; exit 77; }
fail() { echo "vcan: FAILED: $*"; [ ! -s "$work/console.txt" ] || tail -n 40 "$work/console.txt"; exit 1; }
cache=${XDG_CACHE_HOME:-$HOME/.cache}/traction
[ "$(uname -m)" = x86_64 ] || skip "this machine is no x86"
command -v qemu-system-x86_64 >/dev/null 2>&1 || skip "no qemu-system-x86_64 here (apt: qemu-system-x86)"
mkdir -p "$cache" "$work"
kernel=$(find "$cache" -maxdepth 1 -name 'x86-kernel-*' | sort -V | tail -n 1)
if [ -z "$kernel" ]; then
    [ "$fetch" = --fetch ] || skip "Debian's kernel for x86 is not in $cache; tests/emulate/vcan.sh ... --fetch brings it (70 MB)"
    package=$(apt-cache depends linux-image-amd64 | sed -n 's/^ *Depends: //p' | head -n 1)
    making=$(mktemp -d "$cache/making.XXXXXX")
    (cd "$making" && apt-get -q download "$package" busybox-static >apt.log 2>&1 && for file in ./*.deb; do dpkg-deb -x "$file" .; done) ||
        fail "apt brings no $package and busybox-static"
    kernel=$cache/x86-kernel-${package#linux-image-}
    mkdir "$making/kept"
    mv "$making"/boot/vmlinuz-* "$making/kept/vmlinuz"
    find "$making" -path '*/bin/busybox' -exec mv {} "$making/kept/" \;
    for module in net/can/can net/can/can-raw drivers/net/can/dev/can-dev drivers/net/can/vcan; do find "$making" -path "*/$module.ko*" -exec mv {} "$making/kept/" \;; done
    mv "$making/kept" "$kernel"
    rm -rf "$making"
fi
for module in "$kernel"/*.ko.xz; do [ ! -e "$module" ] || xz -d "$module"; done

# --- the system: these programs and the libraries that they are linked with
cd "$work"
work=$(pwd)
rm -rf system && mkdir -p system
put() { # put FILE...: at its own place
    for file; do
        mkdir -p "system$(dirname "$file")"
        cp -L "$file" "system$file"
    done
}
put "$traction" "$tractiond"
for program in "$traction" "$tractiond"; do ldd "$program" | grep -o '/[^ ]*'; done | sort -u | while read -r library; do put "$library"; done
for folder in bin dev proc sys tmp lib/modules; do mkdir -p "system/$folder"; done
cp "$kernel"/*.ko system/lib/modules/
cp "$kernel/busybox" system/bin/
words='sh awk cat grep insmod ip kill mount sed sleep'
cp -r "$root/rovers" "$root/models" system/ 2>/dev/null || true
printf '[hardware]\nwheels = "can"\nsensors = "can"\nemergency_stop = "can"\ncan_interface = "vcan0"\npriority = 50\n' >system/desk.toml
printf 'duration_s = 600.0\nseed = 4\n[ground]\nsoil = "concrete"\n[[drive]]\nfor_s = 600.0\nmode = "stop"\n' >system/world.toml
printf 'duration_s = 8.0\nseed = 4\n[ground]\nsoil = "concrete"\n[[drive]]\nfor_s = 7.0\nmode = "platform_speed"\nspeed_m_s = 0.3\n[[drive]]\nfor_s = 1.0\nmode = "stop"\n' >drive.toml
"$traction" simulate drive.toml --frames system/frames --out /dev/null >out 2>&1 || fail "the commands of a drive"
"$traction" drive --new-key system/key >out 2>&1 || fail "a key"
cat >system/init <<INIT
#!/bin/busybox sh
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin TRACTION_ROOT=/
traction=$traction tractiond=$tractiond
INIT
cat >>system/init <<'INIT'
mount -t proc proc /proc; mount -t sysfs sys /sys; mount -t devtmpfs dev /dev
for module in can can-dev can-raw vcan; do insmod /lib/modules/$module.ko; done
end() { echo "vcan: $*"; echo o >/proc/sysrq-trigger; sleep 60; }
code=0
$traction simulate /world.toml --can vcan0 >/none.txt 2>&1 || code=$?
echo "none: $code: $(cat /none.txt)"
ip link set lo up
ip link add vcan0 type vcan
code=0
$traction simulate /world.toml --can vcan0 >/down.txt 2>&1 || code=$?
echo "down: $code: $(cat /down.txt)"
ip link set vcan0 up
$traction simulate /world.toml --can vcan0 --json /bus.json >/bus.txt 2>&1 &
nodes=$!
until grep -q 'waiting for the SYNC' /bus.txt; do kill -0 $nodes || end "the nodes ended: $(cat /bus.txt)"; sleep 0.2; done
code=0
{ sleep 9; kill -TERM $(cat /tmp/daemon); } &
sh -c 'echo $$ >/tmp/daemon; exec "$0" "$@"' $tractiond --hal linux /desk.toml commands=/frames --log /log >/daemon.txt 2>&1 || code=$?
echo "recorded: $code: $(cat /daemon.txt)"
$tractiond --hal linux /desk.toml --log /log2 --link 127.0.0.1 --link-key /key >/linked.txt 2>&1 &
daemon=$!
sleep 1
code=0
$traction drive --host 127.0.0.1 --key /key --speed 0.3 --for 5 --json /drive.json >/drive.txt 2>&1 || code=$?
echo "linked: $code: $(cat /drive.txt)"
grep mean_speed /drive.json
kill -TERM $daemon
wait $daemon
echo "daemon: $?: $(cat /linked.txt)"
kill -TERM $nodes
code=0
wait $nodes || code=$?
echo "nodes: $code: $(cat /bus.txt)"
grep -E 'ticks|lost|frames' /bus.json
code=0
$traction convert /log/log_000001.ulg --out /run.csv || code=$?
echo "convert: $code"
awk -F , '/^t_s,/ { for (i = 1; i <= NF; i++) if ($i == "estimate.speed_m_s") column = i; next } $1 + 0 >= 5 && $column != "" { print "speed: " $column; exit }' /run.csv
end whole
INIT
chmod +x system/init
{
    (cd system && find . -mindepth 1 -type d | sed 's/^[.]//') | sort | while read -r path; do echo "dir $path 0755 0 0"; done
    for word in $words; do echo "slink /bin/$word busybox 0777 0 0"; done
    echo 'nod /dev/console 0600 0 0 c 5 1'
    (cd system && find . -type f | sed 's/^[.]//') | sort | while read -r path; do
        mode=0755
        [ "$path" != /key ] || mode=0600
        echo "file $path $work/system$path $mode 0 0"
    done
} >list
pack=$(find "$cache" -maxdepth 2 -path '*/board-*/gen_init_cpio' | head -n 1)
[ -n "$pack" ] || skip "no gen_init_cpio: it comes with the emulated board's kernel (./traction emulate)"
"$pack" list >initramfs || fail "no initramfs"
timeout 1500 qemu-system-x86_64 -m 1024 -nodefaults -display none -serial file:console.txt -kernel "$kernel/vmlinuz" -initrd initramfs -icount shift=0,sleep=off \
    -append 'console=ttyS0 quiet rdinit=/init' -no-reboot || fail "QEMU: $?"
tr -d '\r' <console.txt >said.txt
says() { grep -q -- "$1" said.txt || fail "expected: $1"; }
says '^vcan: whole'
says '^none: 3: .*is no CAN interface of this machine; make one: modprobe vcan'
says '^down: 3: .*ip link set vcan0 up'
says '^recorded: 0: .*asked to stop.*faults seen 00000000'
says '^linked: 0: '
says '^daemon: 0: '
says '^nodes: 143: '
says '"lost_frames": 0'
says '^convert: 0'
# the middle of each drive: 0.3 m/s were asked for, a tenth off is a platform that does not follow (concrete, 2 s after its start)
awk -F '[:,]' '/mean_speed_m_s/ { v = $2; found = 1 } END { exit !(found && v > 0.27 && v < 0.33) }' said.txt || fail "the operator's drive: $(grep mean_speed said.txt)"
awk '$1 == "speed:" { v = $2; found = 1 } END { exit !(found && v > 0.27 && v < 0.33) }' said.txt || fail "the recorded drive: $(grep '^speed' said.txt)"
grep -E '^recorded|^[0-9.]* s: |mean_speed|^speed' said.txt
echo "vcan: holds"
