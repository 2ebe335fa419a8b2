#include "ground_speed.h"

#include "fixed.h"

#include <math.h>

static const float early_accel_m_s2 = 0.2f; // [m/s^2] assumed: the speed changes by 0.05 m/s at most in the first half window
static const float speed_max_m_s = 10.0f;
static const float p_vv_max = 4.0f; // [m^2/s^2] (2 m/s)^2: beyond it nothing more is unknown, assumed
static const float p_vv_min = 1e-8f;
static const float p_bb_min = 1e-8f;

void ground_speed_reset(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const ground_speed_state_t zero = {0};
    *state = zero;
    state->p_vv = 1.0f; // (1 m/s)^2: nothing is known
    state->p_bb = config->bias_start_m_s2 * config->bias_start_m_s2;
    state->speed_noise_m2_s2 = config->speed_noise_m2_s2;
    state->misfit = 1.0f;
}

static ground_speed_track_t best_of(const ground_speed_state_t *state)
{
    const ground_speed_track_t track = {state->speed_m_s, state->bias_m_s2, state->p_vv, state->p_vb, state->p_bb};
    return track;
}

static void keep_best(ground_speed_state_t *state, const ground_speed_track_t *track)
{
    state->speed_m_s = track->speed_m_s;
    state->bias_m_s2 = track->bias_m_s2;
    state->p_vv = track->p_vv;
    state->p_vb = track->p_vb;
    state->p_bb = track->p_bb;
}

// A covariance that is too large to mean anything more is shrunk as a whole, so it stays positive; what rounding leaves is mended.
static void hold(const ground_speed_config_t *config, ground_speed_track_t *track)
{
    const float bb_max = config->bias_max_m_s2 * config->bias_max_m_s2;
    track->speed_m_s = fixed_clamp(track->speed_m_s, -speed_max_m_s, speed_max_m_s);
    track->bias_m_s2 = fixed_clamp(track->bias_m_s2, -config->bias_max_m_s2, config->bias_max_m_s2);
    if (fixed_greater(track->p_vv, p_vv_max)) {
        track->p_vb *= p_vv_max / track->p_vv;
        track->p_vv = p_vv_max;
    }
    if (fixed_greater(track->p_bb, bb_max)) {
        track->p_vb *= bb_max / track->p_bb;
        track->p_bb = bb_max;
    }
    track->p_vv = fixed_clamp(track->p_vv, p_vv_min, p_vv_max);
    track->p_bb = fixed_clamp(track->p_bb, p_bb_min, bb_max > p_bb_min ? bb_max : p_bb_min);
    const float bound = track->p_vv * track->p_bb;
    if (!fixed_greater(bound, track->p_vb * track->p_vb)) {
        track->p_vb = 0.0f; // correlated beyond 1: rounding alone makes that, and independence claims less
    }
}

// (2) over `time_s`, in which V changes by `change_m_s`.
static void move(const ground_speed_config_t *config, ground_speed_track_t *track, float change_m_s, float time_s, float noise, float bias_noise)
{
    track->speed_m_s += change_m_s - track->bias_m_s2 * time_s;
    track->p_vv += time_s * (time_s * track->p_bb - 2.0f * track->p_vb) + noise;
    track->p_vb -= time_s * track->p_bb;
    track->p_bb += bias_noise;
    hold(config, track);
}

// Running integral of the raw accelerometer.
static void integrate(const ground_speed_config_t *config, ground_speed_state_t *state, float accel_m_s2)
{
    const float step = fixed_clamp(accel_m_s2 * config->tick_s * 1048576.0f + state->integral_rest_m_s, -1e8f, 1e8f); // 95 m/s
    const int32_t whole = (int32_t)step;
    state->integral_rest_m_s = step - (float)whole;
    const int32_t last = state->integral_q20[state->head];
    state->head = (state->head + 1) % GROUND_SPEED_HISTORY;
    state->integral_q20[state->head] = (int32_t)((uint32_t)last + (uint32_t)whole);
}

enum { NOISE_TICKS = 32, NOISE_EVERY = 16, NOISE_LOST_BITS = 4, NOISE_LIMIT = 8191 };
static const float noise_share = 0.125f; // [1] of a mean that enters the running one: 1.3 s of memory, 10 % of spread (assumed)

