"""mavlink_peer.py: one end of a MAVLink connection, by pymavlink and the dialect that make_headers.py made; peer.py and ground_station.py
speak through it to a running tractiond, and share no code with it."""
import importlib
import socket
import sys
import time


def load(folder):
    sys.path.insert(0, folder)
    return importlib.import_module("traction_dialect")


def signing_time():
    return int((time.time() - 1420070400) * 1e5)


class Peer:
    def __init__(self, dialect, key, system, port):
        self.dialect = dialect
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", port))
        self.mav = dialect.MAVLink(None, srcSystem=system, srcComponent=190)
        self.mav.robust_parsing = True
        if key:
            self.mav.signing.secret_key = key
            self.mav.signing.link_id = 3
            self.mav.signing.timestamp = signing_time()
            self.mav.signing.sign_outgoing = True
            self.mav.signing.allow_unsigned_callback = lambda mav, message: False
        self.heard, self.latest, self.all, self.refused = {}, {}, [], 0

    def bytes_of(self, message):
        self.mav.signing.timestamp = max(self.mav.signing.timestamp, signing_time())
        return message.pack(self.mav)

    def send(self, message):
        self.socket.send(self.bytes_of(message))

    def listen(self, seconds):
        until = time.monotonic() + seconds
        got = []
        while (left := until - time.monotonic()) > 0:
            self.socket.settimeout(left)
            try:
                data = self.socket.recv(2048)
            except (socket.timeout, ConnectionRefusedError):
                continue
            for message in self.mav.parse_buffer(data) or []:
                if message.get_type() == "BAD_DATA":
                    self.refused += 1
                    continue
                self.heard[message.get_type()] = self.heard.get(message.get_type(), 0) + 1
                self.latest[message.get_type()] = message
                got.append(message)
                self.all.append(message)
        return got

    def until(self, kind, seconds=3, ask=None, good=lambda message: True):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if ask:
                self.send(ask)
            for message in self.listen(0.2):
                if message.get_type() == kind and good(message):
                    return message
        raise SystemExit(f"no {kind} within {seconds} s; heard {self.heard}")
