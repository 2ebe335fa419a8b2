// replay - feeds logged frames and commands to control_step and prints every bit of every trace.
//
// usage: replay FRAMES.txt [--hash]     Portable C, firmware sources only: the same file gives the same bytes on x86 and on ARM.
// One line per tick, fields separated by blanks; '#' starts a comment line:
//   tick present enc0 enc1 enc2 enc3 cur0 cur1 cur2 cur3 battery accel gyro estop n radar_0 .. radar_{n-1}
//   mode v yaw w0 w1 w2 w3 d0 d1 d2 d3 slip_ref slip_wheels age
// Counts are decimal, `present` is hexadecimal without prefix; v, yaw, w, d and slip_ref are the bits of the float in hexadecimal.
// A log of `traction simulate` holds all of it (docs/log_format.md). With --hash only the last line is printed: FNV-1a, 64 bit, over all
// trace lines.
#include "firmware/core/rover_config.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static uint64_t hash = 14695981039346656037u;

static void feed(const char *line) {
    for (; *line != '\0'; line++) {
        hash = (hash ^ (uint8_t)*line) * 1099511628211u;
    }
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_of(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void print_trace(const trace_t *trace, bool quiet) {
    char line[1200];
    int used = snprintf(line, sizeof line, "%" PRIu32 " %d %08" PRIx32 " %08" PRIx32, trace->tick, (int)trace->mode, trace->faults,
                        trace->present);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        const wheel_trace_t *w = &trace->wheel[i];
        const float values[] = {w->speed_rad_s, w->accel_rad_s2, w->set_speed_rad_s, w->current_A, w->torque_Nm, w->traction_N,
                                w->slip,        w->duty};
        for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
            used += snprintf(line + used, sizeof line - (size_t)used, " %08" PRIx32, bits_of(values[k]));
        }
        used += snprintf(line + used, sizeof line - (size_t)used, " %d%d %d", w->slip_valid, w->saturated, trace->actuator.duty_q15[i]);
    }
    const float values[] = {trace->battery_voltage_V, trace->accel_x_m_s2,  trace->gyro_z_rad_s,   trace->radar_speed_m_s,
                            trace->speed_m_s,         trace->speed_std_m_s, trace->accel_bias_m_s2};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
        used += snprintf(line + used, sizeof line - (size_t)used, " %08" PRIx32, bits_of(values[k]));
    }
    snprintf(line + used, sizeof line - (size_t)used, " %d%d%d%d\n", trace->radar_fresh, trace->standstill, trace->actuator.motor_enable,
             trace->actuator.status_led);
    feed(line);
    if (!quiet) {
        fputs(line, stdout);
    }
}

// Reads one line into a frame and a command; false when a field is missing.
static bool parse(const char *text, sensor_frame_t *frame, command_t *command) {
    int at = 0;
    int step = 0;
    uint32_t n = 0;
    uint32_t mode = 0;
    int estop = 0;
    uint32_t bits[11];
    memset(frame, 0, sizeof *frame);
    memset(command, 0, sizeof *command);
    if (sscanf(text, "%" SCNu32 " %" SCNx32 " %" SCNd32 " %" SCNd32 " %" SCNd32 " %" SCNd32 "%n", &frame->tick, &frame->present,
               &frame->encoder_count[0], &frame->encoder_count[1], &frame->encoder_count[2], &frame->encoder_count[3], &step) != 6) {
        return false;
    }
    at += step;
    if (sscanf(text + at, "%" SCNu16 " %" SCNu16 " %" SCNu16 " %" SCNu16 " %" SCNu16 " %" SCNd16 " %" SCNd16 " %d %" SCNu32 "%n",
               &frame->current_count[0], &frame->current_count[1], &frame->current_count[2], &frame->current_count[3],
               &frame->battery_count, &frame->accel_x_count, &frame->gyro_z_count, &estop, &n, &step) != 9 ||
        n > RADAR_SAMPLES_PER_TICK_MAX) {
        return false;
    }
    at += step;
    for (uint32_t i = 0; i < n; i++, at += step) {
        if (sscanf(text + at, "%" SCNu16 "%n", &frame->radar_count[i], &step) != 1) {
            return false;
        }
    }
    if (sscanf(text + at, "%" SCNu32 "%n", &mode, &step) != 1) {
        return false;
    }
    at += step;
    for (int i = 0; i < 11; i++, at += step) {
        if (sscanf(text + at, "%" SCNx32 "%n", &bits[i], &step) != 1) {
            return false;
        }
    }
    if (sscanf(text + at, "%" SCNu8 " %" SCNu32, &command->slip_wheels, &command->age_ticks) != 2) {
        return false;
    }
    frame->radar_samples = (uint8_t)n;
    frame->emergency_stop = estop != 0;
    command->mode = mode < MODE_COUNT ? (control_mode_t)mode : MODE_STOP;
    command->platform_speed_m_s = float_of(bits[0]);
    command->yaw_rate_rad_s = float_of(bits[1]);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        command->wheel_speed_rad_s[i] = float_of(bits[2 + i]);
        command->duty[i] = float_of(bits[6 + i]);
    }
    command->slip_ref = float_of(bits[10]);
    return true;
}

int main(int argc, char **argv) {
    if (argc < 2) {
        fprintf(stderr, "usage: replay FRAMES.txt [--hash]\n");
        return 2;
    }
    FILE *in = fopen(argv[1], "r");
    if (in == NULL) {
        fprintf(stderr, "replay: cannot read %s\n", argv[1]);
        return 4;
    }
    static control_state_t state;
    const control_config_t config = rover_config_default();
    const bool quiet = argc > 2 && strcmp(argv[2], "--hash") == 0;
    control_reset(&config, &state);
    char text[600];
    for (long line = 1; fgets(text, sizeof text, in) != NULL; line++) {
        sensor_frame_t frame;
        command_t command;
        if (text[0] == '#') {
            continue;
        }
        if (!parse(text, &frame, &command)) {
            fprintf(stderr, "replay: %s:%ld: not a frame; the fields are listed at the head of tests/replay/replay.c\n", argv[1], line);
            fclose(in);
            return 3;
        }
        const trace_t trace = control_step(&config, &state, &command, &frame);
        print_trace(&trace, quiet);
    }
    fclose(in);
    printf("%016" PRIx64 "\n", hash);
    return 0;
}
