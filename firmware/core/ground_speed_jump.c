#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

// (7), two ticks later. Its state is that of the window's middle, [v + tau b - change, b], which Doppler values see alone: a bias that
// jumps within the window enters it as the window does.
static ground_speed_track_t to_middle(const ground_speed_track_t *track, float tau, float change_m_s)
{
    const ground_speed_track_t out = {
        .speed_m_s = track->speed_m_s + tau * track->bias_m_s2 - change_m_s,
        .bias_m_s2 = track->bias_m_s2,
        .p_vv = ground_speed_spread_of(track, tau),
        .p_vb = track->p_vb + tau * track->p_bb,
        .p_bb = track->p_bb,
    };
    return out;
}

int32_t ground_speed_middle_q20(const ground_speed_state_t *state, uint32_t ago)
{
    const int32_t then = state->integral_q20[((uint32_t)state->head - ago) % GROUND_SPEED_HISTORY];
    return (int32_t)((uint32_t)then - (uint32_t)(int32_t)(fixed_clamp(state->value_change_m_s, -1000.0f, 1000.0f) * 1048576.0f));
}

// Of the value that waits.
static int32_t middle_q20(const ground_speed_state_t *state) { return ground_speed_middle_q20(state, 2u); }

static void start_agile(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const float ago = 2.0f * config->tick_s;
    const float change =
        (float)fixed_wrap_difference(state->integral_q20[state->head], middle_q20(state)) * (1.0f / 1048576.0f); // up to now
    const ground_speed_track_t best = ground_speed_best_of(state);
    state->agile.at = to_middle(&best, state->value_tau_s + ago, change);
    state->agile.at.p_bb += config->agile_m2_s4;
    ground_speed_hold(config, &state->agile.at);
    state->agile.q20 = middle_q20(state);
    state->agile.ticks = 2;
    state->agile_left = config->agile_values;
}

// The present from the middle of the window.
static void take_agile(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_track_t *middle)
{
    const float ago = state->value_tau_s + 2.0f * config->tick_s;
    const float change = (float)fixed_wrap_difference(state->integral_q20[state->head], middle_q20(state)) * (1.0f / 1048576.0f);
    ground_speed_track_t track = to_middle(middle, -ago, -change);
    ground_speed_hold(config, &track);
    ground_speed_keep_best(state, &track);
}

static const float slope_sure_m2_s4 = 0.01f; // (0.1 m/s^2)^2, assumed

static const float jump_costs = 12.0f; // 2 ln of the odds against a bias that jumps, assumed: as much as one value may tell of a sign

// (35), (36)
static void keep_before(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_track_t *before, bool asked)
{
    const float most = -ground_speed_square(config->slow_m_s); // both beyond it, or one by more
    if (fixed_greater(slope_sure_m2_s4, before->p_bb) && fixed_greater(most, before->speed_m_s * state->speed_m_s)) {
        ground_speed_split(state, &state->other, before);
        state->odds = state->agile_sum;
        state->other_alive = state->odds < config->sign_sure;
    } else if (asked && fixed_greater(most, state->other.at.speed_m_s * state->speed_m_s)) {
        state->odds = fixed_clamp(state->odds - jump_costs, 0.0f, config->sign_sure);
        state->other_alive = true;
    }
}

void ground_speed_forget_agile(ground_speed_state_t *state)
{
    state->agile_sum = 0.0f;
    state->agile_left = 0;
}

static const float jolt_left = 0.85f; // [1] a value later, assumed: half of it after half a second

void ground_speed_update_agile(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    state->jolt_m_s *= jolt_left;
    if (state->agile_left <= 0) {
        start_agile(config, state);
        return;
    }
    state->agile_left--;
    ground_speed_track_t *at = &state->agile.at;
    const float ticks = (float)(state->agile.ticks - 2);
    const int32_t q20 = middle_q20(state);
    ground_speed_move(config, at, (float)fixed_wrap_difference(q20, state->agile.q20) * (1.0f / 1048576.0f), ticks * config->tick_s,
                      ticks * state->speed_noise_m2_s2, config->agile_m2_s4);
    state->agile.q20 = q20;
    state->agile.ticks = 2;
    const ground_speed_value_t value = ground_speed_value_for(config, state, at, state->value_accel_m_s2 - at->bias_m_s2);
    const float spread = at->p_vv + value.noise_m2_s2;
    const float told = 4.0f * value.speed_m_s * at->speed_m_s / spread;
    const bool sure = fabsf(told) >= config->sign_sure;
    const float odds =
        told +
        (sure ? 0.0f : ground_speed_wheel_odds(config, value.speed_m_s, state->value_wheel_m_s) + ground_speed_force_odds(config, state));
    const float sign = odds < 0.0f ? -1.0f : 1.0f;
    const float innovation = sign * value.speed_m_s - at->speed_m_s;
    ground_speed_track_t mirrored = *at;
    const float cost = ground_speed_square(innovation) / spread + ground_speed_ln_rough(spread);
    ground_speed_correct(config, at, innovation, 0.0f, value.noise_m2_s2);
    state->agile_sum = fixed_clamp(
        state->agile_sum + fixed_clamp(state->value_cost - cost, -100.0f, config->agile_most) - config->agile_drift, 0.0f, 1000.0f);
    const bool known = fixed_greater(ground_speed_bias_known_m2_s4, state->p_bb); // else X tells of that bias, not of a jump
    const bool apart =
        known && ground_speed_body_departs(state) && ground_speed_told_by_wheels(config, state, config->apart_told_m_s) > 0.0f;
    if (state->agile_sum > (apart ? config->agile_sure : config->agile_limit)) {
        const ground_speed_track_t before = ground_speed_best_of(state);
        const bool asked = state->other_alive;
        take_agile(config, state, at);
        state->other_alive = fabsf(odds) < config->sign_sure;
        if (!state->other_alive) {
            keep_before(config, state, &before, asked);
        } else {
            const ground_speed_track_t best = ground_speed_best_of(state);
            ground_speed_correct(config, &mirrored, -sign * value.speed_m_s - mirrored.speed_m_s, 0.0f, value.noise_m2_s2);
            take_agile(config, state, &mirrored);
            const ground_speed_track_t other = ground_speed_best_of(state);
            ground_speed_split(state, &state->other, &other);
            ground_speed_keep_best(state, &best);
            state->odds = fabsf(odds);
        }
        state->agile_sum = 0.0f;
        state->agile_left = 0;
        state->refused = 0;
        state->one_sided = 0.0f;
        state->jolt_m_s = apart ? 0.0f : fabsf(state->speed_m_s - before.speed_m_s); // (40)
    } else if (state->agile_sum > 0.0f && state->agile_left == 0) {
        state->agile_left = 1; // not while it is about to win
    }
}
