#!/bin/sh
# python.sh SUITE [--keep] - README's Python lines, typed as they stand, in a minimal Debian of that suite (bookworm, trixie) after README's
# first command: the package is built and installed by pip into a fresh environment; then the notebook "your own log", and one that
# simulates with a hidden effect, diagnoses, adds what is named, and shows the ladder. Says what each step took. What it needs: system.sh.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
suite=${1:?python.sh: which suite, bookworm or trixie?}
shift
keep=no
for option; do
    case $option in
        --keep) keep=yes ;;
        *) echo "bare: unknown option '$option' (known: --keep)" >&2; exit 2 ;;
    esac
done
. "$here/tests/bare/system.sh"
# README's own words: the block that installs the package, and the packages that it says are wanted
lines=$(awk '/^```/ { if (inside && text ~ /pip install .\.\/python/) printf "%s", text; inside = ($0 == "```sh"); text = ""; next } inside { text = text $0 "\n" }' "$here/README.md")
[ "$(printf '%s\n' "$lines" | wc -l)" -eq 2 ] || die "README.md has no block of two lines that installs ./python"
packages=$(sed -n 's/.*apt: `\(python3[^`]*\)`.*/\1/p' "$here/README.md" | head -n 1)
[ -n "$packages" ] || die "README.md does not tell which packages Python wants (apt: \`python3...\`)"
make_system
timed demo "$inside" sh -c "${enter}./traction demo"
# shellcheck disable=SC2086 # a list of packages
timed apt "$inside" apt-get install -y -q --no-install-recommends $packages
say "python: $("$inside" python3 --version), compiler: $("$inside" sh -c 'c++ --version' | head -n 1)"
timed first_line "$inside" sh -c "$enter$(printf '%s\n' "$lines" | sed -n 1p)"
timed second_line "$inside" sh -c "$enter$(printf '%s\n' "$lines" | sed -n 2p)"
cat "$base/$suite.second_line.log"
grep -q 'slip_sinkage' "$base/$suite.second_line.log" || die "README's second line does not name the effect that it hides"
timed own_log "$inside" sh -c "${enter}.venv/bin/jupyter-execute python/notebooks/your_own_log.ipynb"
timed hidden "$inside" sh -c "${enter}.venv/bin/python tests/bare/hidden_effect.py /root/hidden.ipynb"
cat "$base/$suite.hidden.log"
say "$suite: README's Python lines and both notebooks ran"
