#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

// 2 ln of the odds that the wheels give to forward travel.
float ground_speed_wheel_odds(const ground_speed_config_t *config, float measured, float wheel_m_s)
{
    const float rim = fabsf(wheel_m_s);
    if (!fixed_greater(rim, config->still_m_s)) {
        return 0.0f;
    }
    const bool match = fixed_greater(measured, 0.5f * rim) && fixed_greater(1.5f * rim, measured); // slip of -0.33 to 0.5
    const bool spins = fixed_greater(rim, measured); // slip of 0 to 1 the wheels' way, or of more than 1 against it
    const float odds = match ? config->wheel_match : spins ? config->wheel_spins : config->wheel_odds;
    return wheel_m_s < 0.0f ? -odds : odds;
}

static const float rolls_share = 0.15f; // of its rim speed, and beside it, what a wheel may slip that is hardly driven: assumed
static const float rolls_m_s = 0.02f;

// Where the wheels part, one that nothing drives rolls with the ground, whatever those that spin beside it do: the hint is its rim speed,
// if the radar's value agrees with it.
float ground_speed_hint(const ground_speed_config_t *config, const ground_speed_input_t *input, float measured)
{
    const float rim = fabsf(input->slowest_m_s);
    const bool rolls = fixed_greater(rim, config->still_m_s) && fixed_greater(rolls_m_s + rolls_share * rim, fabsf(measured - rim));
    return rolls ? input->slowest_m_s : input->wheel_m_s;
}

// What a body that its wheels push cannot do is overtake them: a radius and a radar's angle that are 10 % off, and a value's noise
// (assumed).
static const float overtaken_share = 0.1f, overtaken_parted = 0.15f; // the latter: by the slowest of wheels that part, as in a turn
static const float overtaken_m_s = 0.02f;

// g of (12): whether the wheels slip so fast that friction has no other direction.
static float slips(const ground_speed_config_t *config, float share, float slip_m_s, float wheel_m_s, float rim_m_s)
{
    const bool overtakes = (slip_m_s < 0.0f) != (wheel_m_s < 0.0f) && fixed_greater(rim_m_s, config->still_m_s);
    const float rolling = overtakes ? overtaken_m_s + share * rim_m_s : config->wheel_noise_m_s + config->wheel_slip * rim_m_s;
    const float beyond = fabsf(slip_m_s) - rolling;
    return !fixed_greater(beyond, 0.0f) ? 0.0f : fixed_greater(beyond, rolling) ? 1.0f : beyond / rolling;
}

float ground_speed_force_odds(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const float measured = state->value_m_s;
    const float wheel_m_s = state->value_wheel_m_s;
    const float force_m_s2 = ground_speed_felt_force(config, state, state->value_accel_m_s2);
    const float rim = fabsf(wheel_m_s);
    const float told = ground_speed_square(force_m_s2 * config->force_per_s2_m);
    const float most = fixed_greater(told, config->force_most) ? config->force_most : told;
    const float forth = wheel_m_s - measured; // u of +, and of -
    const float back = wheel_m_s + measured;
    const float share = state->value_parts ? overtaken_parted : overtaken_share;
    float odds = 0.0f;
    if ((forth < 0.0f) != (force_m_s2 < 0.0f)) {
        odds -= most * slips(config, share, forth, wheel_m_s, rim);
    }
    if ((back < 0.0f) != (force_m_s2 < 0.0f)) {
        odds += most * slips(config, share, back, wheel_m_s, rim);
    }
    return odds;
}

void ground_speed_split(ground_speed_state_t *state, ground_speed_side_t *side, const ground_speed_track_t *track)
{
    state->doubt_m_s = 0.0f; // until the first value since
    state->doubt_m2_s2 = 0.0f;
    side->at = *track;
    side->ticks = 0;
    side->q20 = state->integral_q20[state->head];
}

// 1 where the wheels turn with the track at a speed that agrees with the radar's, -1 where they turn against it, else 0.
static int32_t with_wheels(const ground_speed_config_t *config, const ground_speed_state_t *state, float measured, float wheel_m_s)
{
    const bool rolls = fixed_greater(1.15f * fabsf(wheel_m_s), measured); // what overtakes its wheels is not pushed by them
    const bool match = rolls && fabsf(ground_speed_wheel_odds(config, measured, wheel_m_s)) >= config->wheel_match;
    return !match ? 0 : (wheel_m_s < 0.0f) == (state->speed_m_s < 0.0f) ? 1 : -1;
}

