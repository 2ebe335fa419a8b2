#include "ground_speed.h"

#include "fixed.h"

#include <math.h>

static const float early_accel_m_s2 = 0.2f; // [m/s^2] assumed: the speed changes by 0.05 m/s at most in the first half window

void ground_speed_reset(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const ground_speed_state_t zero = {0};
    *state = zero;
    state->p_vv = 1.0f; // (1 m/s)^2: nothing is known
    state->p_bb = config->bias_start_m_s2 * config->bias_start_m_s2;
    state->speed_noise_m2_s2 = config->speed_noise_m2_s2;
}

static void predict(const ground_speed_config_t *config, ground_speed_state_t *state, float accel_m_s2)
{
    const float T = config->tick_s;
    state->speed_m_s = fixed_clamp(state->speed_m_s + (accel_m_s2 - state->bias_m_s2) * T, -10.0f, 10.0f); // (2), bounded
    state->p_vv += T * (T * state->p_bb - 2.0f * state->p_vb) + state->speed_noise_m2_s2;
    state->p_vb -= T * state->p_bb;
    state->p_bb += config->bias_noise_m2_s4;
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

static void correct(ground_speed_state_t *state, float innovation, float tau, float noise)
{
    const float hv = state->p_vv + tau * state->p_vb;
    const float hb = state->p_vb + tau * state->p_bb;
    const float total = hv + tau * hb + noise;
    const float per_total = 1.0f / total;
    const float kv = hv * per_total;
    const float kb = hb * per_total;
    state->speed_m_s += kv * innovation;
    state->bias_m_s2 += kb * innovation;
    state->p_vv -= kv * hv;
    state->p_vb -= kv * hb;
    state->p_bb -= kb * hb;
}

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

// What is left of the window's speed when (3) is moved to the present: innovation = measured - middle.
typedef struct {
    float middle_m_s; // speed in the window's middle, as predicted
    float tau_s;
    float accel_m_s2; // mean acceleration over the window
} window_t;

static window_t look_back(const doppler_window_t *window, const ground_speed_state_t *state, float accel, float late_s)
{
    const int32_t oldest = (state->head - (window->ticks - 1) + GROUND_SPEED_HISTORY) % GROUND_SPEED_HISTORY;
    const float span = (float)fixed_wrap_difference(state->integral_q20[state->head], state->integral_q20[oldest]) * (1.0f / 1048576.0f);
    const float tau = window->tau_s + late_s;
    const window_t out = {
        .tau_s = tau,
        .middle_m_s = state->speed_m_s + tau * state->bias_m_s2 - window_change_m_s(window, state) - accel * late_s, // (3)
        .accel_m_s2 = span * window->per_s - state->bias_m_s2,
    };
    return out;
}

// (4), (5): a slope or a tilt changes the bias at once; values that keep missing on one side tell of it long before (2) would.
static const float one_sided_max = 4.0f; // [1] assumed: no single value tells of a jump

static void watch_bias(const ground_speed_config_t *config, ground_speed_state_t *state, float innovation, float spread)
{
    const float one_sided = fixed_clamp(innovation * fabsf(innovation) / spread, -one_sided_max, one_sided_max);
    state->one_sided += config->jump_share * (one_sided - state->one_sided); // (4)
    if (fabsf(state->one_sided) > config->jump_limit) {
        state->p_bb = fixed_clamp(state->p_bb + config->jump_m2_s4, 0.0f, config->bias_max_m_s2 * config->bias_max_m_s2); // (5)
        state->one_sided = 0.0f;
    }
}

static void update_doppler(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input, float accel)
{
    const window_t window = look_back(config->window, state, accel, fixed_clamp(fixed_finite(input->doppler_late_s), -0.25f, 1.0f));
    const float measured = fixed_clamp(input->doppler_m_s, 0.0f, 10.0f);
    float sign = window.middle_m_s < 0.0f ? -1.0f : 1.0f;
    const bool lost = state->refused >= config->gate_patience;
    if ((lost || fabsf(window.middle_m_s) < config->sign_hysteresis_m_s) && state->still_ticks == 0) {
        sign = input->wheel_m_s < 0.0f ? -1.0f : 1.0f;
    }
    const bool early = input->doppler_late_s < 0.0f;
    if (early && fabsf(window.accel_m_s2) > early_accel_m_s2) {
        return; // w of (3) is that of a full window
    }
    const float shorter =
        early ? 2.5f
              : 1.0f; // variance of an early value over a full window's: 2.3 to 2.7 for half the samples, 1.7 to 2.3 with the mirror image
    const float noise = shorter * (config->doppler_noise_m2_s2 + config->doppler_noise_m_s * measured) +
                        config->doppler_accel_s2 * window.accel_m_s2 * window.accel_m_s2;
    const float innovation = sign * measured - window.middle_m_s;
    const float spread = state->p_vv + window.tau_s * (2.0f * state->p_vb + window.tau_s * state->p_bb) + noise;
    watch_bias(config, state, innovation, spread);
    if (innovation * innovation > config->gate_sigma * config->gate_sigma * spread) {
        if (state->refused < config->gate_patience) {
            state->refused++;
            return;
        }
        state->p_vv = 1.0f; // [m^2/s^2] nothing is known any more
        state->p_vb = 0.0f;
    }
    state->refused = 0;
    correct(state, innovation, window.tau_s, noise);
}

// A quiet echo says that the window's mean speed was too low to be heard.
static void update_quiet(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input, float accel)
{
    const window_t window = look_back(config->window, state, accel, fixed_clamp(fixed_finite(input->doppler_late_s), -0.25f, 1.0f));
    const float spread = state->p_vv + window.tau_s * (2.0f * state->p_vb + window.tau_s * state->p_bb) + config->quiet_noise_m2_s2;
    if (window.middle_m_s * window.middle_m_s <= config->gate_sigma * config->gate_sigma * spread) { // else a fade of the echo
        correct(state, -window.middle_m_s, window.tau_s, config->quiet_noise_m2_s2);
    }
}

// Standing: wheels at rest for a while, and either no echo or a speed so low that blocked wheels end it at once.
static bool is_standing(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const bool wheels_rest = state->still_ticks >= config->still_needed;
    return wheels_rest && (state->quiet >= config->quiet_needed || fabsf(state->speed_m_s) < config->sign_hysteresis_m_s);
}

ground_speed_output_t ground_speed_step(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const float accel = input->accel_valid ? fixed_clamp(fixed_finite(input->accel_x_m_s2), -100.0f, 100.0f) : state->bias_m_s2;
    const bool fresh = input->doppler_fresh && fixed_is_finite(input->doppler_m_s);
    integrate(config, state, accel);
    predict(config, state, accel);
    if (fresh) {
        state->quiet = input->doppler_quiet ? state->quiet + (state->quiet < 1000 ? 1 : 0) : 0;
    }
    if (!fresh && (uint32_t)state->head % NOISE_EVERY == 0u && config->speed_noise_max_m2_s2 > config->speed_noise_m2_s2) {
        watch_noise(config, state); // not in the tick of a value, which is the longest
    }
    const bool rest = fixed_greater(config->still_m_s, fabsf(fixed_finite(input->wheel_m_s)));
    state->still_ticks = rest ? state->still_ticks + (state->still_ticks < 1000 ? 1 : 0) : 0;
    state->standstill = is_standing(config, state);
    if (config->method == GROUND_SPEED_PAPER) {
        if (fresh) {
            update_paper(config, state, input->doppler_m_s, input->wheel_m_s);
        }
    } else if (state->standstill) {
        correct(state, -state->speed_m_s, 0.0f, config->standing_noise_m2_s2);
    } else if (fresh && state->quiet >= config->quiet_needed) {
        update_quiet(config, state, input, accel);
    } else if (fresh && !input->doppler_quiet) {
        update_doppler(config, state, input, accel);
    }
    state->speed_m_s = fixed_clamp(state->speed_m_s, -10.0f, 10.0f);
    state->bias_m_s2 = fixed_clamp(state->bias_m_s2, -config->bias_max_m_s2, config->bias_max_m_s2);
    if (fresh || state->standstill || state->std_m_s == 0.0f) { // between, the filter forgets little: a root is dear
        // (3) does not see what the accelerometer's noise has done since the window's middle: V carries it on both sides.
        const float unseen =
            config->method == GROUND_SPEED_PAPER || state->standstill ? 0.0f : state->speed_noise_m2_s2 * config->window->tau_ticks;
        const float variance = state->p_vv + unseen;
        state->std_m_s = sqrtf(variance > 0.0f ? variance : 0.0f);
    }
    const ground_speed_output_t out = {
        .speed_m_s = state->speed_m_s,
        .std_m_s = state->std_m_s,
        .bias_m_s2 = state->bias_m_s2,
        .standstill = state->standstill,
    };
    return out;
}
