#!/bin/sh
# flash.sh ROOT TRACTION WORK [--if-built] - traction flash over a real ssh server (Debian's dropbear for armel) onto the emulated board with a
# NOR flash and JFFS2, which keep what was written when QEMU is killed: a power cut, at instants of the transfer, the install, the self-test,
# the trial and after it. The version is the file that goes onto the rover. --if-built: fewer cuts, and only where kernel and ssh server are.
set -eu
root=$1 traction=$2 work=$3 only=${4-} label='flashed board'
. "$root/tests/emulate/desk.sh"

sed 's/^duration_s.*/duration_s = 90.0/; s/^for_s = 22.0/for_s = 82.0/' "$root/scenarios/cruise.toml" >drive.toml
"$traction" simulate drive.toml --frames board/frames --out /dev/null >out 2>err || fail "frames of a drive"
cat >board/default <<'DEFAULT'
STATE=/flash/state
TRACTIOND_HAL=replay
TRACTIOND_OPTIONS='--realtime --log-budget 2'
TRACTIOND_ROVER=/frames
if grep -q '# ends' rover.toml; then TRACTIOND_ROVER=/nowhere; fi
DEFAULT
make_board
rover=$root/rovers/lhomme_desages.toml
for n in 0 1 2; do pack p$n.tar --key key --program tractiond --rover "$rover"; done
now_ms() { date +%s%3N; }

# --- the first flash, and the next
power_on
began=$(now_ms)
flash 0 'the new version runs: confirmed 0' p0.tar
grep -q 'self-test passed' out || fail "no self-test on the board"
echo "an empty board was flashed in $(($(now_ms) - began)) ms"
good=0
if [ "$only" != --if-built ]; then
    flash 0 'the new version runs: confirmed 1' p1.tar
    good=1
fi

# --- pieces of every length, so that some of them are one word at an edge of the flash memory's buffer (emulate/kernel/build.sh)
memory_is_well() {
    say_ssh 'busybox dmesg' >dmesg.txt || fail "no words of the kernel"
    ! grep -i 'write error\|status timeout\|not ready' dmesg.txt || fail "the driver of the flash memory complains"
}
say_ssh 'i=0; text=; while [ $i -lt 1500 ]; do text=x$text; [ ${#text} -lt 24 ] || text=x; echo $text >>/flash/pieces; i=$((i + 1)); done; sync' || fail "pieces cannot be written"
pieces=$(awk 'BEGIN { n = 0; for (i = 0; i < 1500; i++) { if (++n == 24) n = 1; sum += n + 1 } print sum }')
[ "$(say_ssh 'cat /flash/pieces' | wc -c)" -eq "$pieces" ] || fail "of the pieces' $pieces bytes not all are there"
say_ssh 'rm /flash/pieces'
memory_is_well
echo '1500 pieces of 2 to 24 bytes were written, and read back'

# --- what is refused changes nothing
over --status >before.txt 2>err || fail "no status"
unchanged() { over --status >after.txt 2>err || fail "no status"; cmp -s before.txt after.txt || fail "$1 changed the board"; }
board_refuses() { # PACKAGE WORDS: what this side would refuse, too, is given to the board itself
    code=0
    say_ssh traction-slot --folder /flash/traction install <"$1" >out 2>err || code=$?
    [ $code -eq 3 ] || fail "the board took $1: $code"
    grep -qF -- "$2" err || fail "$1: expected: $2"
}
{ head -c 100000 p2.tar; printf 'x'; tail -c +100002 p2.tar; } >changed.tar
cp p2.tar unsigned.tar
tar --delete -f unsigned.tar manifest.sig
board_refuses changed.tar 'traction-slot: '
board_refuses unsigned.tar 'traction-slot: '
told='changed, unsigned'
if [ "$only" != --if-built ]; then
    flash 3 'number 0 is not above 1' p0.tar
    sed 's/^name = .*/name = "Another"/' "$rover" >another.toml
    pack another.tar --key key --program tractiond --rover another.toml
    flash 3 'for the rover Another, this is Lhomme-Desages' another.tar
    { head -c 18 tractiond; printf '\267\0'; tail -c +21 tractiond; } >arm64 # e_machine
    pack arm64.tar --key key --program arm64 --rover "$rover"
    flash 3 'for the architecture arm64' arm64.tar
    "$traction" flash --new-key other >out 2>err
    pack foreign.tar --key other --program tractiond --rover "$rover"
    flash 3 'this rover obeys the key' foreign.tar
    head -c 700000 p2.tar >cut.tar
    board_refuses cut.tar 'traction-slot: '
    for package in changed cut unsigned; do
        code=0
        over $package.tar >out 2>err || code=$?
        [ $code -eq 3 ] || fail "$package.tar ended with $code"
    done
    told="$told, older, another rover, another architecture, foreign, cut"