static const float rolls_pull = 6.0f; // [1] of (18), times wheel_pull, assumed

static const float force_against = 1.0f; // 2 ln of the odds of (12), assumed

// A sign that was lost at a restart or in a slide is the same at constant speed as the right one; wheels that turn against it all the time,
// or friction that does, ask anew.
void ground_speed_ask_again(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const float force = ground_speed_force_odds(config, state);
    const bool dragged = fixed_greater(state->speed_m_s < 0.0f ? force : -force, force_against);
    const bool against = dragged || with_wheels(config, state, state->value_m_s, state->value_wheel_m_s) < 0;
    const int32_t more = against && state->rolls ? 2 : 1;
    state->against = against || state->against < 0 ? state->against + (state->against >= 1000 ? 0 : more) : 0;
    if (state->against >= config->against_values) {
        const ground_speed_track_t best = ground_speed_best_of(state);
        const float bias = 2.0f * state->value_accel_m_s2 - best.bias_m_s2;                 // (2) of the mirror image
        const float window_m2_s2 = (float)config->window->ticks * state->speed_noise_m2_s2; // of V over it
        const float p_bb = best.p_bb + 4.0f * window_m2_s2 * ground_speed_square(config->window->per_s);
        const ground_speed_track_t mirror = ground_speed_told(config, state, best.speed_m_s < 0.0f ? 1.0f : -1.0f, bias, p_bb);
        ground_speed_split(state, &state->other, &mirror);
        state->odds = config->against_odds;
        state->other_alive = true;
        state->against = -1; // (27): asked
    }
}

// (9): takes the likelier sign, and follows the other too where it may be the right one.
float ground_speed_choose_sign(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_track_t *track,
                               float measured, float middle, float spread, float wheel_m_s)
{
    const float told = 4.0f * measured * middle / spread; // 2 ln of the odds of +
    if (fabsf(told) >= config->sign_sure || state->other_alive) {
        return middle < 0.0f ? -1.0f : 1.0f;
    }
    const float odds = told + ground_speed_wheel_odds(config, measured, wheel_m_s) + ground_speed_force_odds(config, state);
    ground_speed_split(state, &state->other, track);
    state->odds = fabsf(odds);
    state->other_alive = state->odds < config->sign_sure;
    return odds < 0.0f ? -1.0f : 1.0f;
}

static void move_side(const ground_speed_config_t *config, const ground_speed_state_t *state, ground_speed_side_t *side, int32_t ticks_ago)
{
    const int32_t until = state->integral_q20[((uint32_t)(state->head - ticks_ago)) % GROUND_SPEED_HISTORY];
    const float change = (float)fixed_wrap_difference(until, side->q20) * (1.0f / 1048576.0f);
    const float n = (float)(side->ticks - ticks_ago);
    ground_speed_move(config, &side->at, change, n * config->tick_s, n * state->speed_noise_m2_s2, n * config->bias_noise_m2_s4);
    side->q20 = until;
    side->ticks = ticks_ago;
}

typedef struct {
    float middle_m_s, spread_m2_s2;
    ground_speed_value_t value;
    float told; // 2 ln of the odds of +
} expected_t;

// What a side expects of the value that the best saw `ticks_ago`.
static expected_t expect(const ground_speed_config_t *config, const ground_speed_state_t *state, ground_speed_side_t *side,
                         int32_t ticks_ago)
{
    move_side(config, state, side, ticks_ago);
    expected_t out;
    out.value = ground_speed_value_for(config, state, &side->at, state->value_accel_m_s2 - side->at.bias_m_s2);
    out.middle_m_s = side->at.speed_m_s + state->value_tau_s * side->at.bias_m_s2 - state->value_change_m_s;
    out.spread_m2_s2 = ground_speed_spread_of(&side->at, state->value_tau_s) + out.value.noise_m2_s2;
    out.told = 4.0f * out.value.speed_m_s * out.middle_m_s / out.spread_m2_s2;
    return out;
}

// Corrects it with that sign; returns e^2/S + ln S.
static float see(const ground_speed_config_t *config, const ground_speed_state_t *state, ground_speed_side_t *side,
                 const expected_t *expected, float sign)
{
    const float innovation = sign * expected->value.speed_m_s - expected->middle_m_s;
    ground_speed_correct(config, &side->at, innovation, state->value_tau_s, expected->value.noise_m2_s2);
    return ground_speed_square(innovation) / expected->spread_m2_s2 + ground_speed_ln_rough(expected->spread_m2_s2);
}

