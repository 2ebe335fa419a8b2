#include "safety.h"

#include "fixed.h"

#include <math.h>

// Which latch a lost sensor sets, by the number of its FRAME_* bit.
static const uint32_t lost_fault[SAFETY_SENSORS] = {
    FAULT_ENCODER_LOST, FAULT_ENCODER_LOST, FAULT_ENCODER_LOST, FAULT_ENCODER_LOST, FAULT_CURRENT_LOST, FAULT_CURRENT_LOST,
    FAULT_CURRENT_LOST, FAULT_CURRENT_LOST, FAULT_BATTERY_LOST, FAULT_ACCEL_LOST,   FAULT_GYRO_LOST,    FAULT_RADAR_LOST,
};

// Counts how long a cause has lasted; true once it has lasted longer than `limit_s`.
static bool lasted(float *elapsed_s, bool cause, float tick_s, float limit_s)
{
    if (!cause) {
        *elapsed_s = 0.0f;
        return false;
    }
    *elapsed_s = fixed_clamp(*elapsed_s + tick_s, 0.0f, limit_s + 2.0f * tick_s);
    return fixed_greater(*elapsed_s, limit_s);
}

// Counts up in a bad tick, to 0 in a good one; true once there were more than `patience` in a row.
static bool too_many(uint32_t *ticks, bool bad, uint32_t patience)
{
    *ticks = !bad ? 0u : *ticks + (*ticks < UINT32_MAX ? 1u : 0u);
    return *ticks > patience;
}

static uint32_t check_line(const safety_config_t *config, safety_state_t *state, const sensor_frame_t *frame)
{
    const bool unread = (config->required & FRAME_EMERGENCY_STOP) != 0u && (frame->present & FRAME_EMERGENCY_STOP) == 0u;
    const bool deaf = too_many(&state->line_ticks, unread, config->patience_ticks);
    return frame->emergency_stop || deaf ? (uint32_t)FAULT_EMERGENCY_STOP : 0u;
}

static uint32_t check_bridges(const safety_config_t *config, safety_state_t *state, const sensor_frame_t *frame, uint32_t *wheels)
{
    const uint32_t answers = (frame->present / FRAME_BRIDGE_0) & 0xfu;
    const uint8_t *status = frame->bridge_status;
    const bool well = answers == state->bridges && (status[0] | status[1] | status[2] | status[3]) == 0u;
    if (well && !state->bridges_counting) {
        return 0u;
    }
    state->bridges |= answers;
    state->bridges_counting = !well;
    uint32_t faults = 0;
    for (uint32_t wheel = 0; wheel < WHEEL_COUNT; wheel++) {
        const uint32_t bit = 1u << wheel;
        const bool bad = (answers & bit) != 0u ? status[wheel] != 0u : (state->bridges & bit) != 0u;
        if (too_many(&state->bridge_ticks[wheel], bad, config->patience_ticks)) {
            faults |= (uint32_t)FAULT_BRIDGE;
            *wheels |= bit;
        }
    }
    return faults;
}

static uint32_t check_sensors(const safety_config_t *config, safety_state_t *state, const safety_input_t *input, uint32_t *wheels)
{
    const uint32_t all = (1u << SAFETY_SENSORS) - 1u;
    if ((input->usable & all) == all && input->absurd == 0u && !state->counting) {
        return 0u; // the tick of a rover that is well: every count is 0 and stays so
    }
    state->counting = (input->usable & all) != all || input->absurd != 0u; // else the counts are cleared in this tick
    uint32_t faults = 0;
    for (uint32_t i = 0; i < SAFETY_SENSORS; i++) {
        const uint32_t bit = 1u << i;
        const bool absurd = (input->absurd & bit) != 0u;
        const bool good = (input->usable & bit) != 0u;
        const bool lost = too_many(&state->bad_ticks[i], !good, config->patience_ticks) && (config->required & bit) != 0u;
        const bool mad = too_many(&state->absurd_ticks[i], absurd, config->patience_ticks);
        faults |= lost ? lost_fault[i] : 0u;
        faults |= mad ? (uint32_t)FAULT_ABSURD_SENSOR : 0u;
        *wheels |= (lost || mad) && i < 2u * WHEEL_COUNT ? 1u << (i % WHEEL_COUNT) : 0u;
    }
    return faults;
}

