#!/bin/sh
# board.sh SUITE [--test] [--keep] - the emulated board (docs/emulated_board.md) from a fresh clone on a minimal Debian of that suite (bookworm,
# trixie): what is missing is installed, the kernel is built from that Debian's own kernel source, figure 16 of the paper is driven, twice, and
# both runs must agree in every record. --test: then ./traction emulate --test. What it needs, and TRACTION_BARE, TRACTION_BARE_CACHE: system.sh.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
suite=${1:?board.sh: which suite, bookworm or trixie?}
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
scenario=fig16_blocked_wheels
# exit 1: its wheels are blocked, and the firmware latches the stall
drive() { timed "$1_drive" "$inside" sh -c "${enter}./traction emulate $scenario --json $1.json --keep $1 || [ \$? -eq 1 ]"; }
drive first
grep '^traction: ' "$base/$suite.first_drive.log" | sed 's/^traction: /bare:   /; s/\(are not here:\).*/\1 .../'
drive second
! grep '^traction: building' "$base/$suite.second_drive.log" || die "the second drive built again"
cat "$base/$suite.second_drive.log"
made=$system/root/traction
grep -q '"equal_in_process": true' "$made/first.json" || die "the trace is not that of the simulation in process"
cmp -s "$made/first/records" "$made/second/records" || die "two runs of one scenario differ"
say "$("$inside" sh -c 'qemu-system-arm --version' | head -n 1); $("$inside" sh -c 'cat ~/.cache/traction/board-*/kernel.txt'); $("$inside" sh -c 'arm-linux-gnueabi-gcc --version' | head -n 1)"
say "SHA-256 of the trace: $(sha256sum <"$made/first/trace.txt" | cut -d ' ' -f 1), of all records: $(sha256sum <"$made/first/records" | cut -d ' ' -f 1)"
if [ "$run_tests" = yes ]; then
    timed board_tests "$inside" sh -c "${enter}./traction emulate --test"
    tail -n 40 "$base/$suite.board_tests.log"
fi
say "$suite: the emulated board drives"
