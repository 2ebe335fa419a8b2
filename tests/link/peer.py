"""peer.py DIALECT_FOLDER PORT KEY_FILE LOG_FILE: an operator of its own making, by pymavlink, before a running tractiond (supervision.sh).
Signs, drives, lists and fetches a log, asks what a ground station asks, and does what must be refused. LOG_FILE: the fetched log."""
import random
import socket
import sys
import time

import mavlink_peer

folder, port, key_file, log_file = sys.argv[1:]
dialect = mavlink_peer.load(folder)


class Peer(mavlink_peer.Peer):
    def __init__(self, key, system):
        super().__init__(dialect, key, system, int(port))

    def command(self, speed, mode=3, session=None, behind_ms=0):
        status = self.latest["TRACTION_STATUS"]
        return dialect.MAVLink_traction_command_message(
            target_system=1, target_component=1, session=status.session if session is None else session,
            rover_time_ms=max(0, status.time_boot_ms - behind_ms), platform_speed_m_s=speed, yaw_rate_rad_s=0, slip_ref=0, mode=mode, slip_wheels=0)

    def drive(self, speed, seconds):
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            self.send(self.command(speed))
            self.listen(0.02)

    def counts(self):
        """Of a second that begins after all that was sent before."""
        self.listen(0.1)
        return self.until("TRACTION_LINK", ask=dialect.MAVLink_command_long_message(1, 1, 512, 0, 53141, 0, 0, 0, 0, 0, 0))


def check(good, what):
    if not good:
        raise SystemExit("peer.py: " + what)


key = bytes.fromhex(open(key_file, encoding="ascii").read().strip())
heartbeat = dialect.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
peer, nobody, forger = Peer(key, 201), Peer(None, 202), Peer(bytes(32), 203)

# telemetry: signed by the rover's key, or nothing of it would be believed here
peer.until("TRACTION_STATUS", ask=heartbeat)
began, seen = time.monotonic(), peer.heard["TRACTION_STATUS"]
for _ in range(3):
    peer.send(heartbeat)
    peer.listen(1)
rate = (peer.heard["TRACTION_STATUS"] - seen) / (time.monotonic() - began)
check(15 <= rate <= 22, f"{rate} statuses a second, 20 asked for")  # a loaded machine may lose some
check(peer.heard["HEARTBEAT"] >= 2 and peer.latest["HEARTBEAT"].type == 10, "no heartbeat of a ground rover")
check(peer.refused == 0, "packets of the rover that its own key does not verify")

# what a ground station asks first, without a key
nobody.send(heartbeat)
ask = dialect.MAVLink_param_request_list_message(1, 1)
first = nobody.until("PARAM_VALUE", ask=ask)
nobody.listen(1)
names = {m.param_index: (m.param_id, m.param_value) for m in nobody.all if m.get_type() == "PARAM_VALUE"}
check(len(names) == first.param_count, f"{len(names)} of {first.param_count} parameters")
check(len({name for name, _ in names.values()}) == first.param_count, "names of parameters that are not different")
check(any(name == "wheel_radius_m" and abs(value - 0.057) < 1e-6 for name, value in names.values()), "no wheel_radius_m")
nobody.until("AUTOPILOT_VERSION", ask=dialect.MAVLink_command_long_message(1, 1, 512, 0, 148, 0, 0, 0, 0, 0, 0))
count = nobody.until("MISSION_COUNT", ask=dialect.MAVLink_mission_request_list_message(1, 1))
check(count.count == 0, "a mission")

# unsigned, forged, replayed, stale: refused, each counted
before = peer.counts()
nobody.latest["TRACTION_STATUS"] = forger.latest["TRACTION_STATUS"] = peer.latest["TRACTION_STATUS"]
for _ in range(5):
    nobody.send(nobody.command(0.3))
    forger.send(forger.command(0.3))
