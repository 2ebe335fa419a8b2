#!/bin/sh
# site.sh ROOT WORK - the docs' site builds strictly, fetches nothing, and is seen to fail on a broken link, a broken anchor and a page that
# mkdocs.yml does not name. 77: mkdocs is not here.
set -eu
root=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
code=0
sh "$root/cmake/docs.sh" "$work/site" >"$work/said" 2>&1 || code=$?
[ "$code" -ne 77 ] || { echo "skipped: $(cat "$work/said")"; exit 77; }
fail() { echo "site.sh: $*"; cat "$work/said"; exit 1; }
[ "$code" -eq 0 ] || fail "the site does not build (exit $code)"
for page in "$root"/docs/*.md; do
    name=$(basename "$page" .md)
    [ -s "$work/site/$name.html" ] || fail "no page $name.html"
done
if grep -rlE '<(script|link|img|iframe)[^>]*(src|href)="?(https?:)?//' "$work/site" --include='*.html' >"$work/fetches"; then
    fail "pages fetch from elsewhere: $(head -n 3 "$work/fetches")"
fi

# refuses WORDS: a copy with the fault is not built, and says WORDS
refuses() {
    code=0
    sh "$work/copy/cmake/docs.sh" "$work/broken" >"$work/said" 2>&1 || code=$?
    [ "$code" -eq 1 ] || fail "built in spite of: $1 (exit $code)"
    grep -q -- "$1" "$work/said" || fail "does not say: $1"
    rm -rf "$work/copy"
}
copy() {
    mkdir -p "$work/copy/cmake"
    cp -R "$root/docs" "$root/mkdocs.yml" "$work/copy/"
    cp "$root/cmake/docs.sh" "$root/cmake/Doxyfile" "$root/cmake/doxygen_comments.awk" "$work/copy/cmake/"
    ln -s "$root/.venv" "$work/copy/.venv"
    mkdir -p "$work/copy/firmware/core" "$work/copy/hal"
}
copy
echo '[nowhere](nowhere.md)' >>"$work/copy/docs/glossary.md"
refuses "nowhere.md"
copy
echo '[no such heading](tutorial.md#no-such-heading)' >>"$work/copy/docs/glossary.md"
refuses "no-such-heading"
copy
echo '# Forgotten' >"$work/copy/docs/forgotten.md"
refuses "forgotten.md"
echo "the site builds; a broken link, a broken anchor and a forgotten page do not"
