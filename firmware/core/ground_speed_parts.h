// ground_speed_parts.h - what the files of ground_speed share; nobody else includes it. The numbers are the equations of ground_speed.h.
//
//   ground_speed.c        a tick: what is done when, standing, the wheels' witness, the standard deviation
//   ground_speed_track.c  one track [v, b]: prediction (2), correction, bounds; V and what a window remembers (3); noise (6)
//   ground_speed_value.c  a Doppler value on the best track: (1), (3), (4), (5), (8), (11); a quiet one
//   ground_speed_cover.c  whether a quiet echo tells of a stop or of a radar that sees nothing, (38)
//   ground_speed_sign.c   the other sign, (9)
//   ground_speed_held.c   a sign that is sure as long as the radar hears no turn, (17)
//   ground_speed_slide.c  a turn through zero that the last values tell of, (15)
//   ground_speed_jump.c   the track whose bias may jump, (7)
//   ground_speed_gyro.c   a gyro whose offset has moved, (16)
//   ground_speed_wheels.c where accelerometer and wheels part: (10), and whether it is slip or a slope, (13); what of it is noise, (14)
#ifndef TRACTION_FIRMWARE_CORE_GROUND_SPEED_PARTS_H
#define TRACTION_FIRMWARE_CORE_GROUND_SPEED_PARTS_H

#include "fixed.h"
#include "ground_speed.h"

static const float ground_speed_bias_known_m2_s4 = 0.09f; // (0.3 m/s^2)^2: what is not known has no jump to be told by, assumed

static inline float ground_speed_square(float x) { return x * x; }

// ln |x| to within 0.06: exponent, and mantissa as a straight line; -88 for 0.
static inline float ground_speed_ln_rough(float x)
{
    return (float)((int32_t)(fixed_bits(x) & 0x7fffffffu) - 0x3f800000) * (0.693147f / 8388608.0f);
}

// What a mean of the accelerometer less the lean was when it was felt.
static inline float ground_speed_felt_force(const ground_speed_config_t *config, const ground_speed_state_t *state, float level_m_s2)
{
    return state->lean_q8 == 0 ? level_m_s2 : level_m_s2 + (float)state->lean_q8 * config->lean_m_s2_per_q8;
}

static inline ground_speed_track_t ground_speed_best_of(const ground_speed_state_t *state)
{
    const ground_speed_track_t track = {state->speed_m_s, state->bias_m_s2, state->p_vv, state->p_vb, state->p_bb};
    return track;
}

static inline void ground_speed_keep_best(ground_speed_state_t *state, const ground_speed_track_t *track)
{
    state->speed_m_s = track->speed_m_s;
    state->bias_m_s2 = track->bias_m_s2;
    state->p_vv = track->p_vv;
    state->p_vb = track->p_vb;
    state->p_bb = track->p_bb;
}

// --- ground_speed_track.c

// Brings a track back into its bounds.
void ground_speed_hold(const ground_speed_config_t *config, ground_speed_track_t *track);
void ground_speed_move(const ground_speed_config_t *config, ground_speed_track_t *track, float change_m_s, float time_s, float noise,
                       float bias_noise);
void ground_speed_correct(const ground_speed_config_t *config, ground_speed_track_t *track, float innovation, float tau, float noise);
// Variance of what (3) expects.
float ground_speed_spread_of(const ground_speed_track_t *track, float tau);
void ground_speed_integrate(const ground_speed_config_t *config, ground_speed_state_t *state, float accel_m_s2);
void ground_speed_watch_slow_noise(ground_speed_state_t *state);
void ground_speed_watch_noise(const ground_speed_config_t *config, ground_speed_state_t *state);

// What (3) needs of the past: the speed in the window's middle is v + tau b - change.
typedef struct {
    float tau_s;
    float change_m_s;
    float accel_m_s2; // mean raw acceleration over the window
} ground_speed_past_t;

ground_speed_past_t ground_speed_look_back(const ground_speed_config_t *config, const ground_speed_state_t *state, float late);

// --- ground_speed_value.c

// The last value as a track sees it whose own acceleration in the value's window is `own_accel`: it smears the window, (11).
typedef struct {
    float speed_m_s;
    float noise_m2_s2;
} ground_speed_value_t;

ground_speed_value_t ground_speed_value_for(const ground_speed_config_t *config, const ground_speed_state_t *state,
                                            const ground_speed_track_t *track, float own_accel_m_s2);