peer.listen(0.2)
peer.send(peer.command(0.3, session=12345))
peer.send(peer.command(0.3, behind_ms=400))
peer.send(peer.command(50))
now = peer.counts()
check(now.accepted == before.accepted, "a command that must be refused was obeyed")
for field, wanted in (("refused_unsigned", 5), ("refused_signature", 5), ("refused_stale", 2), ("refused_other", 1)):
    got = getattr(now, field) - getattr(before, field)
    check(got == wanted, f"{field} rose by {got}, expected {wanted}")
check(peer.latest["TRACTION_STATUS"].mode == 0, "the rover drives")

# a signed command drives; the same bytes again are a replay
recorded = peer.bytes_of(peer.command(0.3))
peer.socket.send(recorded)
peer.socket.send(recorded)
noise = random.Random(20261122)
flood = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
flooded, until = 0, time.monotonic() + 4
while time.monotonic() < until:  # while noise comes from elsewhere
    for _ in range(10):
        data = bytearray(noise.randbytes(noise.randrange(1, 300)))
        data[0] = noise.choice((0xFD, 0xFE, data[0]))
        flood.sendto(data, ("127.0.0.1", int(port)))
        flooded += 1
    peer.send(peer.command(0.3))
    peer.listen(0.02)
status = peer.latest["TRACTION_STATUS"]
check(status.mode == 3 and status.flags & 2, f"not in command: mode {status.mode}")
check(0.2 < status.speed_m_s < 0.4, f"drives at {status.speed_m_s} m/s, asked for 0.3")  # under way after 4 s, within a third
check(status.faults == 0, f"faults {status.faults:x} under {flooded} datagrams of noise")

# then silence: stopped, and told
silent = time.monotonic()
while time.monotonic() < silent + 0.6:
    peer.listen(0.1)
status = peer.latest["TRACTION_STATUS"]
check(status.flags & 4 and status.faults & 2, f"silence was not noticed: faults {status.faults:x}, flags {status.flags}")
check(status.drive != 3, "the bridges drive on")
lost = peer.counts()
check(lost.losses - now.losses >= 1, "the loss was not counted")  # a busy machine may lose more
check(lost.refused_replay - now.refused_replay == 1, "the replayed packet was not counted as such")
peer.socket.send(recorded)  # the old packet does not set it going again
peer.send(peer.command(0, mode=0))
peer.listen(0.3)
check(peer.latest["TRACTION_STATUS"].faults == 0, "a stop did not clear the time-out")
check(peer.counts().refused_replay - lost.refused_replay == 1, "the second replay was not counted")

# the log: listed, and the bytes of its beginning as they are on the disk
entry = peer.until("LOG_ENTRY", ask=dialect.MAVLink_log_request_list_message(1, 1, 0, 0xFFFF))
check(entry.num_logs == 1 and entry.size > 10000, f"log {entry}")
pieces, end = {}, time.monotonic() + 20
size = entry.size
while len(pieces) * 90 < size and time.monotonic() < end:
    missing = next(i for i in range((size + 89) // 90) if i not in pieces)
    peer.send(dialect.MAVLink_log_request_data_message(1, 1, entry.id, missing * 90, size - missing * 90))
    quiet = 0
    while quiet < 3:
        got = [m for m in peer.listen(0.1) if m.get_type() == "LOG_DATA"]
        quiet = 0 if got else quiet + 1
        for message in got:
            if message.ofs + 90 <= size and message.count == 90 or message.ofs + message.count >= size:
                pieces[message.ofs // 90] = bytes(message.data[: message.count])
        if len(pieces) * 90 >= size:
            break
data = b"".join(pieces[i] for i in range(len(pieces)))[:size]
with open(log_file, "wb") as file:
    file.write(data)
check(len(data) == size, f"{len(data)} of {size} bytes of the log")
print(f"pymavlink: {rate:.1f} statuses a second, {first.param_count} parameters, {size} bytes of log, every refusal counted, {flooded} datagrams of noise borne")
