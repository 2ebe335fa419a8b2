#include "frames.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- writing

typedef struct {
    char *at;
} pen_t;

static void decimal(pen_t *pen, int64_t value) { pen->at += sprintf(pen->at, "%" PRId64 " ", value); }

static void real(pen_t *pen, float value) {
    uint32_t bits = 0;
    memcpy(&bits, &value, sizeof bits);
    pen->at += sprintf(pen->at, "%08" PRIx32 " ", bits);
}

size_t frames_print(const sensor_frame_t *frame, const command_t *command, char line[FRAMES_LINE]) {
    pen_t pen = {line};
    const int samples = frame->radar_samples < RADAR_SAMPLES_PER_TICK_MAX ? frame->radar_samples : RADAR_SAMPLES_PER_TICK_MAX;
    decimal(&pen, frame->tick);
    decimal(&pen, frame->elapsed_ticks);
    decimal(&pen, frame->time_us);
    pen.at += sprintf(pen.at, "%" PRIx32 " ", frame->present);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        decimal(&pen, frame->encoder_count[i]);
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        decimal(&pen, frame->current_count[i]);
    }
    decimal(&pen, frame->battery_count);
    const int16_t body[] = {frame->accel_x_count, frame->accel_y_count, frame->accel_z_count,
                            frame->gyro_x_count,  frame->gyro_y_count,  frame->gyro_z_count};
    for (size_t i = 0; i < sizeof body / sizeof *body; i++) {
        decimal(&pen, body[i]);
    }
    decimal(&pen, frame->emergency_stop ? 1 : 0);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        decimal(&pen, frame->bridge_status[i]);
    }
    decimal(&pen, frame->radar_sequence);
    decimal(&pen, samples);
    for (int i = 0; i < samples; i++) {
        decimal(&pen, frame->radar_count[i]);
    }
    decimal(&pen, (int64_t)command->mode);
    real(&pen, command->platform_speed_m_s);
    real(&pen, command->yaw_rate_rad_s);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        real(&pen, command->wheel_speed_rad_s[i]);
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        real(&pen, command->duty[i]);
    }
    real(&pen, command->slip_ref);
    decimal(&pen, command->slip_wheels);
    decimal(&pen, command->age_ticks);
    pen.at[-1] = '\n';
    return (size_t)(pen.at - line);
}

// --- reading

typedef struct {
    const char *at;
    char *why;
    bool good; // false: why is filled, and every later field reads as 0
} reader_t;

static void refuse(reader_t *reader, const char *field, const char *mend) {
    if (reader->good) {
        const int length = (int)strcspn(reader->at, " \n");
        (void)snprintf(reader->why, FRAMES_WHY, "%s = %.*s: %s", field, length < 40 ? length : 40, reader->at, mend);
    }
    reader->good = false;
}

// The next field, low..high. `last`: a newline ends it, not a blank.
static int64_t field(reader_t *reader, const char *name, int base, int64_t low, int64_t high, bool last) {
    if (!reader->good) {
        return 0;
    }
    if (*reader->at == '\n' || *reader->at == '\0') {
        refuse(reader, name, "missing; the line ends too early (hal/replay/frames.h lists the fields)");
        return 0;
    }
    char *end = NULL;
    errno = 0;
    const char *digit = *reader->at == '-' && base == 10 ? reader->at + 1 : reader->at; // strtoll takes blanks, + and 0x too
    const bool begins =
        (*digit >= '0' && *digit <= '9' && digit[1] != 'x' && digit[1] != 'X') || (base == 16 && *digit >= 'a' && *digit <= 'f');
    const long long value = begins ? strtoll(reader->at, &end, base) : 0;
    if (!begins || (*end != ' ' && *end != '\n' && *end != '\0')) {
        refuse(reader, name, base == 16 ? "not a hexadecimal number" : "not a whole number");
        return 0;
    }
    if (errno != 0 || value < low || value > high) {
        char mend[80];
        (void)snprintf(mend, sizeof mend, base == 16 ? "out of range; %" PRIx64 " to %" PRIx64 : "out of range; %" PRId64 " to %" PRId64,
                       low, high);
        refuse(reader, name, mend);
        return 0;
    }
    if (last && *end != '\n') {
        refuse(reader, name, *end == ' ' ? "is the last field; something follows it" : "the line has no end; the file was cut off");
        return 0;
    }
    reader->at = *end == ' ' ? end + 1 : end;
    return value;
}

