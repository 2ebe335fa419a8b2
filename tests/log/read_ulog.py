"""read_ulog.py LOG.csv LOG.ulg: a second reading of what `traction convert` writes, by PyPI's pyulog: every cell of the CSV is there, with its
time, its signal's name and every bit of its value, and nothing else is; the header's lines are the CSV's."""
import csv
import re
import sys

from pyulog import ULog

columns, header = {}, {}
with open(sys.argv[1], encoding="utf-8", newline="") as file:
    rows = []
    for line in file:
        if line.startswith("#"):
            key, _, value = line[2:].rstrip("\n").partition(": ")
            header[key] = value
        else:
            rows.append(line)
table = list(csv.reader(rows))
for row in table[1:]:
    for name, cell in zip(table[0][1:], row[1:]):
        if cell:
            columns.setdefault(name, []).append((float(row[0]), float(cell)))

log = ULog(sys.argv[2])
assert not log.file_corruption, "corrupt"
header.pop("format")
lines = [one for group in log.msg_info_multiple_dict["traction_header"] for one in group]
found = dict(line.split(": ", 1) for line in lines)
assert found == header, "the header is not the CSV's"
topics = {}
for data in log.data_list:
    assert data.multi_id == 0 and data.name not in topics
    assert re.fullmatch(r"[a-zA-Z0-9_-]+", data.name), data.name
    assert all(re.fullmatch(r"[a-zA-Z][a-zA-Z0-9_]*", field.field_name) for field in data.field_data), data.name
    topics[data.name] = data.data
places = [line for group in log.msg_info_multiple_dict["traction_signal"] for line in group]
assert [place.split(" ", 2)[2] for place in places] == table[0][1:], "the columns, in order"
cells = 0
for place in places:
    topic, field, name = place.split(" ", 2)
    if topic == "-":
        assert name not in columns
        continue
    data, samples = topics[topic], columns[name]
    stamps = data["timestamp"]
    assert len(samples) == len(stamps), (name, len(samples), len(stamps))
    for row, (t_s, value) in enumerate(samples):
        time_s = data["t_s"][row] if "t_s" in data else int(stamps[row]) / 1e6
        assert float(time_s) == t_s and float(data[field][row]) == value, (name, t_s, value)
        cells += 1
assert cells == sum(len(samples) for samples in columns.values())
print(f"pyulog reads {cells} cells in {len(topics)} topics as they stand in the CSV: {', '.join(sorted(topics))}")
