#!/bin/sh
# traction flash from the key to the running version, on a folder as the board: first in place of ssh a script that runs the command here,
# then a real ssh server on loopback (dropbear), where one can be had. The version is the real tractiond, driving a scenario in real time.
# usage: flash.sh WORK_FOLDER SOURCE_FOLDER TRACTION TRACTION_SLOT TRACTIOND
set -eu
work=$1 source=$2 traction=$3 slot=$4 tractiond=$5
rm -rf "$work"
mkdir -p "$work"
cd "$work"
work=$(pwd)
running= server=
# the ssh server may miss a TERM that comes just before it waits
# shellcheck disable=SC2086 # several numbers
trap '[ -z "$running" ] || kill $running 2>/dev/null || true; [ -z "$server" ] || kill -9 "$server" 2>/dev/null || true' EXIT
fail() { echo "FAILED: $*"; for file in out err starter.txt; do [ ! -s "$file" ] || { echo "--- $file"; tail -n 25 "$file"; }; done; exit 1; }
run() { # run EXPECTED_CODE COMMAND...
    expected=$1
    shift
    code=0
    "$@" >out 2>err || code=$?
    [ "$code" -eq "$expected" ] || fail "$* ended with $code, expected $expected"
}
says() { grep -qF -- "$1" out err || fail "expected: $1"; }
flash() { # flash EXPECTED_CODE ARGUMENT...
    expected=$1
    shift
    run "$expected" "$traction" flash --host board --ssh "$work/ssh" --installer "${installer:-$slot}" --folder "$work/board" "$@"
}
pack() { # pack OUT ROVER [OPTION...]
    out=$1 rover=$2
    shift 2
    run 0 "$traction" flash --pack "$out" --key key --program "$tractiond" --rover "$rover" "$@"
}

until_true() { # until_true WHAT COMMAND...: on a loaded machine too
    what=$1 tries=0
    shift
    until "$@"; do
        tries=$((tries + 1))
        [ "$tries" -lt 300 ] || fail "$what"
        sleep 0.1
    done
}

# --- the key and the package
run 0 "$traction" flash --new-key key
[ "$(stat -c %a key)" = 600 ] || fail "the key's mode"
run 4 "$traction" flash --new-key key
says 'a key is never overwritten'
run 2 "$traction" flash --pack p.tar --rover lhomme_desages
says 'give --key FILE'
run 2 "$traction" flash --pack p.tar --key key
says 'give --rover FILE'
run 2 "$traction" flash --pack p.tar --new-key other
run 2 "$traction" flash
grep -v '^\[hardware\]' "$source/rovers/heavy.toml" | sed '/^wheels = "/,$d' >no_hardware.toml
run 3 "$traction" flash --pack p.tar --key key --program "$tractiond" --rover no_hardware.toml
says 'no section [hardware]'
run 3 "$traction" flash --pack p.tar --key key --program "$source/README.md" --rover lhomme_desages
says 'no program (ELF)'
cp key open_key
chmod 644 open_key
run 3 "$traction" flash --pack p.tar --key open_key --program "$tractiond" --rover lhomme_desages
says 'others may read the key'
run 2 "$traction" flash --pack key --key key --program "$tractiond" --rover lhomme_desages
says 'would replace what goes into it'
run 4 "$traction" flash /dev/zero
says 'larger than any package'
run 4 "$traction" flash .
run 4 "$traction" flash --pack p.tar --key nowhere --program "$tractiond" --rover lhomme_desages
sed 's/^seed ..../seed 0000/' key >spoilt_key
sed 's/^next 0/next 1024/' key >empty_key
chmod 600 spoilt_key empty_key
run 3 "$traction" flash --pack p.tar --key empty_key --program "$tractiond" --rover lhomme_desages
says '1024 signatures are used up'
[ ! -e p.tar ] || fail "a package that was refused was written"
grep -qx 'next 0' key || fail "an index was used up by what was refused"
pack p0.tar lhomme_desages
says 'number 0 of key'
pack p1.tar lhomme_desages
says 'number 1 of key'
grep -qx 'next 2' key || fail "the key does not keep its index"
tar tf p0.tar | tr '\n' ' ' | grep -qx 'manifest manifest.sig tractiond start rover.toml parameters check.frames check.hash ' || fail "the archive's files"
run 0 "$traction" flash p0.tar --key key.pub
says 'signed by this key, and whole'
run 0 "$traction" flash --new-key other
run 3 "$traction" flash p0.tar --key other.pub
says 'and this rover obeys the key'
cp spoilt_key spoilt2
run 0 "$traction" flash --pack ps.tar --key spoilt_key --program "$tractiond" --rover lhomme_desages # same name, another secret
run 3 "$traction" flash ps.tar --key key.pub
says "signature is not by the key"

