"""ground_station.py DIALECT_FOLDER PORT [KEY_FILE] - what QGroundControl sends to a vehicle that it meets, in its order, before a running
tractiond (supervision.sh), without a signing key and with one: heartbeat, AUTOPILOT_VERSION, standard modes, component information, all
parameters (and those that were lost by index), mission, fence and rally points, then what its older versions ask, its log page, and what its
buttons would do. Each question is answered or refused in its protocol's own words, and nothing moves the rover."""
import sys
import time

import mavlink_peer

folder, port = sys.argv[1], int(sys.argv[2])
key = bytes.fromhex(open(sys.argv[3], encoding="ascii").read().strip()) if len(sys.argv) > 3 else None
dialect = mavlink_peer.load(folder)
station = mavlink_peer.Peer(dialect, key, 255, port)  # component 190, MAV_COMP_ID_MISSIONPLANNER
ROVER, AUTOPILOT, ALL = 1, 1, 0
ACCEPTED, DENIED, UNSUPPORTED = 0, 2, 3
REQUEST_MESSAGE, REPOSITION = 512, 192


def check(good, what):
    if not good:
        raise SystemExit(f"ground_station.py ({'signed' if key else 'unsigned'}): {what}")


def heartbeat():
    # MAV_TYPE_GCS, MAV_AUTOPILOT_INVALID, MAV_MODE_MANUAL_ARMED, MAV_STATE_ACTIVE
    station.send(dialect.MAVLink_heartbeat_message(6, 8, 192, 0, 4, 3))


def ask(command, *parameters, component=AUTOPILOT):
    """A COMMAND_LONG and its acknowledgement, sent again as QGroundControl does where none comes."""
    numbers = list(parameters) + [0.0] * (7 - len(parameters))
    asked = dialect.MAVLink_command_long_message(ROVER, component, command, 0, *numbers)
    ack = station.until("COMMAND_ACK", ask=asked, good=lambda message: message.command == command)
    check((ack.target_system, ack.target_component) == (255, 190), f"command {command} is acknowledged to {ack.target_system}")
    return ack.result


# it waits for a heartbeat, which says what it has met
heartbeat()
met = station.until("HEARTBEAT", ask=dialect.MAVLink_heartbeat_message(6, 8, 192, 0, 4, 3))
check(met.type == 10 and met.get_srcComponent() == 1 and met.base_mode & 1, f"no ground rover with modes of its own: {met}")

# 1. what are you
check(ask(REQUEST_MESSAGE, 148) == ACCEPTED, "AUTOPILOT_VERSION was refused")
version = station.latest.get("AUTOPILOT_VERSION") or station.until("AUTOPILOT_VERSION")
check(version.flight_sw_version >> 8 > 0, "a version of nothing")
MAVLINK2, FENCE, RALLY, FTP = 8192, 16384, 32768, 32
check(version.capabilities & MAVLINK2, "no MAVLink 2")
check(not version.capabilities & (FENCE | RALLY | FTP), "fence, rally points or files are promised")

# 2. modes, 3. component information, its metadata's successor first: none, said so
for message in (435, 397, 395):
    check(ask(REQUEST_MESSAGE, message) == UNSUPPORTED, f"REQUEST_MESSAGE {message} is not unsupported")

# 4. all parameters, from every component; what is lost is asked for by index
station.send(dialect.MAVLink_param_request_list_message(ROVER, ALL))
first = station.until("PARAM_VALUE")
have = {first.param_index: first}
for _ in range(30):
    for message in station.listen(0.2):
        if message.get_type() == "PARAM_VALUE":
            have[message.param_index] = message
    missing = [i for i in range(first.param_count) if i not in have]
    if not missing:
        break
    for index in missing[:10]:
        station.send(dialect.MAVLink_param_request_read_message(ROVER, AUTOPILOT, b"", index))
check(len(have) == first.param_count, f"{len(have)} of {first.param_count} parameters")
names = [message.param_id for message in have.values()]
check(len(set(names)) == len(names), "two parameters of one name")
check({message.param_type for message in have.values()} == {9}, "not MAV_PARAM_TYPE_REAL32")
again = station.until("PARAM_VALUE", ask=dialect.MAVLink_param_request_read_message(ROVER, AUTOPILOT, b"wheel_radius_m", -1),
                      good=lambda message: message.param_id == "wheel_radius_m")
check(abs(again.param_value - 0.057) < 1e-6, f"wheel_radius_m is {again.param_value}")