// A track of which nothing is known but the last value with that sign, and a bias.
ground_speed_track_t ground_speed_told(const ground_speed_config_t *config, const ground_speed_state_t *state, float sign, float bias_m_s2,
                                       float p_bb);
void ground_speed_update_paper(const ground_speed_config_t *config, ground_speed_state_t *state, float doppler_m_s, float wheel_m_s);
void ground_speed_update_doppler(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input);
void ground_speed_update_quiet(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input);

// --- ground_speed_cover.c

// At every quiet value, before it counts: (38).
void ground_speed_judge_quiet(const ground_speed_config_t *config, ground_speed_state_t *state, float wheel_m_s);
// At every loud value, a tick later.
void ground_speed_watch_cover(ground_speed_state_t *state);
// In every tick of a rest.
void ground_speed_watch_rest(ground_speed_state_t *state);

// --- ground_speed_sign.c

// 2 ln of the odds that (12) gives to forward travel, of the last value.
float ground_speed_force_odds(const ground_speed_config_t *config, const ground_speed_state_t *state);
// The same of the wheels' sign alone.
float ground_speed_wheel_odds(const ground_speed_config_t *config, float measured, float wheel_m_s);
// The wheels' hint for a value: their mean rim speed, or that of one that rolls beside others that spin.
float ground_speed_hint(const ground_speed_config_t *config, const ground_speed_input_t *input, float measured);
void ground_speed_split(ground_speed_state_t *state, ground_speed_side_t *side, const ground_speed_track_t *track);
// Instead of that, where one sign is taken alone.
void ground_speed_ask_again(const ground_speed_config_t *config, ground_speed_state_t *state);
float ground_speed_choose_sign(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_track_t *track,
                               float measured, float middle, float spread, float wheel_m_s);
void ground_speed_update_other(const ground_speed_config_t *config, ground_speed_state_t *state);

// --- ground_speed_slide.c

// At every value that tells of a full window.
void ground_speed_remember(ground_speed_state_t *state);
void ground_speed_watch_slide(const ground_speed_config_t *config, ground_speed_state_t *state);

// --- ground_speed_held.c

// At every value, a tick later: (17), (18).
void ground_speed_watch_held(const ground_speed_config_t *config, ground_speed_state_t *state);

// --- ground_speed_jump.c

// The window's middle of the last value, which came `ago` ticks ago: V there, as the mean over the window.
int32_t ground_speed_middle_q20(const ground_speed_state_t *state, uint32_t ago);

void ground_speed_forget_agile(ground_speed_state_t *state);
void ground_speed_update_agile(const ground_speed_config_t *config, ground_speed_state_t *state);

// --- ground_speed_gyro.c

void ground_speed_watch_gyro(const ground_speed_config_t *config, ground_speed_state_t *state);
// Whether the lean has just told of a slope.
bool ground_speed_gyro_tells(const ground_speed_config_t *config, const ground_speed_state_t *state);
// What it has just told is its offset; the share of it that is taken off at once.
void ground_speed_gyro_lied(const ground_speed_config_t *config, ground_speed_state_t *state, float share);

// --- ground_speed_wheels.c

void ground_speed_weigh_wheels(const ground_speed_config_t *config, ground_speed_state_t *state);
float ground_speed_told_by_wheels(const ground_speed_config_t *config, const ground_speed_state_t *state, float least_m_s);
// (21)
bool ground_speed_body_departs(const ground_speed_state_t *state);
// While (13) holds the wheels' word: what the body felt beside it is over.
bool ground_speed_force_is_over(const ground_speed_config_t *config, const ground_speed_state_t *state);
void ground_speed_watch_wheels(const ground_speed_config_t *config, ground_speed_state_t *state, const ground_speed_input_t *input);
// (23), where the wheels roll or creep.
void ground_speed_follow_wheels(const ground_speed_config_t *config, ground_speed_state_t *state, bool creep);
void ground_speed_watch_radar(const ground_speed_config_t *config, ground_speed_state_t *state);
// What a track that rolls needs of the past in place of (3): the wheels' speed, and its mean over about the window.
ground_speed_past_t ground_speed_rolled(const ground_speed_state_t *state);
void ground_speed_no_rolling(ground_speed_state_t *state);

#endif
