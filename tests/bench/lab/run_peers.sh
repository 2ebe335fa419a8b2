#!/bin/sh
# run_peers.sh LOGS.json ANSWERS.json TRACTION - PySINDy and SysIdentPy on a campaign's logs, in the project's .venv of pinned packages.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
venv=$here/../../../.venv
if [ ! -x "$venv/bin/python" ]; then
    python3 -m venv "$venv" || { echo "python3 has no venv module (apt: python3-venv)"; exit 3; }
fi
if ! "$venv/bin/python" -c 'import pysindy, sysidentpy' 2>/dev/null; then
    "$venv/bin/pip" install -q --disable-pip-version-check -r "$here/requirements.txt" ||
        { echo "pip cannot install PySINDy and SysIdentPy here (no package index within reach)"; exit 3; }
fi
# one core, as the lab is timed
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1
exec "$venv/bin/python" "$here/peers.py" "$1" "$2" "$3"