// 1/(1 + (1 + x/16)^8), x = 2 ln of the odds: at least 1/(1 + exp(x/2)), the probability of the less likely sign.
static float doubt_of(float odds)
{
    const float a = 1.0f + fixed_clamp(odds, 0.0f, 100.0f) * (1.0f / 16.0f);
    return 1.0f / (1.0f + ground_speed_square(ground_speed_square(ground_speed_square(a))));
}

static const float most_told = 12.0f; // [1] of one value about a sign: no single value decides (assumed)
static const float scatters = 1.5f;   // [1] f of (26), assumed

static const float stop_odds = 2.0f; // 2 ln of the odds against a stop, assumed

enum { ROLLS_OLD_TICKS = 25 }; // of (39): 35 of the 60 that (13) lasts, a window and 0.1 s

enum { ANSWERED_VALUES = 12 }; // of (27), and then those of any question

// (39)
static bool stopped_within(const ground_speed_config_t *config, const ground_speed_state_t *state, const ground_speed_track_t *other)
{
    return state->rolls_ticks > ROLLS_OLD_TICKS && state->lean_q8 == 0 && fixed_greater(config->slow_m_s, fabsf(other->speed_m_s));
}

// The other sign sees the value one tick later, in a tick that has time.
void ground_speed_update_other(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const expected_t expected = expect(config, state, &state->other, 1);
    const float force = ground_speed_force_odds(config, state);
    const bool sure = fabsf(expected.told) >= config->sign_sure;
    const float sign = !sure ? -state->value_sign : expected.middle_m_s < 0.0f ? -1.0f : 1.0f;
    const bool moot_value = stopped_within(config, state, &state->other.at);
    const float cost = moot_value ? state->value_cost : see(config, state, &state->other, &expected, sign);
    const int32_t with = with_wheels(config, state, state->value_m_s, state->value_wheel_m_s);
    if (!moot_value && state->rolls && with < 0 && fixed_greater(state->odds, config->against_odds)) {
        state->odds = config->against_odds; // (18) asks anew
    }
    const float told = fixed_clamp(cost - state->value_cost, -most_told, most_told) +
                       (state->rolls ? rolls_pull * config->wheel_pull : config->wheel_pull) * (float)with +
                       config->force_pull * (state->speed_m_s < 0.0f ? -force : force);
    state->odds += moot_value ? 0.0f : told;
    if (state->roll_denied && fixed_greater(state->value_cost, cost)) { // (43)
        state->odds -= most_told;
    }
    state->roll_denied = false;
    if (moot_value && fixed_greater(state->odds, stop_odds) && ground_speed_force_is_over(config, state)) {
        state->odds = stop_odds;
    }
    const bool won = state->odds < 0.0f;
    if (won) {
        const ground_speed_track_t best = ground_speed_best_of(state);
        move_side(config, state, &state->other, 0);
        ground_speed_keep_best(state, &state->other.at);
        ground_speed_split(state, &state->other, &best);
        state->odds = -state->odds;
        state->value_cost = cost; // the best's, for (7)
    }
    const float apart = state->speed_m_s - state->other.at.speed_m_s;
    const bool one = !fixed_greater(apart * apart, 0.5f * (state->p_vv + state->other.at.p_vv));
    const bool refuted = !(state->odds < config->sign_sure);
    const bool same = sure && !won && (sign < 0.0f) == (state->value_sign < 0.0f);
    const bool moot = same && with < 0 && state->rolls_ticks == 0 && state->rolls_wait == 0;                // (34)
    state->against = refuted && !won && with < 0 && state->against < 0 ? -ANSWERED_VALUES : state->against; // (27)
    state->other_alive = !one && !refuted && !moot;
    if (won) {
        if (state->refused == 0 && fixed_greater(scatters, state->misfit)) {
            ground_speed_forget_agile(state); // (26)
        }
        ground_speed_no_rolling(state);
    }
    const float doubt = doubt_of(state->odds);
    state->doubt_m_s = state->other_alive ? doubt * (state->speed_m_s - state->other.at.speed_m_s) : 0.0f;
    state->doubt_m2_s2 = state->other_alive ? doubt * (1.0f - doubt) * apart * apart : 0.0f;
}
