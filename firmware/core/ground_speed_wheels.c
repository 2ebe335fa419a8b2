#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

// X^2 of (10) beyond `least` and twice what the accelerometer's noise makes of it: Qv T/(2 (T/0.25 s)) = 12.5 Qv.
float ground_speed_told_by_wheels(const ground_speed_config_t *config, const ground_speed_state_t *state, float least_m_s)
{
    return ground_speed_square(state->apart_m_s) - ground_speed_square(least_m_s) - config->apart_noise * state->speed_noise_m2_s2;
}

static const float wheel_jump_m_s2 = 10.0f; // faster, no torque changes a rim: the first count after a start

static const float rolling_slip_m2_s2 = 9e-4f; // (3 cm/s)^2: what slip changes by where a slope begins, assumed
static const float sway_times = 2.0f;          // a sine's peak over its mean square
static const float rest_share = 0.0625f;       // [1] of a look that enters (24): about 16 ticks
static const float beside_share = 0.25f;       // [1] of a value that enters its mean: half a second

static const float wheels_share = 1.5f; // [1] of (21)
static const float felt_sigmas = 4.0f;  // of X, beyond which it is no noise

enum { FIRST_TICKS = 10, FORCE_TICKS = 8, DENIED_VALUES = 2, ROLL_TICKS = 60, ROLL_AGAIN_TICKS = 100, LEAN_MEAN_BITS = 5 };

// f of (13), over the last ticks.
static float force_now(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const int32_t now = state->integral_q20[state->head];
    const int32_t then = state->integral_q20[((uint32_t)state->head - FORCE_TICKS) % GROUND_SPEED_HISTORY];
    return (float)fixed_wrap_difference(now, then) * (config->per_tick_1_s / (1048576.0f * FORCE_TICKS));
}

static const float back_m_s2 = 0.5f; // assumed: 3 deg

// (39)
bool ground_speed_force_is_over(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    return fixed_greater(back_m_s2, fabsf(force_now(config, state) - state->other.at.bias_m_s2));
}

// (21): X is what the body did beside the wheels, not what the wheels did.
bool ground_speed_body_departs(const ground_speed_state_t *state)
{
    return fixed_greater(fabsf(state->apart_m_s), wheels_share * fabsf(state->wheel_m_s - state->wheel_mean_m_s));
}

// Whether the radar's last value, less the wheels' mean of its window, has left its own mean by more than noise and `slip` explain.
static bool radar_departs(const ground_speed_config_t *config, const ground_speed_state_t *state, float slip_m2_s2)
{
    const float left = state->value_beside_m_s - state->beside_mean_m_s;
    const float noise = state->value_trust * (config->doppler_noise_m2_s2 + config->doppler_noise_m_s * state->value_heard_m_s);
    return fixed_greater(ground_speed_square(left), config->roll_odds * (noise + slip_m2_s2));
}

// To be called at every value. While the best track rolls, the mean is that of before; a value that leaves it by more than slip may change
// by tells that it does not roll.
void ground_speed_watch_radar(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const float before = state->value_beside_m_s;
    state->value_beside_m_s = state->value_heard_m_s - fabsf(state->wheel_mean_m_s);
    if (state->rolls_ticks > 0) {
        state->roll_denied = radar_departs(config, state, rolling_slip_m2_s2);
    } else {
        const bool denied = ground_speed_gyro_tells(config, state) &&
                            fixed_greater(ground_speed_told_by_wheels(config, state, config->roll_told_m_s), 0.0f) &&
                            !radar_departs(config, state, 0.0f);
        state->gyro_denied = !denied ? 0 : state->gyro_denied + (state->gyro_denied < DENIED_VALUES ? 1 : 0);
        state->beside_mean_m_s = state->accepted && state->slide.held > 0
                                     ? state->beside_mean_m_s + beside_share * (before - state->beside_mean_m_s)
                                     : state->value_beside_m_s;
    }
}

// Variance of X over the last quarter of a second: of a body that sways on its wheels, not of a slope that begins.
static float sway_m2_s2(const ground_speed_state_t *state) { return state->apart_m2_s2 - ground_speed_square(state->apart_mean_m_s); }

static const float untold_share = 0.5f; // [1] of the way between both words, while nothing has told: assumed

// Until a value comes after (13), the claim covers half of what the wheels' word has taken away by now.
static void claim_untold(ground_speed_state_t *state, float more_m_s)
{
    state->rolled_m_s += more_m_s;
    const float claim_m_s = untold_share * fabsf(state->rolled_m_s);
    state->doubt_m2_s2 = ground_speed_square(claim_m_s);
    state->std_m_s = fixed_greater(claim_m_s, state->std_m_s) ? claim_m_s : state->std_m_s;
}

