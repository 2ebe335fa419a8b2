#!/bin/sh
# Logs become MCAP and are read back by PyPI's mcap: one of the simulator's (several rates), one with names that ROS does not take.
# usage: mcap.sh TRACTION SOURCE_FOLDER WORK_FOLDER
set -eu
traction=$1 source=$2 work=$3
python=$source/.venv/bin/python
"$python" -c 'import mcap, mcap_ros2' 2>/dev/null || { echo 'skipped: no mcap in .venv (tests/replay/requirements.txt)'; exit 77; }
rm -rf "$work"
mkdir -p "$work"
cd "$work"
"$traction" simulate "$source/scenarios/cruise.toml" --out run.csv >said
"$traction" convert run.csv --out again.csv >>said # as it is written, the last line included
"$traction" convert run.csv --out run.mcap >>said
"$python" "$source/tests/log/read_mcap.py" again.csv run.mcap
cat >odd.csv <<'T'
# format: traction-log 1
# note: names as people give them
t_s,arm.Position.x_m,arm.position_x_m,7up,"a, b",arm._,lone.value
-1.5,1,,2,3,,
-1,2,5,,4,1e-300,
0.000000001,3,6,7,,-0,8
1700,4,7,8,9,1e300,
T
"$traction" convert odd.csv --out odd_again.csv >>said
"$traction" convert odd.csv --out odd.mcap >>said
"$python" - <<'P'
import io
from mcap.reader import SeekingReader
from mcap_ros2.decoder import DecoderFactory
reader = SeekingReader(open("odd.mcap", "rb"), validate_crcs=True, decoder_factories=[DecoderFactory()])
metadata = {one.name: one.metadata for one in reader.iter_metadata()}["traction-log"]
assert metadata["moved_s"].startswith("1.5"), metadata
messages = list(reader.iter_decoded_messages())
assert messages[0][2].log_time == 0 and messages[-1][2].log_time == 1701500000000, "times are moved to begin at 0"
print(len(messages), "messages with names that ROS does not take")
P
code=0
"$traction" convert run.csv --out /nowhere/run.mcap >said 2>&1 || code=$?
[ $code -eq 4 ] || { echo "a folder that is not there: exit $code"; exit 1; }
