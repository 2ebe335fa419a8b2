#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

static const float falls = 0.7f;           // [1] of its mean: below, it may be on its way through zero; assumed
static const float level_share = 0.25f;    // [1] of a value that enters its mean: half a second
static const float sharp_m_s2 = 1.2f;      // what turns a body within a window, unheard: 7 deg of slope or a stop, assumed
static const float sharp_told_m_s2 = 0.5f; // where gyros tell the slope, an acceleration is one; assumed
static const float sure_sigmas2 = 9.0f;
static const float rolls_least = 0.5f; // [1] of the rim's speed
static const float rolls_most = 1.1f;  // as overtaken_share of (12)
static const float beyond = 0.25f;     // [1] of the value, by which the estimate has passed zero

enum { HELD_VALUES = 6 }; // as many as (15) looks at

static void release(ground_speed_state_t *state)
{
    state->held_sign = 0.0f;
    state->held_values = 0;
}

// The value's window, with the sign that is held; the bias may have jumped.
static void take_held(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const ground_speed_track_t track =
        ground_speed_told(config, state, state->held_sign, state->bias_m_s2, state->p_bb + config->agile_m2_s4);
    ground_speed_keep_best(state, &track);
    state->other_alive = false;
    state->rolls_ticks = 0;
    state->gyro_tried = false;
    state->one_sided = 0.0f;
    ground_speed_forget_agile(state);
}

static const float close_share = 0.12f; // of its rim speed, and beside it, what the body's may be less by: assumed
static const float close_m_s = 0.02f;
static const float ahead_share = 0.06f; // and more
static const float ahead_m_s = 0.01f;
static const float parts_sigmas2 = 16.0f;
static const float parts_m2_s2 = 4e-4f; // (2 cm/s)^2

enum { PARTED_VALUES = 24 }; // 3 s, assumed
enum { ROLLED_VALUES = 8 };  // of (42): in the last of them a radar may have been covered already

static bool is_close(float beside_m_s, float rim)
{
    return fixed_greater(beside_m_s, -close_m_s - close_share * rim) && fixed_greater(ahead_m_s + ahead_share * rim, beside_m_s);
}

// (18)
static void watch_rolling(ground_speed_state_t *state)
{
    const float rim = fabsf(state->wheel_mean_m_s);
    const float left = state->value_beside_m_s - state->beside_mean_m_s;
    const bool beside = is_close(state->value_beside_m_s, rim);
    const bool parts = !beside && fixed_greater(ground_speed_square(left), parts_sigmas2 * state->value_noise_m2_s2 + parts_m2_s2); // (37)
    state->parted_values = parts ? PARTED_VALUES : state->parted_values > 0 ? state->parted_values - 1 : 0;
    state->rolls = state->parted_values == 0 && beside && is_close(state->beside_mean_m_s, rim);
    state->rolled_values = state->rolls && state->rolls_ticks == 0 ? ROLLED_VALUES
                           : state->rolled_values > 0              ? state->rolled_values - 1
                                                                   : 0;
}

static const float scatter_share = 0.015f; // [1] of a value that enters the mean of (28): eight seconds
static const float scatter_most = 12.25f;  // [1] the gate's square
static const float calm_times = 2.0f;      // [1] 1 over what e^2/S is where the claim is right
static const float calm_least = 0.25f;     // [1] half of the standard deviation, assumed
static const float calm_most = 4.0f;       // [1] twice it, assumed

// (28)
static void watch_scatter(ground_speed_state_t *state)
{
    state->scatter += scatter_share * (fixed_clamp(state->value_scatter, 0.0f, scatter_most) - state->scatter);
    const bool known = !state->other_alive && !state->value_parts;
    state->calm = known ? fixed_clamp(calm_times * state->scatter, calm_least, calm_most) : 1.0f;
    state->calm_at_m2_s2 = state->value_noise_m2_s2;
    state->calm_less_m2_s2 = (1.0f - state->calm) * state->value_noise_m2_s2;
}

// (17), of the value that came a tick ago.
void ground_speed_watch_held(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    watch_scatter(state);
    watch_rolling(state);
    if (state->rolls) {
        ground_speed_follow_wheels(config, state, false);
    }
    const float heard = state->value_heard_m_s;
    const float rim = fabsf(state->value_wheel_m_s);
    const float wheel_sign = state->value_wheel_m_s < 0.0f ? -1.0f : 1.0f;
    const bool first = state->held_values == 0;
    if (!fixed_greater(heard, config->slow_m_s) || fixed_greater(falls * state->held_level_m_s, heard) ||
        fixed_greater(fabsf(state->value_accel_m_s2 - state->bias_m_s2), state->lean_q8 == 0 ? sharp_m_s2 : sharp_told_m_s2)) {
        release(state);
    }
    state->held_level_m_s = first ? heard : state->held_level_m_s + level_share * (heard - state->held_level_m_s);
    const float sign = state->speed_m_s < 0.0f ? -1.0f : 1.0f;
    const bool rolls = fixed_greater(state->held_level_m_s, rolls_least * rim) && fixed_greater(rolls_most * rim, state->held_level_m_s);
    if (!rolls) {
        release(state);
        return;
    }
    if (fixed_bits(state->held_sign) == 0u) {
        const bool sure = !state->other_alive && state->refused == 0 && sign * wheel_sign > 0.0f &&
                          fixed_greater(ground_speed_square(state->speed_m_s), sure_sigmas2 * state->p_vv);
        state->held_values = !sure ? 0 : state->held_values < HELD_VALUES ? state->held_values + 1 : HELD_VALUES;
        state->held_sign = state->held_values >= HELD_VALUES ? sign : 0.0f;
    } else if (state->held_sign * wheel_sign < 0.0f) {
        release(state);
    } else if (fixed_greater(-beyond * heard, state->held_sign * state->speed_m_s)) {
        take_held(config, state);
    }
}
