#include "supervisor_parts.h"

#include <math.h>
#include <string.h>

void supervisor_begin(supervisor_t *link, const supervisor_config_t *config, const supervisor_world_t *world)
{
    memset(link, 0, sizeof *link);
    link->config = *config;
    link->world = *world;
    channel_begin(&link->channel, config->system, SUPERVISOR_COMPONENT, config->key);
    link->setting[SETTING_STATUS_HZ] = 20.0f;
    link->setting[SETTING_BULK_KB_S] = 100.0f;
    link->setting[SETTING_SPEED_MAX] = config->speed_max_m_s;
    link->setting[SETTING_YAW_MAX] = config->yaw_max_rad_s;
}

uint32_t supervisor_age_ticks(const command_t *order, uint64_t received_ns, uint64_t now_ns)
{
    const uint64_t tick_ns = (uint64_t)TICK_US * 1000u;
    if (order->mode == MODE_STOP || now_ns <= received_ns) {
        return 0;
    }
    const uint64_t old_ns = now_ns - received_ns, ticks = old_ns / tick_ns + (old_ns % tick_ns != 0u ? 1u : 0u);
    return ticks < UINT32_MAX ? (uint32_t)ticks : UINT32_MAX;
}

// --- commands

static uint16_t sender_of(const mavlink_message_t *packet) { return (uint16_t)(packet->sysid * 256u + packet->compid); }

static void obey(supervisor_t *link, const command_t *command, uint16_t sender, int peer)
{
    link->order.command = *command;
    link->order.number++;
    link->counts.accepted++;
    link->heard_ms = link->now_ms;
    link->operator_id = command->mode == MODE_STOP ? 0u : sender;
    link->operator_peer = peer;
}

static void obey_stop(supervisor_t *link)
{
    const command_t stop = {.mode = MODE_STOP};
    obey(link, &stop, 0, SUPERVISOR_NOBODY);
}

// Another drives, and is still there.
static bool taken(const supervisor_t *link, uint16_t sender, int peer)
{
    const bool same = link->operator_id == sender && link->operator_peer == peer;
    return link->operator_id != 0u && !same && link->now_ms - link->heard_ms < SUPERVISOR_OPERATOR_MS;
}

static bool within(float value, float limit) { return value >= -limit && value <= limit; } // no NaN is

static bool allowed(const supervisor_t *link, const mavlink_traction_command_t *asked)
{
    const bool mode = asked->mode == MODE_PLATFORM_SPEED || asked->mode == MODE_SLIP || asked->mode == MODE_SOIL_SWEEP;
    return mode && within(asked->platform_speed_m_s, link->setting[SETTING_SPEED_MAX]) &&
           within(asked->yaw_rate_rad_s, link->setting[SETTING_YAW_MAX]) && within(asked->slip_ref, 1.0f) &&
           asked->slip_wheels < 1u << WHEEL_COUNT;
}

static void take_command(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    mavlink_traction_command_t asked;
    mavlink_msg_traction_command_decode(packet, &asked);
    if (asked.target_system != link->config.system) {
        return; // a command for everybody is for nobody
    }
    if (asked.mode == MODE_STOP) {
        obey_stop(link);
    } else if (asked.session != link->config.session || link->now_ms - asked.rover_time_ms > SUPERVISOR_STALE_MS) {
        link->counts.refused_stale++; // a time in the future too: it wraps
    } else if (taken(link, sender_of(packet), peer) || !allowed(link, &asked)) {
        link->counts.refused_other++;
    } else {
        const command_t command = {.mode = (control_mode_t)asked.mode,
                                   .platform_speed_m_s = asked.platform_speed_m_s,
                                   .yaw_rate_rad_s = asked.yaw_rate_rad_s,
                                   .slip_ref = asked.slip_ref,
                                   .slip_wheels = asked.slip_wheels};
        obey(link, &command, sender_of(packet), peer);
    }
}

// What was signed before this program began is no command: a board that starts anew has forgotten whom it heard.
static bool from_before(const supervisor_t *link, const mavlink_message_t *packet)
{
    return channel_packet_time(packet) < link->config.started_10us;
}