static uint32_t check_circuit(const safety_input_t *input, uint32_t wheel, uint32_t *limit)
{
    const uint32_t bit = 1u << wheel;
    *limit |= input->broken & bit;
    return ((input->contradict & bit) != 0u ? (uint32_t)FAULT_ENCODER_CIRCUIT : 0u) |
           ((input->broken & bit) != 0u ? (uint32_t)FAULT_MOTOR_OPEN : 0u);
}

static uint32_t check_time(const safety_config_t *config, safety_state_t *state, const safety_input_t *input)
{
    uint32_t faults = 0;
    const uint32_t tick = input->frame->tick;
    if (state->started && tick != state->last_tick + 1u) {
        const uint32_t jump = tick - state->last_tick - 1u; // wraps to a huge number when time stands still or runs back
        const uint32_t room = UINT32_MAX - state->missed;
        state->missed += jump < room ? jump : room;
        state->good_ticks = 0;
    } else if (state->missed > 0u && ++state->good_ticks >= config->missed_forget_ticks) {
        const uint32_t most = config->missed_ticks_max + 1u; // so that a long gap is forgotten in a stated time
        state->missed = (state->missed > most ? most : state->missed) - 1u;
        state->good_ticks = 0;
    }
    state->last_tick = tick;
    state->started = true;
    if (state->missed > config->missed_ticks_max) {
        faults |= FAULT_MISSED_TICKS;
    }
    if (input->command_age_ticks > config->command_patience_ticks) {
        faults |= FAULT_COMMAND_TIMEOUT;
    }
    return faults;
}

// (1), (2) and stall of one wheel; sets its bit in *limit when its current must be limited.
static uint32_t check_wheel(const safety_config_t *config, safety_state_t *state, const safety_input_t *input, int wheel, uint32_t *limit)
{
    uint32_t faults = 0;
    const float current_A = fixed_clamp(input->current_A[wheel], -100.0f, 100.0f); // [A] far beyond any rail: keeps (1), (2) finite
    const float square = current_A * current_A;
    const float excess = square - config->current_continuous_A2;
    state->i2t_A2_ticks[wheel] = fixed_clamp(state->i2t_A2_ticks[wheel] + excess, 0.0f, 1e6f); // (1)
    if (fixed_greater(state->i2t_A2_ticks[wheel], config->i2t_max_A2_ticks)) {
        faults |= FAULT_OVER_CURRENT;
        *limit |= 1u << (uint32_t)wheel;
    }
    if ((uint32_t)wheel == state->turn) {
        state->rise_K[wheel] = fixed_clamp(config->keeping * state->rise_K[wheel] + config->heating_K_A2 * square, 0.0f, 1000.0f); // (2)
    }
    if (fixed_greater(state->rise_K[wheel], config->temperature_rise_max_K)) {
        faults |= FAULT_OVER_TEMPERATURE;
    }
    const bool stalled = fixed_greater(fabsf(current_A), config->stall_current_A) &&
                         fixed_greater(config->stall_speed_rad_s, fabsf(input->speed_rad_s[wheel]));
    if (lasted(&state->stall_s[wheel], stalled, config->tick_s, config->stall_s)) {
        faults |= FAULT_STALL;
        *limit |= 1u << (uint32_t)wheel;
    }
    return faults;
}

static uint32_t check_battery(const safety_config_t *config, safety_state_t *state, const safety_input_t *input)
{
    const bool known = (input->usable & FRAME_BATTERY) != 0u;
    const bool low = known && !fixed_greater(input->battery_V, config->battery_min_V);
    const bool broken = known && !fixed_greater(input->battery_V, config->brown_out_V);
    uint32_t faults = lasted(&state->low_battery_s, low, config->tick_s, config->battery_s) ? (uint32_t)FAULT_LOW_BATTERY : 0u;
    faults |= too_many(&state->brown_out_ticks, broken, config->brown_out_ticks) ? (uint32_t)FAULT_BROWN_OUT : 0u;
    return faults;
}

