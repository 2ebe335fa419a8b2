"""read_ulog.py LOG [FRAMES]: pyulog reads an on-board log; every tick is there once and in order, and with FRAMES (hal/replay/frames.h) the
counts are those that went in."""
import sys

from pyulog import ULog

log = ULog(sys.argv[1])
assert not log.file_corruption, "corrupt"
data = {d.name: d.data for d in log.data_list}
ticks = data["frame"]["tick"]
assert list(ticks) == list(range(ticks[0], ticks[0] + len(ticks))), "ticks missing"
assert list(data["frame"]["timestamp"]) == [(t + 1) * 10000 for t in ticks]
if len(sys.argv) > 2:
    lines = [line.split() for line in open(sys.argv[2], encoding="ascii") if not line.startswith("#")]
    assert len(lines) == len(ticks), (len(lines), len(ticks))
    for row, words in enumerate(lines):
        for wheel in range(4):
            assert data["frame"][f"encoder[{wheel}]"][row] == int(words[4 + wheel]), row
            assert data["frame"][f"current[{wheel}]"][row] == int(words[8 + wheel]), row
        assert data["frame"]["accel[0]"][row] == int(words[13]), row
print(f"pyulog reads {len(ticks)} ticks")