// The number of the parameter that has this name on the wire; as many as there are: none has.
static uint32_t parameter_named(const supervisor_t *link, const char *name)
{
    char id[SUPERVISOR_ID + 1];
    float value = 0;
    uint32_t i = 0;
    while (supervisor_parameter(link, i, id, &value) && strncmp(id, name, SUPERVISOR_ID) != 0) {
        i++;
    }
    return i;
}

static void take_parameter_set(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    mavlink_param_set_t set;
    mavlink_msg_param_set_decode(packet, &set);
    const uint32_t index = parameter_named(link, set.param_id);
    const bool done = supervisor_set(link, index, set.param_value);
    link->counts.accepted += done ? 1u : 0u;
    link->counts.refused_other += done ? 0u : 1u;
    (void)supervisor_tell_parameter(link, peer, index); // as it is now: a refusal shows itself
}

static void acknowledge(supervisor_t *link, int peer, const mavlink_message_t *packet, uint16_t command, uint8_t result)
{
    mavlink_message_t answer;
    const mavlink_command_ack_t ack = {
        .command = command, .result = result, .target_system = packet->sysid, .target_component = packet->compid};
    (void)mavlink_msg_command_ack_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &answer, &ack);
    (void)supervisor_send(link, peer, &answer);
}

// The message that a ground station asks for by its number; false: it is none that can be asked for.
static bool tell_message(supervisor_t *link, int peer, float number)
{
    if (number == (float)MAVLINK_MSG_ID_AUTOPILOT_VERSION) {
        supervisor_tell_version(link, peer);
    } else if (number == (float)MAVLINK_MSG_ID_HEARTBEAT) {
        supervisor_tell_heartbeat(link, peer);
    } else if (number == (float)MAVLINK_MSG_ID_TRACTION_LINK) {
        supervisor_tell_link(link, peer);
    } else {
        return false;
    }
    return true;
}

static void take_command_long(supervisor_t *link, int peer, const mavlink_message_t *packet, bool key)
{
    mavlink_command_long_t asked;
    mavlink_msg_command_long_decode(packet, &asked);
    uint8_t result = MAV_RESULT_UNSUPPORTED;
    if (asked.command == MAV_CMD_REQUEST_MESSAGE) {
        result = tell_message(link, peer, asked.param1) ? MAV_RESULT_ACCEPTED : MAV_RESULT_UNSUPPORTED;
    } else if (asked.command == MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES) {
        supervisor_tell_version(link, peer);
        result = MAV_RESULT_ACCEPTED;
    } else if (!key) {
        link->counts.refused_unsigned++;
        result = MAV_RESULT_DENIED;
    } else if (from_before(link, packet)) {
        link->counts.refused_replay++;
        result = MAV_RESULT_DENIED;
    } else if (asked.command == MAV_CMD_COMPONENT_ARM_DISARM && asked.param1 == 0.0f) {
        obey_stop(link);
        result = MAV_RESULT_ACCEPTED;
    } else { // it is armed by TRACTION_COMMAND alone, which must be repeated
        link->counts.refused_other++;
        result = asked.command == MAV_CMD_COMPONENT_ARM_DISARM ? MAV_RESULT_DENIED : MAV_RESULT_UNSUPPORTED;
    }
    acknowledge(link, peer, packet, asked.command, result);
}

// --- questions

static void take_parameter_read(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    mavlink_param_request_read_t asked;
    mavlink_msg_param_request_read_decode(packet, &asked);
    const uint32_t index = asked.param_index >= 0 ? (uint32_t)asked.param_index : parameter_named(link, asked.param_id);
    (void)supervisor_tell_parameter(link, peer, index);
}

static void take_mission_request(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    mavlink_message_t answer;
    const mavlink_mission_count_t none = {.target_system = packet->sysid,
                                          .target_component = packet->compid,
                                          .mission_type = mavlink_msg_mission_request_list_get_mission_type(packet)};
    (void)mavlink_msg_mission_count_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &answer, &none);
    (void)supervisor_send(link, peer, &answer);
}

