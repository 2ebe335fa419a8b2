#!/bin/sh
# docs.sh [OUT] - builds the docs' site from docs/ into OUT (build/site), strictly: a broken link, or a page that mkdocs.yml does not name,
# fails. Nothing is fetched. With doxygen there is OUT/api too, from the headers of the firmware and the HAL. 77: mkdocs is not here.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
out=${1:-$root/build/site}
case $out in /*) ;; *) out=$PWD/$out ;; esac
python=$root/.venv/bin/python
if ! { [ -x "$python" ] && "$python" -c 'import mkdocs, material' 2>/dev/null; }; then
    echo "docs: no mkdocs-material; to mend: python3 -m venv .venv && .venv/bin/pip install -r cmake/docs-requirements.txt" >&2
    exit 77
fi
cd "$root"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# not --quiet: with it warnings are not counted, and --strict passes what it should not
NO_MKDOCS_2_WARNING=1 "$python" -m mkdocs build --strict --clean --site-dir "$out" >"$log" 2>&1 ||
    { grep -vE '^INFO|^$' "$log" >&2; echo "docs: the site is not built: see above" >&2; exit 1; }
if command -v doxygen >/dev/null 2>&1; then
    mkdir -p "$out/api"
    { cat cmake/Doxyfile; echo "OUTPUT_DIRECTORY = \"$out\""; } | doxygen - >"$log" 2>&1 || { tail -n 20 "$log" >&2; exit 1; }
    echo "docs: $out/index.html, with the headers' reference in api/"
else
    echo "docs: $out/index.html; without the headers' reference: doxygen is not here (apt: doxygen)"
fi
