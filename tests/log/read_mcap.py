"""read_mcap.py LOG.csv LOG.mcap: a second reading of what `traction convert` writes, by the PyPI packages mcap (the format, its CRCs, by index
and without) and mcap-ros2-support (schemas and CDR): every cell of the CSV is there, with its time, and nothing else is."""
import csv
import io
import re
import sys

from mcap.reader import NonSeekingReader, SeekingReader
from mcap_ros2.decoder import DecoderFactory

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


def read(reader):
    found, names = {}, {}
    last = 0
    for schema, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
        assert schema.encoding == "ros2msg" and channel.message_encoding == "cdr", (schema, channel)
        assert message.log_time >= last and message.publish_time == message.log_time, "messages out of order"
        last = message.log_time
        if channel.id not in names:
            fields = re.findall(r"^float64 (\S+) # (.+)$", schema.data.decode(), re.M)
            assert fields and all(re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", field) for field, _ in fields), schema.data
            names[channel.id] = fields
        for field, name in names[channel.id]:
            found.setdefault(name, []).append((message.log_time, getattr(decoded, field)))
    return found


with open(sys.argv[2], "rb") as file:
    data = file.read()
by_index = SeekingReader(io.BytesIO(data), validate_crcs=True, decoder_factories=[DecoderFactory()])
summary = by_index.get_summary()
metadata = {record.name: record.metadata for record in by_index.iter_metadata()}
header.pop("format")
assert metadata == {"traction-log": header}, "the header is not the metadata"
one = read(by_index)
two = read(NonSeekingReader(io.BytesIO(data), validate_crcs=True, decoder_factories=[DecoderFactory()]))
assert one == two, "with and without its index it is not the same"
assert set(one) == set(columns), set(one) ^ set(columns)
cells = 0
for name, samples in columns.items():
    assert len(samples) == len(one[name]), (name, len(samples), len(one[name]))
    for (t_s, value), (time_ns, got) in zip(samples, one[name]):
        assert abs(t_s * 1e9 - time_ns) <= 1 and value == got, (name, t_s, value, time_ns, got)  # half a nanosecond, rounded
        cells += 1
messages = sum(summary.statistics.channel_message_counts.values())
assert messages == summary.statistics.message_count > 0
topics = sorted(channel.topic for channel in summary.channels.values())
assert len(set(topics)) == len(topics) == summary.statistics.channel_count
print(f"mcap reads {cells} cells in {messages} messages of {len(topics)} topics as they stand in the CSV")
