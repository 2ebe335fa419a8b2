#!/bin/sh
# A simulation that SIGKILL ends leaves LOG.part; the log made of it is whole to its last row, passes the check, and replays bit for bit.
# usage: recover.sh TRACTION SOURCE_FOLDER WORK_FOLDER
set -eu
traction=$1 source=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"
fail() { echo "FAILED: $*"; exit 1; }
sed 's/^duration_s = .*/duration_s = 3000/' "$source/scenarios/cruise.toml" >long.toml
for out in run.csv run.ulg; do
    for wait in 0.1 0.3 0.7 1.3; do
        "$traction" simulate long.toml --quiet --out $out --truth truth.csv 2>/dev/null &
        run=$!
        for _ in $(seq 200); do [ -s $out.part ] && [ -s truth.csv.part ] && break; sleep 0.05; done
        sleep $wait
        "$traction" recover $out.part --out none.csv >said 2>&1 && fail "a part is taken from a run that goes on"
        grep -q "is being written by a run that goes on" said || fail "$(cat said)"
        kill -KILL $run
        wait $run 2>/dev/null || true
        [ ! -e $out ] || fail "a killed run has a log"
        code=0
        "$traction" check $out.part >said 2>&1 || code=$?
        [ $code -eq 3 ] && grep -q "traction recover $out.part --out" said || fail "check of a part ends with $code: $(cat said)"
        "$traction" recover $out.part --out whole_$out --json recovered.json >said || fail "recover ends with $?: $(cat said)"
        "$traction" recover truth.csv.part --out truth.csv >>said || fail "the truth: $(cat said)"
        code=0
        "$traction" check whole_$out --json check.json >said || code=$?
        [ $code -le 1 ] && grep -q '"interrupted"' check.json || fail "check ends with $code, or does not know that the run was ended: $(cat said)"
        ! grep -q 'cut_last_line\|"error"' check.json || fail "not whole: $(cat check.json)"
        "$traction" replay whole_$out >said || fail "what was recovered does not replay: $(cat said)"
        rm -f $out.part truth.csv.part truth.csv
    done
done
# one that ends by itself leaves nothing but its log, and tells of what is there
"$traction" simulate long.toml --for 30 --out run.csv >said
[ "$(ls -A | grep -c part)" -eq 0 ] || fail "a run that ended leaves $(ls -A)"
echo old >run.csv.part
"$traction" simulate long.toml --for 30 --out run.csv >said
grep -q "run.csv.part is what an earlier run had" said && [ "$(cat run.csv.part)" = old ] || fail "an earlier part: $(cat said)"
echo "8 runs killed, each a whole log that replays"
