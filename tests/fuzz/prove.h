// prove.h - what one run of prove.c and its parts takes from another one.
#ifndef TRACTION_TESTS_FUZZ_PROVE_H
#define TRACTION_TESTS_FUZZ_PROVE_H

#include "firmware/core/rover_config.h"

#include <__fc_builtin.h>

// Proved by prove_transform for any (int16_t)(sample - mean); that no difference wraps is checked where it is called.
/*@ requires fits: \forall integer n; 0 <= n < 256 ==> -32768 <= sample[n] - mean <= 32767;
    assigns power[0 .. 127] \from sample[0 .. 255], mean;
    ensures \initialized(power + (0 .. 127)); */
void fft_power_about(const int16_t sample[FFT_LENGTH], int32_t mean, uint64_t power[FFT_BINS]);
/*@ requires fits: \forall integer n; 0 <= n < 256 ==> -32768 <= sample[n] - mean <= 32767;
    assigns power[0 .. 127] \from sample[0 .. 255], mean;
    ensures \initialized(power + (0 .. 127)); */
void fft_power_flat(const int16_t sample[FFT_LENGTH], int32_t mean, uint64_t power[FFT_BINS]);

// What no interval holds, and who holds it instead. By runs of their own:
//   sense.step        |step| <= encoder_step_max, from a quotient         prove_step
//   made, railed      a block holds no more than came, at most 64         prove_block
//   safety.radar_sum  32 numbers of 10 bits                               prove_radar_dead
//   log2_ticks        of at most 2^8                                      prove_lean
// By proof_assumptions_test in every tick of arbitrary frames, because each is a relation between two numbers:
//   rest_q8, lean_mean_q8, a gap's samples   a mean, and a point of a line, lie between their ends
//   calm_sum                                 of a stretch: no more than calm_ticks times what a calm sample is off by, at most 63
//   gyro_q8                                  x - x/10 is nearer to 0 than x
//   clean, late_samples                      no more than is in the window; what came since a window that waits, for two ticks at most
//   gyro_alone_ticks, rolls_ticks, rolls_wait, unheard_ticks, still_ticks, beyond, relief   counts that stop at their ends
static void relations(const control_config_t *config, control_state_t *state) {
    const int most = config->sense.encoder_step_max;
    //@ loop unroll 4;
    for (int n = 0; n < WHEEL_COUNT; n++) {
        state->sense.step[n] = Frama_C_interval(-most, most);
    }
    //@ loop unroll 5;
    for (int n = 0; n < DOPPLER_BLOCKS; n++) {
        state->doppler.made[n] = Frama_C_interval(0, 64);
        state->doppler.railed[n] = Frama_C_interval(0, 64);
    }
    //@ loop unroll 3;
    for (int n = 0; n < 3; n++) {
        state->sense.lean.rest_q8[n] = Frama_C_interval(-32768 * 256, 32767 * 256);
    }
    //@ loop unroll 3;
    for (int n = 0; n < 3; n++) {
        state->sense.lean.calm_count[n] = Frama_C_interval(-32768, 32767);
        state->sense.lean.calm_sum[n] = Frama_C_interval(-63 * config->sense.lean.calm_count, 63 * config->sense.lean.calm_count);
    }
    state->sense.lean.log2_ticks = Frama_C_interval(0, 8);
    state->ground_speed.lean_mean_q8 = Frama_C_interval(-66977792, 66977792);
    state->ground_speed.gyro_q8 = Frama_C_interval(-4194304, 4194304);
    state->sense.gyro_q8 = Frama_C_interval(-4194304, 4194304);
    state->doppler.clean = Frama_C_interval(0, 256);
    state->doppler.late_samples = Frama_C_interval(-64, 191);
    state->ground_speed.gyro_alone_ticks = Frama_C_interval(0, 1099);
    state->ground_speed.rolls_ticks = Frama_C_interval(0, 60);
    state->ground_speed.rolls_wait = Frama_C_interval(0, 100);
    state->ground_speed.unheard_ticks = Frama_C_interval(0, 1000);
    state->ground_speed.still_ticks = Frama_C_interval(0, 1000);
    state->beyond = Frama_C_interval(0, 3);
    state->doppler.relief = Frama_C_interval(0, 6);
}

#endif
