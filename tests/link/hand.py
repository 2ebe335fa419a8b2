"""hand.py TRACTION PORT KEY_FILE: a hand at the terminal: `traction drive` in a pseudo-terminal; the space bar is pressed as a keyboard repeats
it, and let go. Before a running tractiond (supervision.sh)."""
import json
import os
import pty
import re
import select
import sys
import time

traction, port, key = sys.argv[1:]
child, terminal = pty.fork()
if child == 0:
    os.environ["TERM"] = "xterm"
    os.execv(traction, [traction, "drive", "--host", f"127.0.0.1:{port}", "--key", key, "--json", "hand.json"])
screen = ""


def look(seconds, press=b"", every_s=0.05):
    """What the screen shows at the end; the key pressed again and again meanwhile."""
    global screen
    until, next_s = time.monotonic() + seconds, 0
    while (now := time.monotonic()) < until:
        if press and now >= next_s:
            os.write(terminal, press)
            next_s = now + every_s
        if select.select([terminal], [], [], 0.02)[0]:
            try:
                screen += os.read(terminal, 65536).decode(errors="replace")
            except OSError:  # it has ended
                break
    last = screen[screen.rfind("\x1b[H") :]
    return last


def check(good, what, seen):
    if not good:
        raise SystemExit(f"hand.py: {what}; the screen: {seen!r}")


seen = look(2)
check("hold SPACE to drive" in seen and "stands" in seen, "no screen, or it drives by itself", seen)
os.write(terminal, b"\x1b[A" * 6)  # six times up: 0.30 m/s, and nothing moves by that
seen = look(1)
check("0.30 m/s" in seen and "stands" in seen, "the arrows do not set the speed, or drive", seen)
seen = look(3, b" ")
check("DRIVES" in seen and "platform speed" in seen.splitlines()[2], "it does not drive while the space bar is held", seen)
speed = float(re.search(r"(-?\d+\.\d+) m/s \+-", seen).group(1))
check(0.2 < speed < 0.4, f"drives at {speed} m/s, asked for 0.3", seen)  # a third, as in peer.py
seen = look(1)
check("stands" in seen and "| stop" in seen, "it drives on when the space bar is let go", seen)
check("faults: none" in seen, "letting go is a stop, no fault", seen)
seen = look(0.3, b" ")
os.write(terminal, b"x")
seen = look(0.4)
check("stands" in seen, "any other key does not let go", seen)
os.write(terminal, b"q")
look(1)
_, status = os.waitpid(child, 0)
check(os.waitstatus_to_exitcode(status) == 0, f"ended with {status}", seen)
told = json.load(open("hand.json"))
check(told["status"]["mode"] == "stop" and told["link"]["accepted"] > 20, f"{told}", seen)
print(f"by hand: {speed:.2f} m/s while the space bar is held")
