#include "ulog.h"

#include <string.h>

enum { RADAR_SAMPLES = 8, TICK_MS = TICK_US / 1000 };

typedef struct {
    uint8_t *at;
} writer_t;

static void put8(writer_t *w, uint32_t value) { *w->at++ = (uint8_t)value; }
static void put16(writer_t *w, uint32_t value)
{
    put8(w, value);
    put8(w, value >> 8u);
}
static void put32(writer_t *w, uint32_t value)
{
    put16(w, value);
    put16(w, value >> 16u);
}
static void put64(writer_t *w, uint64_t value)
{
    put32(w, (uint32_t)value);
    put32(w, (uint32_t)(value >> 32u));
}
static void put_float(writer_t *w, float value)
{
    uint32_t bits = 0;
    memcpy(&bits, &value, sizeof bits);
    put32(w, bits);
}
static void put_text(writer_t *w, const char *text)
{
    const size_t length = strlen(text);
    memcpy(w->at, text, length);
    w->at += length;
}

// Begins a message; its size is filled in by end.
static uint8_t *begin(writer_t *w, char kind)
{
    uint8_t *start = w->at;
    put16(w, 0);
    put8(w, (uint8_t)kind);
    return start;
}

static void end(const writer_t *w, uint8_t *start)
{
    writer_t size = {.at = start};
    put16(&size, (uint32_t)(w->at - start - 3));
}

static uint64_t stamp_us(uint32_t tick) { return ((uint64_t)tick + 1u) * TICK_US; }

enum { TOPIC_FRAME, TOPIC_RADAR, TOPIC_COMMAND, TOPIC_TRACE, TOPIC_LINK, TOPICS };

// In the order of the bytes below.
static const char *const topic_format[TOPICS] = {
    "frame:uint64_t timestamp;uint32_t tick;uint32_t elapsed_ticks;uint32_t time_us;uint32_t present;int32_t[4] encoder;uint16_t[4] "
    "current;"
    "uint16_t battery;int16_t[3] accel;int16_t[3] gyro;uint32_t radar_sequence;uint8_t radar_samples;uint8_t[4] bridge;bool "
    "emergency_stop;",
    "radar:uint64_t timestamp;uint32_t sequence;uint8_t samples;uint16_t[8] count;",
    "command:uint64_t timestamp;float platform_speed_m_s;float yaw_rate_rad_s;float[4] wheel_speed_rad_s;float[4] duty;float "
    "slip_ref;uint32_t age_ticks;uint8_t mode;uint8_t slip_wheels;",
    "trace:uint64_t timestamp;uint32_t faults;uint32_t fault_wheels;float[4] speed_rad_s;float[4] accel_rad_s2;float[4] set_speed_rad_s;"
    "float[4] current_A;float[4] torque_Nm;float[4] traction_N;float[4] slip;float[4] slip_std;float[4] duty;float battery_voltage_V;"
    "float accel_x_m_s2;float gyro_z_rad_s;float radar_speed_m_s;float speed_m_s;float speed_std_m_s;float accel_bias_m_s2;uint32_t "
    "order_sequence;"
    "int16_t[4] duty_q15;uint8_t mode;uint8_t drive;uint8_t slip_valid;uint8_t saturated;uint8_t encoder_refused;bool radar_fresh;"
    "bool standstill;bool status_led;",
    "link:uint64_t timestamp;uint32_t accepted;uint32_t refused_unsigned;uint32_t refused_signature;uint32_t refused_replay;uint32_t "
    "refused_stale;uint32_t refused_other;uint32_t broken;uint32_t losses;",
};

static void put_info(writer_t *w, const char *key, const char *value)
{
    uint8_t *start = begin(w, 'I');
    put8(w, (uint32_t)strlen(key));
    put_text(w, key);
    put_text(w, value);
    end(w, start);
}