// (3): true once the radar has been dead for its blocks in a row. Standing wheels forgive it: a quiet front end then tells nothing.
static bool radar_dead(const safety_config_t *config, safety_state_t *state, const sensor_frame_t *frame, bool turning)
{
    enum { BLOCK = 32 };
    if (!turning) {
        state->radar_dead_blocks = 0;
        state->radar_samples = 0;
        return false;
    }
    for (uint32_t i = 0; i < frame->radar_samples && i < RADAR_SAMPLES_PER_TICK_MAX; i++) {
        if (state->radar_samples == 0u) {
            state->radar_first = frame->radar_count[i];
            state->radar_sum = 0;
            state->radar_square = 0;
        }
        const int32_t x = (int32_t)frame->radar_count[i] - (int32_t)state->radar_first; // within +-1023: sense calls more absurd
        state->radar_sum += x;
        state->radar_square += (uint32_t)(x * x);
        if (++state->radar_samples == BLOCK) {
            const uint32_t power = (uint32_t)BLOCK * state->radar_square - (uint32_t)(state->radar_sum * state->radar_sum);
            const bool dead = power < config->radar_dead_count2;
            state->radar_dead_blocks = dead ? state->radar_dead_blocks + (state->radar_dead_blocks < UINT32_MAX ? 1u : 0u) : 0u;
            state->radar_samples = 0;
        }
    }
    return state->radar_dead_blocks >= config->radar_dead_blocks;
}

// The rover passes faster than any wheel that turns this way explains, beyond what the estimate knows it does not know; or the radar is
// dead while all turn.
static uint32_t check_agreement(const safety_config_t *config, safety_state_t *state, const safety_input_t *input)
{
    const bool backward = fixed_greater(0.0f, input->ground_speed_m_s);
    const float passes = backward ? -input->ground_speed_m_s : input->ground_speed_m_s;
    const float turns_rad_s = backward ? -input->low_rad_s : input->high_rad_s; // of the wheel that turns most this way
    const float explained = turns_rad_s * config->disagree_ratio_m + config->disagree_m_s;
    const bool beyond = fixed_greater(passes, explained) && fixed_greater(passes - config->sigmas * input->ground_speed_std_m_s, explained);
    const bool disagrees = lasted(&state->disagree_s, beyond, config->tick_s, config->disagree_s);
    uint32_t faults = disagrees ? (uint32_t)FAULT_SPEED_DISAGREE : 0u;
    if ((input->usable & FRAME_RADAR) != 0u) {
        const bool turning = fixed_greater(input->least_rad_s, config->turning_rad_s);
        faults |= radar_dead(config, state, input->frame, turning) ? (uint32_t)FAULT_RADAR_LOST : 0u;
    }
    return faults;
}

void safety_warm(const safety_config_t *config, safety_state_t *state, const float rise_K[WHEEL_COUNT])
{
    const float unknown_K = 0.8f * config->temperature_rise_max_K;
    for (int wheel = 0; wheel < WHEEL_COUNT; wheel++) {
        const bool known = rise_K != 0 && fixed_is_finite(rise_K[wheel]);
        state->rise_K[wheel] = known ? fixed_clamp(rise_K[wheel], 0.0f, 1000.0f) : unknown_K;
    }
}

safety_output_t safety_step(const safety_config_t *config, safety_state_t *state, const safety_input_t *input)
{
    uint32_t limit = 0;
    uint32_t wheels = 0;
    uint32_t now = check_line(config, state, input->frame);
    now |= check_sensors(config, state, input, &wheels);
    now |= check_bridges(config, state, input->frame, &wheels);
    now |= check_time(config, state, input);
    for (int wheel = 0; wheel < WHEEL_COUNT; wheel++) {
        const uint32_t mine = check_wheel(config, state, input, wheel, &limit) | check_circuit(input, (uint32_t)wheel, &limit);
        wheels |= mine != 0u ? 1u << (uint32_t)wheel : 0u;
        now |= mine;
    }
    state->turn = (state->turn + 1u) % WHEEL_COUNT;
    now |= check_battery(config, state, input);
    now |= check_agreement(config, state, input);
    now |= input->estimator;

    state->faults = input->command_stop ? now : (state->faults | now);
    state->limited = input->command_stop ? limit : (state->limited | limit);
    state->wheels = input->command_stop ? wheels : (state->wheels | wheels);
    const safety_output_t out = {
        .faults = state->faults,
        .motors_off = (state->faults & ~(uint32_t)SAFETY_LIMITING) != 0u,
        .limited = state->limited,
        .wheels = state->wheels,
    };
    return out;
}
