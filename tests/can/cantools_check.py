"""cantools_check.py DBC DUMP: a second reading of the bus. Reads frames that the C packed (`candump -L` lines with the values beside them)
and compares what cantools itself decodes from the DBC, and encodes back, with what went in. The four wheels' messages must be laid out alike,
for one C function serves them all."""
import sys

import cantools

dbc = cantools.database.load_file(sys.argv[1])
for kind in ("ORDER%d", "WHEEL%d_STATE", "WHEEL%d_DIAGNOSIS"):
    layouts = {tuple((s.name, s.start, s.length, s.is_signed, s.scale) for s in dbc.get_message_by_name(kind % w).signals) for w in range(4)}
    assert len(layouts) == 1, kind
count = 0
for line in open(sys.argv[2], encoding="ascii"):
    frame, values = line.rstrip("\n").split(" ; ")
    ident, data = frame.split("#")
    data = bytes.fromhex(data)
    message = dbc.get_message_by_frame_id(int(ident, 16))
    assert message.length == len(data), line
    decoded = message.decode(data, decode_choices=False, scaling=False)
    for pair in values.split():
        name, value = pair.split("=")
        assert decoded[name] == int(value), (line, name, decoded[name])
    assert message.encode(decoded, scaling=False, strict=False) == data, line
    count += 1
assert count >= 1000, count
print(f"cantools reads and writes {count} frames as the C does")
