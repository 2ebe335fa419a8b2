#!/bin/sh
# first_build.sh SOURCE_TREE WORK_FOLDER [CLI] - the build of the first `./traction demo`, twice without a compiler cache: as that configures
# it, and with several files compiled as one (TRACTION_TOGETHER). Says what each took; fails where one warns, or where the second one's program
# drives another byte, or answers otherwise, than CLI (by default the first one's). TRACTION_FIRST=together builds the second alone.
set -eu
from=$1 work=$2 cli=${3-}
mkdir -p "$work"
export CCACHE_DISABLE=1

# built NAME OPTION...: configured so and built, with its seconds
built() {
    name=$1
    shift
    rm -rf "$work/$name"
    cmake -S "$from" -B "$work/$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBUILD_TESTING=OFF -DTRACTION_WERROR=OFF "$@" >"$work/$name.configure" 2>&1 ||
        { tail -n 30 "$work/$name.configure" >&2; exit 1; }
    # shellcheck disable=SC2016
    bash -c 'TIMEFORMAT="%R %U %S"; time ninja -C "$1" traction >"$1.log" 2>&1' bash "$work/$name" 2>"$work/$name.time" ||
        { grep -E 'error|FAILED' -A 5 "$work/$name.log" | head -n 40 >&2; exit 1; }
    tail -n 1 "$work/$name.time" | awk -v name="$name" '{ printf "%-13s %4.0f s, %4.0f CPU s\n", name, $1, $2 + $3 }'
    ! grep -F 'warning:' "$work/$name.log" || { echo "$name: the build warns" >&2; exit 1; }
}
if [ "${TRACTION_FIRST-}" != together ]; then
    built file_by_file
    cli=${cli:-$work/file_by_file/host_tools/cli/traction}
fi
built together -DTRACTION_TOGETHER=ON
[ -n "$cli" ] || exit 0
export TRACTION_ROOT="$from"
for scenario in demo_sand fig17_slip_servo_gravel two_wheels; do
    "$work/together/host_tools/cli/traction" simulate $scenario --seed 3 --quiet --out "$work/one.csv"
    "$cli" simulate $scenario --seed 3 --quiet --out "$work/other.csv"
    cmp "$work/one.csv" "$work/other.csv" || { echo "$scenario: compiled together it drives other bytes" >&2; exit 1; }
done
for what in one other; do
    program=$cli
    [ $what = other ] || program=$work/together/host_tools/cli/traction
    status=0
    "$program" simulate demo_sand --seed 3 --effect slip_sinkage:coefficient=0.3 --quiet --out "$work/hidden.csv" || status=$?
    "$program" diagnose "$work/hidden.csv" --model rover_sand --quiet --json "$work/$what.json" || status=$?
    [ $status -le 1 ] || { echo "diagnose ends with $status" >&2; exit 1; }
done
cmp "$work/one.json" "$work/other.json" || { echo "compiled together the lab answers otherwise" >&2; exit 1; }
echo "the same logs of 3 scenarios, the same diagnosis, byte for byte"
