#!/bin/sh
# The supervision link end to end on this machine: tractiond drives a simulated rover, `traction drive` and an operator made of pymavlink alone
# speak to it over loopback. Driven, refused, lost, stopped; logs fetched, checked; mistakes told.
# usage: supervision.sh TRACTION TRACTIOND STOPS_IN_TIME WORK_FOLDER SOURCE_FOLDER
set -eu
traction=$1 tractiond=$2 stops_in_time=$3 work=$4 source=$5
rm -rf "$work"
mkdir -p "$work"
cd "$work"
daemon=
end() { [ -z "$daemon" ] || { kill -TERM "$daemon" 2>/dev/null && wait "$daemon" 2>/dev/null; } || true; daemon=; }
trap end EXIT INT TERM
renice -n -10 -p $$ >/dev/null 2>&1 || true # who may, goes before what computes beside it
fail() { echo "supervision.sh: $*"; for file in rover.err said; do [ ! -f $file ] || { echo "--- $file"; tail -n 20 $file; }; done; exit 1; }
run() { # run EXPECTED_CODE ARGUMENT...: traction
    expected=$1
    shift
    code=0
    "$traction" "$@" >said 2>&1 || code=$?
    [ "$code" -eq "$expected" ] || fail "traction $*: exit $code, expected $expected"
}
# A machine that is busy for 80 ms stops the rover, rightly: what must drive for seconds on end has three tries.
three() { # three NAME COMMAND...
    name=$1
    shift
    for try in 1 2 3; do
        if "$@" >"$name.txt" 2>&1; then cat "$name.txt"; return 0; fi
        echo "$name, try $try: $(tail -n 1 "$name.txt")"
    done
    fail "$name"
}
says() { grep -q -- "$1" "$2" || fail "expected in $2: $1"; }

cat >stand.toml <<'T'
title = "Stands until somebody drives it"
duration_s = 300.0
seed = 7
[ground]
soil = "concrete"
[[drive]]
for_s = 300.0
mode = "stop"
T
start() { # start OPTION...: the rover; $port is where it listens
    : >rover.err # else the port of the one before is read before the shell has emptied it
    "$tractiond" --hal sim stand.toml --link 127.0.0.1:0 "$@" 2>rover.err &
    daemon=$!
    tries=0
    while [ $tries -lt 80 ]; do
        tries=$((tries + 1))
        port=$(sed -n 's/.*listens on 127.0.0.1:\([0-9]*\) .*/\1/p' rover.err)
        [ -z "$port" ] || return 0
        sleep 0.25
    done
    fail 'tractiond does not listen'
}

# keys, and what is wrong with a command line
run 0 drive --new-key key
[ "$(stat -c %a key)" = 600 ] || fail 'the key can be read by others'
run 4 drive --new-key key
says 'never overwritten' said
run 0 drive --new-key other
run 2 drive --speed 0.3
says 'no --host' said
run 2 drive --host 127.0.0.1 --speed 0.3
says '--key' said
run 2 drive --host 127.0.0.1 --key key --slip 0.2 --wheels 7
says 'no wheel' said
run 2 drive --host 127.0.0.1 --fetch 1
says '--out' said
run 3 drive --host 127.0.0.1:99999 --for 1
says 'is no address' said
cp key open && chmod 644 open
run 3 drive --host 127.0.0.1 --key open --speed 0.3
says 'mode 644' said
run 4 drive --host 127.0.0.1:9 --for 1 # nobody there
says 'no rover answers' said
code=0
"$tractiond" --hal sim stand.toml --link nowhere 2>said || code=$?
[ $code -eq 3 ] || fail "tractiond --link nowhere: exit $code"
says 'no address of this machine' said
code=0
"$tractiond" --hal sim stand.toml --link 127.0.0.1:0 --link-key open 2>said || code=$?
[ $code -eq 3 ] || fail "tractiond with a key that others may read: exit $code"

# without a key: told aloud, telemetry, and no command
start
says 'no --link-key: telemetry only, no command is accepted' rover.err
run 0 drive --host 127.0.0.1:"$port" --for 1.5
says 'm/s' said
run 4 drive --host 127.0.0.1:"$port" --key key --speed 0.3 --for 1
says 'has no key' said
end

