#!/bin/sh
# Follows docs/effects.md, "Adding a loss at the wheel", to the letter in a copy of the tree, builds what the walk over the catalogue needs,
# and runs it: the new loss acts in the plant and in the lab. Usage: new_wheel_loss.sh SOURCE_TREE WORK_FOLDER
set -eu
from=$1 work=$2
rm -rf "$work/tree"
mkdir -p "$work/tree"
for part in "$from"/*; do
    case ${part##*/} in build*) ;; *) cp -R "$part" "$work/tree/" ;; esac
done
cd "$work/tree"

# Each block that follows "In `FILE`, before `TEXT`:" goes before the first line of FILE that holds TEXT.
awk -v list="$work/changed" '
function put(    line, done, out) {
    out = file ".new"; done = 0
    while ((getline line < file) > 0) {
        if (!done && index(line, anchor) > 0) { printf "%s", block > out; done = 1 }
        print line > out
    }
    close(file); close(out)
    if (!done) { print "docs/effects.md: " file " has no line with " anchor > "/dev/stderr"; exit 1 }
    system("mv \"" out "\" \"" file "\"")
    print file > list
    blocks++
}
/^In `[^`]*`, before `[^`]*`:$/ { split($0, part, "`"); file = part[2]; anchor = part[4]; next }
/^```cpp$/ && file != "" { inside = 1; block = ""; next }
/^```$/ && inside { inside = 0; put(); file = ""; next }
inside { block = block $0 "\n" }
END { if (blocks < 4) { print "docs/effects.md: " blocks + 0 " blocks to add, it must be a field, its name, its law and a row" > "/dev/stderr"; exit 1 } }
' docs/effects.md

files=$(sort -u "$work/changed" | wc -l)
echo "files changed outside tests: $files"
sort -u "$work/changed"
[ "$files" -le 3 ] || { echo "a loss at the wheel must not touch more than 3 files" >&2; exit 1; }

# Little optimisation: the compiler's time is what this test costs.
cmake -S . -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 > "$work/configure.log" 2>&1 ||
    { cat "$work/configure.log" >&2; exit 1; }
ninja -C "$work/build" lab_effect_walk_test effects_test > "$work/build.log" 2>&1 || { tail -40 "$work/build.log" >&2; exit 1; }
"$work/build/tests/plant/effects_test" --gtest_brief=1 --gtest_filter='Catalogue.*:Acting.*'
"$work/build/tests/lab/lab_effect_walk_test" --gtest_brief=1
echo "churned_soil walks with $(grep -c '^        {"' sim/physics/effects/*_effects.cpp | awk -F: '{ n += $2 } END { print n - 1 }') others"