fi
unchanged 'what was refused'
echo "refused, and nothing changed: $told"

# --- a version that does not come up: the old one runs again, by itself
if [ "$only" != --if-built ]; then
    arm-linux-gnueabi-strip -o false "$target/firmware/flash/traction-slot" # an ARM program that is no tractiond
    pack false.tar --key key --program false --rover "$rover"
    flash 1 'fails its self-test on this board' false.tar
fi
{ cat "$rover"; echo '# ends'; } >ends.toml
pack ends.tar --key key --program tractiond --rover ends.toml
flash 1 'the old version runs; the new one did not come up: returned' ends.tar
runs() { # runs NUMBER: that version is good, and its program is running
    tries=0
    until over --status >out 2>err && grep -q "number $1, .*good" out && say_ssh ps 2>/dev/null | grep -q '[.]/tractiond'; do
        tries=$((tries + 1))
        [ $tries -lt 60 ] || fail "number $1 does not run"
        sleep 1
    done
}
runs $good
echo 'returned by itself from a version that does not come up'

# --- the plug pulled
next=0 cuts=0 kept=0 on_trial=0 changed=0
pack_next() { pack next.tar --key key --program tractiond --rover "$rover"; next=$(sed -n 's/.*number \([0-9]*\) of key.*/\1/p' out | head -n 1); }
pack_next
cut() { # cut WORDS SECONDS: so long after the flash said that
    words=$1 after=$2
    : >flashing.txt
    over --wait 100 next.tar >flashing.txt 2>&1 &
    flashing=$!
    tries=0
    until grep -qF -- "$words" flashing.txt; do
        kill -0 $flashing 2>/dev/null || { cat flashing.txt; fail "the flash ended before it said: $words"; }
        tries=$((tries + 1))
        [ $tries -lt 2400 ] || fail "the flash never said: $words"
        sleep 0.05
    done
    sleep "$after"
    last=$(tail -n 1 flashing.txt)
    power_off
    kill $flashing 2>/dev/null || true
    wait $flashing 2>/dev/null || true
    flashing=''
    power_on
    cuts=$((cuts + 1))
    grep -q "number $good, " out || grep -q "number $next, .*good" out || fail "after a cut ($last) the way back is lost"
    if grep -q "number $next, .*good" out; then
        changed=$((changed + 1)) good=$next
        runs "$good"
        pack_next
        is='the new version, for good'
    else
        is='the old version'
        kept=$((kept + 1))
        if grep -q 'on trial' out; then
            kept=$((kept - 1)) on_trial=$((on_trial + 1)) is='the new version, on trial; sent back'
            say_ssh traction-slot --folder /flash/traction return >/dev/null || fail "return"
        fi
        runs "$good"
    fi
    echo "cut $after s after \"$words\": $is"
}
cut 'sends' 0.3
cut 'signature and checksums hold' 0.1
cut 'waits until the new version is healthy' 4
if [ "$only" != --if-built ]; then
    for after in 0.0 0.4 0.8 1.2 1.6 2.0; do cut 'signature and checksums hold' $after; done
    for after in 0.0 1.0 2.0; do cut 'written and read back' $after; done
    cut 'self-test passed' 0
    for after in 0.0 0.1 0.3; do cut 'on trial from the next start on' $after; done
    cut 'the new version runs' 0
fi
echo "$cuts cuts: $kept times the old version, $on_trial times the new one on trial, $changed times the new one for good"
flash 0 "the new version runs: confirmed $next" next.tar
memory_is_well
power_off
power_on
runs "$next"
memory_is_well

# --- and every log that a cut ended is read up to it
logs=$(say_ssh ls /flash/state/log | grep '[.]ulg')
read=0
for log in $logs; do
    if ! say_ssh cat "/flash/state/log/$log" >$log; then # the version that runs goes on logging: the ring drops the oldest
        say_ssh ls /flash/state/log | grep -q "^$log\$" && fail "$log is not fetched"
        continue
    fi
    code=0
    "$traction" convert "$log" --out log.csv >out 2>err || code=$?
    [ $code -eq 0 ] || grep -q 'holds no whole tick' err || fail "$log is not read" # cut before its first tick was on the flash
    [ $code -ne 0 ] || read=$((read + 1))
done
[ $read -ge 2 ] || fail "of the logs on the flash memory $read are read"
echo "$read logs of $(echo "$logs" | wc -l) that starts and cuts left on the flash memory are read; the others have no tick yet"
power_off
echo "$label: holds"
