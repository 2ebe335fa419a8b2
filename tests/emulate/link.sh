#!/bin/sh
# link.sh ROOT TRACTION WORK [--if-built] - the supervision link (docs/supervision.md) of the emulated board, over its own network device: a drive in
# lockstep with a world is logged on the NOR flash; at the desk the log is listed and downloaded by MAVLink over QEMU's network, which loses
# datagrams, and is byte for byte what ssh brings and what the drive handed out; check reads it. Who has another key stops nothing.
set -eu
root=$1 traction=$2 work=$3 only=${4-} label='link of the board'
. "$root/tests/emulate/desk.sh"
export TRACTION_ROOT="$root"

sed 's/^duration_s.*/duration_s = 180.0/; s/^for_s = 22.0/for_s = 172.0/' "$root/scenarios/cruise.toml" >desk.toml
"$traction" simulate desk.toml --frames board/frames --out /dev/null >out 2>err || fail "frames of a drive"
make_board
grep -q -- '--link-key /etc/link.key' board/default || skip "this build has no supervision link (pymavlink)"
pack p0.tar --key key --program tractiond --rover lhomme_desages
"$traction" flash p0.tar --image board/nor.img --key key.pub --mount /flash --folder /flash/traction --size 65536 >out 2>err || fail "image"
printf 'duration_s = 8.0\nseed = 5\n[ground]\nsoil = "sand"\n[[drive]]\nfor_s = 8.0\nmode = "platform_speed"\nspeed_m_s = 0.3\n' >drive.toml
"$traction" emulate drive.toml --board board --flash board/nor.img --keep kept --json drive.json >out 2>err || fail "drive"
grep -q '"equal_in_process": true' drive.json || fail "the trace is not that of the simulation"
[ "$(ls kept/log | wc -l)" -eq 1 ] || fail "one log was expected: $(ls kept/log)"
number=$(ls kept/log | sed 's/^log_0*\([0-9]*\)[.]ulg$/\1/')

linked() { "$traction" drive --host "127.0.0.1:$port" "$@" >out 2>err; }
power_on
tries=0
until linked --for 1; do # the version takes a moment after the ssh server
    tries=$((tries + 1))
    [ $tries -lt 30 ] || fail "no telemetry from the board"
    sleep 1
done
grep -q 'm/s' out || fail "telemetry without a speed"
linked --logs || fail "the list of logs"
say_ssh cat "/flash/state/log/log_$(printf %06d "$number").ulg" >by_ssh.ulg || fail "the log is not fetched by ssh"
awk -v n="$number" -v size="$(stat -c %s by_ssh.ulg)" '$1 == n { found = index($0, size) } END { exit !found }' out || fail "the list has no log $number of $(stat -c %s by_ssh.ulg) bytes"
began=$(date +%s%3N)
linked --fetch "$number" --out by_link.ulg || fail "the download"
took=$(($(date +%s%3N) - began))
cmp by_ssh.ulg by_link.ulg || fail "MAVLink brings another file than ssh"
cmp by_ssh.ulg "kept/log/$(ls kept/log)" || fail "the log on the flash memory is not the one that the drive handed out"
"$traction" convert by_link.ulg --out run.csv >out 2>err || fail "convert"
"$traction" check run.csv >check.txt 2>err || { cat check.txt; fail "check"; }
echo "log $number of the drive: $(stat -c %s by_link.ulg) bytes in $took ms over the link, byte for byte as by ssh; check reads it"

# --- the log that is being written: what was there when it was asked for
linked --logs || fail "the list of logs"
newest=$(awk '$1 ~ /^[0-9]+$/ { n = $1 } END { print n }' out)
[ "$newest" -gt "$number" ] || fail "the version at the desk writes no log of its own"
linked --fetch "$newest" --out growing.ulg || fail "the download of a log that grows"
say_ssh cat "/flash/state/log/log_$(printf %06d "$newest").ulg" | head -c "$(stat -c %s growing.ulg)" | cmp - growing.ulg || fail "a log that grows came wrongly"
linked --fetch 77 --out none.ulg && fail "a log that is not there"
[ ! -e none.ulg ] || fail "a file of a log that is not there"

# --- orders: by the board's key alone
"$traction" drive --new-key other >out 2>err || fail "another key"
code=0
linked --key other --stop || code=$?
[ $code -eq 4 ] && grep -q 'signs with another key' out err || fail "another key: exit $code"
linked --key board/link.key --stop || fail "a stop by the board's key"
power_off
echo 'a log that grows, a log that is not there, an order by another key: as told'
echo "$label: holds"
