// firmware_count - what the firmware executes, between markers that arm_count sees. Prints one label a region, in order.
#include "firmware/core/rover_config.h"

#include <stdio.h>
#include <string.h>

#if WITH_KISSFFT
#include "kiss_fftr.h"
#include <math.h>
#include <stdlib.h>
#endif

__attribute__((noinline)) void count_begin(void) { __asm__ volatile(""); }
__attribute__((noinline)) void count_end(void) { __asm__ volatile(""); }
void count_begin(void);
void count_end(void);

static uint64_t random_state = 7;

static int draw(int range) {
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (int)((uint32_t)(random_state >> 33) % (uint32_t)range);
}

static sensor_frame_t frame_at(uint32_t tick) {
    static uint32_t sequence;
    sensor_frame_t frame = {.tick = tick,
                            .elapsed_ticks = 1,
                            .time_us = tick * 10000u,
                            .present = FRAME_ALL,
                            .battery_count = 1800,
                            .accel_z_count = 2452,
                            .radar_sequence = sequence,
                            .radar_samples = tick % 25 < 3 ? 6 : 5};
    sequence += frame.radar_samples;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        frame.encoder_count[i] = (int32_t)(40 * tick) + draw(4);
        frame.current_count[i] = (uint16_t)(2148 + draw(30));
    }
    frame.accel_x_count = (int16_t)(draw(100) - 40);
    frame.accel_y_count = (int16_t)(300 + draw(100)); // on a side slope: the gyros' turn of gravity is looked at whole
    frame.gyro_x_count = (int16_t)(draw(40) - 20);
    frame.gyro_y_count = (int16_t)(draw(40) - 20);
    frame.gyro_z_count = (int16_t)(draw(40) - 20);
    for (int n = 0; n < 6; n++) {
        static int phase;
        phase += 40; // of 1024 a turn: 20 Hz
        const int p = phase & 1023;
        frame.radar_count[n] = (uint16_t)(512 + (p < 512 ? p - 256 : 768 - p) / 2 + draw(60) - 30);
    }
    return frame;
}

// Stack below this function: painted before a tick, looked at after it. The program has no signal handler that could write there.
enum { PAINT_BYTES = 8192, PAINT = 0xa5 };

static inline __attribute__((always_inline)) volatile uint8_t *stack_pointer(void) {
    volatile uint8_t *pointer;
    __asm__ volatile("mov %0, sp" : "=r"(pointer));
    return pointer;
}
#define PAINT_STACK()                                                                                                                      \
    for (volatile uint8_t *at = stack_pointer() - PAINT_BYTES; at != stack_pointer(); at++) {                                              \
        *at = PAINT;                                                                                                                       \
    }

static int tick_table(void) {
    int deepest = 0;
    static const char *const names[] = {"tick stop",           "tick open_loop", "tick wheel_speed",
                                        "tick platform_speed", "tick slip",      "tick soil_sweep"};
    _Static_assert(sizeof names / sizeof *names == MODE_COUNT, "each mode has a name");
    for (int mode = 0; mode < MODE_COUNT; mode++) {
        static control_state_t state;
        const control_config_t config = rover_config_default();
        control_reset(&config, &state);
        command_t command = {
            .mode = (control_mode_t)mode, .platform_speed_m_s = 0.2f, .yaw_rate_rad_s = 0.1f, .slip_ref = 0.4f, .slip_wheels = 15};
        for (int i = 0; i < WHEEL_COUNT; i++) {
            command.wheel_speed_rad_s[i] = 4.0f + 0.1f * (float)i;
            command.duty[i] = 0.3f;
        }
        for (uint32_t tick = 0; tick < 1000; tick++) {
            const sensor_frame_t frame = frame_at(tick);
            PAINT_STACK();
            count_begin();
            const trace_t trace = control_step(&config, &state, &command, &frame);
            count_end();
            int depth = PAINT_BYTES;
            for (volatile uint8_t *at = stack_pointer() - PAINT_BYTES; depth > 0 && *at == PAINT; at++) {
                depth--;
            }
            deepest = depth > deepest ? depth : deepest;
            puts(trace.radar_fresh ? "tick with a radar value" : "tick without");
            puts(names[mode]);
        }
    }
    return deepest;
}

int main(void) {
    static int16_t sample[FFT_LENGTH];
    static uint64_t power[FFT_BINS];
    for (int n = 0; n < FFT_LENGTH; n++) {
        sample[n] = (int16_t)(draw(20000) - 10000);
    }
    count_begin();
    count_end();
    puts("empty");
    puts("empty");
    count_begin();
    fft_power(sample, power);
    count_end();
    puts("fft: Hann, FFT, 127 powers");
    puts("fft: Hann, FFT, 127 powers");
#if WITH_KISSFFT
    static int16_t hann_q15[FFT_LENGTH];
    for (int n = 0; n < FFT_LENGTH; n++) {
        hann_q15[n] = (int16_t)(16383.5 * (1 - cos(2 * 3.14159265358979323846 * n / FFT_LENGTH)));
    }
    static kiss_fft_cpx out[FFT_LENGTH / 2 + 1];
    static int32_t plain[FFT_LENGTH / 2];
    kiss_fftr_cfg cfg = kiss_fftr_alloc(FFT_LENGTH, 0, NULL, NULL);
    for (int windowed = 0; windowed < 2; windowed++) {
        const char *const name = windowed != 0 ? "KissFFT int16: Q15 Hann, FFT, 127 powers" : "KissFFT int16: FFT, 127 powers";
        int16_t input[FFT_LENGTH];
        count_begin();
        for (int n = 0; windowed != 0 && n < FFT_LENGTH; n++) {
            input[n] = (int16_t)((sample[n] * hann_q15[n] + (1 << 14)) >> 15);
        }
        kiss_fftr(cfg, windowed != 0 ? input : sample, out);
        for (int k = 1; k < FFT_LENGTH / 2; k++) {
            plain[k] = out[k].r * out[k].r + out[k].i * out[k].i;
        }
        count_end();
        puts(name);
        puts(plain[5] == 12345 ? "" : name); // the powers are used
    }
#endif
    printf("%d\n", tick_table()); // the last label: bytes of stack
    return 0;
}
