#!/bin/sh
# bare.sh SUITE [--test] [--keep] - what a stranger's first minutes are: a minimal Debian of that suite (bookworm, trixie), this checkout
# cloned into it, and README's commands. Says what each step took. What it needs, and TRACTION_BARE, TRACTION_BARE_CACHE: system.sh.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
suite=${1:?bare.sh: which suite, bookworm or trixie?}
shift
run_tests=no keep=no
for option; do
    case $option in
        --test) run_tests=yes ;;
        --keep) keep=yes ;;
        *) echo "bare: unknown option '$option' (known: --test, --keep)" >&2; exit 2 ;;
    esac
done
. "$here/tests/bare/system.sh"
make_system
packages=$(awk '$1 == "build" { print $2 }' "$here/cmake/apt-packages.txt")
# shellcheck disable=SC2086
"$inside" apt-get install -s --no-install-recommends $packages >"$base/$suite.plan.log" 2>&1 || die "apt cannot install the build's packages ($base/$suite.plan.log)"
say "packages: $(grep -c '^Inst ' "$base/$suite.plan.log") to install, $("$inside" apt-get install --no-install-recommends --assume-no $packages 2>/dev/null | sed -n 's/^Need to get \(.*\) of archives.*/\1/p; s/^ *Download size: \(.*\)/\1/p' | head -n 1) to download"
# no_warnings: what the last build said
no_warnings() {
    if grep -q 'warning:' "$system/root/traction/build/host/build.log"; then
        grep 'warning:' "$system/root/traction/build/host/build.log" | sort | uniq -c
        die "the build warns"
    fi
}
# README's first command: installs, configures, builds, runs
timed first_demo "$inside" sh -c "${enter}./traction demo"
no_warnings
grep '^traction: ' "$base/$suite.first_demo.log" | sed 's/^traction: /bare:   /; s/\(are not here:\).*/\1 .../'
tail -n 8 "$base/$suite.first_demo.log"
timed second_demo "$inside" sh -c "${enter}./traction demo"
! grep '^traction: building' "$base/$suite.second_demo.log" || die "the second demo built again"
say "compiler: $("$inside" sh -c 'c++ --version' | head -n 1)"
if [ -z "${TRACTION_BARE_CACHE-}" ]; then
    # the build alone, from installed packages and without ccache: the figures of docs/performance.md
    "$inside" rm -rf /root/traction/build
    timed configure_and_build "$inside" sh -c "${enter}CCACHE_DISABLE=1 ./traction build"
    no_warnings
fi
if [ "$run_tests" = yes ]; then
    timed tests "$inside" sh -c "${enter}./traction test"
    grep -E 'tests passed|SKIPPED|Skipped|\*\*\*' "$base/$suite.tests.log" || true
fi
say "$suite: all green"
