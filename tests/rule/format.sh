#!/bin/sh
# format.sh ROOT [--fix] - every C and C++ file that git tracks under ROOT is what clang-format 14 makes of it; names each that is not.
# The formatter: clang-format-14 or clang-format of version 14 where the system has one, else 14.0.6 from the package index into the
# project's .venv (requirements.txt). Exit 0 all are, 1 some are not, 3 nothing to check, 77 no formatter to be had (told in words).
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
cd "$1"

of_version_14() { "$1" --version 2>/dev/null | grep -q 'version 14\.'; }

venv=$here/../../.venv
formatter=
for candidate in clang-format-14 clang-format "$venv/bin/clang-format"; do
    if [ -z "$formatter" ] && of_version_14 "$candidate"; then formatter=$candidate; fi
done
if [ -z "$formatter" ]; then
    log=$(mktemp)
    if { [ -x "$venv/bin/python" ] || python3 -m venv "$venv"; } >"$log" 2>&1 &&
        "$venv/bin/pip" install -q --disable-pip-version-check --timeout 20 --retries 1 -r "$here/requirements.txt" >>"$log" 2>&1 &&
        of_version_14 "$venv/bin/clang-format"; then
        formatter=$venv/bin/clang-format
        rm -f "$log"
    else
        echo "format: skipped, no clang-format 14 here (apt: clang-format-14) and none from the package index ($log)"
        exit 77
    fi
fi

# a checkout without git has no list of what is tracked: then every source there is, but for what was built
if ! files=$(git ls-files -- '*.c' '*.h' '*.cpp' 2>/dev/null) || [ -z "$files" ]; then
    files=$(find . -path ./build -prune -o -path ./.venv -prune -o \( -name '*.c' -o -name '*.h' -o -name '*.cpp' \) -print)
fi
# the tree that is crooked on purpose is judged by its own test alone
files=$(printf '%s\n' "$files" | grep -v 'tests/rule/broken/format/' || true)
[ -n "$files" ] || { echo "format: no C or C++ file under $1: the rule was not checked"; exit 3; }
if [ "${2:-}" = --fix ]; then
    # shellcheck disable=SC2086 # no tracked source has a blank in its name
    exec "$formatter" -i $files
fi
# shellcheck disable=SC2086
if crooked=$("$formatter" --dry-run --Werror -ferror-limit=1 $files 2>&1); then
    echo "format holds in $(printf '%s\n' "$files" | wc -l) files ($("$formatter" --version))"
else
    printf '%s\n' "$crooked" | sed -n 's/^\([^:]*\):\([0-9]*\):.*Wclang-format-violations.*/\1:\2: is not formatted/p' | sort -u -t: -k1,1
    echo "format: to mend: sh tests/rule/format.sh . --fix"
    exit 1
fi
