#include "supervisor_parts.h"

#include "firmware/core/fault_name.h"
#include "firmware/core/safety.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TOLD_HEARTBEAT = 0, TOLD_STATUS, TOLD_COMMON, TOLD_LINK };
enum { FLAG_STANDSTILL = 1, FLAG_IN_COMMAND = 2, FLAG_TOO_OLD = 4 };

size_t supervisor_send(supervisor_t *link, int peer, const mavlink_message_t *packet)
{
    uint8_t bytes[CHANNEL_PACKET];
    const size_t length = channel_bytes(packet, bytes);
    link->world.send(link->world.context, peer, bytes, length);
    return length;
}

// --- parameters

typedef struct {
    const char *id;
    float low, high;
} setting_t;

// The speeds' own upper limits are the firmware's (supervisor_config_t).
static const setting_t settings[SUPERVISOR_PARAMETERS] = {
    {"LINK_STATUS_HZ", 1.0f, 50.0f}, {"LINK_BULK_KB_S", 1.0f, 1000.0f}, {"LINK_SPEED_MAX", 0.0f, 0.0f}, {"LINK_YAW_MAX", 0.0f, 0.0f}};

bool supervisor_set(supervisor_t *link, uint32_t index, float value)
{
    if (index >= SUPERVISOR_PARAMETERS) {
        return false; // the rover's own are the file's (tractiond --parameters): they hold for a run
    }
    const float high = index == SETTING_SPEED_MAX ? link->config.speed_max_m_s
                       : index == SETTING_YAW_MAX ? link->config.yaw_max_rad_s
                                                  : settings[index].high;
    if (!(value >= settings[index].low && value <= high)) {
        return false;
    }
    link->setting[index] = value;
    return true;
}

uint32_t supervisor_parameter_count(const supervisor_t *link)
{
    return SUPERVISOR_PARAMETERS + (link->config.rover != NULL ? (uint32_t)ROVER_PARAMETER_COUNT : 0u);
}

// "encoder_counts_per_turn" with words of 3: "enc_cou_per_tur". Returns its length, which may be more than was written.
static size_t shortened(const char *name, size_t word, char id[SUPERVISOR_ID + 1])
{
    size_t length = 0, in_word = 0;
    for (; *name != '\0'; name++) {
        in_word = *name == '_' ? 0u : in_word + 1u;
        if (in_word <= word) {
            if (length < SUPERVISOR_ID) {
                id[length] = *name;
            }
            length++;
        }
    }
    id[length < SUPERVISOR_ID ? length : SUPERVISOR_ID] = '\0';
    return length;
}

bool supervisor_parameter(const supervisor_t *link, uint32_t index, char id[SUPERVISOR_ID + 1], float *value)
{
    if (index < SUPERVISOR_PARAMETERS) {
        (void)shortened(settings[index].id, SUPERVISOR_ID, id);
        *value = link->setting[index];
        return true;
    }
    const uint32_t own = index - SUPERVISOR_PARAMETERS;
    if (link->config.rover == NULL || own >= ROVER_PARAMETER_COUNT) {
        return false;
    }
    size_t word = SUPERVISOR_ID;
    while (shortened(rover_parameter_name((int32_t)own), word, id) > SUPERVISOR_ID) {
        word--;
    }
    *value = link->config.rover->value[own];
    return true;
}

size_t supervisor_tell_parameter(supervisor_t *link, int peer, uint32_t index)
{
    mavlink_message_t packet;
    char id[SUPERVISOR_ID + 1] = "";
    mavlink_param_value_t value = {
        .param_type = MAV_PARAM_TYPE_REAL32, .param_count = (uint16_t)supervisor_parameter_count(link), .param_index = (uint16_t)index};
    if (!supervisor_parameter(link, index, id, &value.param_value)) {
        return 0;
    }
    memcpy(value.param_id, id, strlen(id)); // no 0 where all characters are used
    (void)mavlink_msg_param_value_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &value);
    return supervisor_send(link, peer, &packet);
}

// --- telemetry

static bool moving_asked(const supervisor_t *link) { return link->order.number > 0u && link->order.command.mode != MODE_STOP; }

static bool too_old(const supervisor_t *link) { return moving_asked(link) && link->now_ms - link->heard_ms > link->config.patience_ms; }

