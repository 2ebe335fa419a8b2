#!/bin/sh
# five_answers.sh TRACTION BROWSER_DIR [OUT] - plays the demo with seeds 1 to 10, reads in Chromium what each page answers to the five
# questions, and checks it against the seal (answers.mjs). BROWSER_DIR: where browser_test.cmake put its packages. With OUT: writes it.
set -eu
traction=$1 browser=$2 out=${3:-}
here=$(cd "$(dirname "$0")" && pwd)
chromium=$(command -v chromium || command -v chromium-browser) || { echo "SKIPPED: no chromium here (Debian: apt-get install chromium)"; exit 0; }
[ -d "$browser/node_modules" ] || { echo "SKIPPED: $browser has no packages: run ctest -R report_browser_test first"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for seed in 1 2 3 4 5 6 7 8 9 10; do
    "$traction" demo --seed "$seed" --out "$work/$seed" > "$work/said" || { cat "$work/said"; exit 1; }
done
cp "$here/answers.mjs" "$browser/answers.mjs"
node "$browser/answers.mjs" "$chromium" "$work" "$work/answers.md"
[ -z "$out" ] || cp "$work/answers.md" "$out"
