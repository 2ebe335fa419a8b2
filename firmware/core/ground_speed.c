#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

void ground_speed_reset(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const ground_speed_state_t zero = {0};
    *state = zero;
    state->p_vv = 1.0f; // (1 m/s)^2: nothing is known
    state->p_bb = config->bias_start_m_s2 * config->bias_start_m_s2;
    state->speed_noise_m2_s2 = config->speed_noise_m2_s2;
    state->misfit = 1.0f;
    state->scatter = 0.5f;
    state->usual_noise_m2_s2 = config->speed_noise_m2_s2;
    state->usual_slow_m2_s2 = config->speed_noise_m2_s2;
    state->unseen_m2_s2 = config->speed_noise_m2_s2 * config->window->tau_ticks;
    state->calm = 1.0f;
    ground_speed_weigh_wheels(config, state);
}

enum {
    PUSH_TICKS = 100,
    UNFELT_VALUES = 900
}; // a window and the loud values after it; two minutes, in which most lines are learnt (doppler_line.h): one that wavers is never

enum { SILENT_TICKS = 25 }; // two values missed: what was loud before tells nothing of now

// (19): what stood and is faster than slow_m_s a second later was pushed, and the accelerometer has felt at least half of it.
static bool was_pushed(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const int32_t then = state->integral_q20[((uint32_t)state->head - PUSH_TICKS) % GROUND_SPEED_HISTORY];
    const float change_m_s = (float)fixed_wrap_difference(state->integral_q20[state->head], then) * (1.0f / 1048576.0f);
    const float felt_m_s = change_m_s - (float)PUSH_TICKS * config->tick_s * state->bias_m_s2;
    return fixed_greater(fabsf(felt_m_s), 0.5f * config->slow_m_s);
}

// Standing: wheels at rest for a while, and either no echo or a speed so low that blocked wheels end it at once; or wheels at rest for long
// while nothing that the radar says tells of a speed: the accelerometer alone must not drive a parked rover away.
static bool is_standing(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const bool heard = state->unheard_ticks < config->parked_needed; // what was loud before that tells nothing any more
    if (state->still_ticks < config->still_needed) {
        return false;
    }
    if (heard && state->loud >= config->loud_needed) {
        return state->standstill && state->loud < UNFELT_VALUES && !was_pushed(config, state);
    }
    const bool slow = state->heard && fabsf(state->speed_m_s) < config->slow_m_s && state->p_vv < ground_speed_square(config->slow_m_s);
    const bool quiet = state->loud == 0 && state->unheard_ticks < SILENT_TICKS;
    const bool parked = state->still_ticks >= config->parked_needed && (!heard || quiet);
    return slow || parked || state->quiet >= config->quiet_needed;
}

static const float ears_open_m_s = 0.1f; // [m/s] rim speed above which a front end without any noise is dead, not a rover that stands

static void count_values(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const bool loud = !input->doppler_quiet && fixed_greater(input->doppler_m_s, config->slow_m_s);
    const bool deaf = input->doppler_dead && fixed_greater(fabsf(input->wheel_m_s), ears_open_m_s);
    state->heard = true;
    state->quiet = input->doppler_quiet && !deaf ? state->quiet + (state->quiet < 1000 ? 1 : 0) : 0;
    state->loud = loud ? state->loud + (state->loud < 1000 ? 1 : 0) : 0;
    if (loud && state->standstill) { // (32)
        const bool leaps = fixed_greater(fabsf(input->doppler_m_s - state->loud_m_s), 0.5f * config->slow_m_s);
        state->loud = leaps && state->loud > config->loud_needed ? config->loud_needed : state->loud;
        state->loud_m_s = input->doppler_m_s;
    }
}

static const float creep_noise_m_s = 0.015f, creep_slip = 0.2f, beside_most = 5.0f / 12.0f;
static const float creep_alike = 4.0f;    // [1]
static const float creep_sigmas2 = 6.25f; // of (25)

