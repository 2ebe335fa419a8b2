#!/bin/sh
# Mutation run over the lab's decision and fit with its quick tests as judges. usage: mutate_lab.sh [MUTANTS [SEED [MINUTES [BUILD_FOLDER]]]];
# Run: ./traction mutate --lab. Needs a configured host build; says so where there is none. The same command goes on where it was broken off.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${4:-$root/build/host}
command -v python3 > /dev/null || { echo "mutate_lab: skipped, needs python3 (apt: python3)"; exit 0; }
[ -f "$build/build.ninja" ] || { echo "mutate_lab: $build is not configured; to mend: cmake --preset host" >&2; exit 3; }
judges="lab_rules_test lab_judge_test lab_manner_test lab_doubt_test lab_candidates_test" # tests of milliseconds first; whole diagnoses last, for what only they come by
# shellcheck disable=SC2086 # a list of targets
said=$(ninja -C "$build" $judges 2>&1) || {
  printf '%s\n' "$said" | tail -n 20 >&2
  echo "mutate_lab: the tests do not build (configured without tests? cmake --preset host)" >&2
  exit 3
}
# shellcheck disable=SC2086
exec python3 "$root/tests/mutate/mutate_lab.py" --root "$root" --build "$build" --out "$root/build/mutate_lab" --tests $judges \
  --slowest 8 --mutants "${1:-100}" --seed "${2:-1}" --minutes "${3:-60}"