void supervisor_tell_heartbeat(supervisor_t *link, int peer)
{
    mavlink_message_t packet;
    const uint32_t faults = link->trace.faults;
    const bool on = link->seen && link->trace.actuator.drive == DRIVE_ON;
    uint8_t state = !link->seen ? MAV_STATE_BOOT : on ? MAV_STATE_ACTIVE : MAV_STATE_STANDBY;
    state = (faults & ~(uint32_t)SAFETY_LIMITING) != 0u ? MAV_STATE_EMERGENCY : faults != 0u ? MAV_STATE_CRITICAL : state;
    const mavlink_heartbeat_t heartbeat = {.type = MAV_TYPE_GROUND_ROVER,
                                           .autopilot = MAV_AUTOPILOT_GENERIC,
                                           .base_mode =
                                               (uint8_t)(MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | (on ? MAV_MODE_FLAG_SAFETY_ARMED : 0)),
                                           .custom_mode = (uint32_t)link->trace.mode,
                                           .system_status = state,
                                           .mavlink_version = 3};
    (void)mavlink_msg_heartbeat_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &heartbeat);
    (void)supervisor_send(link, peer, &packet);
}

void supervisor_tell_version(supervisor_t *link, int peer)
{
    mavlink_message_t packet;
    const uint32_t *version = link->config.version;
    const mavlink_autopilot_version_t told = {
        .capabilities = MAV_PROTOCOL_CAPABILITY_MAVLINK2 | MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST,
        .flight_sw_version = version[0] << 24u | version[1] << 16u | version[2] << 8u | (uint32_t)FIRMWARE_VERSION_TYPE_OFFICIAL};
    (void)mavlink_msg_autopilot_version_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &told);
    (void)supervisor_send(link, peer, &packet);
}

void supervisor_tell_link(supervisor_t *link, int peer)
{
    mavlink_message_t packet;
    const supervisor_counts_t *counts = &link->counts;
    const mavlink_traction_link_t told = {.session = link->config.session,
                                          .accepted = counts->accepted,
                                          .refused_unsigned = counts->refused_unsigned,
                                          .refused_signature = counts->refused_signature,
                                          .refused_replay = counts->refused_replay,
                                          .refused_stale = counts->refused_stale,
                                          .refused_other = counts->refused_other,
                                          .broken = counts->broken,
                                          .losses = counts->losses,
                                          .operator_system = (uint8_t)(link->operator_id / 256u),
                                          .keyed = link->channel.keyed ? 1u : 0u};
    (void)mavlink_msg_traction_link_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &told);
    (void)supervisor_send(link, peer, &packet);
}

void supervisor_tell_text(supervisor_t *link, int severity, const char *text)
{
    mavlink_message_t packet;
    mavlink_statustext_t told = {.severity = (uint8_t)severity};
    const size_t length = strlen(text);
    memcpy(told.text, text, length < sizeof told.text ? length : sizeof told.text);
    (void)mavlink_msg_statustext_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &told);
    (void)supervisor_send(link, SUPERVISOR_EVERYBODY, &packet);
}

// scale*value as an integer within +-limit; NaN is 0.
static int32_t scaled(float value, float scale, int32_t limit)
{
    const float product = value * scale;
    if (!(product > (float)-limit)) {
        return product < 0.0f ? -limit : 0;
    }
    return product < (float)limit ? (int32_t)(product + (product < 0.0f ? -0.5f : 0.5f)) : limit;
}