// (20), (44): a wheel's word counts, if there are wheels.
static bool wheels_creep(const ground_speed_config_t *config, const ground_speed_state_t *state, float wheel_m_s)
{
    if (!fixed_greater(config->still_m_s, 0.0f) || !fixed_greater(config->slow_m_s, fabsf(wheel_m_s)) ||
        (state->unheard_ticks >= SILENT_TICKS && !state->cover.on && !fixed_greater(config->slow_m_s, state->value_heard_m_s)) ||
        state->rolls_ticks > 0) {
        return false;
    }
    const float mean_m_s = fabsf(state->wheel_mean_m_s);
    const float gains_m_s = fabsf(wheel_m_s - state->asked_m_s);
    if (!fixed_greater(config->slow_m_s, mean_m_s) || fixed_greater(gains_m_s, beside_most * config->slow_m_s)) {
        return false;
    }
    if (state->quiet > 0 || state->cover.on) {
        return true;
    }
    const float beside_m_s = mean_m_s + beside_most * config->slow_m_s;
    const float most_m_s = fixed_greater(config->lowest_m_s, beside_m_s) ? config->lowest_m_s : beside_m_s; // (22)
    return state->accepted && fixed_greater(config->slow_m_s, state->value_heard_m_s) &&
           (state->value_at_most || !fixed_greater(state->value_heard_m_s, most_m_s));
}

static const float alone_noise_m_s = 0.02f, alone_slip = 0.1f; // of (42), assumed

// (42): no radar, but wheels that rolled as long as there was one, and of which nothing has told since that they slip more or less.
static bool wheels_alone(const ground_speed_config_t *config, ground_speed_state_t *state, bool wheels_part)
{
    if (!state->cover.on && state->unheard_ticks < SILENT_TICKS) {
        return false;
    }
    if (ground_speed_body_departs(state) && fixed_greater(ground_speed_told_by_wheels(config, state, config->apart_told_m_s), 0.0f)) {
        state->rolls = false;
        state->rolled_values = 0;
    }
    return state->rolled_values > 0 && !wheels_part && !state->other_alive && state->rolls_ticks == 0;
}

// Where nothing is known, the wheels tell a little: the rim's speed, give or take what slips; but not against the radar.
static void ask_wheels(const ground_speed_config_t *config, ground_speed_state_t *state, float wheel_m_s, bool wheels_part)
{
    const bool creeps = wheels_creep(config, state, wheel_m_s);
    state->asked_m_s = wheel_m_s;
    if (state->standstill && wheels_part) { // (33)
        ground_speed_follow_wheels(config, state, true);
    }
    const bool alone = !creeps && wheels_alone(config, state, wheels_part);
    const float spread = creeps  ? creep_noise_m_s + creep_slip * fabsf(wheel_m_s)
                         : alone ? alone_noise_m_s + alone_slip * fabsf(wheel_m_s)
                                 : config->wheel_noise_m_s + config->wheel_slip * fabsf(wheel_m_s);
    const float noise = ground_speed_square(spread);
    if (creeps) {
        ground_speed_follow_wheels(config, state, true);
        ground_speed_track_t track = ground_speed_best_of(state);
        const float innovation = wheel_m_s - track.speed_m_s;
        if (fixed_greater(ground_speed_square(innovation), creep_sigmas2 * (track.p_vv + noise))) { // (25)
            track.p_vv += ground_speed_square(innovation);
        }
        ground_speed_correct(config, &track, innovation, 0.0f, creep_alike * noise);
        ground_speed_keep_best(state, &track);
        state->other_alive = false;
        if (fixed_greater(config->still_m_s, fabsf(wheel_m_s))) {
            ground_speed_watch_rest(state); // (44)
        }
        return;
    }
    const bool denied = state->unheard_ticks < SILENT_TICKS && fixed_greater(fabsf(state->value_m_s - fabsf(wheel_m_s)), 2.0f * spread);
    const bool undecided = state->other_alive && state->unheard_ticks < SILENT_TICKS; // which sign it is, the radar tells
    if ((alone || (!denied && !undecided)) && fixed_greater(state->p_vv, 1.2f * noise)) {
        ground_speed_track_t track = ground_speed_best_of(state);
        const float slip_m_s = !alone ? 0.0f : wheel_m_s < 0.0f ? -state->beside_mean_m_s : state->beside_mean_m_s;
        ground_speed_correct(config, &track, wheel_m_s + slip_m_s - track.speed_m_s, 0.0f, noise);
        ground_speed_keep_best(state, &track);
        state->other_alive = false;
    }
}

