#!/bin/sh
# Mutation run over firmware/core with the unit tests as judge. usage: mutate.sh [MUTANTS] [SEED] [BUILD_FOLDER [OPTION]...]; Run: ./traction mutate
# The mutants are universalmutator's (PyPI, pinned, in an environment of its own in the build folder).
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
out=${3:-$root/build/mutate}
command -v python3 > /dev/null || { echo "mutate: skipped, needs python3 (apt: python3 python3-venv)"; exit 0; }
mkdir -p "$out"
if [ ! -x "$out/venv/bin/mutate" ]; then
  { python3 -m venv "$out/venv" && "$out/venv/bin/pip" -q install universalmutator==1.1.13; } > "$out/venv.log" 2>&1 || {
    rm -rf "$out/venv"
    echo "mutate: skipped, universalmutator 1.1.13 cannot be installed ($out/venv.log; apt: python3-venv)"
    exit 0
  }
fi
mutants=${1:-300} seed=${2:-1}
[ $# -le 3 ] && set -- || shift 3
exec "$out/venv/bin/python" "$root/tests/fuzz/mutate.py" --root "$root" --out "$out" --mutants "$mutants" --seed "$seed" "$@"