size_t ulog_head(uint32_t first_tick, const char *version, uint8_t out[ULOG_HEAD])
{
    static const uint8_t magic[8] = {'U', 'L', 'o', 'g', 0x01, 0x12, 0x35, 1};
    writer_t w = {.at = out};
    memcpy(w.at, magic, sizeof magic);
    w.at += sizeof magic;
    put64(&w, stamp_us(first_tick));
    uint8_t *flags = begin(&w, 'B');
    memset(w.at, 0, 40);
    w.at += 40;
    end(&w, flags);
    put_info(&w, "char[8] sys_name", "traction");
    char key[24] = "char[00] ver_sw";
    char text[61] = "";
    (void)strncat(text, version, sizeof text - 1u);
    const size_t length = strlen(text);
    key[5] = (char)('0' + length / 10u);
    key[6] = (char)('0' + length % 10u);
    if (length > 0u) {
        put_info(&w, key, text);
    }
    for (uint32_t i = 0; i < TOPICS; i++) {
        uint8_t *start = begin(&w, 'F');
        put_text(&w, topic_format[i]);
        end(&w, start);
    }
    for (uint32_t i = 0; i < TOPICS; i++) {
        uint8_t *start = begin(&w, 'A');
        put8(&w, 0);
        put16(&w, i);
        const size_t name = (size_t)(strchr(topic_format[i], ':') - topic_format[i]);
        memcpy(w.at, topic_format[i], name);
        w.at += name;
        end(&w, start);
    }
    return (size_t)(w.at - out);
}

static uint8_t *begin_data(writer_t *w, uint32_t topic, uint32_t tick)
{
    uint8_t *start = begin(w, 'D');
    put16(w, topic);
    put64(w, stamp_us(tick));
    return start;
}

static void put_frame(writer_t *w, const sensor_frame_t *frame)
{
    uint8_t *start = begin_data(w, TOPIC_FRAME, frame->tick);
    put32(w, frame->tick);
    put32(w, frame->elapsed_ticks);
    put32(w, frame->time_us);
    put32(w, frame->present);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        put32(w, (uint32_t)frame->encoder_count[i]);
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        put16(w, frame->current_count[i]);
    }
    put16(w, frame->battery_count);
    const int16_t axes[] = {frame->accel_x_count, frame->accel_y_count, frame->accel_z_count,
                            frame->gyro_x_count,  frame->gyro_y_count,  frame->gyro_z_count};
    for (size_t i = 0; i < sizeof axes / sizeof *axes; i++) {
        put16(w, (uint16_t)axes[i]);
    }
    put32(w, frame->radar_sequence);
    put8(w, frame->radar_samples);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        put8(w, frame->bridge_status[i]);
    }
    put8(w, frame->emergency_stop ? 1u : 0u);
    end(w, start);
}

static void put_radar(writer_t *w, const sensor_frame_t *frame)
{
    const uint32_t held = frame->radar_samples < RADAR_SAMPLES_PER_TICK_MAX ? frame->radar_samples : RADAR_SAMPLES_PER_TICK_MAX;
    for (uint32_t at = 0; at < held; at += RADAR_SAMPLES) {
        uint8_t *start = begin_data(w, TOPIC_RADAR, frame->tick);
        put32(w, frame->radar_sequence + at);
        put8(w, held - at < RADAR_SAMPLES ? held - at : RADAR_SAMPLES);
        for (uint32_t i = at; i < at + RADAR_SAMPLES; i++) {
            put16(w, i < held ? frame->radar_count[i] : 0u);
        }
        end(w, start);
    }
}

static void put_command(writer_t *w, uint32_t tick, const command_t *command)
{
    uint8_t *start = begin_data(w, TOPIC_COMMAND, tick);
    put_float(w, command->platform_speed_m_s);
    put_float(w, command->yaw_rate_rad_s);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        put_float(w, command->wheel_speed_rad_s[i]);
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        put_float(w, command->duty[i]);
    }
    put_float(w, command->slip_ref);
    put32(w, command->age_ticks);
    put8(w, (uint32_t)command->mode);
    put8(w, command->slip_wheels);
    end(w, start);
}