static void take_log_list(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    mavlink_log_request_list_t asked;
    mavlink_msg_log_request_list_decode(packet, &asked);
    supervisor_transfer_t *transfer = &link->transfer;
    transfer->count = link->world.list != NULL ? link->world.list(link->world.context, transfer->log, SUPERVISOR_LOGS) : 0u;
    transfer->peer = peer;
    transfer->listing = true;
    transfer->next = 0;
    while (transfer->next < transfer->count && (uint16_t)transfer->log[transfer->next].number < asked.start) {
        transfer->next++;
    }
    const size_t all = transfer->count;
    while (transfer->count > transfer->next && asked.end != UINT16_MAX &&
           (uint16_t)transfer->log[transfer->count - 1u].number > asked.end) {
        transfer->count--;
    }
    transfer->listing = transfer->next < transfer->count || all == 0u; // that there is none is told too
}

static void take_log_request(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    mavlink_log_request_data_t asked;
    mavlink_msg_log_request_data_decode(packet, &asked);
    supervisor_transfer_t *transfer = &link->transfer;
    supervisor_log_t logs[SUPERVISOR_LOGS];
    const size_t count = link->world.list != NULL ? link->world.list(link->world.context, logs, SUPERVISOR_LOGS) : 0u;
    for (size_t i = 0; i < count; i++) {
        if ((uint16_t)logs[i].number == asked.id) {
            transfer->reading = true;
            transfer->reader = peer;
            transfer->number = logs[i].number;
            transfer->id = asked.id;
            transfer->offset = asked.ofs;
            transfer->end = asked.count < UINT32_MAX - asked.ofs ? asked.ofs + asked.count : UINT32_MAX;
        }
    }
}

// What anybody may ask. false: it is none of these.
static bool take_question(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    switch (packet->msgid) {
    case MAVLINK_MSG_ID_PARAM_REQUEST_LIST:
        link->parameter_peer = peer;
        link->parameter_next = 0;
        link->parameter_end = supervisor_parameter_count(link);
        return true;
    case MAVLINK_MSG_ID_PARAM_REQUEST_READ:
        take_parameter_read(link, peer, packet);
        return true;
    case MAVLINK_MSG_ID_MISSION_REQUEST_LIST:
        take_mission_request(link, peer, packet);
        return true;
    case MAVLINK_MSG_ID_LOG_REQUEST_LIST:
        take_log_list(link, peer, packet);
        return true;
    case MAVLINK_MSG_ID_LOG_REQUEST_DATA:
        take_log_request(link, peer, packet);
        return true;
    case MAVLINK_MSG_ID_LOG_REQUEST_END:
        link->transfer.reading = link->transfer.listing = false;
        return true;
    default:
        return false;
    }
}

// What asks for something to be done; all else (heartbeats, telemetry of others) is heard and left alone.
static bool acts(uint32_t id)
{
    static const uint32_t doing[] = {MAVLINK_MSG_ID_TRACTION_COMMAND,
                                     MAVLINK_MSG_ID_PARAM_SET,
                                     MAVLINK_MSG_ID_SET_MODE,
                                     MAVLINK_MSG_ID_MANUAL_CONTROL,
                                     MAVLINK_MSG_ID_RC_CHANNELS_OVERRIDE,
                                     MAVLINK_MSG_ID_COMMAND_INT,
                                     MAVLINK_MSG_ID_LOG_ERASE,
                                     MAVLINK_MSG_ID_SETUP_SIGNING,
                                     MAVLINK_MSG_ID_MISSION_COUNT,
                                     MAVLINK_MSG_ID_MISSION_CLEAR_ALL,
                                     MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED,
                                     MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT,
                                     MAVLINK_MSG_ID_SET_ATTITUDE_TARGET,
                                     MAVLINK_MSG_ID_FILE_TRANSFER_PROTOCOL};
    for (size_t i = 0; i < sizeof doing / sizeof *doing; i++) {
        if (doing[i] == id) {
            return true;
        }
    }
    return false;
}