// (13): the best track rolls from here on, what the accelerometer alone would have is the other one.
static void begin_rolling(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    ground_speed_track_t best = ground_speed_best_of(state);
    ground_speed_split(state, &state->other, &best);
    state->other_alive = true;
    state->odds = config->roll_odds;
    best.speed_m_s -= state->apart_m_s;
    best.p_vv += 0.25f * ground_speed_square(state->apart_m_s); // what (10) has forgotten of it, up to its half
    ground_speed_hold(config, &best);
    ground_speed_keep_best(state, &best);
    state->rolled_m_s = 0.0f;
    claim_untold(state, state->apart_m_s);
    state->apart_m_s = 0.0f;
    state->rolls_ticks = ROLL_TICKS;
    state->rolled_values = 0;
    ground_speed_forget_agile(state);
}

// The wheels' change of speed is the body's; what the accelerometer feels beside it is bias.
static void roll(const ground_speed_config_t *config, ground_speed_state_t *state, float ticks)
{
    if (state->other_alive && fixed_bits(state->odds) == fixed_bits(config->roll_odds)) {
        claim_untold(state, state->apart_m_s);
    }
    state->speed_m_s -= state->apart_m_s;
    state->bias_m_s2 += config->roll_share * config->per_tick_1_s * state->apart_m_s;
    state->p_vv += ticks * config->roll_noise_m2_s2;
    state->p_vb = 0.0f;
    state->p_bb = config->roll_bias_m2_s4;
    state->apart_m_s = 0.0f;
}

static const float long_share = 0.125f; // [1] of a mean that enters the long one: as the noise's own memory, 1.3 s and more

// c of (14): what of X is the accelerometer's noise, against what X is: encoders, slip and sway count as what they are. Where X is nothing
// but that noise, c is what theory has; it is never more.
void ground_speed_weigh_wheels(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    if (config->method == GROUND_SPEED_PAPER) {
        return;
    }
    const float noise = config->felt_noise * state->speed_noise_m2_s2;
    state->apart_long_m2_s2 += long_share * (state->apart_m2_s2 - state->apart_long_m2_s2);
    state->felt_trust = fixed_greater(state->apart_long_m2_s2, noise) ? noise / state->apart_long_m2_s2 : 1.0f;
    state->per_felt_most_s2_m2 = 1.0f / (ground_speed_square(felt_sigmas) * noise);
}

// (14): within what the accelerometer's white noise makes of X, X is that noise; beyond, it is slip or a slope, and the less of it is noise
// the further it lies out.
static float felt(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const float left = 1.0f - ground_speed_square(state->apart_m_s) * state->per_felt_most_s2_m2;
    return fixed_greater(left, 0.0f) ? config->felt_share * state->felt_trust * state->apart_m_s * ground_speed_square(left) : 0.0f;
}