// [1] of the variance that (14) takes, x = X/sigma: 0.8 (2 E[x^2 (1 - x^2/16)^2] - E[x^2 (1 - x^2/16)^4]) = 0.68 of a normal x; and X
// holds noise from before the window's middle, too, which the values have corrected in part: 0.95 altogether (measured with
// tests/unit/ground_speed_test: 0.68 claims 18 % too much, 0.95 a twentieth).
static const float felt_takes = 0.95f;

static const float wheels_own = 1.0f / 9.0f; // [1] of X^2, a third of X, assumed (measured with any_rover_run: a seventh to a quarter)

// What X widens the claim by, (10), (31).
static void watch_apart(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const float noise = config->apart_noise * state->speed_noise_m2_s2;
    const float told = ground_speed_told_by_wheels(config, state, config->apart_least_m_s);
    // of a body that sways on its wheels: the mean square, less what noise makes on average, a ninth of what it may make
    const float shaken = state->apart_m2_s2 - ground_speed_square(config->apart_least_m_s) - (1.0f / 9.0f) * noise;
    const float apart2 = fixed_clamp(fixed_greater(shaken, told) ? shaken : told, 0.0f, config->speed_max_m_s);
    const float wheels2 = ground_speed_square(state->wheel_m_s - state->wheel_mean_m_s);
    const bool against = fixed_greater(0.0f, state->speed_m_s * state->wheel_m_s);
    const bool leapt = state->rolls_wait > 0;
    const bool own = fixed_greater(wheels2, noise) && !ground_speed_body_departs(state);
    const bool theirs = !against && (leapt || own);
    state->apart_claim_m2_s2 = (theirs ? wheels_own : 1.0f) * config->apart_share * apart2;
}

static const float stands_share = 0.16f; // [1] of (29), derived there

static void state_std(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    float variance;
    if (state->standstill) {
        const float stands = stands_share * state->apart_m2_s2 + ground_speed_square(state->rest_mean_m_s); // (29)
        variance = fixed_greater(state->p_vv, stands) ? stands : state->p_vv;
    } else if (config->method == GROUND_SPEED_PAPER) {
        variance = state->p_vv;
    } else {
        // (3) does not see what the accelerometer's noise has done since the window's middle: V carries it on both sides.
        const float rest = fixed_bits(state->felt_m_s) == 0u ? 1.0f : 1.0f - felt_takes * state->felt_trust; // of it, that (14) leaves
        const float own = state->p_vv + state->unseen_m2_s2 * rest;
        float calm = fixed_greater(own, state->calm_at_m2_s2) ? own - state->calm_less_m2_s2 : own * state->calm; // (28)
        calm = state->cover.on && fixed_greater(calm, own) ? own : calm;                                          // no value tells there
        variance = calm + state->apart_claim_m2_s2 + ground_speed_square(state->alike_m_s) + ground_speed_square(state->jolt_m_s);
        variance += state->other_alive ? state->doubt_m2_s2 : 0.0f;
    }
    variance += fixed_bits(state->gyro_doubt_m2_s2) == 0u ? 0.0f : state->gyro_doubt_m2_s2;
    state->std_m_s = sqrtf(variance > 0.0f ? variance : 0.0f);
}

// What need not be done in every tick, one after the other in ticks that have time; all of it 8 times a second or more.
enum { CHORES = 8 };

static void do_chore(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    state->chore = (state->chore + 1u) % (2u * CHORES);
    if (state->chore == 0u && config->speed_noise_max_m2_s2 > config->speed_noise_m2_s2) {
        ground_speed_watch_noise(config, state);
    } else if (state->chore == CHORES) {
        ground_speed_watch_slow_noise(state);
    } else if (state->chore % CHORES == 1u) {
        ground_speed_watch_gyro(config, state);
    } else if (state->chore % CHORES == 3u) {
        ask_wheels(config, state, fixed_clamp(fixed_finite(input->wheel_m_s), -config->speed_max_m_s, config->speed_max_m_s),
                   input->wheels_part);
    } else if (state->chore % CHORES == 4u && state->unheard_ticks >= SILENT_TICKS) {
        state->loud = 0;
    } else if (state->chore % CHORES == 2u) {
        watch_apart(config, state);
    } else if (state->chore % CHORES == 5u) {
        watch_apart(config, state);
        state_std(config, state);
    } else if (state->chore % CHORES == 6u) {
        ground_speed_track_t track = ground_speed_best_of(state);
        ground_speed_hold(config, &track);
        ground_speed_keep_best(state, &track);
    }
}