# --- a board: a folder, a starter, and the daemon in real time
cat >ssh <<'SSH'
#!/bin/sh
# in place of ssh: the remote command by a shell, as a server would run it; CUT: only so many bytes of the input arrive
while [ "$1" != -- ]; do shift; done
shift 2
if [ -n "${CUT-}" ]; then head -c "$CUT" | sh -c "$*"; else exec sh -c "$*"; fi
SSH
chmod +x ssh
installer=/nowhere/traction-slot
flash 3 p0.tar
says 'is not on the board'
installer=
flash 4 p0.tar
says 'traction-slot init'
run 0 "$slot" --folder board init --key key.pub --rover Lhomme-Desages
run 3 "$slot" --folder board init --key "$source/README.md" --rover Lhomme-Desages
says 'no public key'
run 2 "$slot" --folder board fly
run 2 "$slot" --folder board status --wait 0
sed 's/^duration_s.*/duration_s = 3600.0/; s/^for_s = 22.0/for_s = 3590.0/' "$source/scenarios/cruise.toml" >drive.toml
{ cat drive.toml; printf '\n[[fault]]\nwhat = "sensor"\nsensor = "radar"\nhow = "dropped"\nfrom_s = 2.0\n'; } >deaf.toml
cat >defaults <<DEFAULTS
STATE=$work/state
TRACTIOND_HAL=sim
TRACTIOND_OPTIONS='--realtime --log-budget 1'
TRACTIOND_ROVER=$work/drive.toml
if grep -q '# is deaf' rover.toml; then TRACTIOND_ROVER=$work/deaf.toml; fi
if grep -q '# ends' rover.toml; then TRACTIOND_ROVER=nowhere.toml; fi
DEFAULTS
TRACTIOND_DEFAULTS=$work/defaults
export TRACTIOND_DEFAULTS
run 0 "$slot" --folder board status
says 'no version yet'

flash 0 p0.tar # no starter: it waits for one
says 'installed; no version runs there now'
start_board() { # start_board [SECONDS]: of a trial
    "$slot" --folder "$work/board" run --trial-seconds "${1-40}" >>starter.txt 2>&1 &
    starter=$!
    running="$running $starter"
}
start_board
flash 4 p1.tar # the first one is on trial still
says 'the board is busy, and was not changed: another version is on trial'
run 0 "$slot" --folder board status --wait 30
says 'confirmed 0'
daemon() { pgrep -P "$starter" || echo none; }
daemon_runs() { [ "$(daemon)" != none ]; }
flash 0 p0.tar
says 'this very version runs already'

# --- a new version
before=$(daemon)
flash 0 --dry-run p1.tar
says 'the board would take it; nothing was written'
[ "$(daemon)" = "$before" ] || fail "--dry-run stopped the rover"
flash 0 --json result.json p1.tar
says 'self-test passed'
says 'the new version runs: confirmed 1'
grep -q '"outcome": "confirmed"' result.json || fail "the result as JSON"
first=$(daemon)
[ "$first" != "$before" ] && [ "$first" != none ] || fail "the new version was not started"
still() { [ "$(daemon)" = "$first" ] || fail "the version that runs was disturbed by $1"; }
find board -type f ! -name lock -exec sha256sum {} + | sort -k 2 >board.sums
unchanged() { find board -type f ! -name lock -exec sha256sum {} + | sort -k 2 | cmp -s - board.sums || fail "$1 changed the board"; still "$1"; }

