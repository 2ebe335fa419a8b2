#!/bin/sh
# long_log.sh TRACTION LAB_GENERATE DIR: an hour at 100 Hz within 2 GB of memory, with the verdict of its first ten minutes (of an unknown
# shape not its variable), and it is said what was looked at. A sinking soil, and an hour with nothing hidden.
set -eu
traction=$1 generate=$2 dir=$3
mkdir -p "$dir"
verdict() { # what is named: the sentence up to its figures
    status=0 one=$1
    shift
    python3 -c '
import resource, subprocess, sys
code = subprocess.run(sys.argv[1:]).returncode
used_kB = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
if used_kB > 2 * 1024 * 1024: sys.exit("%d kB of memory" % used_kB)
sys.exit(10 + code)' "$traction" diagnose --model "$dir/$one.toml" --log "$dir/$one.csv" "$@" >"$dir/out.txt" 2>&1 || status=$?
    [ $status -eq 10 ] || [ $status -eq 11 ] || { cat "$dir/out.txt"; exit 1; }
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
judge sinkage --apart --soil sand --seed 501 --effect slip_sinkage:coefficient=0.2
judge clean --apart --soil concrete --seed 502 --exact
