#!/bin/sh
# run.sh ROOT BUILD CLI install | style | pytest FILE: one test of the Python package. 77: skipped, in words.
set -eu
root=$1 build=$2 cli=$3 what=$4
shift 4
venv=$build/python-venv
python=$venv/bin/python
skip() { echo "skipped: $*"; exit 77; }

case $what in
    install)
        command -v python3 >/dev/null || skip "no python3 here"
        python3 -c 'import sys, sysconfig, os; sys.exit(not (sys.version_info >= (3, 11) and os.path.exists(os.path.join(sysconfig.get_paths()["include"], "Python.h"))))' ||
            skip "needs Python 3.11 or later with its headers (apt: python3-dev)"
        [ -x "$python" ] || python3 -m venv "$venv" || skip "python3 -m venv does not work here (apt: python3-venv)"
        # again only where the list of packages is another one; not compiled to bytecode: few of their modules are ever imported
        if ! cmp -s "$root/python/requirements-test.txt" "$venv/installed.txt"; then
            words=$venv/pip.log
            if ! "$python" -m pip install -q --no-compile --disable-pip-version-check --timeout 20 --retries 1 -r "$root/python/requirements-test.txt" >"$words" 2>&1; then
                "$python" -m pip download -q --no-deps --timeout 20 --retries 1 -d "$venv/reach" nanobind==3.1.0 >/dev/null 2>&1 ||
                    skip "no package index can be reached ($(tail -n 1 "$words"))"
                cat "$words"
                exit 1
            fi
            cp "$root/python/requirements-test.txt" "$venv/installed.txt"
        fi
        # what the build needs is there, pinned: nothing else is fetched
        "$python" -m pip install -q --disable-pip-version-check --no-build-isolation --no-deps --force-reinstall "$root/python" \
            --config-settings cmake.define.TRACTION_BUILD="$build" --config-settings build-dir="$build/python-build"
        cd /
        "$python" -c 'import traction; print("installed:", traction.__file__)' ;;
    style)
        [ -f "$venv/installed.txt" ] || skip "the package could not be installed"
        cd "$root/python"
        "$venv/bin/ruff" check . ../tests/python
        "$venv/bin/ruff" format --check . ../tests/python
        cd "$venv" # the installed package with its stubs, not the sources
        "$python" -m mypy --config-file "$root/python/pyproject.toml" -p traction ;;
    pytest)
        [ -f "$venv/installed.txt" ] || skip "the package could not be installed"
        cd "$root/tests/python"
        TRACTION_CLI=$cli "$python" -m pytest -q -p no:cacheprovider --durations=5 "$@" ;;
esac
