#!/bin/sh
# glossary.sh ROOT - docs/glossary.md holds what it says: each of its terms ("**term** - two lines") is used in another document or in the tools,
# and every word by which the lab gives a verdict, a kind or a status stands in it. Exit 1 with a line per offence.
set -eu
cd "$1"
glossary=docs/glossary.md
[ -f "$glossary" ] || { echo "glossary: no $glossary: the rule was not checked"; exit 3; }
terms=$(sed -n 's/^\*\*\(.*\)\*\* - .*/\1/p' "$glossary" | tr -d '`')
used=$(find README.md docs host_tools/*/*.cpp host_tools/*/*.h host_tools/lab \( -name '*.md' -o -name '*.cpp' -o -name '*.h' \) ! -path "$glossary" 2>/dev/null || true)
status=0
offence() { echo "glossary: $*"; status=1; }

# shellcheck disable=SC2086 # no source has a blank in its name
all=$(cat $used | tr '\n' ' ')
twice=$(printf '%s\n' "$terms" | sort | uniq -d | tr '\n' ';')
[ -z "$twice" ] || offence "stands there twice: $twice"
while read -r term; do
    case $all in *"$term"*) continue ;; esac
    printf '%s' "$all" | grep -qiF -- "$term" || offence "\"$term\" is used nowhere else"
done <<TERMS
$terms
TERMS

# what the code assigns to, or compares with, a verdict, a kind or a status; and what a profile's verdict_of returns
# shellcheck disable=SC2046
words=$({ grep -ohE '\b(verdict|kind|status) [!=]?= [^;,]*' $(find host_tools/lab -name '*.cpp'); sed -n '/^std::string verdict_of/,/^}/p' $(find host_tools/lab -name '*.cpp') | grep return; } |
    grep -oE '"[a-z_]+"' | tr -d '"' | sort -u)
[ -n "$words" ] || { echo "glossary: no verdict found in host_tools/lab: the rule was not checked"; exit 3; }
for word in $words; do
    printf '%s\n' "$terms" | grep -qxF -- "$word" || offence "the verdict \"$word\" of the output is not in it"
done
[ "$status" -ne 0 ] || echo "glossary: $(printf '%s\n' "$terms" | wc -l) terms, $(printf '%s\n' "$words" | wc -l) words of verdicts"
exit "$status"
