#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

// [1] variance of an early value over a full window's: 2.3 to 2.7 for half the samples, 1.7 to 2.3 with the mirror image
static const float early_noise = 2.5f;
static const float early_accel_m_s2 = 0.2f; // [m/s^2] assumed: the speed changes by 0.05 m/s at most in the first half window

// The paper drives forward only; the sign of the wheels extends its filter to reverse.
void ground_speed_update_paper(const ground_speed_config_t *config, ground_speed_state_t *state, float doppler_m_s, float wheel_m_s)
{
    const float sign = fixed_greater(0.0f, wheel_m_s) ? -1.0f : 1.0f;
    const float gain = state->p_vv / (state->p_vv + config->doppler_noise_m2_s2); // (1)
    state->speed_m_s += gain * (sign * fixed_clamp(doppler_m_s, 0.0f, config->speed_max_m_s) - state->speed_m_s);
    state->p_vv -= gain * state->p_vv;
    state->p_vb = 0.0f;
    state->p_bb = 0.0f;
}

// (4), (5): values that keep missing on one side tell of a slope long before (2) would.
static const float one_sided_max = 4.0f; // [1] assumed: no single value tells of a jump

static void watch_bias(const ground_speed_config_t *config, ground_speed_state_t *state, ground_speed_track_t *track, float innovation,
                       float spread)
{
    const float one_sided = fixed_clamp(innovation * fabsf(innovation) / spread, -one_sided_max, one_sided_max);
    state->one_sided += config->jump_share * (one_sided - state->one_sided); // (4)
    if (fabsf(state->one_sided) > config->jump_limit) {
        track->p_bb += config->jump_m2_s4; // (5)
        state->one_sided = 0.0f;
        ground_speed_hold(config, track);
    }
}

// (8)
static void watch_misfit(const ground_speed_config_t *config, ground_speed_state_t *state, float cost)
{
    const float limited = fixed_clamp(cost, 0.0f, ground_speed_square(config->gate_sigma));
    state->misfit = fixed_clamp(state->misfit * (1.0f + config->misfit_share * (limited - 1.0f)), 1.0f, config->misfit_max);
}

static const float deaf_at_most = 4.0f; // [1] as deaf as it gets below three quarters of slow_m_s

// (20): what the radar's value is wrong by where its band-pass hardly lets the echo through.
static float deaf_m2_s2(const ground_speed_config_t *config, float heard_m_s)
{
    const float below = fixed_clamp(deaf_at_most * (1.0f - heard_m_s * config->per_slow_s_m), 0.0f, 1.0f);
    return below * config->deaf_noise_m2_s2;
}

ground_speed_value_t ground_speed_value_for(const ground_speed_config_t *config, const ground_speed_state_t *state,
                                            const ground_speed_track_t *track, float own_accel_m_s2)
{
    const float heard = state->value_heard_m_s;
    const float accel2 = fixed_clamp(own_accel_m_s2 * own_accel_m_s2 - track->p_bb, 0.0f, 100.0f);
    const float heard2 = heard * heard;
    const float less2 = fixed_clamp(ground_speed_square(config->doppler_spread_s) * accel2, 0.0f, 0.5f * heard2);
    float noise =
        state->value_trust * (config->doppler_noise_m2_s2 + config->doppler_noise_m_s * heard) + config->doppler_accel_s2 * accel2;
    if (fixed_greater(config->slow_m_s, heard)) {
        noise += deaf_m2_s2(config, heard);
    }
    const ground_speed_value_t out = {
        .speed_m_s = fixed_greater(less2, 0.0f) ? sqrtf(heard2 - less2) : heard, // (11)
        .noise_m2_s2 = noise,
    };
    return out;
}

// Of the value that came a tick or two ago; +-1.
ground_speed_track_t ground_speed_told(const ground_speed_config_t *config, const ground_speed_state_t *state, float sign, float bias_m_s2,
                                       float p_bb)
{
    const float tau = state->value_tau_s;
    ground_speed_track_t out = {
        .speed_m_s = sign * state->value_m_s - tau * bias_m_s2 + state->value_change_m_s,
        .bias_m_s2 = bias_m_s2,
        .p_vv = state->value_noise_m2_s2 + tau * tau * p_bb,
        .p_vb = -tau * p_bb,
        .p_bb = p_bb,
    };
    ground_speed_hold(config, &out);
    return out;
}

static const float believed_cost = 4.0f; // [1] two standard deviations

// What was believed of the speed, the slope and the sign was a line's.
static void begin_anew(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    state->accepted = false;
    state->refused = 0;
    state->p_vv = 1.0f; // [m^2/s^2] nothing is known any more
    state->p_vb = 0.0f;
    state->p_bb = ground_speed_square(config->bias_start_m_s2);
    state->bias_m_s2 = state->value_accel_m_s2; // as if it rolled along, give or take
    state->misfit = 1.0f;
    state->other_alive = false;
    state->against = 0;
    state->leap_left = 0;
    state->rolls_ticks = 0;
    state->slide.held = 0;
    ground_speed_forget_agile(state);
}

