#!/bin/sh
# product.sh ROOT TRACTION WORK [--if-built] - the whole product in one run: a version is flashed over ssh onto the emulated board; it drives, in
# lockstep with a world that hides an effect; its log is fetched from the board's flash memory, checked and diagnosed; the effect is named and
# added; the better numbers are exported, packed, signed and flashed; the board comes up with them and drives. Desk and drive are two boots of
# one image with one flash memory: at the desk a real clock and a network, in the drive a counted clock and a world.
set -eu
root=$1 traction=$2 work=$3 only=${4-} label='product'
. "$root/tests/emulate/desk.sh"
export TRACTION_ROOT="$root"
effect=slip_sinkage:coefficient=0.2

make_board
value() { sed -n "s/^ *\"$1\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}$/\1/p" "$2"; }
drive() { # drive NAME: on the board, by the version in its slots
    "$traction" emulate demo_sand --effect $effect --board board --flash board/nor.img --keep "$1" --json "$1.json" >out 2>err || fail "drive $1"
    [ "$(value equal_in_process "$1.json")" = true ] || fail "drive $1: the trace is not that of the simulation"
    [ "$(value unread_ticks "$1.json")" = 0 ] || fail "drive $1: the board missed ticks"
    grep -q 'the new version is healthy, and the good one from now on' "$1/tractiond.txt" || fail "drive $1: the version was not confirmed by its drive"
    echo "$1: $(value ticks "$1.json") ticks as in process, confirmed by its drive"
}
installed() { # installed PACKAGE NUMBER: at the desk, without a world: it is tried in its drive
    flash 0 'installed; no version runs there now' "$1"
    grep -q 'self-test passed' out || fail "no self-test on the board"
    over --status >out 2>err && grep -q "number $2, .*on trial" out || fail "number $2 is not on trial"
}

# --- a flash memory without a version drives nothing, and says so
code=0
"$traction" emulate cruise --board board --flash board/nor.img >out 2>err || code=$?
[ $code -ne 0 ] && grep -q 'traction-slot init makes the folder' out err || fail "an empty flash memory: exit $code"
if [ "$only" != --if-built ]; then # one that was made ready, too
    power_on idle
    power_off
    code=0
    "$traction" emulate cruise --board board --flash board/nor.img >out 2>err || code=$?
    [ $code -ne 0 ] && grep -q 'neither slot holds a whole version' out err || fail "empty slots: exit $code"
fi
printf x >short.img
code=0
"$traction" emulate cruise --board board --flash short.img >out 2>err || code=$?
[ $code -ne 0 ] && grep -q "the board's NOR flash has 67108864" out err || fail "a flash memory of one byte: exit $code"

# --- the first version, with the description's numbers
pack v0.tar --key key --program tractiond --rover lhomme_desages
power_on idle
installed v0.tar 0
power_off
drive first

# --- its log, fetched from the flash memory: to the effect's name and to better numbers
power_on idle
grep -q 'confirmed 0' out || fail "version 0 is not the good one"
log=$(say_ssh ls /flash/state/log | grep '[.]ulg' | tail -n 1)
say_ssh cat "/flash/state/log/$log" >board.ulg || fail "the log is not fetched"
"$traction" convert board.ulg --out run.csv >out 2>err || fail "convert"
"$traction" check run.csv >check.txt 2>err || fail "check"
"$traction" diagnose --model "$root/models/rover_sand.toml" --log run.csv --apply --out better.toml >diagnose.txt 2>err || fail "diagnose"
grep -q '^found: slip_sinkage: coefficient = ' diagnose.txt || { cat diagnose.txt; fail "slip_sinkage is not named"; }
grep '^found: ' diagnose.txt
awk '/^found: / { gsub(/[][,]/, " "); exit !($6 <= 0.2 && 0.2 <= $7) }' diagnose.txt || fail "0.2, which was hidden, is not within its bracket"
"$traction" export --model better.toml --firmware rover.txt >out 2>err || fail "export"

# --- the better numbers, on the board
pack v1.tar --key key --program tractiond --rover lhomme_desages --parameters rover.txt
tar xOf v1.tar parameters >packed.txt
installed v1.tar 1
power_off
drive better
cmp -s packed.txt better/parameters.txt || fail "the board drove with other numbers than were flashed"
! cmp -s first/parameters.txt better/parameters.txt || fail "nothing was learnt"
power_on idle
grep -q 'confirmed 1' out || fail "version 1 is not the good one"
power_off
echo "$label: holds"
