#include "ground_speed.h"

#include "fixed.h"

#include <math.h>

enum { WINDOW_TICKS = 51 }; // ticks that a window of 256 samples at 512 Hz covers

// w_j of (3): the square of the Hann window, over its age in ticks, Q15, sum 32768. tau = 25 ticks.
static const int16_t weight_q15[WINDOW_TICKS] = {
    0, 0, 0, 2, 5, 13, 26, 46, 77, 119, 175, 245, 332, 434, 550, 680, 821, 969, 1122, 1273, 1419, 1554, 1675, 1777, 1855, 1906,
    1924, 1906, 1855, 1777, 1675, 1554, 1419, 1273, 1122, 969, 821, 680, 550, 434, 332, 245, 175, 119, 77, 46, 26, 13, 5, 2, 0,
};

void ground_speed_reset(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const ground_speed_state_t zero = {0};
    *state = zero;
    state->p_vv = 1.0f; // (1 m/s)^2: nothing is known
    state->p_bb = config->bias_start_m_s2 * config->bias_start_m_s2;
}

static void predict(const ground_speed_config_t *config, ground_speed_state_t *state, float accel_m_s2)
{
    const float T = config->tick_s;
    state->speed_m_s = fixed_clamp(state->speed_m_s + (accel_m_s2 - state->bias_m_s2) * T, -10.0f, 10.0f); // (2), bounded
    state->p_vv += T * (T * state->p_bb - 2.0f * state->p_vb) + config->speed_noise_m2_s2;
    state->p_vb -= T * state->p_bb;
    state->p_bb += config->bias_noise_m2_s4;
}

// Running integral of the raw accelerometer.
static void integrate(const ground_speed_config_t *config, ground_speed_state_t *state, float accel_m_s2)
{
    const float step = fixed_clamp(accel_m_s2 * config->tick_s, -100.0f, 100.0f) * 1048576.0f + state->integral_rest_m_s;
    const int32_t whole = (int32_t)step;
    state->integral_rest_m_s = step - (float)whole;
    const int32_t last = state->integral_q20[state->head];
    state->head = (state->head + 1) % GROUND_SPEED_HISTORY;
    state->integral_q20[state->head] = (int32_t)((uint32_t)last + (uint32_t)whole);
}

// sum_j w_j (V(t) - V(t - s_j)) of (3).
static float window_change_m_s(const ground_speed_state_t *state)
{
    const int32_t now = state->integral_q20[state->head];
    int64_t sum = 0;
    for (int32_t j = 0; j < WINDOW_TICKS; j++) {
        const int32_t then = state->integral_q20[(state->head - j + GROUND_SPEED_HISTORY) % GROUND_SPEED_HISTORY];
        sum += (int64_t)fixed_wrap_difference(now, then) * weight_q15[j];
    }
    return (float)(int32_t)(sum >> 15) * (1.0f / 1048576.0f);
}

static void correct(ground_speed_state_t *state, float innovation, float tau, float noise)
{
    const float hv = state->p_vv + tau * state->p_vb;
    const float hb = state->p_vb + tau * state->p_bb;
    const float total = hv + tau * hb + noise;
    const float kv = hv / total;
    const float kb = hb / total;
    state->speed_m_s += kv * innovation;
    state->bias_m_s2 += kb * innovation;
    state->p_vv -= kv * hv;
    state->p_vb -= kv * hb;
    state->p_bb -= kb * hb;
}

static void update_ours(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input, float accel)
{
    const float change = window_change_m_s(state) + accel * input->doppler_late_s;
    const float tau = 0.25f + input->doppler_late_s;
    const float middle = state->speed_m_s + tau * state->bias_m_s2 - change; // speed in the window's middle, predicted
    float sign = middle < 0.0f ? -1.0f : 1.0f;
    if (fabsf(middle) < config->sign_hysteresis_m_s && input->wheel_m_s != 0.0f) {
        sign = input->wheel_m_s < 0.0f ? -1.0f : 1.0f;
    }
    const float noise = config->doppler_noise_m2_s2 + config->doppler_noise_m_s * input->doppler_m_s + config->doppler_accel_s2 * accel * accel;
    const float innovation = sign * input->doppler_m_s - middle;
    const float spread = state->p_vv + tau * (2.0f * state->p_vb + tau * state->p_bb) + noise;
    const float gate = config->gate_sigma * config->gate_sigma * spread;
    if (innovation * innovation > gate && state->refused < config->gate_patience) {
        state->refused++;
        return;
    }
    if (state->refused >= config->gate_patience) {
        state->p_vv = 1.0f;
        state->p_vb = 0.0f;
    }
    state->refused = 0;
    correct(state, innovation, tau, noise);
}

static void stand_still(ground_speed_state_t *state)
{
    state->bias_m_s2 += 0.0f;
    correct(state, -state->speed_m_s, 0.0f, 1e-6f); // (1 mm/s)^2
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
    state->standstill = state->quiet >= config->quiet_needed;
    if (fresh && config->method == GROUND_SPEED_PAPER) {
        const float sign = state->speed_m_s < 0.0f ? -1.0f : 1.0f;
        const float gain = state->p_vv / (state->p_vv + config->doppler_noise_m2_s2); // (1)
        state->speed_m_s += gain * (sign * input->doppler_m_s - state->speed_m_s);
        state->p_vv -= gain * state->p_vv;
        state->p_vb = 0.0f;
        state->p_bb = 0.0f;
    } else if (fresh && state->standstill) {
        stand_still(state);
    } else if (fresh && !input->doppler_quiet) {
        update_ours(config, state, input, accel);
    }
    state->bias_m_s2 = fixed_clamp(state->bias_m_s2, -config->bias_max_m_s2, config->bias_max_m_s2);
    const ground_speed_output_t out = {
        .speed_m_s = state->speed_m_s,
        .std_m_s = sqrtf(state->p_vv > 0.0f ? state->p_vv : 0.0f),
        .bias_m_s2 = state->bias_m_s2,
        .standstill = state->standstill,
    };
    return out;
}
