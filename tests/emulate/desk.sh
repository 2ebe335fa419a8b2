# desk.sh - sourced by the tests of the emulated board that is flashed (flash.sh, product.sh): keys, image, the board's power, ssh to it.
# They set root, traction, work, only (--if-built, or empty) and label. Exit 77, in words, where something is missing.
target=$root/build/korebot
skip() { echo "$label: SKIPPED, $*; ./traction emulate --test brings it"; exit 77; }
fail() { echo "$label: FAILED: $*"; for file in out err board/console.txt; do [ ! -s "$file" ] || { echo "--- $file"; tail -n 25 "$file"; }; done; exit 1; }
for program in qemu-system-arm ssh ssh-keygen arm-linux-gnueabi-strip dpkg-deb; do
    command -v $program >/dev/null 2>&1 || skip "no $program here"
done
for program in firmware/flash/traction-slot firmware/app/tractiond emulate/board_init emulate/board_seed; do
    [ -x "$target/$program" ] || skip "build/korebot is not built"
done
rm -rf "$work"
mkdir -p "$work/board"
cd "$work"
work=$(pwd)
qemu='' flashing=''
# shellcheck disable=SC2086 # one or none each
trap '[ -z "$qemu$flashing" ] || kill -KILL $qemu $flashing 2>/dev/null || true' EXIT

# make_board: with what is in `board` already
make_board() {
    status=0
    sh "$root/emulate/flash_board.sh" "$root" "$traction" board ${only:+"$only"} >out 2>err || status=$?
    [ $status -ne 77 ] || skip "the board's kernel or its ssh server has not been built or fetched on this machine (minutes)"
    [ $status -eq 0 ] || fail "the board cannot be laid out"
    cp board/key board/key.pub board/id .
    arm-linux-gnueabi-strip -o tractiond "$target/firmware/app/tractiond"
    port=$((20000 + $$ % 20000))
}
pack() { # pack OUT OPTION...
    out=$1
    shift
    "$traction" flash --pack "$out" "$@" >out 2>err || fail "pack $out"
}
say_ssh() { ssh -T -o BatchMode=yes -o ConnectTimeout=10 -o UserKnownHostsFile=board/known -o IdentitiesOnly=yes -i id -p "$port" root@127.0.0.1 "$@"; }
over() { "$traction" flash --host 127.0.0.1 --port "$port" --known-hosts board/known --identity id --folder /flash/traction "$@"; }
power_on() { # power_on [idle]: at the desk
    : >board/console.txt
    sh "$root/emulate/power_on.sh" board "$port" "${1-}" >qemu.txt 2>&1 &
    qemu=$!
    waited=0
    until over --status >out 2>err; do
        ! grep -q 'Kernel panic' board/console.txt || fail "the board's kernel gave up"
        kill -0 "$qemu" 2>/dev/null || fail "QEMU ended: $(cat qemu.txt)"
        waited=$((waited + 1))
        [ $waited -lt 300 ] || fail "the board does not come up"
        sleep 0.5
    done
}
power_off() { # as a plug is pulled
    kill -KILL "$qemu" 2>/dev/null || true
    wait "$qemu" 2>/dev/null || true
    qemu=''
}
flash() { # flash EXPECTED_CODE WORDS ARGUMENT...
    expected=$1 words=$2
    shift 2
    code=0
    over --wait 180 "$@" >out 2>err || code=$?
    [ "$code" -eq "$expected" ] || fail "flash $* ended with $code, expected $expected"
    grep -qF -- "$words" out err || fail "flash $*: expected: $words"
}
