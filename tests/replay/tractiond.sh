#!/bin/sh
# tractiond's command line: every mistake is told with its exit code, a trace is whole or its loss is told, a signal ends the run with
# the motors stopped. usage: tractiond.sh WORK_FOLDER SIM_HERE MAKE_FRAMES TRACTIOND [EMULATOR...]
set -eu
work=$1 sim_here=$2 make_frames=$3 program=$4
shift 4
mkdir -p "$work"
cd "$work"
run() { # run EXPECTED_CODE ARGUMENT...: output in out, messages in err
    expected=$1
    shift
    code=0
    ${emulator:+$emulator} "$program" "$@" >out 2>err || code=$?
    [ "$code" -eq "$expected" ] || { echo "tractiond $*: exit $code, expected $expected"; cat err; exit 1; }
}
emulator=$*
says() { grep -qF -- "$1" err || { echo "expected on stderr: $1"; echo "got:"; cat err; exit 1; }; }

${emulator:+$emulator} "$make_frames" frames.txt

run 0 --help
grep -q '  replay FRAMES' out
run 2
says 'no --hal'
run 2 --hal canbus
says '--hal canbus: there is no such HAL; known here: replay'
run 2 --hal replay --hush frames.txt
says '--hush'
run 2 --hal replay --firmware mine frames.txt
says '--firmware mine: unknown; give default or paper'
run 2 --hal replay
says '--hal replay: got 0 arguments; give one file of frames'
run 3 --hal replay nowhere.txt
says 'nowhere.txt: cannot be read: No such file'
if [ "$sim_here" = 0 ]; then
    run 2 --hal sim cruise.toml
    says '--hal sim: not in this build: the simulator runs on the host alone'
else
    run 3 --hal sim nowhere.toml
    says 'nowhere.toml: cannot be read: No such file'
fi

# a frame that is none: file, line, field, value, mend; what came before was driven, and the motors are stopped
awk 'NR == 3 { $14 = 70000 } { print }' frames.txt >bad.txt
run 3 --hal replay bad.txt
says 'bad.txt:3: accel = 70000: out of range; -32768 to 32767; motors stopped after 2 ticks'
head -c 1000 frames.txt >short.txt
run 3 --hal replay short.txt
says 'short.txt:'

# the parameter file reaches the firmware, its mistakes reach the user
run 0 --hal replay --hash frames.txt
plain=$(cat out)
printf 'format = "traction.firmware/1"\nwheel_radius_m = 0.06\n' >rover.txt
run 0 --hal replay --hash --parameters rover.txt frames.txt
[ "$plain" != "$(cat out)" ] || { echo "the parameter file changed nothing"; exit 1; }
printf 'format = "traction.firmware/1"\nwheel_radius_m = 57\n' >rover.txt
run 3 --hal replay --parameters rover.txt frames.txt
says 'rover.txt:2: wheel_radius_m'
run 0 --hal replay --hash --firmware paper frames.txt
[ "$plain" != "$(cat out)" ] || { echo "--firmware paper changed nothing"; exit 1; }

# every tick is in the trace; a disk that is full is told
run 0 --hal replay --trace trace.txt frames.txt
[ "$(wc -l <trace.txt)" -eq 3000 ] || { echo "the trace has $(wc -l <trace.txt) lines"; exit 1; }
run 0 --hal replay --trace - --hash frames.txt
head -n 3000 out | cmp - trace.txt
[ "$(tail -n 1 out)" = "$plain" ] || { echo "another hash beside the trace"; exit 1; }
if [ -w /dev/full ]; then
    run 4 --hal replay --trace /dev/full frames.txt
    says '/dev/full: the trace could not be written whole'
fi
run 4 --hal replay --trace nowhere/trace.txt frames.txt
says 'nowhere/trace.txt: cannot be written'

# 30 s of drive in real time end within a tick of a signal, with the motors stopped and the trace whole
for signal in INT TERM; do
    ( # of its own: an interactive shell's job control ignores INT in the background
        trap - INT
        exec ${emulator:+$emulator} "$program" --hal replay --realtime --trace trace.txt frames.txt 2>err
    ) &
    child=$!
    sleep 1
    kill -s "$signal" $child
    code=0
    wait $child || code=$?
    [ "$code" -eq 0 ] || { echo "SIG$signal: exit $code"; cat err; exit 1; }
    says 'asked to stop'
    says 'motors stopped'
    lines=$(wc -l <trace.txt)
    [ "$lines" -gt 5 ] && [ "$lines" -lt 2000 ] || { echo "SIG$signal: $lines ticks in a second"; exit 1; }
    ticks=$(sed -n 's/.* \([0-9]*\) ticks.*/\1/p' err)
    [ "$lines" -eq "$ticks" ] || { echo "SIG$signal: $lines lines, $ticks ticks"; exit 1; }
done
# health for who started it (docs/flash.md): 1000 ticks in a row without a fault, and not before
run 2 --hal replay --health-fd 0 frames.txt
says '--health-fd 0: not a descriptor; give one from 1 to 1023'
run 0 --hal replay --health-fd 9 frames.txt 9>health
[ "$(cat health)" = healthy ] || { echo "on the health descriptor:"; cat health; exit 1; }
head -n 999 frames.txt >short.txt
run 0 --hal replay --health-fd 9 short.txt 9>health
[ ! -s health ] || { echo "healthy before its time:"; cat health; exit 1; }
run 0 --hal replay --health-fd 9 frames.txt # which nobody opened
echo "tractiond: messages, exit codes, traces and signals as stated"