static void put_trace(writer_t *w, const trace_t *trace)
{
    uint8_t *start = begin_data(w, TOPIC_TRACE, trace->tick);
    put32(w, trace->faults);
    put32(w, trace->fault_wheels);
    static const size_t members[] = {
        offsetof(wheel_trace_t, speed_rad_s), offsetof(wheel_trace_t, accel_rad_s2), offsetof(wheel_trace_t, set_speed_rad_s),
        offsetof(wheel_trace_t, current_A),   offsetof(wheel_trace_t, torque_Nm),    offsetof(wheel_trace_t, traction_N),
        offsetof(wheel_trace_t, slip),        offsetof(wheel_trace_t, slip_std),     offsetof(wheel_trace_t, duty)};
    for (size_t m = 0; m < sizeof members / sizeof *members; m++) {
        for (int i = 0; i < WHEEL_COUNT; i++) {
            float value = 0;
            memcpy(&value, (const char *)&trace->wheel[i] + members[m], sizeof value);
            put_float(w, value);
        }
    }
    const float values[] = {trace->battery_voltage_V, trace->accel_x_m_s2,  trace->gyro_z_rad_s,   trace->radar_speed_m_s,
                            trace->speed_m_s,         trace->speed_std_m_s, trace->accel_bias_m_s2};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        put_float(w, values[i]);
    }
    put32(w, trace->actuator.sequence);
    uint32_t valid = 0, saturated = 0, refused = 0;
    for (uint32_t i = 0; i < WHEEL_COUNT; i++) {
        put16(w, (uint16_t)trace->actuator.duty_q15[i]);
        valid |= trace->wheel[i].slip_valid ? 1u << i : 0u;
        saturated |= trace->wheel[i].saturated ? 1u << i : 0u;
        refused |= trace->wheel[i].encoder_refused ? 1u << i : 0u;
    }
    put8(w, (uint32_t)trace->mode);
    put8(w, (uint32_t)trace->actuator.drive);
    put8(w, valid);
    put8(w, saturated);
    put8(w, refused);
    put8(w, trace->radar_fresh ? 1u : 0u);
    put8(w, trace->standstill ? 1u : 0u);
    put8(w, trace->actuator.status_led ? 1u : 0u);
    end(w, start);
}

size_t ulog_tick(const sensor_frame_t *frame, const command_t *command, const trace_t *trace, uint8_t out[ULOG_TICK])
{
    writer_t w = {.at = out};
    put_frame(&w, frame);
    put_radar(&w, frame);
    put_command(&w, frame->tick, command);
    put_trace(&w, trace);
    return (size_t)(w.at - out);
}

size_t ulog_text(uint32_t tick, int level, const char *text, uint8_t out[ULOG_TEXT])
{
    writer_t w = {.at = out};
    uint8_t *start = begin(&w, 'L');
    put8(&w, (uint32_t)('0' + level));
    put64(&w, stamp_us(tick));
    char cut[201] = "";
    (void)strncat(cut, text, sizeof cut - 1u);
    put_text(&w, cut);
    end(&w, start);
    return (size_t)(w.at - out);
}

size_t ulog_link(uint32_t tick, const uint32_t counts[ULOG_LINK_COUNTS], uint8_t out[ULOG_TEXT])
{
    writer_t w = {.at = out};
    uint8_t *start = begin_data(&w, TOPIC_LINK, tick);
    for (int i = 0; i < ULOG_LINK_COUNTS; i++) {
        put32(&w, counts[i]);
    }
    end(&w, start);
    return (size_t)(w.at - out);
}

size_t ulog_dropout(uint32_t ticks, uint8_t out[ULOG_TEXT])
{
    writer_t w = {.at = out};
    uint8_t *start = begin(&w, 'O');
    put16(&w, ticks < UINT16_MAX / TICK_MS ? ticks * TICK_MS : (uint32_t)UINT16_MAX);
    end(&w, start);
    return (size_t)(w.at - out);
}
