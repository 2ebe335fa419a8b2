#!/bin/sh
# tidy.sh BUILD FOLDER... - clang-tidy 14 finds nothing (.clang-tidy says what it looks for) in the C and C++ files of these folders that
# BUILD compiles. The suite asks for firmware, hal and sim; the rest by hand:
#   sh tests/rule/tidy.sh build/host host_tools
# Exit 0 nothing found, 1 something (told), 3 nothing to look at, 77 no clang-tidy 14 here (told).
set -eu
cd "$(dirname -- "$0")/../.."
build=$1
shift
tidy=
for candidate in clang-tidy-14 clang-tidy; do
    if [ -z "$tidy" ] && "$candidate" --version 2>/dev/null | grep -q 'version 14\.'; then tidy=$candidate; fi
done
[ -n "$tidy" ] || { echo 'tidy: SKIPPED, no clang-tidy 14 here (apt: clang-tidy-14); other versions know other checks'; exit 77; }
[ -f "$build/compile_commands.json" ] || { echo "tidy: $build has no compile_commands.json: configure it first"; exit 3; }
files=$(git ls-files -- "$@" 2>/dev/null | grep -E '\.(c|cpp)$' || find "$@" -name '*.c' -o -name '*.cpp')
compiled=$(for file in $files; do if grep -q "/$file\"" "$build/compile_commands.json"; then echo "$file"; fi; done)
[ -n "$compiled" ] || { echo "tidy: $build compiles no file of $*: the rule was not checked"; exit 3; }
# the build's own precompiled headers are gcc's: the same commands without them; its compiler may know warnings and passes that clang does not
database=$(mktemp -d)
trap 'rm -rf "$database"' EXIT
sed 's/ -Winvalid-pch -include [^ ]*cmake_pch\.hxx//; s/ -fno-tree-sink//' "$build/compile_commands.json" >"$database/compile_commands.json"
# C++ files are read many at a time as one, so that their headers are read and looked through once: a unit that includes them (but one
# file's names may be those of another: shadowing is the compiler's to tell). Fifty of hal and sim, compiled as its first is, with the
# folders and macros of all; elsewhere ten of a folder, compiled as its first is.
folders=$(echo firmware hal sim host_tools "$@" | tr " " "|")
commands=$database/compile_commands.json built=$(cd "$build" && pwd)
printf '%s\n' "$compiled" | grep '\.c$' >"$database/others" || true
printf '%s\n' "$compiled" | grep '\.cpp$' | sort | awk -v made="$database" -v root="$PWD" '
    { group = $0; most = 10; sub(/\/[^\/]*$/, "", group) }
    group ~ /^(hal|sim)\// { group = "hal and sim"; most = 50 }
    group != last || held == most { last = group; held = 0; unit = made "/unit_" ++units ".cpp"; print unit }
    { printf "#include \"%s/%s\" // NOLINT(bugprone-suspicious-include)\n", root, $0 > unit }
    held++ == 0 || most == 50 { print $0 > unit ".files" }' >"$database/units"
while read -r unit; do
    while read -r file; do grep -m 1 "\"command\".* -c [^ ]*/$file\"" "$commands"; done <"$unit.files" >"$unit.commands"
    options=$(grep -oE -- ' (-D|-I|-isystem )[^ ]+' "$unit.commands" | sort -u | tr -d '\n')
    command=$(head -n 1 "$unit.commands" | sed "s| -c [^ ]*\"|$options -c $unit\"|")
    sed -i "1s|^\[|[{\"directory\": \"$built\", $command \"file\": \"$unit\"},|" "$commands"
done <"$database/units"
cat "$database/others" >>"$database/units"
if said=$(xargs -P 2 -n 20 "$tidy" -p "$database" --config-file=.clang-tidy --header-filter="/($folders)/" --quiet --extra-arg=-Wno-unknown-warning-option --extra-arg=-Qunused-arguments --extra-arg=-Wno-shadow <"$database/units" 2>&1); then
    echo "tidy: nothing found in $(printf '%s\n' "$compiled" | wc -l) files of $*"
else
    printf '%s\n' "$said" | grep -vE '^[0-9]+ warnings? (generated|treated)|^Suppressed' || true
    exit 1
fi