// (6) from the second differences of V, each limited to 0.125 m/s per tick: the sum stays below 2^31.
static void watch_noise(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    uint32_t sum = 0;
    int32_t newer = state->integral_q20[state->head];
    int32_t middle = state->integral_q20[((uint32_t)state->head - 1u) % GROUND_SPEED_HISTORY];
    for (uint32_t j = 2; j < NOISE_TICKS + 2; j++) {
        const int32_t older = state->integral_q20[((uint32_t)state->head - j) % GROUND_SPEED_HISTORY];
        const int32_t bend =
            fixed_wrap_difference(fixed_wrap_difference(newer, middle), fixed_wrap_difference(middle, older)) >> NOISE_LOST_BITS;
        const int32_t limited = bend < -NOISE_LIMIT ? -NOISE_LIMIT : bend > NOISE_LIMIT ? NOISE_LIMIT : bend;
        sum += (uint32_t)(limited * limited);
        newer = middle;
        middle = older;
    }
    const float mean = (float)sum * (1.0f / (2.0f * NOISE_TICKS * 65536.0f * 65536.0f)); // units of 2^-16 m/s
    state->accel_noise_m2_s2 += noise_share * (mean - state->accel_noise_m2_s2);
    state->speed_noise_m2_s2 = fixed_clamp(state->accel_noise_m2_s2, config->speed_noise_m2_s2, config->speed_noise_max_m2_s2);
}

// sum_j w_j (V(t) - V(t - s_j)) of (3).
static float window_change_m_s(const doppler_window_t *window, const ground_speed_state_t *state)
{
    const int32_t now = state->integral_q20[state->head];
    int32_t sum = 0; // Q19, each product truncated: 2^-20 m/s a tick at most
    for (uint32_t j = 0; j < (uint32_t)window->ticks; j++) {
        const int32_t then = state->integral_q20[((uint32_t)state->head - j) % GROUND_SPEED_HISTORY];
        sum += fixed_mul_low(fixed_wrap_difference(now, then), (uint32_t)window->weight_q15[j]);
    }
    return (float)sum * (1.0f / 524288.0f);
}

static void correct(const ground_speed_config_t *config, ground_speed_track_t *track, float innovation, float tau, float noise)
{
    const float hv = track->p_vv + tau * track->p_vb;
    const float hb = track->p_vb + tau * track->p_bb;
    const float total = hv + tau * hb + noise;
    const float per_total = 1.0f / total;
    const float kv = hv * per_total;
    const float kb = hb * per_total;
    track->speed_m_s += kv * innovation;
    track->bias_m_s2 += kb * innovation;
    track->p_vv -= kv * hv;
    track->p_vb -= kv * hb;
    track->p_bb -= kb * hb;
    hold(config, track);
}

// Variance of what (3) expects.
static float spread_of(const ground_speed_track_t *track, float tau) { return track->p_vv + tau * (2.0f * track->p_vb + tau * track->p_bb); }

static float square(float x) { return x * x; }

// The paper drives forward only; the sign of the wheels extends its filter to reverse.
static void update_paper(const ground_speed_config_t *config, ground_speed_state_t *state, float doppler_m_s, float wheel_m_s)
{
    const float sign = fixed_greater(0.0f, wheel_m_s) ? -1.0f : 1.0f;
    const float gain = state->p_vv / (state->p_vv + config->doppler_noise_m2_s2); // (1)
    state->speed_m_s += gain * (sign * fixed_clamp(doppler_m_s, 0.0f, 10.0f) - state->speed_m_s);
    state->p_vv -= gain * state->p_vv;
    state->p_vb = 0.0f;
    state->p_bb = 0.0f;
}

// What (3) needs of the past: the speed in the window's middle is v + tau b - change.
typedef struct {
    float tau_s;
    float change_m_s;
    float accel_m_s2; // mean raw acceleration over the window
} window_t;

static window_t look_back(const doppler_window_t *window, const ground_speed_state_t *state, float accel, float late_s)
{
    const int32_t oldest = (state->head - (window->ticks - 1) + GROUND_SPEED_HISTORY) % GROUND_SPEED_HISTORY;
    const float span = (float)fixed_wrap_difference(state->integral_q20[state->head], state->integral_q20[oldest]) * (1.0f / 1048576.0f);
    const window_t out = {
        .tau_s = window->tau_s + late_s,
        .change_m_s = window_change_m_s(window, state) + accel * late_s,
        .accel_m_s2 = span * window->per_s,
    };
    return out;
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
        hold(config, track);
    }
}

