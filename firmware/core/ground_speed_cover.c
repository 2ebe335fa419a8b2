#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

static const float ticks_known = 300.0f; // 3 s: longer, the bias's error alone makes half of a rim's speed, assumed

static const float heard_share = 0.6f;        // [1] of slow_m_s: a rim above it rolls at a speed that the radar hears, assumed
static const float covered_share = 0.3f;      // [1] and above this where it did not hear it when it was faster, assumed
static const float hardly_share = 1.25f;      // [1] below it a quiet echo tells of no stop that was not felt, assumed
static const float settled_m2_s4 = 4e-4f;     // (0.02 m/s^2)^2: how well the bias is known at best, assumed
static const float unsettled_m2_s4 = 1.6e-3f; // (0.04 m/s^2)^2: a jump's is more than that, assumed
static const float stop_sigmas2 = 4.0f;       // [1] two sigma, squared, assumed

// Where the speed was known last: V, the bias and the ticks since.
typedef struct {
    int32_t q20;
    float speed_m_s, bias_m_s2, bias_m2_s4, ticks;
    bool value;
} known_t;

static known_t known_by(const ground_speed_config_t *config, const ground_speed_state_t *state, int32_t ago)
{
    const int32_t at = (state->slide.newest + SLIDE_VALUES - ago) % SLIDE_VALUES;
    const float since = (float)(int32_t)(state->slide.ticks - state->slide.came[at]) + state->slide.tau_s[at] * config->per_tick_1_s;
    const float unsure = state->slide.bias_m2_s4[at];
    const known_t value = {state->slide.q20[at],
                           state->slide.sign[at] * state->slide.heard_m_s[at],
                           state->slide.bias_m_s2[at],
                           fixed_greater(unsure, settled_m2_s4) ? unsure : settled_m2_s4,
                           since,
                           true};
    return value;
}

// The oldest of the last values, or the end of the last rest; where a value's bias had not settled, a newer one whose had.
static known_t known_last(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const float since_rest = (float)(int32_t)(state->slide.ticks - state->cover.rest_ended);
    const known_t rest = {
        state->cover.rest_q20, 0.0f, state->cover.rest_bias_m_s2, settled_m2_s4, state->cover.rested ? since_rest : ticks_known, false};
    if (state->slide.held == 0) {
        return rest;
    }
    known_t out = known_by(config, state, state->slide.held - 1);
    if (!fixed_greater(rest.ticks, out.ticks)) {
        return rest;
    }
    for (int32_t i = state->slide.held - 2; i >= 0 && fixed_greater(out.bias_m2_s4, unsettled_m2_s4); i--) {
        const known_t newer = known_by(config, state, i);
        out = fixed_greater(out.bias_m2_s4, newer.bias_m2_s4) ? newer : out;
    }
    return out;
}

void ground_speed_judge_quiet(const ground_speed_config_t *config, ground_speed_state_t *state, float wheel_m_s)
{
    const float least_m_s = (state->cover.on ? covered_share : heard_share) * config->slow_m_s;
    const bool turns = fixed_greater(config->still_m_s, 0.0f) && fixed_greater(fabsf(wheel_m_s), least_m_s);
    if (!turns) {
        state->cover.on = false;
        state->cover.stopped = false;
        state->cover.judged = false;
        return;
    }
    if (state->cover.on) { // values before are none to compare with
        state->loud = 0;
        state->refused = 0;
        ground_speed_forget_agile(state);
    }
    if (state->cover.judged) {
        return;
    }
    const known_t from = known_last(config, state);
    if (!fixed_greater(ticks_known, from.ticks)) { // the wheels and what was known of old agree, or it fades
        state->cover.on =
            state->cover.on || fixed_greater(wheel_m_s < 0.0f ? -state->speed_m_s : state->speed_m_s, 0.5f * fabsf(wheel_m_s));
        return;
    }
    const float time_s = from.ticks * config->tick_s;
    const float change_m_s = (float)fixed_wrap_difference(state->integral_q20[state->head], from.q20) * (1.0f / 1048576.0f);
    const float expected = from.speed_m_s + change_m_s - time_s * from.bias_m_s2; // (38)
    const float along = wheel_m_s < 0.0f ? -expected : expected;
    const float gap_m_s = along - 0.5f * fabsf(wheel_m_s);
    const float noise_m2_s2 = from.ticks * state->speed_noise_m2_s2 + ground_speed_square(time_s) * from.bias_m2_s4;
    const float gap2 = ground_speed_square(gap_m_s);
    const bool goes_on = gap_m_s > 0.0f && fixed_greater(gap2, noise_m2_s2);
    const float beyond_m_s = fabsf(expected) - config->slow_m_s; // of what the radar would hear
    const bool slow = !fixed_greater(beyond_m_s, 0.0f) || fixed_greater(noise_m2_s2, ground_speed_square(beyond_m_s));
    const bool falls_short = gap_m_s < 0.0f && fixed_greater(gap2, stop_sigmas2 * noise_m2_s2);
    state->cover.stopped = falls_short && slow && from.value; // after a rest a window is half of it still
    const bool hardly = from.value && fixed_greater(hardly_share * config->slow_m_s, fabsf(wheel_m_s));
    const bool was = state->cover.on;
    state->cover.on = goes_on || (hardly && !state->cover.stopped);
    if (state->cover.on && !was && state->quiet >= config->quiet_needed) { // what has pulled it to a standstill was none
        state->speed_m_s = expected;
        state->bias_m_s2 = from.bias_m_s2;
        state->p_vv += noise_m2_s2;
        state->other_alive = false;
    }
    state->cover.judged = goes_on; // the first quiet value after a loud one tells best; what has stopped may set off
}

void ground_speed_watch_cover(ground_speed_state_t *state)
{
    state->cover.on = false;
    state->cover.stopped = false;
    state->cover.judged = false;
    state->slide.bias_m_s2[state->slide.newest] = state->cover.before_m_s2[GROUND_SPEED_BEFORE - 1];
    state->slide.bias_m2_s4[state->slide.newest] = state->cover.before_m2_s4[GROUND_SPEED_BEFORE - 1];
    for (int32_t i = GROUND_SPEED_BEFORE - 1; i > 0; i--) {
        state->cover.before_m_s2[i] = state->cover.before_m_s2[i - 1];
        state->cover.before_m2_s4[i] = state->cover.before_m2_s4[i - 1];
    }
    state->cover.before_m_s2[0] = state->bias_m_s2;
    state->cover.before_m2_s4[0] = state->p_bb;
}

void ground_speed_watch_rest(ground_speed_state_t *state)
{
    state->cover.rested = true;
    state->cover.rest_ended = state->slide.ticks;
    state->cover.rest_q20 = state->integral_q20[state->head];
    state->cover.rest_bias_m_s2 = state->bias_m_s2;
    for (int32_t i = 0; i < GROUND_SPEED_BEFORE; i++) {
        state->cover.before_m_s2[i] = state->bias_m_s2;
        state->cover.before_m2_s4[i] = settled_m2_s4;
    }
}
