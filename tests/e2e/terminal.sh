#!/bin/sh
# terminal.sh TRACTION ROOT WORK - what the lab's verbs print fits 80 columns; colour stands in a terminal that has it, and nowhere else;
# the statistics stand where --details asks for them.
set -eu
traction=$1 root=$2 work=$3
mkdir -p "$work"
cd "$work"
export LC_ALL=C.UTF-8
fail() { echo "FAIL: $*"; exit 1; }
model=$root/models/rover_sand.toml
"$traction" simulate "$root/scenarios/sweep_sand.toml" --out run.csv --effect slip_sinkage:coefficient=0.3 > said_simulate
"$traction" compare --model "$model" --log run.csv > said_compare
"$traction" compare --model "$model" --log run.csv --details > details_compare
"$traction" diagnose --model "$model" --log run.csv --apply --out better.toml > said_diagnose
"$traction" fit --model "$model" --log run.csv > said_fit
"$traction" history --model better.toml > said_history
for said in said_compare said_diagnose said_fit said_history; do
    grep -Env '^.{0,80}$' "$said" && fail "$said is wider than 80 columns"
    grep -q "$(printf '\033')" "$said" && fail "$said: colour in a file"
done
grep -q 'R2' said_compare && fail "statistics without --details"
grep -q 'R2' details_compare || fail "no statistics with --details"
grep -q 'What is missing? slip_sinkage' said_diagnose || fail "diagnose does not answer what is missing"

if command -v script > /dev/null; then # bsdutils: a terminal for a command
    coloured() { grep -q "$(printf '\033\[1m')" "$1"; }
    env -u NO_COLOR TERM=xterm script -qec "$traction diagnose --model $model --log run.csv" /dev/null > terminal < /dev/null
    coloured terminal || fail "no colour in a terminal"
    NO_COLOR=1 TERM=xterm script -qec "$traction compare --model $model --log run.csv" /dev/null > terminal < /dev/null
    coloured terminal && fail "colour with NO_COLOR"
    env -u NO_COLOR TERM=dumb script -qec "$traction compare --model $model --log run.csv" /dev/null > terminal < /dev/null
    coloured terminal && fail "colour in a dumb terminal"
else
    echo "script(1) is not here: colour was not looked at"
fi
echo "fits 80 columns; colour where a terminal has it"