// (10), over the ticks since the last time: it waits in ticks that are busy.
void ground_speed_watch_wheels(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const float wheel = fixed_clamp(fixed_finite(input->wheel_m_s), -config->speed_max_m_s, config->speed_max_m_s);
    const int32_t now = state->integral_q20[state->head];
    const int32_t passed = state->wheel_ticks;
    const float ticks = (float)passed;
    const float change = (float)fixed_wrap_difference(now, state->wheel_q20) * (1.0f / 1048576.0f) -
                         state->bias_m_s2 * config->tick_s * ticks - (wheel - state->wheel_m_s);
    const float keep = 1.0f - config->apart_forget * (ticks < 10.0f ? ticks : 10.0f);
    if (!fixed_greater(fabsf(wheel - state->wheel_m_s), wheel_jump_m_s2 * config->tick_s * ticks)) {
        state->apart_m_s = keep * fixed_clamp(state->apart_m_s + change, -config->speed_max_m_s, config->speed_max_m_s);
    } else if (state->slide.ticks > FIRST_TICKS) {
        state->rolls_wait = ROLL_AGAIN_TICKS; // (21)
    }
    const float share = 1.0f - keep;
    state->apart_m2_s2 += share * (ground_speed_square(state->apart_m_s) - state->apart_m2_s2);
    state->apart_mean_m_s += share * (state->apart_m_s - state->apart_mean_m_s);
    state->wheel_m_s = wheel;
    state->wheel_mean_m_s += share * (wheel - state->wheel_mean_m_s);
    const bool slow = fixed_greater(config->still_m_s, fabsf(wheel));
    state->rest_mean_m_s = slow ? state->rest_mean_m_s + rest_share * (wheel - state->rest_mean_m_s) : 0.0f; // (24)
    state->wheel_q20 = now;
    state->wheel_ticks = 0;
    state->lean_mean_q8 += (state->lean_q8 - state->lean_mean_q8) >> LEAN_MEAN_BITS;
    if (config->method == GROUND_SPEED_PAPER) {
        return;
    }
    state->felt_m_s = input->accel_valid && !input->wheels_part ? felt(config, state) : 0.0f;
    state->rolls_wait -= state->rolls_wait > passed ? passed : state->rolls_wait;
    if (state->rolls_ticks > 0) {
        state->rolls_ticks -= state->rolls_ticks > passed ? passed : state->rolls_ticks;
        roll(config, state, ticks);
        if (state->rolls_ticks == 0 && state->gyro_tried) {
            ground_speed_gyro_lied(config, state, 1.0f);
            state->gyro_tried = false;
        }
    } else if (!input->doppler_fresh && fixed_greater(ground_speed_bias_known_m2_s4, state->p_bb) && state->rolls_wait == 0 &&
               !state->other_alive && input->accel_valid && !input->wheels_part &&
               fixed_greater(ground_speed_told_by_wheels(config, state, config->roll_told_m_s), sway_times * sway_m2_s2(state))) {
        const float force = force_now(config, state);
        const float departs = force - state->bias_m_s2;
        const bool back = state->apart_m_s < 0.0f;
        const bool felt = fixed_greater(back ? -departs : departs, config->slip_force_m_s2); // else it is the wheels that depart: they spin
        const float felt_m_s2 = ground_speed_felt_force(config, state, force);
        const bool pushed = fixed_greater(back ? felt_m_s2 : -felt_m_s2, config->slip_force_m_s2); // along the slip that X would be
        const bool told = ground_speed_gyro_tells(config, state); // the gyro has seen the slope: it is slip, unless the gyro lies
        if (felt && ground_speed_body_departs(state) && !pushed && (!told || state->gyro_denied >= DENIED_VALUES) &&
            !radar_departs(config, state, 0.0f)) {
            state->gyro_tried = told;
            begin_rolling(config, state);
        }
    }
}

static const float follow_least_m_s = 0.01f; // what slip may change by in a quarter of a second, assumed
static const float follow_most_m_s = 0.05f; // 0.2 m/s^2: the radar would not hear a slide that begins so for a quarter of a second, assumed
static const float per_forget_1_s = 4.0f;   // 1/0.25 s of (10)

// (23)
void ground_speed_follow_wheels(const ground_speed_config_t *config, ground_speed_state_t *state, bool creep)
{
    const float apart_m_s = state->apart_m_s;
    const float told = ground_speed_told_by_wheels(config, state, follow_least_m_s);
    if (state->other_alive || state->rolls_ticks > 0 || !fixed_greater(told, 0.0f) || !ground_speed_body_departs(state)) {
        return;
    }
    if (!creep && (fixed_greater(fabsf(apart_m_s), follow_most_m_s) || radar_departs(config, state, 0.0f))) {
        return;
    }
    const float square = ground_speed_square(apart_m_s);
    const float by_m_s = told / square * apart_m_s;
    const float left = per_forget_1_s * per_forget_1_s * (square - told);
    ground_speed_track_t track = ground_speed_best_of(state);
    track.speed_m_s -= by_m_s;
    track.bias_m_s2 += per_forget_1_s * by_m_s;
    track.p_vv += 0.25f * told;
    track.p_bb = fixed_greater(left, track.p_bb) ? left : track.p_bb;
    ground_speed_hold(config, &track);
    ground_speed_keep_best(state, &track);
    state->apart_m_s -= by_m_s;
}

ground_speed_past_t ground_speed_rolled(const ground_speed_state_t *state)
{
    const ground_speed_past_t out = {.tau_s = 0.0f, .change_m_s = state->wheel_m_s - state->wheel_mean_m_s, .accel_m_s2 = 0.0f};
    return out;
}

// The one that believes the accelerometer won: what the wheels told was no rolling, and is forgotten.
void ground_speed_no_rolling(ground_speed_state_t *state)
{
    if (state->rolls_ticks > 0) {
        state->rolls_ticks = 0;
        state->rolls_wait = ROLL_AGAIN_TICKS;
        state->gyro_tried = false;
        state->apart_m_s = 0.0f;
        ground_speed_forget_agile(state);
    }
}
