#!/bin/sh
# tractiond's on-board log and its init script: what was driven is in the log, after a stop, after a kill, after a fault; mistakes are told.
# usage: onboard_log.sh WORK_FOLDER SOURCE_FOLDER MAKE_FRAMES TRACTIOND [EMULATOR...]
set -eu
work=$1 source=$2 make_frames=$3 program=$4
shift 4
rm -rf "$work"
mkdir -p "$work"
cd "$work"
emulator=$*
run() { # run EXPECTED_CODE ARGUMENT...
    expected=$1
    shift
    code=0
    ${emulator:+$emulator} "$program" "$@" >out 2>err || code=$?
    [ "$code" -eq "$expected" ] || { echo "tractiond $*: exit $code, expected $expected"; cat err; exit 1; }
}
says() { grep -qF -- "$1" err || { echo "expected on stderr: $1"; echo "got:"; cat err; exit 1; }; }
python=$source/.venv/bin/python
"$python" -c 'import pyulog' 2>/dev/null || python=
read_ulog() { [ -z "$python" ] || "$python" "$source/tests/replay/read_ulog.py" "$@"; }

${emulator:+$emulator} "$make_frames" frames.txt

run 2 --hal replay --log-budget 0 frames.txt
says '--log-budget 0: not a size; give whole megabytes from 1 to 100000'
run 4 --hal replay --log /dev/null frames.txt
says '--log /dev/null: is no folder to write in'
run 0 --hal linux --help
grep -q '  linux ROVER' out
run 3 --hal linux nowhere.toml
says 'nowhere.toml: cannot be read'
printf '[hardware]\nwheels = "can"\nsensors = "can"\nemergency_stop = "can"\ncan_interface = "can9"\n' >rover.toml
run 3 --hal linux rover.toml
says 'rover.toml:5: hardware.can_interface = "can9": is no CAN interface that is up'
{ cat rover.toml; echo 'led_lines = 3'; } >wrong.toml
run 3 --hal linux wrong.toml
says 'wrong.toml:6: hardware.led_lines = 3: unknown key'
run 3 --hal linux "$source/rovers/lhomme_desages.toml" root="$work/nothing"
says 'hardware.'

# every tick is in the log, in one file or in several
run 0 --hal replay --log whole --log-budget 64 frames.txt
[ "$(find whole -name 'log_*.ulg' | wc -l)" -eq 1 ]
read_ulog whole/log_000001.ulg frames.txt
run 0 --hal replay --log whole frames.txt # a second start is a second file
[ "$(find whole -name 'log_*.ulg' | wc -l)" -eq 2 ]
cmp whole/log_000001.ulg whole/log_000002.ulg
run 0 --hal replay --log small --log-budget 1 frames.txt
bytes=$(cat small/log_*.ulg | wc -c)
[ "$bytes" -le 1000000 ] || { echo "the budget of 1 MB holds $bytes bytes"; exit 1; }

# killed while it drives, as by a power cut: what was brought to the disk in the last second is there
${emulator:+$emulator} "$program" --hal replay --realtime --log killed frames.txt 2>err &
child=$!
sleep 3
kill -KILL $child
wait $child 2>/dev/null || true
size=$(wc -c <killed/log_000001.ulg)
[ "$size" -ge 35000 ] || { echo "killed after 3 s: the log has $size bytes, less than the first second's"; exit 1; }
read_ulog killed/log_000001.ulg

# the init script starts, tells, stops: with the motors stopped and the log whole
if [ -z "$emulator" ] && command -v start-stop-daemon >/dev/null 2>&1; then
    printf 'DAEMON=%s\nROVER=%s/frames.txt\nSTATE=%s/state\nPIDFILE=%s/pid\nTRACTIOND_HAL=replay\nTRACTIOND_OPTIONS=--realtime\n' \
        "$program" "$work" "$work" "$work" >defaults
    script() { TRACTIOND_DEFAULTS=$work/defaults sh "$source/firmware/app/service/S90tractiond" "$1"; }
    code=0
    script status >out || code=$?
    [ "$code" -eq 3 ]
    script start
    script start | grep -q 'runs already'
    sleep 1.5
    script status | grep -q 'tractiond: runs'
    pid=$(cat pid)
    script stop
    ! kill -0 "$pid" 2>/dev/null || { echo "the init script's stop left $pid running"; exit 1; }
    [ -s state/store ]
    read_ulog state/log/log_000001.ulg
    script stop
else
    echo "init script: skipped, no start-stop-daemon here, or an emulated program"
fi
[ -n "$python" ] || echo "pyulog is not in .venv (tests/replay/requirements.txt): the log was read by ulog_test alone"
echo "tractiond: the on-board log holds what was driven"
