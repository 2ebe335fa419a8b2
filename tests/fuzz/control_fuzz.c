// control_fuzz.c - libFuzzer on control_step: arbitrary frames and commands, whatever was latched before. Any sanitizer report, a duty
// beyond +-1, or a driven wheel under a stopping fault is a finding. Run: sh tests/fuzz/fuzz.sh [seconds]
#include "firmware/core/rover_config.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { REPEAT_MAX = 60 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const size_t step = sizeof(sensor_frame_t) + sizeof(command_t) + 1;
    const control_config_t config = size > 0 && (data[0] & 1u) != 0u ? rover_config_paper() : rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    uint32_t tick = 0;
    for (size_t at = 1; at + step <= size; at += step) {
        sensor_frame_t frame;
        command_t command;
        uint8_t bytes[sizeof frame];
        memcpy(bytes, data + at, sizeof frame);
        bytes[offsetof(sensor_frame_t, emergency_stop)] &= 1u; // a bool is 0 or 1
        memcpy(&frame, bytes, sizeof frame);
        memcpy(&command, data + at + sizeof frame, sizeof command);
        const uint8_t how = data[at + step - 1];
        for (int repeat = 0; repeat <= how % REPEAT_MAX; repeat++) { // long enough to fill radar windows and latch faults
            if ((how & 0x40u) != 0u) {
                frame.tick = tick;
                command.age_ticks = 0;
            }
            tick++;
            const trace_t trace = control_step(&config, &state, &command, &frame);
            for (int i = 0; i < WHEEL_COUNT; i++) {
                if (!(fabsf(trace.wheel[i].duty) <= 1.0f) || trace.actuator.duty_q15[i] < -32767) {
                    abort();
                }
                if ((trace.faults & ~(uint32_t)SAFETY_LIMITING) != 0u &&
                    (trace.actuator.duty_q15[i] != 0 || trace.actuator.drive != DRIVE_BRAKE)) {
                    abort();
                }
            }
            if (!isfinite(trace.speed_m_s) || !isfinite(trace.speed_std_m_s) || !isfinite(trace.accel_bias_m_s2)) {
                abort();
            }
        }
    }
    return 0;
}