static void tell_status(supervisor_t *link)
{
    mavlink_message_t packet;
    const trace_t *trace = &link->trace;
    mavlink_traction_status_t told = {
        .time_boot_ms = link->now_ms,
        .session = link->config.session,
        .tick = trace->tick,
        .faults = trace->faults,
        .speed_m_s = trace->speed_m_s,
        .speed_std_m_s = trace->speed_std_m_s,
        .set_speed_m_s = link->asked.mode == MODE_STOP ? 0.0f : link->asked.platform_speed_m_s,
        .battery_mV = (uint16_t)scaled(trace->battery_voltage_V < 0.0f ? 0.0f : trace->battery_voltage_V, 1000.0f, UINT16_MAX),
        .mode = (uint8_t)trace->mode,
        .drive = (uint8_t)trace->actuator.drive,
        .fault_wheels = (uint8_t)trace->fault_wheels,
        .flags = (uint8_t)((trace->standstill ? FLAG_STANDSTILL : 0) | (moving_asked(link) ? FLAG_IN_COMMAND : 0) |
                           (too_old(link) ? FLAG_TOO_OLD : 0))};
    for (int i = 0; i < WHEEL_COUNT; i++) {
        const wheel_trace_t *wheel = &trace->wheel[i];
        told.slip_e4[i] = (int16_t)(wheel->slip_valid ? scaled(wheel->slip, 1e4f, INT16_MAX - 1) : INT16_MAX);
        told.current_cA[i] = (int16_t)scaled(wheel->current_A, 100.0f, INT16_MAX);
    }
    (void)mavlink_msg_traction_status_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &told);
    (void)supervisor_send(link, SUPERVISOR_EVERYBODY, &packet);
}

// What every ground station shows: battery and errors, ground speed and duty.
static void tell_common(supervisor_t *link)
{
    mavlink_message_t packet;
    const supervisor_counts_t *counts = &link->counts;
    float duty = 0.0f, current_A = 0.0f;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        const float size = fabsf(link->trace.wheel[i].duty);
        duty = size > duty ? size : duty;
        current_A += link->trace.wheel[i].current_A;
    }
    const uint32_t others = counts->refused_stale + counts->refused_other;
    const mavlink_sys_status_t status = {
        .voltage_battery = (uint16_t)scaled(link->trace.battery_voltage_V, 1000.0f, UINT16_MAX - 1),
        .current_battery = (int16_t)scaled(current_A, 100.0f, INT16_MAX),
        .battery_remaining = -1,
        .errors_comm = (uint16_t)(counts->broken < UINT16_MAX ? counts->broken : UINT16_MAX),
        .errors_count1 = (uint16_t)(counts->refused_unsigned < UINT16_MAX ? counts->refused_unsigned : UINT16_MAX),
        .errors_count2 = (uint16_t)(counts->refused_signature < UINT16_MAX ? counts->refused_signature : UINT16_MAX),
        .errors_count3 = (uint16_t)(counts->refused_replay < UINT16_MAX ? counts->refused_replay : UINT16_MAX),
        .errors_count4 = (uint16_t)(others < UINT16_MAX ? others : UINT16_MAX)};
    (void)mavlink_msg_sys_status_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &status);
    (void)supervisor_send(link, SUPERVISOR_EVERYBODY, &packet);
    const mavlink_vfr_hud_t hud = {.groundspeed = fabsf(link->trace.speed_m_s), .throttle = (uint16_t)scaled(duty, 100.0f, 100)};
    (void)mavlink_msg_vfr_hud_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &hud);
    (void)supervisor_send(link, SUPERVISOR_EVERYBODY, &packet);
}

// A fault that is new, in words, as soon as it is there.
static void tell_faults(supervisor_t *link)
{
    const uint32_t fresh = link->trace.faults & ~link->told_faults;
    link->told_faults = link->trace.faults;
    for (int32_t bit = 0; bit < FAULT_COUNT; bit++) {
        if ((fresh & (1u << (uint32_t)bit)) != 0u) {
            char text[64];
            (void)snprintf(text, sizeof text, "fault: %s", fault_name(bit));
            supervisor_tell_text(link, MAV_SEVERITY_ERROR, text);
        }
    }
}

// --- lists and logs: as much as the budget allows

static size_t tell_log_entry(supervisor_t *link)
{
    mavlink_message_t packet;
    supervisor_transfer_t *transfer = &link->transfer;
    const supervisor_log_t *log = &transfer->log[transfer->next];
    const uint32_t last = transfer->count > 0u ? transfer->log[transfer->count - 1u].number : 0u;
    mavlink_log_entry_t entry = {.num_logs = (uint16_t)transfer->count, .last_log_num = (uint16_t)last};
    if (transfer->next < transfer->count) {
        entry.id = (uint16_t)log->number;
        entry.size = log->bytes;
        entry.time_utc = log->time_s;
    }
    transfer->next++;
    transfer->listing = transfer->next < transfer->count;
    (void)mavlink_msg_log_entry_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &entry);
    return supervisor_send(link, transfer->peer, &packet);
}

