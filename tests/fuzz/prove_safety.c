// prove_safety.c - safety.c, and what is asked of radar_dead alone: its sum goes with its count, which no interval holds.
#include "prove.h"

/*@ assigns state->radar_dead_blocks, state->radar_samples, state->radar_first, state->radar_sum, state->radar_square \from
      state->radar_dead_blocks, state->radar_samples, state->radar_first, state->radar_sum, state->radar_square, *frame, *config, turning;
    assigns \result \from state->radar_dead_blocks, *frame, *config, turning;
    ensures goes_with: 0 <= state->radar_samples < 32 &&
      -1023 * state->radar_samples <= state->radar_sum <= 1023 * state->radar_samples || state->radar_samples == 0;
    ensures 0 <= state->radar_samples < 32;
    ensures \result == 0 || \result == 1; */
static bool radar_dead(const safety_config_t *config, safety_state_t *state, const sensor_frame_t *frame, bool turning);

#include "firmware/core/safety.c"

int prove_radar_dead(void) {
    const control_config_t config = rover_config_default();
    sensor_frame_t frame;
    safety_state_t state;
    int dead = 0;
    Frama_C_make_unknown((char *)&frame, sizeof frame);
    //@ loop unroll 64;
    for (int i = 0; i < RADAR_SAMPLES_PER_TICK_MAX; i++) {
        frame.radar_count[i] = (uint16_t)Frama_C_interval(0, 1023);
    }
    //@ loop unroll 32;
    for (int samples = 0; samples < 32; samples++) {
        Frama_C_make_unknown((char *)&state, sizeof state);
        state.radar_samples = (uint32_t)samples;
        state.radar_sum = Frama_C_interval(-1023 * samples, 1023 * samples);
        state.radar_first = (uint16_t)Frama_C_interval(0, 1023);
        dead += radar_dead(&config.safety, &state, &frame, Frama_C_interval(0, 1) != 0) ? 1 : 0;
    }
    return dead;
}
