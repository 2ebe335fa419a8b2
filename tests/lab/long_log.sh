#!/bin/sh
# long_log.sh TRACTION LAB_GENERATE DIR: an hour at 100 Hz within 2 GB of address space, with the verdict of its first ten minutes, and it is
# said what was looked at. An effect that is there, and a clean hour.
set -eu
traction=$1 generate=$2 dir=$3
mkdir -p "$dir"
ulimit -v 2097152 # kB
verdict() { # what is named: the sentence up to its figures
    status=0 one=$1
    shift
    "$traction" diagnose --model "$dir/$one.toml" --log "$dir/$one.csv" "$@" >"$dir/out.txt" 2>&1 || status=$?
    [ $status -le 1 ] || { cat "$dir/out.txt"; exit 1; }
    sed -n 's/^\(The model lacks [^:]*\|Nothing found\|Unknown\|One of\).*/\1/p' "$dir/out.txt" | head -1
}
judge() { # NAME GENERATOR-OPTIONS...
    name=$1
    shift
    "$generate" --duration 3600 --out "$dir/$name.csv" --model "$dir/$name.toml" "$@"
    hour=$(verdict "$name")
    grep -q 'the log is 3600 s long: the 600 s from' "$dir/out.txt" || { echo "$name: what was looked at is not said"; exit 1; }
    minutes=$(verdict "$name" --to 600)
    [ -n "$hour" ] && [ "$hour" = "$minutes" ] || { echo "$name: the hour says '$hour', ten minutes '$minutes'"; exit 1; }
    echo "$name: $hour"
    rm "$dir/$name.csv"
}
judge sinkage --soil sand --seed 501 --effect slip_sinkage:coefficient=0.2
judge clean --soil concrete --seed 502 --exact