static const float hardly_heard = 1.2f; // [1] of a value's trust, noise of a twentieth of the echo; assumed

// (22)
static bool is_at_most(const ground_speed_config_t *config, float heard_m_s, float trust)
{
    return (fixed_greater(trust, hardly_heard) && fixed_greater(config->slow_m_s, heard_m_s)) ||
           !fixed_greater(heard_m_s, config->lowest_m_s);
}

// (22): a value that tells of nothing but an upper limit, within which the track lies.
static __attribute__((noinline)) void keep_below(const ground_speed_config_t *config, ground_speed_state_t *state,
                                                 const ground_speed_past_t *window, float middle, float heard_m_s)
{
    ground_speed_track_t track = ground_speed_best_of(state);
    const float limit = ground_speed_square(heard_m_s);
    state->value_heard_m_s = heard_m_s;
    state->value_accel_m_s2 = window->accel_m_s2;
    state->value_m_s = heard_m_s;
    state->value_sign = middle < 0.0f ? -1.0f : 1.0f;
    state->value_tau_s = window->tau_s;
    state->value_change_m_s = window->change_m_s;
    ground_speed_watch_radar(config, state);
    ground_speed_remember(state);
    if (fixed_greater(ground_speed_spread_of(&track, window->tau_s), limit)) {
        ground_speed_correct(config, &track, -middle, window->tau_s, limit);
        ground_speed_keep_best(state, &track);
    }
    state->accepted = true;
    state->refused = 0;
}

static const float leap_sigmas2 = 9.0f, leap_least_m2_s2 = 0.0009f; // of (41); (3 cm/s)^2
static const float leap_stays = 0.5f, leap_moves = 1.5f;            // [1] of the leap, assumed
static const float leap_claim = 0.7f;                               // [1] of it, assumed: either may be right

enum { LOUD_AGAIN = 4 };   // of (42): a window's length
enum { LEAP_VALUES = 16 }; // two seconds, in which a line at the echo's edge is told by its steadiness, doppler.h

// (41): whether a value that is `left_m_s` off is one that the body cannot have made.
static __attribute__((noinline)) bool leaps(const ground_speed_config_t *config, ground_speed_state_t *state, float left_m_s,
                                            float noise_m2_s2, bool beyond)
{
    const float heard = state->value_heard_m_s;
    const float step_m_s = heard - state->leap_from_m_s;
    const float left = fabsf(left_m_s);
    state->leap_from_m_s = heard;
    if (state->leap_left > 0) {
        const bool stays = fixed_greater(left, leap_stays * state->leap_m_s) && fixed_greater(leap_moves * state->leap_m_s, left);
        state->leap_left = stays && !state->other_alive && state->rolls_ticks == 0 ? state->leap_left - 1 : 0;
    } else if (beyond && state->rolls && state->refused == 0 && state->accepted && !state->other_alive && state->rolls_ticks == 0 &&
               state->rolls_wait == 0 && fixed_greater(config->still_m_s, 0.0f) &&
               fixed_greater(ground_speed_bias_known_m2_s4, state->p_bb) &&
               fixed_greater(ground_speed_square(step_m_s), leap_sigmas2 * noise_m2_s2 + leap_least_m2_s2) &&
               !(ground_speed_body_departs(state) &&
                 fixed_greater(ground_speed_told_by_wheels(config, state, config->apart_told_m_s), 0.0f))) {
        state->leap_left = LEAP_VALUES;
        state->leap_m_s = left;
    }
    if (state->leap_left > 0) {
        const float claim_m_s = leap_claim * left;
        state->jolt_m_s = fixed_greater(claim_m_s, state->jolt_m_s) ? claim_m_s : state->jolt_m_s;
    }
    return state->leap_left > 0;
}