# with one: watched, driven, and not by another key
start --link-key key --log logs
run 0 drive --host 127.0.0.1:"$port" --key key --for 1
run 4 drive --host 127.0.0.1:"$port" --key other --speed 0.3 --for 1
says 'signs with another key' said
three driven "$traction" drive --host 127.0.0.1:"$port" --key key --speed 0.3 --for 4 --json drive.json
python3 - <<'P' || fail "drive.json is not as driven: $(cat drive.json)"
import json
told = json.load(open("drive.json"))
drive, link = told["drive"], told["link"]
assert abs(drive["mean_speed_m_s"] - 0.3) < 0.03, drive  # a tenth: the platform's speed loop on concrete, from 2 s on
assert drive["stopped"] and drive["faults"] == 0 and drive["trouble"] == "", drive
assert drive["statuses"] >= 40, drive                    # of 80: a loaded machine may be late, half is a link
assert link["accepted"] >= 50 and link["refused_unsigned"] == link["refused_replay"] == 0, link
P
run 1 drive --host 127.0.0.1:"$port" --key key --speed 15 --for 2
says 'out of its range' said
run 1 drive --host 127.0.0.1:"$port" --key key --set LINK_SPEED_MAX=99
says 'refused' said
run 0 drive --host 127.0.0.1:"$port" --key key --set LINK_BULK_KB_S=1000
run 0 drive --host 127.0.0.1:"$port" --parameters # anybody may read
says '^wheel_radius_m *0.057' said
says '^LINK_BULK_KB_S *1000' said

# by hand, in a terminal
three hand python3 "$source/tests/link/hand.py" "$traction" "$port" key

# the operator's program dies while the rover moves: it stops by itself, and a stop sets it free again
"$traction" drive --host 127.0.0.1:"$port" --key key --speed 0.3 --for 60 >killed.txt 2>&1 &
killed=$!
sleep 3
kill -KILL $killed
wait $killed 2>/dev/null || true
sleep 0.5
run 0 drive --host 127.0.0.1:"$port" --for 1
says 'command timeout' said
run 0 drive --host 127.0.0.1:"$port" --key key --stop
run 0 drive --host 127.0.0.1:"$port" --for 1
says 'faults: none' said

# the log of it, over the link
run 0 drive --host 127.0.0.1:"$port" --logs
says '^ *1 ' said
run 0 drive --host 127.0.0.1:"$port" --fetch 1 --out fetched.ulg
bytes=$(wc -c <fetched.ulg)
head -c "$bytes" logs/log_000001.ulg | cmp - fetched.ulg || fail 'what was fetched is not what the rover has written'
run 4 drive --host 127.0.0.1:"$port" --fetch 77 --out none.ulg
run 0 convert fetched.ulg --out run.csv
run 0 check run.csv
end
"$stops_in_time" logs/log_000001.ulg || fail 'the rover did not stop in time'

# an operator that shares no code with ours
if [ -x "$source/.venv/bin/python" ] && "$source/.venv/bin/python" -c 'import pymavlink' 2>/dev/null; then
    "$source/.venv/bin/python" "$source/firmware/link/make_headers.py" "$source/firmware/link/traction.xml" Python "$work/dialect/traction_dialect" >generator.txt 2>&1 ||
        fail "the dialect in Python: $(tail -n 3 generator.txt)"
    with_peer() {
        end
        rm -rf peer_logs
        start --link-key key --log peer_logs
        "$source/.venv/bin/python" "$source/tests/link/peer.py" "$work/dialect" "$port" key peer.ulg
    }
    three peer with_peer
    station() { "$source/.venv/bin/python" "$source/tests/link/ground_station.py" "$work/dialect" "$port" "$@"; }
    three station station
    three station_signed station key
    end
    bytes=$(wc -c <peer.ulg)
    head -c "$bytes" peer_logs/log_000001.ulg | cmp - peer.ulg || fail 'what pymavlink fetched is not what the rover has written'
    "$stops_in_time" peer_logs/log_000001.ulg || fail 'the rover did not stop in time'
else
    echo 'no pymavlink in .venv: the independent operator did not speak'
fi
echo 'the supervision link holds from end to end'
