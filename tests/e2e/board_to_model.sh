#!/bin/sh
# The rover's own log through the whole of it: tractiond drives a rover whose wheels sink with slip, over the CAN bus; its on-board log is converted,
# checked, diagnosed; the effect is named with its size, the better model exported, and the rover's program drives on with its numbers.
# usage: board_to_model.sh TRACTION TRACTIOND WORK_FOLDER SOURCE_FOLDER
set -eu
traction=$1 tractiond=$2 work=$3 source=$4
rm -rf "$work"
mkdir -p "$work"
cd "$work"
{ echo 'bus = "can"'; cat "$source/scenarios/demo_sand.toml"; } >sand.toml
if ! "$tractiond" --hal sim sand.toml effect=slip_sinkage:coefficient=0.2 --log log 2>err; then
    grep -q 'this build has no CAN' err && { echo "skipped: built without cantools"; exit 77; }
    cat err
    exit 1
fi
"$traction" convert log/log_000001.ulg --rover "$source/rovers/lhomme_desages.toml" --out run.csv >convert.txt
"$traction" check run.csv >check.txt
"$traction" diagnose --model "$source/models/rover_sand.toml" --log run.csv --apply --out better.toml --json diagnose.json >diagnose.txt
# 0.2 was hidden; the interval must hold it
awk '/^ "/ { inside = $1 == "\"accepted\":" } !inside { next }
     $1 == "\"effect\":" { named = $2 == "\"slip_sinkage\"," ; seen = seen || named }
     named && $1 == "\"high\":" { high = $2 + 0 } named && $1 == "\"low\":" { low = $2 + 0; if (low <= 0.2 && high >= 0.2) held = 1 }
     END { if (!seen) { print "slip_sinkage is not named"; exit 1 } if (!held) { print "its interval misses 0.2"; exit 1 } }' diagnose.json || { cat diagnose.txt; exit 1; }
"$traction" export --model better.toml --firmware rover.txt >/dev/null
"$tractiond" --hal sim sand.toml effect=slip_sinkage:coefficient=0.2 --parameters rover.txt --log log 2>err || { cat err; exit 1; }
grep -q 'faults seen 00000000' err || { cat err; exit 1; }
[ -s log/log_000002.ulg ]
echo "from the on-board log to the better model and back"