static void step_ours(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input, bool fresh)
{
    if (fresh) {
        count_values(config, state, input);
    } else if (state->waits > 1) {
        state->waits = 1;
        ground_speed_watch_held(config, state);
        ground_speed_watch_cover(state);
        if (state->other_alive) {
            ground_speed_update_other(config, state);
        } else if (state->refused == 0) {
            ground_speed_ask_again(config, state);
        }
    } else if (state->waits > 0) {
        state->waits = 0;
        if (state->rolls_ticks == 0) { // (3) knows no jump within its window
            ground_speed_update_agile(config, state);
        }
        state->slide.due = 2;
    } else if (state->slide.due > 0 && !input->busy) {
        ground_speed_watch_slide(config, state);
    } else if (!input->busy) {
        do_chore(config, state, input);
    }
    state->standstill = is_standing(config, state);
    if (state->standstill) {
        ground_speed_track_t track = ground_speed_best_of(state);
        ground_speed_correct(config, &track, -track.speed_m_s, 0.0f, config->standing_noise_m2_s2);
        ground_speed_keep_best(state, &track);
        state->other_alive = false;
        ground_speed_watch_rest(state);
        state->accepted = true; // rest is known: a first value is gated as any
        state->waits = 0;
        state->agile_left = 0;
        state->agile_sum = 0.0f;
    } else if (fresh && state->quiet >= config->quiet_needed) {
        ground_speed_update_quiet(config, state, input);
    } else if (fresh && !input->doppler_quiet) {
        ground_speed_update_doppler(config, state, input);
    }
}

enum { MISSED_MAX = 16 }; // ticks; longer gaps are for safety

static void tick(const ground_speed_config_t *config, ground_speed_state_t *state, float accel, float noise)
{
    ground_speed_integrate(config, state, accel);
    state->other.ticks += state->other.ticks < 1000 ? 1 : 0;
    state->slide.ticks++;
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

// The mean of both signs by their odds, less (14). A tick that is busy has no time for a second difference.
static float reported(ground_speed_state_t *state, bool busy)
{
    if (!busy) {
        state->less_m_s = state->other_alive ? state->doubt_m_s + state->felt_m_s : state->felt_m_s;
    }
    return state->standstill ? state->speed_m_s : state->speed_m_s - state->less_m_s;
}

ground_speed_output_t ground_speed_step(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input)
{
    const float accel = input->accel_valid ? fixed_clamp(fixed_finite(input->accel_x_m_s2), -100.0f, 100.0f) : state->bias_m_s2;
    state->lean_q8 = input->lean_q8;
    bool fresh = input->doppler_fresh && fixed_is_finite(input->doppler_m_s);
    if (fresh && input->doppler_quiet && config->method != GROUND_SPEED_PAPER) {
        ground_speed_judge_quiet(config, state, fixed_finite(input->wheel_m_s));
        fresh = !state->cover.on;
    }
    const bool stood = state->standstill;
    const bool rest = fixed_greater(config->still_m_s, fabsf(fixed_finite(input->wheel_m_s))) &&
                      fixed_greater(config->rest_m_s, fabsf(state->rest_mean_m_s)); // (24)
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
        if (!fresh || state->rolls_ticks > 0) { // a value's tick is dear
            ground_speed_watch_wheels(config, state, input);
        }
    }
    if (config->method == GROUND_SPEED_PAPER) {
        state->standstill = false;
        if (fresh) {
            ground_speed_update_paper(config, state, input->doppler_m_s, input->wheel_m_s);
        }
    } else {
        step_ours(config, state, input, fresh);
    }
    state->speed_m_s = fixed_clamp(state->speed_m_s, -config->speed_max_m_s, config->speed_max_m_s);
    if (!input->busy) { // else it is as it was
        state->bias_m_s2 = fixed_clamp(state->bias_m_s2, -config->bias_max_m_s2, config->bias_max_m_s2);
    }
    if (fresh || stood || state->standstill || fixed_bits(state->std_m_s) == 0u) { // a root is dear; (29) ends with the rest
        state_std(config, state);
    }
    const ground_speed_output_t out = {
        .speed_m_s = reported(state, input->busy),
        .std_m_s = state->std_m_s,
        .bias_m_s2 = state->bias_m_s2,
        .standstill = state->standstill,
        .gyro_q8 = (int32_t)state->gyro_q8,
    };
    return out;
}