// A no in the words of the question's own protocol: a ground station that hears nothing asks again and again.
static void tell_refused(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    if (packet->msgid == MAVLINK_MSG_ID_COMMAND_INT) {
        acknowledge(link, peer, packet, mavlink_msg_command_int_get_command(packet), MAV_RESULT_DENIED);
    } else if (packet->msgid == MAVLINK_MSG_ID_PARAM_SET) {
        mavlink_param_set_t set;
        mavlink_msg_param_set_decode(packet, &set);
        (void)supervisor_tell_parameter(link, peer, parameter_named(link, set.param_id)); // as it was
    } else if (packet->msgid == MAVLINK_MSG_ID_MISSION_COUNT || packet->msgid == MAVLINK_MSG_ID_MISSION_CLEAR_ALL) {
        mavlink_message_t answer;
        const mavlink_mission_ack_t no = {.target_system = packet->sysid,
                                          .target_component = packet->compid,
                                          .type = MAV_MISSION_DENIED,
                                          .mission_type = packet->msgid == MAVLINK_MSG_ID_MISSION_COUNT
                                                              ? mavlink_msg_mission_count_get_mission_type(packet)
                                                              : mavlink_msg_mission_clear_all_get_mission_type(packet)};
        (void)mavlink_msg_mission_ack_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &answer, &no);
        (void)supervisor_send(link, peer, &answer);
    }
}

static void take_packet(supervisor_t *link, int peer, const mavlink_message_t *packet, bool key)
{
    if ((packet->sysid == link->config.system && packet->compid == SUPERVISOR_COMPONENT) || !channel_for_us(&link->channel, packet)) {
        return; // an echo of ours, or somebody else's
    }
    if (packet->msgid == MAVLINK_MSG_ID_COMMAND_LONG) {
        take_command_long(link, peer, packet, key);
        return;
    }
    if (take_question(link, peer, packet) || !acts(packet->msgid)) {
        return;
    }
    if (!key) {
        link->counts.refused_unsigned++;
        tell_refused(link, peer, packet);
    } else if (packet->msgid == MAVLINK_MSG_ID_TRACTION_COMMAND) {
        take_command(link, peer, packet);
    } else if (from_before(link, packet)) {
        link->counts.refused_replay++;
    } else if (packet->msgid == MAVLINK_MSG_ID_PARAM_SET) {
        take_parameter_set(link, peer, packet);
    } else {
        link->counts.refused_other++; // a key is never set, a log never erased from afar; nothing else drives
        tell_refused(link, peer, packet);
    }
}

supervisor_heard_t supervisor_receive(supervisor_t *link, int peer, const uint8_t *bytes, size_t length, uint32_t now_ms,
                                      uint64_t time_10us)
{
    supervisor_heard_t heard = SUPERVISOR_HEARD_NOTHING;
    mavlink_message_t packet;
    link->now_ms = now_ms;
    channel_clock(&link->channel, time_10us);
    channel_next_datagram(&link->channel);
    for (size_t i = 0; i < length; i++) {
        switch (channel_take(&link->channel, bytes[i], &packet)) {
        case CHANNEL_SIGNED:
            heard = SUPERVISOR_HEARD_KEY;
            take_packet(link, peer, &packet, true);
            break;
        case CHANNEL_UNSIGNED:
            heard = heard == SUPERVISOR_HEARD_KEY ? heard : SUPERVISOR_HEARD_SOMEBODY;
            take_packet(link, peer, &packet, false);
            break;
        case CHANNEL_BAD_SIGNATURE: // may listen, as anybody may: it will see that the rover signs with another key
            heard = heard == SUPERVISOR_HEARD_KEY ? heard : SUPERVISOR_HEARD_SOMEBODY;
            link->counts.refused_signature++;
            break;
        case CHANNEL_REPLAYED:
            heard = heard == SUPERVISOR_HEARD_KEY ? heard : SUPERVISOR_HEARD_SOMEBODY;
            link->counts.refused_replay++;
            break;
        case CHANNEL_BROKEN:
            link->counts.broken++;
            break;
        case CHANNEL_NOTHING:
            break;
        }
    }
    return heard;
}
