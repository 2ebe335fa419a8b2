#include "ground_speed.h"

#include "fixed.h"

#include <math.h>

static const float early_accel_m_s2 = 0.2f; // [m/s^2] assumed: the speed changes by 0.05 m/s at most in the first half window
static const float p_vv_max = 4.0f;         // [m^2/s^2] (2 m/s)^2: beyond it nothing more is unknown, assumed
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
    track->speed_m_s = fixed_clamp(track->speed_m_s, -config->speed_max_m_s, config->speed_max_m_s);
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
static void move(const ground_speed_config_t *config, ground_speed_track_t *track, float change_m_s, float time_s, float noise,
                 float bias_noise)
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
    const float step = fixed_clamp(accel_m_s2 * config->tick_q20_s + state->integral_rest_m_s, -1e8f, 1e8f); // 95 m/s
    const int32_t whole = (int32_t)step;
    state->integral_rest_m_s = step - (float)whole;
    const int32_t last = state->integral_q20[state->head];
    state->head = (state->head + 1) % GROUND_SPEED_HISTORY;
    state->integral_q20[state->head] = (int32_t)((uint32_t)last + (uint32_t)whole);
}

enum { NOISE_TICKS = 32, NOISE_LOST_BITS = 4, NOISE_LIMIT = 8191 };
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

