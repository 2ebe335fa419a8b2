#!/bin/sh
# Mutation run over the simulator's physics, plant and sensors with its tests as judges. usage: mutate_sim.sh [MUTANTS [SEED [MINUTES
# [BUILD_FOLDER]]]]; Run: ./traction mutate --sim. Needs a configured host build; says so where there is none. The same command goes on where it
# was broken off.
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${4:-$root/build/host}
command -v python3 > /dev/null || { echo "mutate_sim: skipped, needs python3 (apt: python3)"; exit 0; }
[ -f "$build/build.ninja" ] || { echo "mutate_sim: $build is not configured; to mend: cmake --preset host" >&2; exit 3; }
# the quickest first: what an early one notices costs no later one
judges="hinge_test abreast_test sensor_effects_test soil_law_test sensors_test plant_soft_test layout_test math_test steering_test rocker_test
  plant_numerics_test radar_test soft_oracle_test plant_effects_test effects_test plant_oracle_test terrain_test invariance_test"
# shellcheck disable=SC2086 # a list of targets
said=$(ninja -C "$build" $judges 2>&1) || {
  printf '%s\n' "$said" | tail -n 20 >&2
  echo "mutate_sim: the tests do not build (configured without tests? cmake --preset host)" >&2
  exit 3
}
# shellcheck disable=SC2086
exec python3 "$root/tests/mutate/mutate_lab.py" --name mutate_sim --root "$root" --build "$build" --out "$root/build/mutate_sim" --tests $judges \
  --folders sim/physics sim/plant sim/sensors --mutants "${1:-100}" --seed "${2:-1}" --minutes "${3:-60}"
