#!/bin/sh
# Logs become ULog, are read back by PyPI's pyulog, come back as the very CSV, and answer check and diagnose as the CSV does.
# usage: ulog.sh TRACTION SOURCE_FOLDER WORK_FOLDER
set -eu
traction=$1 source=$2 work=$3
python=$source/.venv/bin/python
rm -rf "$work"
mkdir -p "$work"
cd "$work"
fail() { echo "FAILED: $*"; exit 1; }
"$traction" simulate "$source/scenarios/cruise.toml" --out made.csv >said
"$traction" convert made.csv --out run.csv >>said # as it is written, the last line included
began=$(date +%s%3N)
"$traction" convert run.csv --out run.ulg >>said
echo "$(stat -c %s run.csv) bytes of CSV, $(stat -c %s run.ulg) of ULog, converted in $(($(date +%s%3N) - began)) ms"
[ "$(stat -c %s run.ulg)" -lt "$(stat -c %s run.csv)" ] || fail "the ULog is larger than the CSV"
"$traction" convert run.ulg --out back.csv >>said
cmp run.csv back.csv || fail "what came back is another log"
"$traction" simulate "$source/scenarios/cruise.toml" --out straight.ulg >>said
cmp run.ulg straight.ulg || fail "simulate writes another ULog than convert"
for verb in 'check LOG' "diagnose --log LOG --model $source/models/rover_concrete.toml --to 8"; do
    for log in run.csv run.ulg; do
        # shellcheck disable=SC2086 # the verb's words
        code=0
        "$traction" $(echo "$verb" | sed "s|LOG|$log|") --json "${verb%% *}.$log.json" >>said 2>&1 || code=$?
        [ $code -le 1 ] || { tail -n 5 said; fail "$verb $log: exit $code"; } # 1: not good enough, or nothing found
        echo $code >>"${verb%% *}.$log.json"
    done
    sed 's/run\.ulg/run.csv/g' "${verb%% *}.run.ulg.json" >other.json
    cmp "${verb%% *}.run.csv.json" other.json || fail "${verb%% *} answers otherwise"
done
cat >odd.csv <<'T'
# format: traction-log 1
# note: names as people give them: with colons
t_s,arm.Position.x_m,arm.position_x_m,7up,"a, b",arm._,lone.value,empty.value
-1.5,1,,2,3,,,
-1,2,5,,4,1e-300,,
0.000000001,3,6,7,,-0,8,
1700,4,7,8,9,1e300,,
T
"$traction" convert odd.csv --out odd_again.csv >>said
"$traction" convert odd.csv --out odd.ulg >>said
"$traction" convert odd.ulg --out odd_back.csv >>said
cmp odd_again.csv odd_back.csv || fail "odd names do not come back"
code=0
"$traction" convert run.csv --out /nowhere/run.ulg >said 2>&1 || code=$?
[ $code -eq 4 ] || fail "a folder that is not there: exit $code"
"$python" -c 'import pyulog' 2>/dev/null || { echo 'pyulog: skipped, it is not in .venv (tests/replay/requirements.txt)'; exit 0; }
"$python" "$source/tests/log/read_ulog.py" run.csv run.ulg
"$python" "$source/tests/log/read_ulog.py" odd_again.csv odd.ulg