// (8)
static void watch_misfit(const ground_speed_config_t *config, ground_speed_state_t *state, float cost)
{
    const float limited = fixed_clamp(cost, 0.0f, square(config->gate_sigma));
    state->misfit = fixed_clamp(state->misfit * (1.0f + config->misfit_share * (limited - 1.0f)), 1.0f, config->misfit_max);
}

// 2 ln of the odds that the wheels give to forward travel.
static float wheel_odds(const ground_speed_config_t *config, float measured, float wheel_m_s)
{
    const float rim = fabsf(wheel_m_s);
    if (!fixed_greater(rim, config->still_m_s)) {
        return 0.0f;
    }
    const bool match = fixed_greater(measured, 0.5f * rim) && fixed_greater(1.15f * rim, measured); // slip of -0.15 to 0.5
    const float odds = match ? config->wheel_match : config->wheel_odds;
    return wheel_m_s < 0.0f ? -odds : odds;
}

// (9): takes the likelier sign, and follows the other too where it may be the right one.
static float choose_sign(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_track_t *track, float measured,
                         float middle, float spread, float wheel_m_s)
{
    const float told = 4.0f * measured * middle / spread; // 2 ln of the odds of +
    if (fabsf(told) >= config->sign_sure || (state->other_alive && state->odds < config->sign_sure)) {
        return middle < 0.0f ? -1.0f : 1.0f;
    }
    const float odds = told + wheel_odds(config, measured, wheel_m_s);
    const float sign = odds < 0.0f ? -1.0f : 1.0f;
    state->other = *track;
    state->other_alive = true;
    state->other_ticks = 0;
    state->other_q20 = state->integral_q20[state->head];
    state->odds = fabsf(odds);
    return sign;
}

static void update_doppler(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input, float accel)
{
    const window_t window = look_back(config->window, state, accel, fixed_clamp(fixed_finite(input->doppler_late_s), -0.25f, 1.0f));
    const float measured = fixed_clamp(input->doppler_m_s, 0.0f, 10.0f);
    ground_speed_track_t track = best_of(state);
    const float middle = track.speed_m_s + window.tau_s * track.bias_m_s2 - window.change_m_s; // (3)
    const float own_accel = window.accel_m_s2 - track.bias_m_s2;
    const bool early = input->doppler_late_s < 0.0f;
    if (early && fabsf(own_accel) > early_accel_m_s2) {
        return; // w of (3) is that of a full window
    }
    const float shorter =
        early ? 2.5f
              : 1.0f; // variance of an early value over a full window's: 2.3 to 2.7 for half the samples, 1.7 to 2.3 with the mirror image
    const float trust = fixed_clamp(fixed_finite(input->doppler_trust), 1.0f, 1000.0f) * state->misfit;
    const float accel2 = fixed_clamp(own_accel * own_accel - track.p_bb, 0.0f, 100.0f);
    const float noise =
        trust * shorter * (config->doppler_noise_m2_s2 + config->doppler_noise_m_s * measured) + config->doppler_accel_s2 * accel2;
    float spread = spread_of(&track, window.tau_s) + noise;
    const float nearest = measured - fabsf(middle);
    const float cost = nearest * nearest / spread;
    watch_misfit(config, state, cost);
    if (cost > square(config->gate_sigma)) {
        state->refused += state->refused < 1000 ? 1 : 0;
        if (state->refused < config->gate_patience) {
            return;
        }
        const float s = config->step_s;
        track.p_vv += config->step_m2_s4 * s * s; // (7)
        track.p_vb -= config->step_m2_s4 * s;
        track.p_bb += config->step_m2_s4;
        hold(config, &track);
        spread = spread_of(&track, window.tau_s) + noise;
        if (nearest * nearest > square(config->gate_sigma) * spread) {
            track.p_vv = 1.0f; // [m^2/s^2] nothing is known any more
            track.p_vb = 0.0f;
            spread = spread_of(&track, window.tau_s) + noise;
        }
    }
    state->refused = 0;
    const float sign = choose_sign(config, state, &track, measured, middle, spread, input->wheel_m_s);
    const float innovation = sign * measured - middle;
    watch_bias(config, state, &track, innovation, spread);
    correct(config, &track, innovation, window.tau_s, noise);
    keep_best(state, &track);
    state->value_waits = state->other_alive;
    state->value_m_s = measured;
    state->value_noise_m2_s2 = noise;
    state->value_tau_s = window.tau_s;
    state->value_change_m_s = window.change_m_s;
    state->value_cost = square(innovation) / spread;
    state->value_sign = sign;
}

