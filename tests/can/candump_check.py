"""candump_check.py TRACTION SOURCE_FOLDER: frames of random content, written as candump writes them, decoded by cantools and by `traction convert
--dbc`: the same numbers at the same times. A foreign DBC with both bit orders, multiplexing, floats and long ids; then the rover's own."""
import csv
import math
import os
import random
import subprocess
import sys

import cantools

traction, source = sys.argv[1:]
chance = random.Random(20261122)


def run(code, *words):
    done = subprocess.run([traction, *words], capture_output=True, text=True)
    assert done.returncode == code, (words, done.returncode, done.stderr)
    return done.stdout + done.stderr


def line_of(style, time_us, ident, extended, data):
    name = f"{ident:08X}" if extended else f"{ident:03X}"
    stamp = f"({time_us // 1000000}.{time_us % 1000000:06d})"
    if style == "log":
        return f"{stamp} can0 {name}#{'#1' if len(data) > 8 else ''}{data.hex().upper()}"
    return f" {stamp}  can0  {name}   [{len(data)}]  {' '.join(f'{byte:02X}' for byte in data)}"


for dbc_path in (os.path.join(source, "tests/can/foreign.dbc"), os.path.join(source, "hal/can/traction.dbc")):
    dbc = cantools.database.load_file(dbc_path)
    for style in ("log", "screen"):
        expected, lines, time_us = {}, [], 1770000000123456
        begin = time_us
        for index in range(400):
            message = chance.choice(dbc.messages)
            data = bytes(chance.randrange(256) for _ in range(message.length))
            if message.name == "CHOICE":
                data = bytes([chance.randrange(2)]) + data[1:]
            lines.append(line_of(style, time_us, message.frame_id, message.is_extended_frame, data))
            for name, value in message.decode(data, decode_choices=False).items():
                if math.isfinite(value):
                    expected.setdefault(f"{message.name}.{name}", []).append(((time_us - begin) * 1e-6, value))
            time_us += chance.randrange(1, 50000)
        with open("frames.log", "w", encoding="ascii") as file:
            file.write("\n".join(lines) + "\n")
        run(0, "convert", "frames.log", "--dbc", dbc_path, "--out", "frames.csv")
        with open("frames.csv", encoding="ascii", newline="") as file:
            table = list(csv.reader(line for line in file if not line.startswith("#")))
        got = {}
        for row in table[1:]:
            for name, cell in zip(table[0][1:], row[1:]):
                if cell:
                    got.setdefault(name, []).append((float(row[0]), float(cell)))
        assert set(got) == set(expected), (dbc_path, set(got) ^ set(expected))
        for name, samples in expected.items():
            assert len(samples) == len(got[name]), (name, len(samples), len(got[name]))
            for (t_s, value), (t_got, value_got) in zip(samples, got[name]):
                # the same product of two doubles, but for the last bit of its rounding and of a sum
                assert abs(t_s - t_got) < 1e-9 and abs(value - value_got) <= 4e-16 * max(abs(value), 1.0), (name, t_s, value, t_got, value_got)
        print(f"{os.path.basename(dbc_path)}, {style}: {sum(map(len, got.values()))} values as cantools reads them")

# what is left out is told, and what is wrong is refused with its place
foreign = os.path.join(source, "tests/can/foreign.dbc")
with open("odd.log", "w", encoding="ascii") as file:
    file.write("(10.000000) can0 123#0011223344556677\n(10.010000) can0 7FF#00\n(10.020000) can0 123#R\n(10.030000) can0 123#0011\n"
               "(10.040000) can0 20000004#0000000000000000\n(10.0500 can0 123#00\n")
said = run(0, "convert", "odd.log", "--dbc", foreign, "--out", "odd.csv")
for words in ("1 lines are no frame", "line 6", "1 frames of id 7FF", "1 frames MIXED are shorter"):
    assert words in said, (words, said)
assert "--dbc" in run(2, "convert", "odd.log", "--out", "odd.csv")
with open("foreign.log", "w", encoding="ascii") as file:
    file.write("(10.000000) can0 7FF#00\n")
assert "no frame that the DBC knows" in run(3, "convert", "foreign.log", "--dbc", foreign, "--out", "odd.csv")
for text, words in (("BO_ 1 A: 8 X\n SG_ a : 60|8@1+ (1,0) [0|0] \"\" X\n", "line 2: signal a lies beyond"),
                    ("BO_ 1 A: 8 X\nBO_ 1 B: 8 X\n", "line 2: message 1 stands twice"),
                    ("BO_ 1 A 8 X\n", "line 1: 'BO_ 1 A 8 X' is no message"),
                    ("nothing\n", "names no message"),
                    ("BO_ 1 A: 8 X\n SG_ a m1M : 0|8@1+ (1,0) [0|0] \"\" X\n", "multiplexed and multiplexes")):
    with open("wrong.dbc", "w", encoding="ascii") as file:
        file.write(text)
    said = run(3, "convert", "odd.log", "--dbc", "wrong.dbc", "--out", "odd.csv")
    assert words in said, (words, said)
print("what is left out is told, what is wrong is refused")
