"""nor_flash.py [QEMU] - the flash memory of the emulated board as its kernel's driver writes it (Intel's buffered write: e8, words less one, the
words, d0), spoken to over QEMU's test protocol, no processor running. Two words, and one word that is sent twice to the same place
(emulate/kernel/build.sh), are on the memory after it, with a status of ready and no error. Tells whether this QEMU takes one word sent once,
which QEMU 7.2 does and 10.0 does not. Exit 77 where there is no QEMU."""
import shutil
import subprocess
import sys
import tempfile

MEMORY, SIZE, ERASED = 0x34000000, 64 << 20, 0xFFFFFFFF
READY = 0x800080  # SR.7 of both halves, no other bit
qemu = sys.argv[1] if len(sys.argv) > 1 else shutil.which("qemu-system-arm")
if qemu is None:
    print("nor_flash.py: SKIPPED, no qemu-system-arm here")
    sys.exit(77)


class Board:
    def __init__(self, image):
        known = subprocess.run([qemu, "-M", "versatilepb,help"], capture_output=True, text=True).stdout
        machine = "versatilepb" + (",audiodev=none" if "audiodev" in known else "")
        self.process = subprocess.Popen(
            [qemu, "-M", machine, "-audiodev", "none,id=none", "-accel", "tcg", "-S", "-qtest", "stdio", "-qtest-log", "none", "-nodefaults",
             "-display", "none", "-drive", "if=pflash,format=raw,file=" + image], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def say(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        while answer := self.process.stdout.readline():
            if answer.startswith("OK"):
                return answer
        raise SystemExit("nor_flash.py: QEMU ended")

    def put(self, at, value):
        self.say(f"writel {MEMORY + at:#x} {value:#x}")

    def get(self, at):
        return int(self.say(f"readl {MEMORY + at:#x}").split()[1], 16)

    def write(self, at, count, places, value):
        """The driver's buffered write; the status after it, and what the two words there are."""
        self.put(at, 0xE8)
        ready = self.get(at)
        self.put(at, count)
        for place in places:
            self.put(at + place, value)
        self.put(at, 0xD0)
        status = self.get(at)  # the driver takes what it reads now for the status
        self.put(at, 0x50)
        self.put(at, 0xFF)
        return ready, status, self.get(at), self.get(at + 4)


with tempfile.NamedTemporaryFile() as image:
    image.write(b"\xff" * SIZE)
    image.flush()
    board = Board(image.name)
    try:
        two = board.write(0x1000, 1, (0, 4), 0x12345678)
        twice = board.write(0x2000, 1, (0, 0), 0x12345678)
        once = board.write(0x3000, 0, (0,), 0x12345678)
    finally:
        board.process.kill()
        board.process.wait()
if two != (READY, READY, 0x12345678, 0x12345678):
    raise SystemExit("nor_flash.py: two words: " + " ".join(f"{word:08x}" for word in two))
if twice != (READY, READY, 0x12345678, ERASED):
    raise SystemExit("nor_flash.py: one word, sent twice: " + " ".join(f"{word:08x}" for word in twice))
taken = once == (READY, READY, 0x12345678, ERASED)
print(f"two words, and one word sent twice, are written; one word sent once is {'written too' if taken else 'not: ' + ' '.join(f'{word:08x}' for word in once)}")
