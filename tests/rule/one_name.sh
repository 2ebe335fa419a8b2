#!/bin/sh
# one_name.sh ROOT - what stands in unnamed namespaces has a name of its own within its library (the next folder above with a
# CMakeLists.txt), for who only uses Traction compiles several of its files as one (traction_together in cmake/targets.cmake): there two
# functions of one name are an error, or, worse, overloads between which the compiler chooses without a word.
set -eu
cd "${1:?one_name.sh: which folder?}"
found=$(for list in $(find sim hal host_tools -name CMakeLists.txt 2>/dev/null | sort); do
    folder=${list%/*}
    find "$folder" -name '*.cpp' | sort | while IFS= read -r file; do
        above=${file%/*}
        while [ ! -f "$above/CMakeLists.txt" ]; do above=${above%/*}; done
        [ "$above" != "$folder" ] || echo "$file"
    done | xargs -r awk -v folder="$folder" '
function told(name) {
    if (name in first && first[name] != FILENAME) {
        if (!((name, FILENAME) in said)) print FILENAME ":" FNR ": " name " stands in an unnamed namespace of " first[name] " too"
        said[name, FILENAME] = 1
    } else first[name] = FILENAME
}
FNR == 1 { inside = 0 }
/^namespace \{/ { inside = 1; next }
/^\} \/\/ namespace$/ { inside = 0; next }
!inside || /^using [^=]*;$/ || !/^[A-Za-z]/ || /^(return|public|private|template|using namespace|extern|static_assert|friend)/ { next }
{
    line = $0
    sub(/[ \t]*\/\/.*/, "", line)
    if (match(line, /^(struct|class|enum|enum class|union|using) +[A-Za-z_0-9]+/)) {
        name = substr(line, RSTART, RLENGTH); sub(/.* /, "", name); told(name); next
    }
    while (match(line, /<[^<>]*>/)) line = substr(line, 1, RSTART - 1) substr(line, RSTART + RLENGTH) # template arguments
    if (match(line, /[A-Za-z_0-9:~]+ *(\(|=|\[|\{|;)/)) {
        name = substr(line, RSTART, RLENGTH); sub(/ *[(=[{;]$/, "", name)
        if (name !~ /:/ && name != "operator") told(name)
        line = substr(line, RSTART + RLENGTH)
        while (match(line, /\([^()]*\)|\{[^{}]*\}/)) line = substr(line, 1, RSTART - 1) substr(line, RSTART + RLENGTH)
        while (match(line, /, *[A-Za-z_0-9]+ *=/)) { # the further names of one declaration
            name = substr(line, RSTART, RLENGTH); gsub(/[, =]/, "", name); told(name)
            line = substr(line, RSTART + RLENGTH)
        }
    }
}'
done)
[ -z "$found" ] || { echo "$found"; exit 1; }