void ground_speed_update_doppler(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const ground_speed_past_t window = ground_speed_look_back(config, state, input->doppler_late_s);
    const float heard = fixed_clamp(input->doppler_m_s, 0.0f, config->speed_max_m_s);
    ground_speed_track_t track = ground_speed_best_of(state);
    const bool rolls = state->rolls_ticks > 0;
    ground_speed_past_t own = rolls ? ground_speed_rolled(state) : window;
    float middle = track.speed_m_s + own.tau_s * track.bias_m_s2 - own.change_m_s; // (3)
    const float own_accel = window.accel_m_s2 - track.bias_m_s2;
    const bool early = fixed_greater(0.0f, input->doppler_late_s);
    if (early && fabsf(own_accel) > early_accel_m_s2) {
        return; // w of (3) is that of a full window
    }
    state->value_at_most = !early && is_at_most(config, heard, input->doppler_trust);
    if (state->value_at_most && fixed_greater(heard, fabsf(middle))) {
        keep_below(config, state, &window, middle, heard);
        return;
    }
    state->alike_m_s += 0.25f * (fixed_clamp(fixed_finite(input->doppler_misfit), 0.0f, 10.0f) * heard - state->alike_m_s);
    state->value_heard_m_s = heard;
    state->value_accel_m_s2 = window.accel_m_s2;
    const float trust = fixed_clamp(fixed_finite(input->doppler_trust), 1.0f, 1000.0f) * state->misfit;
    state->value_trust = early ? early_noise * trust : trust;
    const ground_speed_value_t value = ground_speed_value_for(config, state, &track, rolls ? 0.0f : own_accel);
    const float measured = value.speed_m_s;
    const float noise = value.noise_m2_s2;
    float spread = ground_speed_spread_of(&track, own.tau_s) + noise;
    float nearest = middle < 0.0f ? -measured - middle : measured - middle;
    float cost = ground_speed_square(nearest) / spread;
    if (!input->doppler_relieved) {
        state->relieved = false;
    } else if (!state->relieved && cost > believed_cost) { // else the line had not told it
        begin_anew(config, state);
        state->relieved = true;
        track = ground_speed_best_of(state);
        middle = track.speed_m_s + own.tau_s * track.bias_m_s2 - own.change_m_s;
        nearest = middle < 0.0f ? -measured - middle : measured - middle;
        spread = ground_speed_spread_of(&track, own.tau_s) + noise;
        cost = ground_speed_square(nearest) / spread;
    }
    if (state->cover.on && state->loud < LOUD_AGAIN && fixed_greater(cost, ground_speed_square(config->gate_sigma))) {
        return; // (42): noise that passes for an echo
    }
    const bool leapt = leaps(config, state, nearest, noise, fixed_greater(cost, leap_sigmas2));
    if (leapt && (early || state->leap_left < LEAP_VALUES)) {
        return;
    }
    ground_speed_watch_radar(config, state);
    state->value_m_s = measured;
    state->value_noise_m2_s2 = noise;
    state->value_tau_s = window.tau_s;
    state->value_change_m_s = window.change_m_s;
    state->value_cost = cost + ground_speed_ln_rough(spread);
    state->value_scatter = cost;
    state->value_sign = middle < 0.0f ? -1.0f : 1.0f;
    state->value_parts = input->wheels_part;
    state->value_wheel_m_s = ground_speed_hint(config, input, measured);
    if (!early) {
        ground_speed_remember(state);
    }
    if (leapt) { // (15) may need it: a slide moves on
        return;
    }
    state->waits = 2;
    watch_bias(config, state, &track, nearest, spread);
    if (cost > ground_speed_square(config->gate_sigma)) {
        if (state->accepted && state->refused < config->gate_patience) { // before the first, the wheels alone have told, and little
            state->refused++;
            return;
        }
        track.p_vv = 1.0f; // [m^2/s^2] nothing is known any more
        track.p_vb = 0.0f;
        spread = ground_speed_spread_of(&track, own.tau_s) + noise;
        state->value_cost = ground_speed_square(nearest) / spread + ground_speed_ln_rough(spread);
    } else {
        watch_misfit(config, state, cost);
    }
    state->refused = 0;
    state->accepted = true;
    state->value_sign = ground_speed_choose_sign(config, state, &track, measured, middle, spread, state->value_wheel_m_s);
    state->waits = 2;
    ground_speed_correct(config, &track, state->value_sign * measured - middle, own.tau_s, noise);
    ground_speed_keep_best(state, &track);
}

enum { QUIET_BELIEVED = 4 }; // values, half a second of the reference's radar: longer than a fade of the echo, assumed

// A quiet echo says that the window's mean speed was too low to be heard.
void ground_speed_update_quiet(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const ground_speed_past_t window = ground_speed_look_back(config, state, input->doppler_late_s);
    ground_speed_track_t track = ground_speed_best_of(state);
    const float middle = track.speed_m_s + window.tau_s * track.bias_m_s2 - window.change_m_s;
    const float spread = ground_speed_spread_of(&track, window.tau_s) + config->quiet_noise_m2_s2;
    const bool fits = middle * middle <= config->gate_sigma * config->gate_sigma * spread; // else a fade of the echo
    // no wheels that would know better, or a body that was felt to stop, (38)
    const bool sure = (!fixed_greater(config->still_m_s, 0.0f) && state->quiet >= QUIET_BELIEVED) || state->cover.stopped;
    if (!fits && sure) {
        track.p_vv = 1.0f; // [m^2/s^2] nothing is known any more
        track.p_vb = 0.0f;
        track.p_bb = ground_speed_square(config->bias_start_m_s2);
        state->rolls_ticks = 0; // no slope began
    }
    if (fits || sure) {
        ground_speed_correct(config, &track, -middle, window.tau_s, config->quiet_noise_m2_s2);
        ground_speed_keep_best(state, &track);
        state->other_alive = false;
    }
}
