#include "ground_speed_parts.h"

#include "fixed.h"

#include <math.h>

static const float gyro_most_q8 = 4194304.0f; // 2^14 counts: half of what the gyro can read
static const float near_limit = 0.7f;         // [1] of the bias's limit, assumed
static const float near_share = 0.25f;        // [1] of what it tells, taken off in each look while there, assumed

static const float creeping = 4.0f; // [1] where the radar is deaf, silence lasts, and wheels that creep are the better witness; assumed

enum { UNHEARD = 25 };   // ticks; two values missed
enum { GIVE_BACK = 10 }; // looks in which r is given back while it stands, where lean.h learns the offset anew

bool ground_speed_gyro_tells(const ground_speed_config_t *config, const ground_speed_state_t *state)
{
    const int32_t leant_q8 = state->lean_q8 - state->lean_mean_q8;
    return leant_q8 > config->lean_told_q8 || leant_q8 < -config->lean_told_q8;
}

static void move_by(ground_speed_state_t *state, float change_q8)
{
    state->gyro_q8 = (int32_t)fixed_clamp((float)state->gyro_q8 + change_q8, -gyro_most_q8, gyro_most_q8);
}

void ground_speed_gyro_lied(const ground_speed_config_t *config, ground_speed_state_t *state, float share)
{
    const float turned_q8 = config->gyro_turns * (float)(state->lean_q8 - state->lean_mean_q8);
    move_by(state, share * turned_q8);
}

// (16), over the ticks since the last look. Where the bias is not known there is nothing to learn.
void ground_speed_watch_gyro(const ground_speed_config_t *config, ground_speed_state_t *state)
{
    const uint32_t passed = state->slide.ticks - state->gyro_asked;
    const float ticks = passed < 100u ? (float)(int32_t)passed : 100.0f;
    state->gyro_asked = state->slide.ticks;
    if (state->lean_q8 == 0) { // no gyro has told of anything
        state->bias_mean_m_s2 = state->bias_m_s2;
        return;
    }
    const bool alone = state->unheard_ticks > UNHEARD || state->refused > 0; // what is refused tells nothing
    state->gyro_alone_ticks = !alone ? 0 : state->gyro_alone_ticks < 1000 ? state->gyro_alone_ticks + (int32_t)passed % 100 : 1000;
    if (alone && !state->standstill) { // d(r^2 t^2), of a lean that runs off by r
        const bool creeps = fixed_greater(config->slow_m_s, fabsf(state->wheel_m_s));
        state->p_bb += (creeps ? 2.0f * creeping : 2.0f) * config->gyro_runs_m2_s6 * config->tick_s * config->tick_s * ticks *
                       (float)state->gyro_alone_ticks;
    }
    if (state->standstill || state->other_alive || !fixed_greater(ground_speed_bias_known_m2_s4, state->p_bb)) {
        state->bias_mean_m_s2 = state->bias_m_s2;
        state->gyro_doubt_m2_s2 = 0.0f;
        state->gyro_q8 -= state->standstill ? state->gyro_q8 / GIVE_BACK : 0;
        return;
    }
    const float apart = state->bias_m_s2 - state->bias_mean_m_s2;
    const float beyond = fabsf(apart) - config->gyro_sure_m_s2;
    const float sway = fabsf(state->apart_m2_s2 - ground_speed_square(state->apart_mean_m_s));
    const float sure = config->gyro_steady_m2_s2 / (config->gyro_steady_m2_s2 + sway);
    state->gyro_doubt_m2_s2 = fixed_greater(beyond, 0.0f) ? ground_speed_square(beyond) : 0.0f; // times (1 s)^2
    state->bias_mean_m_s2 += config->gyro_slow * ticks * apart;
    move_by(state, config->gyro_learns_q8_s2_m * ticks * apart * sure);
    const bool near = fixed_greater(fabsf(state->bias_m_s2), near_limit * config->bias_max_m_s2);
    if (near && (state->bias_m_s2 < 0.0f) != (state->lean_q8 < 0)) {
        ground_speed_gyro_lied(config, state, near_share);
    }
}
