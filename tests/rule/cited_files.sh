#!/bin/sh
# cited_files.sh ROOT - no comment and no document under ROOT cites a file that the repository does not have (cited_files.awk).
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
root=$(CDPATH='' cd -- "$1" && pwd)
list=$(mktemp)
trap 'rm -f "$list"' EXIT
cd "$root"
if ! git ls-files >"$list" 2>/dev/null || [ ! -s "$list" ]; then # a checkout without git: what was not built
    find . \( -path ./build -o -path ./.venv -o -path ./.git \) -prune -o -type f -print | sed 's#^\./##' | sort >"$list"
fi
# trees that break a rule on purpose are read by their own tests alone; the changelog tells of files as they were
grep -E '(\.(md|c|h|cpp|py|sh|cmake|toml|ts|awk)|CMakeLists\.txt|^traction)$' "$list" |
    grep -vE '^(tests/rule/broken/|CHANGELOG\.md$)' | sed "s#^#$root/#" | tr '\n' '\0' |
    xargs -0 awk -v root="$root" -v list="$list" -f "$here/cited_files.awk" "$list"