static void move_other(const ground_speed_config_t *config, ground_speed_state_t *state, int32_t until_q20, int32_t ticks)
{
    const float change = (float)fixed_wrap_difference(until_q20, state->other_q20) * (1.0f / 1048576.0f);
    const float n = (float)ticks;
    move(config, &state->other, change, n * config->tick_s, n * state->speed_noise_m2_s2, n * config->bias_noise_m2_s4);
    state->other_q20 = until_q20;
    state->other_ticks = 0;
}

// 1/(1 + (1 + x/16)^8), x = 2 ln of the odds: at least 1/(1 + exp(x/2)), the probability of the less likely sign.
static float doubt_of(float odds)
{
    const float a = 1.0f + fixed_clamp(odds, 0.0f, 100.0f) * (1.0f / 16.0f);
    return 1.0f / (1.0f + square(square(square(a))));
}

// The other sign sees the value one tick later, in a tick that has time.
static void update_other(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    state->value_waits = false;
    move_other(config, state, state->integral_q20[((uint32_t)state->head - 1u) % GROUND_SPEED_HISTORY], state->other_ticks - 1);
    state->other_ticks = 1;
    const float middle = state->other.speed_m_s + state->value_tau_s * state->other.bias_m_s2 - state->value_change_m_s;
    const float spread = spread_of(&state->other, state->value_tau_s) + state->value_noise_m2_s2;
    const bool sure = fabsf(4.0f * state->value_m_s * middle / spread) >= config->sign_sure;
    const float sign = !sure ? -state->value_sign : middle < 0.0f ? -1.0f : 1.0f;
    const float innovation = sign * state->value_m_s - middle;
    const float gate2 = square(config->gate_sigma);
    const float cost = fixed_clamp(square(innovation) / spread, 0.0f, gate2);
    state->odds += cost - fixed_clamp(state->value_cost, 0.0f, gate2);
    correct(config, &state->other, innovation, state->value_tau_s, state->value_noise_m2_s2);
    if (state->odds < 0.0f) {
        const ground_speed_track_t best = best_of(state);
        move_other(config, state, state->integral_q20[state->head], state->other_ticks);
        keep_best(state, &state->other);
        state->other = best;
        state->odds = -state->odds;
    }
    const float apart = state->speed_m_s - state->other.speed_m_s;
    const bool one = !fixed_greater(apart * apart, 0.5f * (state->p_vv + state->other.p_vv));
    state->other_alive = !one && state->odds < 2.0f * config->sign_sure;
    const float doubt = doubt_of(state->odds);
    state->doubt_m2_s2 = state->other_alive ? doubt * (1.0f - doubt) * apart * apart : 0.0f;
}

// A quiet echo says that the window's mean speed was too low to be heard.
static void update_quiet(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input, float accel)
{
    const window_t window = look_back(config->window, state, accel, fixed_clamp(fixed_finite(input->doppler_late_s), -0.25f, 1.0f));
    ground_speed_track_t track = best_of(state);
    const float middle = track.speed_m_s + window.tau_s * track.bias_m_s2 - window.change_m_s;
    const float spread = spread_of(&track, window.tau_s) + config->quiet_noise_m2_s2;
    if (middle * middle <= config->gate_sigma * config->gate_sigma * spread) { // else a fade of the echo
        correct(config, &track, -middle, window.tau_s, config->quiet_noise_m2_s2);
        keep_best(state, &track);
        state->other_alive = false;
    }
}

// Standing: wheels at rest for a while, and either no echo or a speed so low that blocked wheels end it at once.
static bool is_standing(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const bool wheels_rest = state->still_ticks >= config->still_needed && state->loud < config->loud_needed;
    const bool slow = fabsf(state->speed_m_s) < config->slow_m_s && state->p_vv < square(config->slow_m_s);
    return wheels_rest && (state->quiet >= config->quiet_needed || slow);
}

static const float ears_open_m_s = 0.1f; // [m/s] rim speed above which a front end without any noise is dead, not a rover that stands

