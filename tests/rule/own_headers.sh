#!/bin/sh
# own_headers.sh ROOT [--fix] - a file that names one of these includes its header itself, or the header of its own name does.
# What another header happens to bring along differs between compilers: gcc 13 and 14 stopped at a missing <cstdint> and <algorithm>.
set -eu
cd "${1:?own_headers.sh: which folder?}"
fix=${2-}
failures=$(mktemp)
trap 'rm -f "$failures"' EXIT

# needs HEADER REGEX: whoever matches the expression includes the header
needs() {
    find . -path ./build -prune -o -path ./tests/rule/broken -prune -o -path ./.venv -prune -o \( -name '*.h' -o -name '*.cpp' \) -print |
        xargs grep -lE "$2" 2>/dev/null | while IFS= read -r file; do
        own=${file%.cpp}.h
        grep -q "#include <$1>" "$file" && continue
        [ "$own" != "$file" ] && [ -f "$own" ] && grep -q "#include <$1>" "$own" && continue
        if [ "$fix" = --fix ] && grep -q '^#include <' "$file"; then
            awk -v line="#include <$1>" '!done && /^#include </ { print line; done = 1 } { print }' "$file" >"$file.part" && cat "$file.part" >"$file" && rm "$file.part"
        else
            echo "$file: $(grep -nE "$2" "$file" | head -n 1 | cut -d: -f1): needs #include <$1>" | tee -a "$failures"
        fi
    done
}
needs cstdint 'std::u?int(8|16|32|64)_t'
needs optional 'std::optional<'
needs array 'std::array<'
needs functional 'std::function<'
needs memory 'std::(unique|shared)_ptr<'
needs map 'std::map<'
needs span 'std::span<'
needs algorithm 'std::(clamp|(stable_)?sort|(min|max|minmax)_element|(any|all|none)_of|find(_if)?|count(_if)?|transform|fill(_n)?|copy(_if|_n)?|nth_element|max|min|minmax|reverse|(lower|upper)_bound|remove_if|unique|equal|replace|rotate|generate|is_sorted|adjacent_find)\('
needs numeric 'std::(accumulate|inner_product|iota|partial_sum|gcd|lcm)\('
needs stdexcept 'std::(runtime_error|logic_error|invalid_argument|out_of_range|length_error|domain_error)\b'
needs cstdio 'std::(s?nprintf|v?snprintf|printf|fprintf|fputs|puts|fopen|fflush|rename|perror)\('
needs cstdlib 'std::(getenv|strto(d|f|l|ll|ul|ull)|abort|exit|system|atof|atoi)\('
needs tuple 'std::(tuple<|tie\(|make_tuple\()'
needs limits 'std::numeric_limits<'
[ ! -s "$failures" ] || { echo "sh tests/rule/own_headers.sh . --fix mends them"; exit 1; }