# 5. mission, fence, rally points: none, each by its own type
for kind in (0, 1, 2):
    count = station.until("MISSION_COUNT", ask=dialect.MAVLink_mission_request_list_message(ROVER, AUTOPILOT, kind),
                          good=lambda message, kind=kind: message.mission_type == kind)
    check(count.count == 0 and count.target_system == 255, f"mission of type {kind}: {count}")
    station.send(dialect.MAVLink_mission_ack_message(ROVER, AUTOPILOT, 0, kind))

# what older versions and other firmware's pages ask: refused, and nothing stops for it
heartbeat()
station.send(dialect.MAVLink_request_data_stream_message(ROVER, ALL, 0, 4, 1))  # has no answer; the rates stay what they are
for command in (519, 410, 511, 521, 11):  # protocol version, home position, message interval, camera, anything
    check(ask(command, 1) in (DENIED, UNSUPPORTED), f"command {command} is not refused")
check(ask(520, 1) == ACCEPTED, "capabilities by the old command")
check(ask(REQUEST_MESSAGE, 259) == UNSUPPORTED and ask(REQUEST_MESSAGE, 280) == UNSUPPORTED, "a camera or a gimbal")

# the log page
entry = station.until("LOG_ENTRY", ask=dialect.MAVLink_log_request_list_message(ROVER, AUTOPILOT, 0, 0xFFFF))
check(entry.num_logs >= 1 and entry.size > 0, f"log {entry}")
data = station.until("LOG_DATA", ask=dialect.MAVLink_log_request_data_message(ROVER, AUTOPILOT, entry.id, 0, 90))
check(bytes(data.data[:7]) == b"ULog\x01\x12\x35", "the log does not begin as ULog does")
station.send(dialect.MAVLink_log_request_end_message(ROVER, AUTOPILOT))

# buttons: arm, take off, go there, upload and clear a mission, set the rover's own number, a stick at 5 Hz, a key, erase: none moves it
def link():
    return station.until("TRACTION_LINK", ask=dialect.MAVLink_command_long_message(ROVER, AUTOPILOT, REQUEST_MESSAGE, 0, 53141, 0, 0, 0, 0, 0, 0))


station.listen(1.2)  # what was asked before is counted
before = link()
check(ask(400, 1) == DENIED, "it was armed")
check(ask(22) in (DENIED, UNSUPPORTED), "it took off")
went = dialect.MAVLink_command_int_message(ROVER, AUTOPILOT, 6, REPOSITION, 0, 0, -1, 1, 0, 0, 0, 0, 0)
ack = station.until("COMMAND_ACK", ask=went, good=lambda message: message.command == REPOSITION)
check(ack.result == DENIED, f"COMMAND_INT: {ack}")
for question in (dialect.MAVLink_mission_count_message(ROVER, AUTOPILOT, 3, 0), dialect.MAVLink_mission_clear_all_message(ROVER, AUTOPILOT, 0)):
    answer = station.until("MISSION_ACK", ask=question)
    check(answer.type == 14, f"a mission is taken: {answer}")  # MAV_MISSION_DENIED
kept = station.until("PARAM_VALUE", ask=dialect.MAVLink_param_set_message(ROVER, AUTOPILOT, b"wheel_radius_m", 1.0, 9),
                     good=lambda message: message.param_id == "wheel_radius_m")
check(abs(kept.param_value - 0.057) < 1e-6, "the wheel's radius was set over the link")
until = time.monotonic() + 1
while time.monotonic() < until:
    station.send(dialect.MAVLink_manual_control_message(ROVER, 1000, 0, 500, 0, 0))
    station.listen(0.2)
station.send(dialect.MAVLink_set_mode_message(ROVER, 1, 3))
station.send(dialect.MAVLink_log_erase_message(ROVER, AUTOPILOT))
station.send(dialect.MAVLink_setup_signing_message(ROVER, AUTOPILOT, list(range(32)), 1))
station.listen(1.2)
now = link()
field = "refused_other" if key else "refused_unsigned"
check(getattr(now, field) - getattr(before, field) >= 11, f"{field} rose by {getattr(now, field) - getattr(before, field)}")
check(now.accepted == before.accepted, "something was obeyed")
status = station.until("TRACTION_STATUS")
check(status.mode == 0 and status.drive != 3 and abs(status.speed_m_s) < 0.05, f"the rover does not stand: {status}")
check(station.until("LOG_ENTRY", ask=dialect.MAVLink_log_request_list_message(ROVER, AUTOPILOT, 0, 0xFFFF)).num_logs == entry.num_logs, "a log was erased")
if key:  # and the signed stop of its emergency button
    check(ask(400, 0) == ACCEPTED, "the stop was not taken")
check(station.refused == 0, "packets of the rover that could not be read" + (" by its key" if key else ""))
print(f"QGroundControl's questions, {'signed' if key else 'unsigned'}: {first.param_count} parameters, each answered or refused")