static void count_values(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const bool loud = !input->doppler_quiet && fixed_greater(input->doppler_m_s, config->slow_m_s);
    const bool deaf = input->doppler_dead && fixed_greater(fabsf(input->wheel_m_s), ears_open_m_s);
    state->quiet = input->doppler_quiet && !deaf ? state->quiet + (state->quiet < 1000 ? 1 : 0) : 0;
    state->loud = loud ? state->loud + (state->loud < 1000 ? 1 : 0) : 0;
}

// Where nothing is known, the wheels tell a little: the rim's speed, give or take what slips.
static void ask_wheels(const ground_speed_config_t *config, ground_speed_state_t *state, float wheel_m_s)
{
    const float noise = square(config->wheel_noise_m_s + config->wheel_slip * fabsf(wheel_m_s));
    if (fixed_greater(state->p_vv, 2.0f * noise)) {
        ground_speed_track_t track = best_of(state);
        correct(config, &track, wheel_m_s - track.speed_m_s, 0.0f, noise);
        keep_best(state, &track);
        state->other_alive = false;
    }
}

enum { STD_EVERY = 8 };

static void state_std(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    // (3) does not see what the accelerometer's noise has done since the window's middle: V carries it on both sides.
    const float unseen =
        config->method == GROUND_SPEED_PAPER || state->standstill ? 0.0f : state->speed_noise_m2_s2 * config->window->tau_ticks;
    const float variance = state->p_vv + unseen + (state->other_alive ? state->doubt_m2_s2 : 0.0f);
    state->std_m_s = sqrtf(variance > 0.0f ? variance : 0.0f);
}

static void step_ours(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input, float accel,
                      bool fresh)
{
    const uint32_t turn = (uint32_t)state->head % NOISE_EVERY;
    if (fresh) {
        count_values(config, state, input);
    } else if (state->value_waits) {
        update_other(config, state);
    } else if (turn == 0u && config->speed_noise_max_m2_s2 > config->speed_noise_m2_s2) {
        watch_noise(config, state); // not in the tick of a value, which is the longest
    } else if (turn % 8u == 3u) {
        ask_wheels(config, state, fixed_clamp(fixed_finite(input->wheel_m_s), -speed_max_m_s, speed_max_m_s));
    }
    state->standstill = is_standing(config, state);
    if (state->standstill) {
        ground_speed_track_t track = best_of(state);
        correct(config, &track, -track.speed_m_s, 0.0f, config->standing_noise_m2_s2);
        keep_best(state, &track);
        state->other_alive = false;
        state->value_waits = false;
    } else if (fresh && state->quiet >= config->quiet_needed) {
        update_quiet(config, state, input, accel);
    } else if (fresh && !input->doppler_quiet) {
        update_doppler(config, state, input, accel);
    }
}

ground_speed_output_t ground_speed_step(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const float accel = input->accel_valid ? fixed_clamp(fixed_finite(input->accel_x_m_s2), -100.0f, 100.0f) : state->bias_m_s2;
    const bool fresh = input->doppler_fresh && fixed_is_finite(input->doppler_m_s);
    const bool rest = fixed_greater(config->still_m_s, fabsf(fixed_finite(input->wheel_m_s)));
    state->still_ticks = rest ? state->still_ticks + (state->still_ticks < 1000 ? 1 : 0) : 0;
    integrate(config, state, accel);
    state->other_ticks += state->other_ticks < 1000 ? 1 : 0;
    ground_speed_track_t track = best_of(state);
    move(config, &track, accel * config->tick_s, config->tick_s, input->accel_valid ? state->speed_noise_m2_s2 : config->blind_noise_m2_s2,
         config->bias_noise_m2_s4);
    keep_best(state, &track);
    if (config->method == GROUND_SPEED_PAPER) {
        state->standstill = false;
        if (fresh) {
            update_paper(config, state, input->doppler_m_s, input->wheel_m_s);
        }
    } else {
        step_ours(config, state, input, accel, fresh);
    }
    if (fresh || state->standstill || state->std_m_s == 0.0f || (uint32_t)state->head % STD_EVERY == 5u) { // a root is dear
        state_std(config, state);
    }
    const ground_speed_output_t out = {
        .speed_m_s = state->speed_m_s,
        .std_m_s = state->std_m_s,
        .bias_m_s2 = state->bias_m_s2,
        .standstill = state->standstill,
    };
    return out;
}
