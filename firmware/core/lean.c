#include "lean.h"

enum {
    STANDING_TICKS = 256, // memory of (3) and (4) while it stands: 2.6 s, assumed
    LOG2_STANDING_TICKS = 8,
    MOVING_TICKS = 16384, // and of (3) before it ever stood: minutes, in which bumps and slopes cancel, assumed
    OPEN_TICKS = 128,     // in which a mean takes all that comes: 1.3 s, assumed
    STOOD_TICKS = 100,    // 1 s of standing is enough, assumed
    LEAN_MAX = (1 << 26) - (1 << 17)
};

static int32_t held(int32_t value, int32_t most) { return value < -most ? -most : value > most ? most : value; }

// A mean whose memory grows, by shifts. A slope that begins before the rover ever stood moves it little.
static void learn_rest(const lean_config_t *config, lean_state_t *state, const lean_input_t *input)
{
    const int32_t most = input->standing ? STANDING_TICKS : MOVING_TICKS;
    state->stood_ticks += input->standing && state->stood_ticks < STOOD_TICKS ? 1 : 0;
    if (state->ticks < most) {
        state->ticks++;
        state->log2_ticks += (state->ticks >> state->log2_ticks) > 1 ? 1 : 0;
    } else if (state->ticks > most) {
        state->ticks = STANDING_TICKS;
        state->log2_ticks = LOG2_STANDING_TICKS;
    }
    const int32_t limit = state->stood_ticks < STOOD_TICKS && state->ticks > OPEN_TICKS ? config->sudden_q8 : INT32_MAX;
    for (int32_t i = 0; i < 3; i++) {
        state->rest_q8[i] += held(input->gyro_count[i] * 256 - state->rest_q8[i], limit) >> state->log2_ticks;
    }
}

// A rover's own accelerations have no mean; what a gyro reads too much has. 2.6 s of memory, less while it stands for the first time.
static void learn_felt(lean_state_t *state, const lean_input_t *input)
{
    const int32_t bits = state->log2_ticks < LOG2_STANDING_TICKS ? state->log2_ticks : LOG2_STANDING_TICKS;
    for (int32_t i = 0; input->accel && i < 2; i++) {
        state->felt_q8[i] += (input->accel_count[i] * 256 - state->felt_q8[i]) >> bits;
    }
}

// The upper word of a product, rounded.
static int32_t high_of(int32_t a, int32_t b) { return (int32_t)(((int64_t)a * b + INT64_C(0x80000000)) >> 32); }

// Radians of this tick about axis i [2^-32], 1/4 at most: no rover turns so.
static int32_t turn_q32(const lean_config_t *config, const lean_state_t *state, const lean_input_t *input, int32_t i)
{
    const int32_t rate_q8 = input->gyro_count[i] * 256 - state->rest_q8[i] - (i == 1 ? input->moved_q8 : 0);
    if (state->stood_ticks < STOOD_TICKS && rate_q8 < config->sudden_q8 && rate_q8 > -config->sudden_q8) {
        return 0;
    }
    const int32_t turn_q20 = high_of(rate_q8, config->turn_q52);
    const int32_t ticks = (int32_t)(input->elapsed_ticks < 16u ? input->elapsed_ticks : 16u); // longer gaps are for safety
    return held(turn_q20 * ticks, 1 << 18) * 4096;
}

void lean_step(const lean_config_t *config, lean_state_t *state, const lean_input_t *input)
{
    for (int32_t i = 0; state->ticks == 0 && i < 3; i++) {
        state->rest_q8[i] = input->gyro_count[i] * 256;
    }
    if (input->standing || state->stood_ticks < STOOD_TICKS) {
        learn_rest(config, state, input);
    }
    learn_felt(state, input);
    const int32_t along = state->felt_q8[0];
    const int32_t across = state->felt_q8[1];
    int32_t change = -high_of(turn_q32(config, state, input, 1), config->gravity_q8);
    int32_t change_across = high_of(turn_q32(config, state, input, 0), config->gravity_q8);
    if ((along < 0 ? -along : along) + (across < 0 ? -across : across) > config->steep_q8) {
        const int32_t yaw = turn_q32(config, state, input, 2);
        change += high_of(yaw, across);
        change_across -= high_of(yaw, along);
    }
    state->lean_q8 = held(state->lean_q8 + change, LEAN_MAX);
    state->felt_q8[0] = held(along + change, config->gravity_q8);
    state->felt_q8[1] = held(across + change_across, config->gravity_q8);
}