# --- what is refused changes nothing, and the version runs on
flash 3 p0.tar
says 'number 0 is not above 1'
unchanged 'an older version'
pack p2.tar lhomme_desages
for part in manifest manifest.sig tractiond check.hash; do
    at=$(grep -abo "$part" p2.tar | head -n 1 | cut -d : -f 1)
    { head -c $((at + 600)) p2.tar; printf '\377'; tail -c +$((at + 602)) p2.tar; } >changed.tar
    [ "$part" = check.hash ] || ! cmp -s changed.tar p2.tar || fail "nothing was changed in $part"
    cmp -s changed.tar p2.tar || { flash 3 changed.tar; unchanged "a byte of $part"; }
done
"$slot" --folder board install changed.tar >out 2>err && fail "the board took a changed package"
CUT=500000
export CUT
flash 3 p2.tar
says 'cut, changed or none at all'
CUT=0 flash 3 p2.tar
unset CUT
unchanged 'a stream that was cut'
run 0 "$traction" flash --pack foreign.tar --key other --program "$tractiond" --rover lhomme_desages
flash 3 foreign.tar
says 'the board refuses it, and was not changed: the package is signed by the key'
flash 3 ps.tar
unchanged 'a foreign signature'
sed 's/^name = .*/name = "Another"/' "$source/rovers/lhomme_desages.toml" >another.toml
pack another.tar another.toml
flash 3 another.tar
says 'for the rover Another, this is Lhomme-Desages'
unchanged 'another rover'
{ head -c 18 "$tractiond"; printf '\267\0'; tail -c +21 "$tractiond"; } >arm64 # e_machine
run 0 "$traction" flash --pack arm64.tar --key key --program arm64 --rover lhomme_desages
flash 3 arm64.tar
says 'for the architecture arm64'
unchanged 'another architecture'
mkfifo hold
hold() {
    "$slot" --folder board install hold >holder.txt 2>&1 &
    holder=$!
    running="$running $holder"
}
hold
held() { # who asks takes the lock for a moment, and may be what the holder met
    if grep -q 'another installer' holder.txt; then hold; fi
    "$slot" --folder board install /dev/null 2>&1 | grep -q 'another installer'
}
until_true 'no installer holds the lock' held
flash 4 p2.tar
says 'another installer is at work'
: >hold
wait "$holder" && fail "an empty package was installed" || true
unchanged 'two installers at once'

# --- a version that does not come up
run 0 "$traction" flash --pack false.tar --key key --program /bin/false --rover lhomme_desages
flash 1 false.tar
says 'fails its self-test on this board'
says 'the old version runs'
still 'a version that failed its self-test'
run 0 "$slot" --folder fresh init --key key.pub --rover Lhomme-Desages
"$slot" --folder fresh run >fresh.txt 2>&1 &
waiting=$!
running="$running $waiting"
first_is_awaited() { "$slot" --folder fresh status | grep -qx 'traction-slot run waits for the first version'; }
until_true 'a starter without a version says that one runs' first_is_awaited
kill "$waiting"
wait "$waiting" || true
run 1 "$traction" flash --host board --ssh "$work/ssh" --installer "$slot" --folder "$work/fresh" false.tar
says 'the new version did not come up, and the board has no other'
{ cat "$source/rovers/lhomme_desages.toml"; echo '# ends'; } >ends.toml
pack ends.tar ends.toml
flash 1 ends.tar
says 'the old version runs; the new one did not come up: returned'
says 'ended with exit code 3'
{ cat "$source/rovers/lhomme_desages.toml"; echo '# is deaf'; } >deaf_rover.toml
pack deaf.tar deaf_rover.toml
kill "$starter"
wait "$starter" || true
start_board 15 # a healthy one needs 10 s
until_true 'the old version does not run under another starter' daemon_runs
flash 1 deaf.tar
says 'not healthy within 15 s: faults 00000020' # FAULT_RADAR_LOST
run 0 "$slot" --folder board status
says 'number 1, version'
until_true 'the old version was not started again' daemon_runs

