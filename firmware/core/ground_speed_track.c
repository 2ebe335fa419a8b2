#include "ground_speed_parts.h"

#include "fixed.h"

static const float p_vv_max = 4.0f; // [m^2/s^2] (2 m/s)^2: beyond it nothing more is unknown, assumed
static const float p_vv_min = 1e-8f;
static const float p_bb_min = 1e-8f;

// A covariance that is too large to mean anything more is shrunk as a whole, so it stays positive; what rounding leaves is mended.
void ground_speed_hold(const ground_speed_config_t *config, ground_speed_track_t *track)
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
void ground_speed_move(const ground_speed_config_t *config, ground_speed_track_t *track, float change_m_s, float time_s, float noise,
                       float bias_noise)
{
    track->speed_m_s += change_m_s - track->bias_m_s2 * time_s;
    track->p_vv += time_s * (time_s * track->p_bb - 2.0f * track->p_vb) + noise;
    track->p_vb -= time_s * track->p_bb;
    track->p_bb += bias_noise;
    ground_speed_hold(config, track);
}

void ground_speed_correct(const ground_speed_config_t *config, ground_speed_track_t *track, float innovation, float tau, float noise)
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
    ground_speed_hold(config, track);
}

// Variance of what (3) expects.
float ground_speed_spread_of(const ground_speed_track_t *track, float tau)
{
    return track->p_vv + tau * (2.0f * track->p_vb + tau * track->p_bb);
}

// Running integral of the raw accelerometer.
void ground_speed_integrate(const ground_speed_config_t *config, ground_speed_state_t *state, float accel_m_s2)
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
static const float slow_most = 3.0f; // [1] times the white noise: beyond, it is the rover's own motion, assumed

enum { SLOW_TICKS = 4, SLOW_BENDS = 6, SLOW_LIMIT = 16383 };

static const float usual_more = 2.0f, usual_less = 0.85f; // [1] of (30): four looks of five find less, assumed
static const float usual_least = 4e-8f;                   // [m^2/s^2] (0.02 m/s^2 T)^2: no accelerometer on wheels is quieter, assumed
static const float usual_most = 4e-4f;                    // [m^2/s^2] as the filter's own

// (30)
static void watch_usual(float *usual, float found)
{
    *usual = fixed_clamp(*usual * (fixed_greater(found, *usual) ? usual_more : usual_less), usual_least, usual_most);
}

// (6'), of sums over four ticks
void ground_speed_watch_slow_noise(ground_speed_state_t *state)
{
    uint32_t sum = 0;
    int32_t newer = state->integral_q20[state->head];
    int32_t middle = state->integral_q20[((uint32_t)state->head - SLOW_TICKS) % GROUND_SPEED_HISTORY];
    for (uint32_t j = 2; j < SLOW_BENDS + 2; j++) {
        const int32_t older = state->integral_q20[((uint32_t)state->head - SLOW_TICKS * j) % GROUND_SPEED_HISTORY];
        const int32_t bend =
            fixed_wrap_difference(fixed_wrap_difference(newer, middle), fixed_wrap_difference(middle, older)) >> NOISE_LOST_BITS;
        const int32_t limited = bend < -SLOW_LIMIT ? -SLOW_LIMIT : bend > SLOW_LIMIT ? SLOW_LIMIT : bend;
        sum += (uint32_t)(limited * limited);
        newer = middle;
        middle = older;
    }
    const float mean = (float)sum * (1.0f / (2.0f * SLOW_TICKS * SLOW_BENDS * 65536.0f * 65536.0f));
    state->slow_noise_m2_s2 += noise_share * (mean - state->slow_noise_m2_s2);
    watch_usual(&state->usual_slow_m2_s2, mean);
}

void ground_speed_watch_noise(const ground_speed_config_t *config, ground_speed_state_t *state)
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
    float noise = state->accel_noise_m2_s2;
    if (fixed_greater(state->slow_noise_m2_s2, noise)) {
        const float most = slow_most * noise;
        noise = fixed_greater(state->slow_noise_m2_s2, most) ? most : state->slow_noise_m2_s2;
    }
    state->speed_noise_m2_s2 = fixed_clamp(noise, config->speed_noise_m2_s2, config->speed_noise_max_m2_s2);
    watch_usual(&state->usual_noise_m2_s2, mean);
    const float slow = state->usual_slow_m2_s2;
    const float usual = fixed_greater(slow, state->usual_noise_m2_s2) ? slow : state->usual_noise_m2_s2;
    const float claimed = fixed_greater(state->speed_noise_m2_s2, usual) ? usual : state->speed_noise_m2_s2;
    state->unseen_m2_s2 = claimed * config->window->tau_ticks;
    ground_speed_weigh_wheels(config, state);
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

ground_speed_past_t ground_speed_look_back(const ground_speed_config_t *config, const ground_speed_state_t *state, float late)
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
    ground_speed_past_t out = {.tau_s = window->tau_s + late_s, .accel_m_s2 = (float)span * (1.0f / 1048576.0f) * window->per_s};
    out.change_m_s = window_change_m_s(window, state, (uint32_t)ago) + (float)since * (1.0f / 1048576.0f) +
                     out.accel_m_s2 * (late_s - (float)ago * config->tick_s);
    return out;
}
