#include "lean.h"

enum {
    STANDING_TICKS = 256, // memory of (3) and (4) while it stands: 2.6 s, assumed
    STOOD_TICKS = 100,    // 1 s of standing is enough, assumed
    CALM_TICKS = 64,
    CALMS_BELIEVED = 3,
    LEAN_MAX = (1 << 26) - (1 << 17)
};

static int32_t held(int32_t value, int32_t most) { return value < -most ? -most : value > most ? most : value; }

// A mean whose memory grows, by shifts, while it stands.
static void learn_rest(lean_state_t *state, const lean_input_t *input)
{
    if (state->stood_ticks == 0 && !state->calm_known) { // nothing is known yet
        state->ticks = 1;
        state->log2_ticks = 0;
    }
    state->stood_ticks += state->stood_ticks < STOOD_TICKS ? 1 : 0;
    for (int32_t i = 0; i < 3; i++) {
        state->rest_q8[i] += (input->gyro_count[i] * 256 - state->rest_q8[i]) >> state->log2_ticks;
    }
}

// What a calm stretch tells: the first of all is believed, the others by a sixteenth; what differs three times in a row is believed, too.
static void take_calm(const lean_config_t *config, lean_state_t *state)
{
    int32_t mean_q8[3];
    bool differs = false;
    for (int32_t i = 0; i < 3; i++) {
        mean_q8[i] = state->calm_count[i] * 256 + state->calm_sum[i] * (256 / CALM_TICKS);
        const int32_t apart = mean_q8[i] - state->rest_q8[i];
        differs = differs || apart > config->sudden_q8 || apart < -config->sudden_q8;
    }
    const bool whole = !state->calm_known || (differs && state->calms_apart >= CALMS_BELIEVED - 1);
    state->calms_apart = !differs || whole ? 0 : state->calms_apart == 0 ? 1 : 2;
    for (int32_t i = 0; i < 3 && (whole || !differs); i++) {
        state->rest_q8[i] = whole ? mean_q8[i] : state->rest_q8[i] + (mean_q8[i] - state->rest_q8[i]) / 16;
    }
    state->calm_known = true;
}

static bool is_within(int32_t value, int32_t most) { return value <= most && value >= -most; }

static void watch_calm(const lean_config_t *config, lean_state_t *state, const lean_input_t *input)
{
    const int32_t x = input->gyro_count[0] - state->calm_count[0];
    const int32_t y = input->gyro_count[1] - state->calm_count[1];
    const int32_t z = input->gyro_count[2] - state->calm_count[2];
    if (state->calm_ticks > 0 && is_within(x, config->calm_count) && is_within(y, config->calm_count) && is_within(z, config->calm_count)) {
        state->calm_ticks++;
        state->calm_sum[0] += x;
        state->calm_sum[1] += y;
        state->calm_sum[2] += z;
    } else {
        state->calm_ticks = 1;
        for (int32_t i = 0; i < 3; i++) {
            state->calm_count[i] = input->gyro_count[i];
            state->calm_sum[i] = 0;
        }
    }
    if (state->calm_ticks >= CALM_TICKS) {
        take_calm(config, state);
        state->calm_ticks = 0;
    }
}

// A rover's own accelerations have no mean; what a gyro reads too much has. 2.6 s of memory, less while it stands for the first time.
static void learn_felt(lean_state_t *state, const lean_input_t *input)
{
    for (int32_t i = 0; input->accel && i < 2; i++) {
        state->felt_q8[i] += (input->accel_count[i] * 256 - state->felt_q8[i]) >> state->log2_ticks;
    }
}

// The upper word of a product, rounded.
static int32_t high_of(int32_t a, int32_t b) { return (int32_t)(((int64_t)a * b + INT64_C(0x80000000)) >> 32); }

// Radians of this tick about axis i [2^-32], 1/4 at most: no rover turns so.
static int32_t turn_q32(const lean_config_t *config, const lean_state_t *state, const lean_input_t *input, int32_t i)
{
    const int32_t apart_q8 = input->gyro_count[i] * 256 - state->rest_q8[i];
    if (state->stood_ticks < STOOD_TICKS && (!state->calm_known || is_within(apart_q8, config->sudden_q8))) {
        return 0;
    }
    const int32_t rate_q8 = i == 1 ? apart_q8 - input->moved_q8 : apart_q8;
    const int32_t turn_q20 = high_of(rate_q8, config->turn_q52);
    const int32_t ticks = (int32_t)(input->elapsed_ticks < 16u ? input->elapsed_ticks : 16u); // longer gaps are for safety
    return held(turn_q20 * ticks, 1 << 18) * 4096;
}

void lean_step(const lean_config_t *config, lean_state_t *state, const lean_input_t *input)
{
    if (state->ticks < STANDING_TICKS) {
        state->ticks++;
        state->log2_ticks += (state->ticks >> state->log2_ticks) > 1 ? 1 : 0;
    }
    if (input->standing) {
        learn_rest(state, input);
    } else if (state->stood_ticks < STOOD_TICKS) {
        watch_calm(config, state, input);
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