// sum_j w_j (V(t) - V(t - s_j)) of (3), t `ago` ticks before now.
static float window_change_m_s(const doppler_window_t *window, const ground_speed_state_t *state, uint32_t ago)
{
    const uint32_t head = (uint32_t)state->head - ago;
    const int32_t now = state->integral_q20[head % GROUND_SPEED_HISTORY];
    int32_t sum = 0; // Q19, each product truncated: 2^-20 m/s a tick at most
    for (uint32_t j = 0; j < (uint32_t)window->ticks; j++) {
        const int32_t then = state->integral_q20[(head - j) % GROUND_SPEED_HISTORY];
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
static float spread_of(const ground_speed_track_t *track, float tau)
{
    return track->p_vv + tau * (2.0f * track->p_vb + tau * track->p_bb);
}

static float square(float x) { return x * x; }

// The paper drives forward only; the sign of the wheels extends its filter to reverse.
static void update_paper(const ground_speed_config_t *config, ground_speed_state_t *state, float doppler_m_s, float wheel_m_s)
{
    const float sign = fixed_greater(0.0f, wheel_m_s) ? -1.0f : 1.0f;
    const float gain = state->p_vv / (state->p_vv + config->doppler_noise_m2_s2); // (1)
    state->speed_m_s += gain * (sign * fixed_clamp(doppler_m_s, 0.0f, config->speed_max_m_s) - state->speed_m_s);
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

static window_t look_back(const ground_speed_config_t *config, const ground_speed_state_t *state, float late)
{
    const doppler_window_t *window = config->window;
    const float late_s = fixed_clamp(fixed_finite(late), -0.25f, 0.12f);
    const int32_t ago =
        late_s > 0.0f ? (int32_t)(late_s * config->per_tick_1_s) : 0; // whole ticks between the window's end and now: 12 at most
    const uint32_t head = (uint32_t)(state->head - ago);
    const uint32_t oldest = head - (uint32_t)(window->ticks - 1);
    const int32_t then = state->integral_q20[head % GROUND_SPEED_HISTORY];
    const int32_t span = fixed_wrap_difference(then, state->integral_q20[oldest % GROUND_SPEED_HISTORY]);
    const int32_t since = fixed_wrap_difference(state->integral_q20[state->head], then);
    window_t out = {.tau_s = window->tau_s + late_s, .accel_m_s2 = (float)span * (1.0f / 1048576.0f) * window->per_s};
    out.change_m_s = window_change_m_s(window, state, (uint32_t)ago) + (float)since * (1.0f / 1048576.0f) +
                     out.accel_m_s2 * (late_s - (float)ago * config->tick_s);
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
    const bool match = fixed_greater(measured, 0.5f * rim) && fixed_greater(1.5f * rim, measured); // slip of -0.33 to 0.5
    const float odds = match ? config->wheel_match : config->wheel_odds;
    return wheel_m_s < 0.0f ? -odds : odds;
}

static void split(ground_speed_state_t *state, ground_speed_side_t *side, const ground_speed_track_t *track)
{
    side->at = *track;
    side->ticks = 0;
    side->q20 = state->integral_q20[state->head];
}

// 1 where the wheels turn with the track at a speed that agrees with the radar's, -1 where they turn against it, else 0.
static int32_t with_wheels(const ground_speed_config_t *config, const ground_speed_state_t *state, float measured, float wheel_m_s)
{
    const bool rolls = fixed_greater(1.15f * fabsf(wheel_m_s), measured); // what overtakes its wheels is not pushed by them
    const bool match = rolls && fabsf(wheel_odds(config, measured, wheel_m_s)) >= config->wheel_match;
    return !match ? 0 : (wheel_m_s < 0.0f) == (state->speed_m_s < 0.0f) ? 1 : -1;
}

// A sign that was lost at a restart is the same at constant speed as the right one; wheels that turn against it all the time ask anew.
static void ask_again(const ground_speed_config_t *config, ground_speed_state_t *state, float measured, float wheel_m_s)
{
    state->against = with_wheels(config, state, measured, wheel_m_s) >= 0 ? 0 : state->against + (state->against < 1000 ? 1 : 0);
    if (state->against >= config->against_values && !state->other_alive) {
        const ground_speed_track_t best = best_of(state);
        split(state, &state->other, &best);
        state->other.at.speed_m_s = -best.speed_m_s;
        state->other.at.p_vb = 0.0f;
        state->odds = config->against_odds;
        state->other_alive = true;
        state->against = 0;
    }
}

// (9): takes the likelier sign, and follows the other too where it may be the right one.
static float choose_sign(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_track_t *track,
                         float measured, float middle, float spread, float wheel_m_s)
{
    const float told = 4.0f * measured * middle / spread; // 2 ln of the odds of +
    if (fabsf(told) >= config->sign_sure || state->other_alive) {
        return middle < 0.0f ? -1.0f : 1.0f;
    }
    const float odds = told + wheel_odds(config, measured, wheel_m_s);
    split(state, &state->other, track);
    state->odds = fabsf(odds);
    state->other_alive = state->odds < config->sign_sure;
    return odds < 0.0f ? -1.0f : 1.0f;
}

// ln |x| to within 0.06: exponent, and mantissa as a straight line; -88 for 0.
static float ln_rough(float x) { return (float)((int32_t)(fixed_bits(x) & 0x7fffffffu) - 0x3f800000) * (0.693147f / 8388608.0f); }

static void update_doppler(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const window_t window = look_back(config, state, input->doppler_late_s);
    const float heard = fixed_clamp(input->doppler_m_s, 0.0f, config->speed_max_m_s);
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
    state->alike_m_s += 0.25f * (fixed_clamp(fixed_finite(input->doppler_misfit), 0.0f, 10.0f) * heard - state->alike_m_s);
    const float trust = fixed_clamp(fixed_finite(input->doppler_trust), 1.0f, 1000.0f) * state->misfit;
    const float accel2 = fixed_clamp(own_accel * own_accel - track.p_bb, 0.0f, 100.0f);
    const float heard2 = heard * heard;
    const float less2 = fixed_clamp(square(config->doppler_spread_s) * accel2, 0.0f, 0.5f * heard2);
    const float measured = fixed_greater(less2, 0.0f) ? sqrtf(heard2 - less2) : heard; // (11)
    const float noise =
        trust * shorter * (config->doppler_noise_m2_s2 + config->doppler_noise_m_s * heard) + config->doppler_accel_s2 * accel2;
    float spread = spread_of(&track, window.tau_s) + noise;
    const float nearest = middle < 0.0f ? -measured - middle : measured - middle;
    const float cost = square(nearest) / spread;
    state->waits = 2;
    state->value_m_s = measured;
    state->value_noise_m2_s2 = noise;
    state->value_tau_s = window.tau_s;
    state->value_change_m_s = window.change_m_s;
    state->value_cost = cost + ln_rough(spread);
    state->value_sign = middle < 0.0f ? -1.0f : 1.0f;
    state->value_wheel_m_s = input->wheel_m_s;
    watch_bias(config, state, &track, nearest, spread);
    if (cost > square(config->gate_sigma)) {
        if (state->refused < config->gate_patience) {
            state->refused++;
            return;
        }
        track.p_vv = 1.0f; // [m^2/s^2] nothing is known any more
        track.p_vb = 0.0f;
        spread = spread_of(&track, window.tau_s) + noise;
    } else {
        watch_misfit(config, state, cost);
    }
    state->refused = 0;
    state->value_sign = choose_sign(config, state, &track, measured, middle, spread, input->wheel_m_s);
    state->waits = 2;
    correct(config, &track, state->value_sign * measured - middle, window.tau_s, noise);
    keep_best(state, &track);
    ask_again(config, state, measured, input->wheel_m_s);
}

static void move_side(const ground_speed_config_t *config, const ground_speed_state_t *state, ground_speed_side_t *side, int32_t ticks_ago)
{
    const int32_t until = state->integral_q20[((uint32_t)(state->head - ticks_ago)) % GROUND_SPEED_HISTORY];
    const float change = (float)fixed_wrap_difference(until, side->q20) * (1.0f / 1048576.0f);
    const float n = (float)(side->ticks - ticks_ago);
    move(config, &side->at, change, n * config->tick_s, n * state->speed_noise_m2_s2, n * config->bias_noise_m2_s4);
    side->q20 = until;
    side->ticks = ticks_ago;
}

typedef struct {
    float middle_m_s, spread_m2_s2;
    float told; // 2 ln of the odds of +
} expected_t;

// What a side expects of the value that the best saw `ticks_ago`.
static expected_t expect(const ground_speed_config_t *config, const ground_speed_state_t *state, ground_speed_side_t *side,
                         int32_t ticks_ago)
{
    move_side(config, state, side, ticks_ago);
    expected_t out;
    out.middle_m_s = side->at.speed_m_s + state->value_tau_s * side->at.bias_m_s2 - state->value_change_m_s;
    out.spread_m2_s2 = spread_of(&side->at, state->value_tau_s) + state->value_noise_m2_s2;
    out.told = 4.0f * state->value_m_s * out.middle_m_s / out.spread_m2_s2;
    return out;
}

// Corrects it with that sign; returns e^2/S + ln S.
static float see(const ground_speed_config_t *config, const ground_speed_state_t *state, ground_speed_side_t *side,
                 const expected_t *expected, float sign)
{
    const float innovation = sign * state->value_m_s - expected->middle_m_s;
    correct(config, &side->at, innovation, state->value_tau_s, state->value_noise_m2_s2);
    return square(innovation) / expected->spread_m2_s2 + ln_rough(expected->spread_m2_s2);
}

// 1/(1 + (1 + x/16)^8), x = 2 ln of the odds: at least 1/(1 + exp(x/2)), the probability of the less likely sign.
static float doubt_of(float odds)
{
    const float a = 1.0f + fixed_clamp(odds, 0.0f, 100.0f) * (1.0f / 16.0f);
    return 1.0f / (1.0f + square(square(square(a))));
}

static const float most_told = 12.0f; // [1] of one value about a sign: no single value decides (assumed)

// The other sign sees the value one tick later, in a tick that has time.
static void update_other(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const expected_t expected = expect(config, state, &state->other, 1);
    const bool sure = fabsf(expected.told) >= config->sign_sure;
    const float sign = !sure ? -state->value_sign : expected.middle_m_s < 0.0f ? -1.0f : 1.0f;
    const float cost = see(config, state, &state->other, &expected, sign);
    state->odds += fixed_clamp(cost - state->value_cost, -most_told, most_told) +
                   config->wheel_pull * (float)with_wheels(config, state, state->value_m_s, state->value_wheel_m_s);
    if (state->odds < 0.0f) {
        const ground_speed_track_t best = best_of(state);
        move_side(config, state, &state->other, 0);
        keep_best(state, &state->other.at);
        split(state, &state->other, &best);
        state->odds = -state->odds;
    }
    const float apart = state->speed_m_s - state->other.at.speed_m_s;
    const bool one = !fixed_greater(apart * apart, 0.5f * (state->p_vv + state->other.at.p_vv));
    state->other_alive = !one && state->odds < config->sign_sure;
    const float doubt = doubt_of(state->odds);
    state->doubt_m2_s2 = state->other_alive ? doubt * (1.0f - doubt) * apart * apart : 0.0f;
}

// X^2 of (10) beyond `least` and twice what the accelerometer's noise makes of it: Qv T/(2 (T/0.25 s)) = 12.5 Qv.
static float told_by_wheels(const ground_speed_config_t *config, const ground_speed_state_t *state, float least_m_s)
{
    return square(state->apart_m_s) - square(least_m_s) - config->apart_noise * state->speed_noise_m2_s2;
}

// (7), two ticks later. Its state is that of the window's middle, [v + tau b - change, b], which Doppler values see alone: a bias that
// jumps within the window enters it as the window does.
static ground_speed_track_t to_middle(const ground_speed_track_t *track, float tau, float change_m_s)
{
    const ground_speed_track_t out = {
        .speed_m_s = track->speed_m_s + tau * track->bias_m_s2 - change_m_s,
        .bias_m_s2 = track->bias_m_s2,
        .p_vv = spread_of(track, tau),
        .p_vb = track->p_vb + tau * track->p_bb,
        .p_bb = track->p_bb,
    };
    return out;
}

// The window's middle of the value that waits: V there, as the mean over the window.
static int32_t middle_q20(const ground_speed_state_t *state)
{
    const int32_t then = state->integral_q20[((uint32_t)state->head - 2u) % GROUND_SPEED_HISTORY];
    return (int32_t)((uint32_t)then - (uint32_t)(int32_t)(fixed_clamp(state->value_change_m_s, -1000.0f, 1000.0f) * 1048576.0f));
}

static void start_agile(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const float ago = 2.0f * config->tick_s;
    const float change =
        (float)fixed_wrap_difference(state->integral_q20[state->head], middle_q20(state)) * (1.0f / 1048576.0f); // up to now
    const ground_speed_track_t best = best_of(state);
    state->agile.at = to_middle(&best, state->value_tau_s + ago, change);
    state->agile.at.p_bb += config->agile_m2_s4;
    hold(config, &state->agile.at);
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
    hold(config, &track);
    keep_best(state, &track);
}

static void update_agile(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    if (state->agile_left <= 0) {
        start_agile(config, state);
        return;
    }
    state->agile_left--;
    ground_speed_track_t *at = &state->agile.at;
    const float ticks = (float)(state->agile.ticks - 2);
    const int32_t q20 = middle_q20(state);
    move(config, at, (float)fixed_wrap_difference(q20, state->agile.q20) * (1.0f / 1048576.0f), ticks * config->tick_s,
         ticks * state->speed_noise_m2_s2, config->agile_m2_s4);
    state->agile.q20 = q20;
    state->agile.ticks = 2;
    const float spread = at->p_vv + state->value_noise_m2_s2;
    const float told = 4.0f * state->value_m_s * at->speed_m_s / spread;
    const bool sure = fabsf(told) >= config->sign_sure;
    const float odds = told + (sure ? 0.0f : wheel_odds(config, state->value_m_s, state->value_wheel_m_s));
    const float sign = odds < 0.0f ? -1.0f : 1.0f;
    const float innovation = sign * state->value_m_s - at->speed_m_s;
    ground_speed_track_t mirrored = *at;
    const float cost = square(innovation) / spread + ln_rough(spread);
    correct(config, at, innovation, 0.0f, state->value_noise_m2_s2);
    state->agile_sum = fixed_clamp(
        state->agile_sum + fixed_clamp(state->value_cost - cost, -100.0f, config->agile_most) - config->agile_drift, 0.0f, 1000.0f);
    const bool apart = told_by_wheels(config, state, config->apart_told_m_s) > 0.0f;
    if (state->agile_sum > (apart ? config->agile_sure : config->agile_limit)) {
        take_agile(config, state, at);
        state->other_alive = fabsf(odds) < config->sign_sure;
        if (state->other_alive) {
            const ground_speed_track_t best = best_of(state);
            correct(config, &mirrored, -sign * state->value_m_s - mirrored.speed_m_s, 0.0f, state->value_noise_m2_s2);
            take_agile(config, state, &mirrored);
            const ground_speed_track_t other = best_of(state);
            split(state, &state->other, &other);
            keep_best(state, &best);
            state->odds = fabsf(odds);
        }
        state->agile_sum = 0.0f;
        state->agile_left = 0;
        state->refused = 0;
        state->one_sided = 0.0f;
    } else if (state->agile_sum > 0.0f && state->agile_left == 0) {
        state->agile_left = 1; // not while it is about to win
    }
}

// A quiet echo says that the window's mean speed was too low to be heard.
static void update_quiet(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const window_t window = look_back(config, state, input->doppler_late_s);
    ground_speed_track_t track = best_of(state);
    const float middle = track.speed_m_s + window.tau_s * track.bias_m_s2 - window.change_m_s;
    const float spread = spread_of(&track, window.tau_s) + config->quiet_noise_m2_s2;
    if (middle * middle <= config->gate_sigma * config->gate_sigma * spread) { // else a fade of the echo
        correct(config, &track, -middle, window.tau_s, config->quiet_noise_m2_s2);
        keep_best(state, &track);
        state->other_alive = false;
    }
}

// Standing: wheels at rest for a while, and either no echo or a speed so low that blocked wheels end it at once; or wheels at rest for long
// while nothing that the radar says tells of a speed: the accelerometer alone must not drive a parked rover away.
static bool is_standing(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const bool heard = state->unheard_ticks < config->parked_needed; // what was loud before that tells nothing any more
    if (state->still_ticks < config->still_needed || (heard && state->loud >= config->loud_needed)) {
        return false;
    }
    const bool slow = fabsf(state->speed_m_s) < config->slow_m_s && state->p_vv < square(config->slow_m_s);
    const bool parked = state->still_ticks >= config->parked_needed && (!heard || state->loud == 0);
    return slow || parked || state->quiet >= config->quiet_needed;
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
    if (fixed_greater(state->p_vv, 1.2f * noise)) {
        ground_speed_track_t track = best_of(state);
        correct(config, &track, wheel_m_s - track.speed_m_s, 0.0f, noise);
        keep_best(state, &track);
        state->other_alive = false;
    }
}

// (10), over the ticks since the last time: it waits in ticks that are busy.
static void watch_wheels(const ground_speed_config_t *config, ground_speed_state_t *state, float wheel_m_s)
{
    const float wheel = fixed_clamp(fixed_finite(wheel_m_s), -config->speed_max_m_s, config->speed_max_m_s);
    const int32_t now = state->integral_q20[state->head];
    const float ticks = (float)state->wheel_ticks;
    const float change = (float)fixed_wrap_difference(now, state->wheel_q20) * (1.0f / 1048576.0f) -
                         state->bias_m_s2 * config->tick_s * ticks - (wheel - state->wheel_m_s);
    const float keep = 1.0f - config->apart_forget * (ticks < 10.0f ? ticks : 10.0f);
    state->apart_m_s = keep * fixed_clamp(state->apart_m_s + change, -config->speed_max_m_s, config->speed_max_m_s);
    state->wheel_m_s = wheel;
    state->wheel_q20 = now;
    state->wheel_ticks = 0;
}

static void state_std(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    // (3) does not see what the accelerometer's noise has done since the window's middle: V carries it on both sides.
    const float unseen =
        config->method == GROUND_SPEED_PAPER || state->standstill ? 0.0f : state->speed_noise_m2_s2 * config->window->tau_ticks;
    const float apart2 = fixed_clamp(told_by_wheels(config, state, config->apart_least_m_s), 0.0f, config->speed_max_m_s);
    const float slope = config->method == GROUND_SPEED_PAPER || state->standstill ? 0.0f : config->apart_share * apart2;
    const float alike = config->method == GROUND_SPEED_PAPER || state->standstill ? 0.0f : square(state->alike_m_s);
    const float variance = state->p_vv + unseen + slope + alike + (state->other_alive ? state->doubt_m2_s2 : 0.0f);
    state->std_m_s = sqrtf(variance > 0.0f ? variance : 0.0f);
}

// What need not be done in every tick, one after the other in ticks that have time; all of it 8 times a second or more.
enum { CHORES = 8 };

static void do_chore(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    state->chore = (state->chore + 1u) % (2u * CHORES);
    if (state->chore == 0u && config->speed_noise_max_m2_s2 > config->speed_noise_m2_s2) {
        watch_noise(config, state);
    } else if (state->chore % CHORES == 3u) {
        ask_wheels(config, state, fixed_clamp(fixed_finite(input->wheel_m_s), -config->speed_max_m_s, config->speed_max_m_s));
    } else if (state->chore % CHORES == 5u) {
        state_std(config, state);
    } else if (state->chore % CHORES == 6u) {
        ground_speed_track_t track = best_of(state);
        hold(config, &track);
        keep_best(state, &track);
    }
}

static void step_ours(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input, bool fresh)
{
    if (fresh) {
        count_values(config, state, input);
    } else if (state->waits > 1) {
        state->waits = 1;
        if (state->other_alive) {
            update_other(config, state);
        }
    } else if (state->waits > 0) {
        state->waits = 0;
        update_agile(config, state);
    } else if (!input->busy) {
        do_chore(config, state, input);
    }
    state->standstill = is_standing(config, state);
    if (state->standstill) {
        ground_speed_track_t track = best_of(state);
        correct(config, &track, -track.speed_m_s, 0.0f, config->standing_noise_m2_s2);
        keep_best(state, &track);
        state->other_alive = false;
        state->waits = 0;
        state->agile_left = 0;
        state->agile_sum = 0.0f;
    } else if (fresh && state->quiet >= config->quiet_needed) {
        update_quiet(config, state, input);
    } else if (fresh && !input->doppler_quiet) {
        update_doppler(config, state, input);
    }
}

enum { MISSED_MAX = 16 }; // ticks; longer gaps are for safety

static void tick(const ground_speed_config_t *config, ground_speed_state_t *state, float accel, float noise)
{
    integrate(config, state, accel);
    state->other.ticks += state->other.ticks < 1000 ? 1 : 0;
    state->agile.ticks += state->agile.ticks < 1000 ? 1 : 0;
    state->wheel_ticks += state->wheel_ticks < 1000 ? 1 : 0;
    state->speed_m_s += (accel - state->bias_m_s2) * config->tick_s; // (2)
    state->behind_ticks += state->behind_ticks < 1000 ? 1 : 0;
    state->behind_noise_m2_s2 = noise;
}

// The covariance of (2), for the ticks since the last time. It waits in ticks that are busy; hold is a chore, and after every correction.
static void catch_up(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const float n = (float)state->behind_ticks;
    const float time_s = n * config->tick_s;
    const float lost = time_s * state->p_bb;
    state->p_vv += time_s * (lost - 2.0f * state->p_vb) + n * state->behind_noise_m2_s2;
    state->p_vb -= lost;
    state->p_bb += n * config->bias_noise_m2_s4;
    state->behind_ticks = 0;
}

ground_speed_output_t ground_speed_step(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const float accel = input->accel_valid ? fixed_clamp(fixed_finite(input->accel_x_m_s2), -100.0f, 100.0f) : state->bias_m_s2;
    const bool fresh = input->doppler_fresh && fixed_is_finite(input->doppler_m_s);
    const bool rest = fixed_greater(config->still_m_s, fabsf(fixed_finite(input->wheel_m_s)));
    state->unheard_ticks = fresh ? 0 : state->unheard_ticks + (state->unheard_ticks < 1000 ? 1 : 0);
    state->still_ticks = rest ? state->still_ticks + (state->still_ticks < 1000 ? 1 : 0) : 0;
    const float noise = input->accel_valid ? state->speed_noise_m2_s2 : config->blind_noise_m2_s2;
    const bool first = fixed_bits(state->std_m_s) == 0u; // nothing was missed before
    uint32_t missed = !first && input->elapsed_ticks > 1u ? input->elapsed_ticks - 1u : 0u;
    missed = missed < MISSED_MAX ? missed : MISSED_MAX;
    for (uint32_t i = 0; i < missed; i++) { // nothing is known of their acceleration: the newest one stands for them
        tick(config, state, accel, config->blind_noise_m2_s2);
    }
    if (missed > 0u) {
        catch_up(config, state);
    }
    tick(config, state, accel, noise);
    if (!input->busy || fresh) {
        catch_up(config, state);
        watch_wheels(config, state, input->wheel_m_s);
    }
    if (config->method == GROUND_SPEED_PAPER) {
        state->standstill = false;
        if (fresh) {
            update_paper(config, state, input->doppler_m_s, input->wheel_m_s);
        }
    } else {
        step_ours(config, state, input, fresh);
    }
    state->speed_m_s = fixed_clamp(state->speed_m_s, -config->speed_max_m_s, config->speed_max_m_s);
    state->bias_m_s2 = fixed_clamp(state->bias_m_s2, -config->bias_max_m_s2, config->bias_max_m_s2);
    if (fresh || state->standstill || fixed_bits(state->std_m_s) == 0u) { // a root is dear
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
