#!/bin/sh
# run.sh ROOT BUILD CLI TRACTIOND WORK - schemas.py by an interpreter that has jsonschema: the project's .venv, or that of the Python tests.
set -eu
root=$1 build=$2
for python in "$root/.venv/bin/python" "$build/python-venv/bin/python"; do
    if [ -x "$python" ] && "$python" -c 'import jsonschema, referencing' 2>/dev/null; then exec "$python" "$root/tests/schemas/schemas.py" "$@"; fi
done
echo "skipped: no jsonschema; to mend: python3 -m venv .venv && .venv/bin/pip install -r tests/schemas/requirements.txt"
exit 77