static float real_field(reader_t *reader, const char *name) {
    const uint32_t bits = (uint32_t)field(reader, name, 16, 0, UINT32_MAX, false);
    float value = 0.0f;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void parse_frame(reader_t *reader, sensor_frame_t *frame) {
    frame->tick = (uint32_t)field(reader, "tick", 10, 0, UINT32_MAX, false);
    frame->elapsed_ticks = (uint32_t)field(reader, "elapsed", 10, 0, UINT32_MAX, false);
    frame->time_us = (uint32_t)field(reader, "time_us", 10, 0, UINT32_MAX, false);
    frame->present = (uint32_t)field(reader, "present", 16, 0, UINT32_MAX, false);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        frame->encoder_count[i] = (int32_t)field(reader, "enc", 10, INT32_MIN, INT32_MAX, false);
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        frame->current_count[i] = (uint16_t)field(reader, "cur", 10, 0, UINT16_MAX, false);
    }
    frame->battery_count = (uint16_t)field(reader, "battery", 10, 0, UINT16_MAX, false);
    int16_t *const body[] = {&frame->accel_x_count, &frame->accel_y_count, &frame->accel_z_count,
                             &frame->gyro_x_count,  &frame->gyro_y_count,  &frame->gyro_z_count};
    for (size_t i = 0; i < sizeof body / sizeof *body; i++) {
        *body[i] = (int16_t)field(reader, i < 3 ? "accel" : "gyro", 10, INT16_MIN, INT16_MAX, false);
    }
    frame->emergency_stop = field(reader, "estop", 10, 0, 1, false) != 0;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        frame->bridge_status[i] = (uint8_t)field(reader, "bridge", 10, 0, UINT8_MAX, false);
    }
    frame->radar_sequence = (uint32_t)field(reader, "radar_sequence", 10, 0, UINT32_MAX, false);
    frame->radar_samples = (uint8_t)field(reader, "n", 10, 0, RADAR_SAMPLES_PER_TICK_MAX, false);
    for (int i = 0; i < frame->radar_samples; i++) {
        frame->radar_count[i] = (uint16_t)field(reader, "radar", 10, 0, UINT16_MAX, false);
    }
}

static void parse_command(reader_t *reader, command_t *command) {
    command->mode = (control_mode_t)field(reader, "mode", 10, 0, MODE_COUNT - 1, false);
    command->platform_speed_m_s = real_field(reader, "v");
    command->yaw_rate_rad_s = real_field(reader, "yaw");
    for (int i = 0; i < WHEEL_COUNT; i++) {
        command->wheel_speed_rad_s[i] = real_field(reader, "w");
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        command->duty[i] = real_field(reader, "duty");
    }
    command->slip_ref = real_field(reader, "slip");
    command->slip_wheels = (uint8_t)field(reader, "slip_wheels", 10, 0, UINT8_MAX, false);
    command->age_ticks = (uint32_t)field(reader, "age", 10, 0, UINT32_MAX, true);
}

bool frames_parse(const char *line, sensor_frame_t *frame, command_t *command, char why[FRAMES_WHY]) {
    reader_t reader = {.at = line, .why = why, .good = true};
    memset(frame, 0, sizeof *frame);
    memset(command, 0, sizeof *command);
    why[0] = '\0';
    parse_frame(&reader, frame);
    parse_command(&reader, command);
    return reader.good;
}
