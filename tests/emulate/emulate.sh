#!/bin/sh
# emulate.sh ROOT TRACTION WORK [--if-built] - the emulated board (docs/emulated_board.md): the rover's own program drives scenarios on it, each
# with the very trace of the simulation in process; runs repeat; the stop stops it; its log goes the whole way to a better model and back.
# --if-built: the short part, and only where QEMU and the board's kernel are there (77: told). Without it: all of it.
set -eu
root=$1 traction=$2 work=$3 only=${4-}
here=$root/tests/emulate
skip() { echo "emulated board: SKIPPED, $*; ./traction emulate --test brings it"; exit 77; }
fail() { echo "emulated board: $*"; exit 1; }
if [ "$only" = --if-built ]; then
    for program in qemu-system-arm arm-linux-gnueabi-gcc; do command -v $program >/dev/null 2>&1 || skip "no $program here"; done
    [ -x "$root/build/korebot/emulate/board_init" ] || skip "build/korebot is not built"
fi
rm -rf "$work"
mkdir -p "$work"
cd "$work"
status=0
TRACTION_BOARD=$(sh "$root/emulate/emulate.sh" "$root" $only) || status=$?
[ $status -ne 77 ] || skip "the board's kernel has not been built on this machine (minutes)"
[ $status -eq 0 ] || fail "cannot be laid out"
export TRACTION_BOARD
export TRACTION_ROOT="$root"
cp "$TRACTION_BOARD/initramfs" once
sh "$root/emulate/emulate.sh" "$root" $only >/dev/null
cmp once "$TRACTION_BOARD/initramfs" || fail "laid out again, the initramfs is another"

# json KEY FILE: a value of the first level
json() { sed -n "s/^ *\"$1\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}$/\1/p" "$2"; }

# drive NAME EXIT_CODE ARGUMENT...: a run; its words and JSON in NAME.txt and NAME.json. Whatever it is, the trace is the simulation's.
drive() {
    name=$1 want=$2
    shift 2
    code=0
    "$traction" emulate "$@" --json "$name.json" >"$name.txt" 2>&1 || code=$?
    [ $code -eq "$want" ] || { cat "$name.txt"; fail "$name exits $code, not $want"; }
    [ "$(json equal_in_process "$name.json")" = true ] || { cat "$name.txt"; fail "$name: the trace is not that of the simulation"; }
    [ "$(json unread_ticks "$name.json")" = 0 ] || fail "$name: the board missed ticks"
    echo "$name: $(json ticks "$name.json") ticks as in process"
}
# same A B KEY: two runs agree
same() { [ "$(json "$3" "$1.json")" = "$(json "$3" "$2.json")" ] || fail "$1 and $2 differ in $3"; }

head_of() { # DURATION SOIL
    printf 'duration_s = %s\nseed = 3\n[ground]\nsoil = "%s"\n' "$1" "$2"
}
drive_of() { # DURATION SPEED
    printf '[[drive]]\nfor_s = %s\nmode = "platform_speed"\nspeed_m_s = %s\n' "$1" "$2"
}

# 1. The stop pressed in the world stops the rover, is latched, and twice the same run is the same in every record and its time, two at once.
{ head_of 4.0 sand; drive_of 4.0 0.3; printf '[[fault]]\nwhat = "emergency_stop"\nfrom_s = 2.0\nto_s = 2.5\n'; } >stop.toml
drive stop_again 1 stop.toml --sensors iio >again.txt & # beside another: a loaded machine
beside=$!
drive stop 1 stop.toml --sensors iio --keep stop --out stop.csv
wait $beside || { cat again.txt; fail "the run beside it failed"; }
[ "$(json memory_kB stop.json)" -lt 4096 ] || fail "tractiond has $(json memory_kB stop.json) kB of the board's 64 MB" # 18 MB when each thread's whole stack was locked
same stop stop_again trace_sha256
same stop stop_again records_sha256
grep -q 'emergency stop' stop.txt || fail "the stop is not told"
awk '$1 == 198 && $NF !~ /^..3.$/ { print "does not drive before"; exit 1 } $1 >= 201 && $NF ~ /^..3.$/ { print "still driven in tick " $1; exit 1 }' stop/trace.txt ||
    fail "the stop does not stop it"

# 2. A slope, over the CAN bus's sensor node.
{ head_of 4.0 gravel; echo 'slope_rad = 0.1'; drive_of 4.0 0.25; } >slope.toml
drive slope 0 slope.toml

# 3. What the board cannot have is refused with file and mend.
{ head_of 1.0 sand; drive_of 1.0 0.2; printf '[[fault]]\nwhat = "missed_ticks"\nticks = 3\nfrom_s = 0.5\n'; } >missed.toml
code=0
"$traction" emulate missed.toml >missed.txt 2>&1 || code=$?
[ $code -eq 3 ] && grep -q 'missed.toml.*missed_ticks' missed.txt || { cat missed.txt; fail "missed_ticks: exit $code"; }
if [ "$only" = --if-built ]; then echo "emulated board: the short part holds"; exit 0; fi

# 4. The paper's figures.
drive blocked 1 fig16_blocked_wheels # a wheel that is held is a stall, here as there
drive slip 0 fig17_slip_servo_sand
drive slip_iio 0 fig17_slip_servo_sand --sensors iio
same slip slip_iio trace_sha256 # wherever the sensors end

# 5. Faults on the bus do there what they do in the simulation.
for how in lost corrupted late duplicated; do
    { echo 'bus = "can"'; head_of 3.0 concrete; drive_of 3.0 0.3; printf '[[fault]]\nwhat = "can"\nhow = "%s"\nshare = 0.1\nnode = "all"\nfrom_s = 1.0\n' $how; } >$how.toml
    drive $how 0 $how.toml
done
for how in silent bus_off; do # of a wheel's node: the other three brake, and what was lost is latched
    { echo 'bus = "can"'; head_of 3.0 concrete; drive_of 3.0 0.3; printf '[[fault]]\nwhat = "can"\nhow = "%s"\nnode = "wheel2"\nfrom_s = 1.0\n' $how; } >$how.toml
    drive $how 1 $how.toml
done
{ echo 'bus = "can"'; head_of 3.0 concrete; drive_of 3.0 0.3; printf '[[fault]]\nwhat = "can"\nhow = "lost"\nshare = 1.0\nnode = "all"\nfrom_s = 1.0\nto_s = 1.1\n'; } >burst.toml
drive burst 1 burst.toml

echo "emulated board: holds"