static size_t tell_log_data(supervisor_t *link)
{
    mavlink_message_t packet;
    supervisor_transfer_t *transfer = &link->transfer;
    mavlink_log_data_t data = {.id = transfer->id, .ofs = transfer->offset};
    const uint32_t left = transfer->end - transfer->offset;
    const size_t wanted = left < sizeof data.data ? left : sizeof data.data;
    const size_t got = wanted > 0u ? link->world.read(link->world.context, transfer->number, transfer->offset, data.data, wanted) : 0u;
    data.count = (uint8_t)got;
    transfer->offset += (uint32_t)got;
    transfer->reading = got == wanted && transfer->offset < transfer->end; // a short packet is the end
    (void)mavlink_msg_log_data_encode_status(link->config.system, SUPERVISOR_COMPONENT, &link->channel.status, &packet, &data);
    return supervisor_send(link, transfer->reader, &packet);
}

static void tell_bulk(supervisor_t *link)
{
    const float step = link->setting[SETTING_BULK_KB_S] * SUPERVISOR_STEP_MS; // kB/s times ms: bytes
    link->credit = link->credit + step < 2.0f * step + CHANNEL_PACKET ? link->credit + step : 2.0f * step + CHANNEL_PACKET;
    while (link->credit >= CHANNEL_PACKET) {
        size_t bytes = 0;
        if (link->parameter_next < link->parameter_end) {
            bytes = supervisor_tell_parameter(link, link->parameter_peer, link->parameter_next++);
        } else if (link->transfer.listing) {
            bytes = tell_log_entry(link);
        } else if (link->transfer.reading) {
            bytes = tell_log_data(link);
        } else {
            return;
        }
        link->credit -= (float)bytes;
    }
}

void supervisor_tick(supervisor_t *link, const trace_t *trace, const command_t *asked)
{
    link->trace = *trace;
    link->asked = *asked;
    link->seen = true;
}

void supervisor_moved(supervisor_t *link, int from, int to)
{
    supervisor_transfer_t *transfer = &link->transfer;
    const bool gone = to == SUPERVISOR_NOBODY;
    link->parameter_end = gone && link->parameter_peer == from ? 0u : link->parameter_end;
    transfer->listing = transfer->listing && !(gone && transfer->peer == from);
    transfer->reading = transfer->reading && !(gone && transfer->reader == from);
    link->parameter_peer = link->parameter_peer == from ? to : link->parameter_peer;
    link->operator_peer = link->operator_peer == from ? to : link->operator_peer;
    transfer->peer = transfer->peer == from ? to : transfer->peer;
    transfer->reader = transfer->reader == from ? to : transfer->reader;
}

static bool due(supervisor_t *link, int which, float rate_Hz)
{
    const uint32_t period_ms = (uint32_t)(1000.0f / rate_Hz);
    const uint32_t late_ms = link->now_ms - link->told_ms[which];
    if (late_ms < period_ms) {
        return false;
    }
    link->told_ms[which] = late_ms < 2u * period_ms ? link->told_ms[which] + period_ms : link->now_ms; // keeps the mean rate
    return true;
}

void supervisor_step(supervisor_t *link, uint32_t now_ms, uint64_t time_10us)
{
    const bool was_too_old = too_old(link);
    link->now_ms = now_ms;
    channel_clock(&link->channel, time_10us);
    link->counts.losses += !was_too_old && too_old(link) ? 1u : 0u;
    if (link->operator_id != 0u && now_ms - link->heard_ms >= SUPERVISOR_OPERATOR_MS) {
        link->operator_id = 0;
    }
    if (link->seen) {
        tell_faults(link);
    }
    if (due(link, TOLD_STATUS, link->setting[SETTING_STATUS_HZ]) && link->seen) {
        tell_status(link);
    }
    if (due(link, TOLD_HEARTBEAT, 1.0f)) {
        supervisor_tell_heartbeat(link, SUPERVISOR_EVERYBODY);
    }
    if (due(link, TOLD_LINK, 1.0f)) {
        supervisor_tell_link(link, SUPERVISOR_EVERYBODY);
    }
    if (due(link, TOLD_COMMON, 2.0f) && link->seen) {
        tell_common(link);
    }
    tell_bulk(link);
}