# killed while on trial, start after start, as by a power cut: the third is the last
pack p3.tar lhomme_desages
kill "$starter"
wait "$starter" || true
flash 0 p3.tar
for try in 1 2 3; do
    start_board
    until_true "start $try is not counted" grep -q "^trial [ab] $try" board/state
    until_true "nothing was started" daemon_runs
    child=$(daemon)
    kill -KILL "$starter" "$child"
    wait "$starter" 2>/dev/null || true
done
start_board
until_true 'the trial was not given up' grep -q '^note returned' board/state
run 0 "$slot" --folder board status
says 'never healthy'
until_true 'the old version does not run' daemon_runs

# the installer killed at many moments of its writing: the version that runs does not mind, and the next flash succeeds
pack p4.tar lhomme_desages
for ms in 001 004 008 012 016 020 025 030 040 050; do
    "$slot" --folder board install --no-restart p4.tar >/dev/null 2>&1 &
    child=$!
    sleep "0.$ms"
    kill -KILL "$child" 2>/dev/null || true
    wait "$child" 2>/dev/null || true
    "$slot" --folder board return >/dev/null
done
flash 0 p4.tar
says 'the new version runs'

# --- what never reaches a shell
run 2 "$traction" flash --host -oProxyCommand=touch p4.tar
run 2 "$traction" flash --host 'a;touch x' p4.tar
run 2 "$traction" flash --host board --folder '/x y' p4.tar
run 2 "$traction" flash --status
[ ! -e x ] || fail "a name was executed"
run 4 "$traction" flash --host board p9.tar
run 3 "$traction" flash --host board --ssh /nowhere/ssh p4.tar
says 'install openssh-client'

# --- over a real ssh server
if ! command -v dropbear >/dev/null 2>&1 || ! command -v ssh >/dev/null 2>&1 || [ "$(id -u)" -ne 0 ] || ! unshare -m true 2>/dev/null; then
    echo "over ssh: skipped, it needs dropbear (apt: dropbear-bin), ssh (openssh-client) and root, for a home of its own"
    exit 0
fi
home=$(getent passwd 0 | cut -d : -f 6)
mkdir -p home/.ssh
chmod 700 home home/.ssh
ssh-keygen -q -t ed25519 -N '' -f id
ssh-keygen -q -t ed25519 -N '' -f stranger
cp id.pub home/.ssh/authorized_keys
chmod 600 home/.ssh/authorized_keys
dropbearkey -t ed25519 -f host_key >/dev/null 2>&1
port=$((20000 + $$ % 20000))
unshare -m sh -c "mount --bind '$work/home' '$home' && exec dropbear -F -E -s -r host_key -P dropbear.pid -p 127.0.0.1:$port" </dev/null >dropbear.txt 2>&1 &
server=$!
running="$running $!"
until_true 'no ssh server' sh -c "ssh-keyscan -p $port 127.0.0.1 2>/dev/null | grep -q ."
: >known
over() { # over EXPECTED_CODE ARGUMENT...
    expected=$1
    shift
    run "$expected" "$traction" flash --host 127.0.0.1 --port "$port" --known-hosts known --installer "${installer:-$slot}" --folder "$work/board" "$@"
}
over 4 --identity id p4.tar
says 'its host key is not known here'
echo "[127.0.0.1]:$port $(dropbearkey -y -f host_key | grep '^ssh-ed25519' | cut -d ' ' -f 1,2)" >known
over 4 --identity stranger p4.tar
says 'it refuses the key stranger for root'
over 0 --identity id p4.tar
says 'this very version runs already'
pack p5.tar lhomme_desages
over 0 --identity id p5.tar
says 'the new version runs: confirmed'
over 0 --identity id --status
installer=/nowhere/traction-slot
over 3 --identity id p5.tar
says 'is not on the board'
installer=
port=$((port + 1))
over 4 --identity id p5.tar
says 'nothing listens there'
port=$((port - 1))
echo "[127.0.0.1]:$port ssh-ed25519 $(cut -d ' ' -f 2 id.pub)" >known
over 4 --identity id p5.tar
says 'its host key is another than before'
chmod 644 id
over 4 --identity id p5.tar
echo "flashed over ssh too"
