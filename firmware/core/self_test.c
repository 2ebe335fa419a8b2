#include "self_test.h"

#include "fixed.h"

#include <math.h>

const char *self_test_name(int32_t index)
{
    switch (index >= 0 && index < SELF_TEST_FAILURES ? 1u << (uint32_t)index : 0u) {
    case SELF_TEST_SILENT:
        return "a device does not answer";
    case SELF_TEST_MOVING:
        return "the rover is not at rest: put it on level ground";
    case SELF_TEST_RADAR_DEAD:
        return "the radar's front end is dead: less noise than one count";
    case SELF_TEST_RADAR_NOISY:
        return "the radar hears far more than its own noise at rest";
    case SELF_TEST_RADAR_OFFSET:
        return "the radar's converter rests elsewhere than described: radar.offset_count";
    case SELF_TEST_ACCEL:
        return "the accelerometer does not feel gravity: bias, axis or scale";
    case SELF_TEST_GYRO:
        return "the gyro turns at rest";
    case SELF_TEST_BATTERY:
        return "the battery is too low to drive";
    case SELF_TEST_CURRENT_ZERO:
        return "a current is measured though no motor is driven: current.offset_count";
    case SELF_TEST_CURRENT_SIGN:
        return "a current runs against its duty: swap the sensor's sign";
    case SELF_TEST_MOTOR_OPEN:
        return "a motor takes no current: wire, brush or bridge";
    case SELF_TEST_ENCODER_SIGN:
        return "a wheel turns against its duty: swap encoder_sign, or the motor's leads";
    case SELF_TEST_ENCODER_DEAD:
        return "an encoder does not move though its motor draws current: dead, or the wheel is held";
    case SELF_TEST_WHEEL_ORDER:
        return "another wheel answers a motor's pulse: the order of the wheels";
    case SELF_TEST_STOPPED:
        return "safety stopped the rover during its self-test";
    default:
        return "";
    }
}

void self_test_begin(self_test_state_t *state, self_test_result_t *result)
{
    const self_test_state_t zero = {0};
    const self_test_result_t none = {0};
    *state = zero;
    state->wheel = -1;
    *result = none;
}

static bool has_wheel(const self_test_config_t *config, int32_t wheel) { return (config->wheels & (1u << (uint32_t)wheel)) != 0u; }

// The first wheel from `wheel` on that the rover has; WHEEL_COUNT: none.
static int32_t wheel_from(const self_test_config_t *config, int32_t wheel)
{
    while (wheel < WHEEL_COUNT && !has_wheel(config, wheel)) {
        wheel++;
    }
    return wheel;
}

static int32_t moved(const self_test_config_t *config, const self_test_state_t *state, const sensor_frame_t *frame, int wheel)
{
    if (!has_wheel(config, wheel)) {
        return 0; // its field has no meaning
    }
    return fixed_wrap_difference(frame->encoder_count[wheel], state->begin_count[wheel]);
}

static void begin_phase(self_test_state_t *state, const sensor_frame_t *frame, int32_t wheel)
{
    state->tick = 0;
    state->wheel = wheel;
    state->duty = 0.0f;
    state->pulse_V = 0.0f;
    state->pulse_n = 0;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        state->begin_count[i] = frame->encoder_count[i];
        state->pulse_A[i] = 0.0f;
    }
}

// --- (1)

static void listen(const self_test_config_t *config, self_test_state_t *state, const sensor_frame_t *frame, const trace_t *trace)
{
    state->frames++;
    for (uint32_t bit = 0; bit < 32u; bit++) {
        const bool missing = ((config->required & ~frame->present) & (1u << bit)) != 0u;
        state->missing[bit] = (uint8_t)(state->missing[bit] + (missing && state->missing[bit] < UINT8_MAX ? 1u : 0u));
        state->silent |= 2u * state->missing[bit] > (uint32_t)config->rest_ticks ? 1u << bit : 0u;
    }
    for (uint32_t i = 0; (frame->present & FRAME_RADAR) != 0u && i < frame->radar_samples && i < RADAR_SAMPLES_PER_TICK_MAX; i++) {
        const int32_t x = (int32_t)(frame->radar_count[i] & 1023u) - config->radar_rest_count;
        if (state->radar_n < 1000) { // 1000 times 1023^2 is within 32 bits
            state->radar_n++;
            state->radar_sum += x;
            state->radar_square += (uint32_t)(x * x);
        }
    }
    const int16_t axis[3] = {frame->accel_x_count, frame->accel_y_count, frame->accel_z_count};
    for (int i = 1; i < 3; i++) {
        state->accel_m_s2[i] += (float)axis[i] * config->accel_m_s2_per_count;
    }
    state->accel_m_s2[0] += fixed_finite(trace->accel_x_m_s2);
    state->gyro_rad_s += fixed_finite(trace->gyro_z_rad_s);
    state->battery_V += fixed_finite(trace->battery_voltage_V);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        state->current_A[i] += fixed_finite(trace->wheel[i].current_A);
    }
}

static void judge_radar(const self_test_config_t *config, const self_test_state_t *state, self_test_result_t *result)
{
    if (state->radar_n == 0) {
        return; // silent, which is told
    }
    const float n = (float)state->radar_n;
    const float mean = (float)state->radar_sum / n;
    const float variance = (float)state->radar_square / n - mean * mean;
    result->radar_offset_count = mean;
    result->radar_noise_count = variance > 0.0f ? sqrtf(variance) : 0.0f;
    result->failures |= fixed_greater(config->radar_dead_count2, variance) ? (uint32_t)SELF_TEST_RADAR_DEAD : 0u;
    result->failures |= fixed_greater(variance, config->radar_noisy_count2) ? (uint32_t)SELF_TEST_RADAR_NOISY : 0u;
    result->failures |= fixed_greater(fabsf(mean), config->radar_offset_count) ? (uint32_t)SELF_TEST_RADAR_OFFSET : 0u;
}

static void judge_rest(const self_test_config_t *config, self_test_state_t *state, const sensor_frame_t *frame, self_test_result_t *result)
{
    const float per_frame = 1.0f / (float)(state->frames > 0u ? state->frames : 1u);
    float square = 0.0f;
    for (int i = 0; i < 3; i++) {
        result->accel_m_s2[i] = state->accel_m_s2[i] * per_frame;
        square += result->accel_m_s2[i] * result->accel_m_s2[i];
    }
    result->battery_V = state->battery_V * per_frame;
    judge_radar(config, state, result);
    // gravity by its length where all axes are there; along x alone only what no slope explains
    const bool axes = (frame->present & FRAME_ACCEL_YZ) != 0u;
    const bool length = axes && fixed_greater(fabsf(sqrtf(square) - config->gravity_m_s2), config->gravity_slack_m_s2);
    const bool steep = fixed_greater(fabsf(result->accel_m_s2[0]), config->accel_slope_m_s2);
    result->failures |= length || steep ? (uint32_t)SELF_TEST_ACCEL : 0u;
    result->failures |= fixed_greater(fabsf(state->gyro_rad_s * per_frame), config->gyro_rad_s) ? (uint32_t)SELF_TEST_GYRO : 0u;
    result->failures |= fixed_greater(config->battery_V, result->battery_V) ? (uint32_t)SELF_TEST_BATTERY : 0u;
    result->failures |= state->silent != 0u ? (uint32_t)SELF_TEST_SILENT : 0u;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        const int32_t turned = moved(config, state, frame, i);
        const uint32_t lost =
            state->silent & (((uint32_t)FRAME_ENCODER_0 | (uint32_t)FRAME_CURRENT_0 | (uint32_t)FRAME_BRIDGE_0) << (uint32_t)i);
        uint32_t mine = turned > config->still_count || turned < -config->still_count ? (uint32_t)SELF_TEST_MOVING : 0u;
        mine |= fixed_greater(fabsf(state->current_A[i] * per_frame), config->zero_A) ? (uint32_t)SELF_TEST_CURRENT_ZERO : 0u;
        result->failures |= mine;
        result->wheels |= mine != 0u || lost != 0u ? 1u << (uint32_t)i : 0u;
    }
}

// --- (2)

static int32_t size_of(int32_t count) { return count < 0 ? -count : count; }

static void judge_pulse(const self_test_config_t *config, self_test_state_t *state, const sense_config_t *sense,
                        const sensor_frame_t *frame, self_test_result_t *result)
{
    const int wheel = state->wheel;
    const float n = (float)(state->pulse_n > 0 ? state->pulse_n : 1);
    const float expected_A = state->pulse_V / n * config->winding_1_ohm;
    const float least_A = config->current_least * expected_A;
    const float mine_A = state->pulse_A[wheel] / n;
    const int32_t mine = moved(config, state, frame, wheel) * sense->encoder_sign[wheel];
    uint32_t failures = 0;
    for (int i = 0; i < WHEEL_COUNT; i++) { // one other's answer, four times all the rest: where the rover rolls, all turn
        const int32_t other = size_of(moved(config, state, frame, i));
        bool turns = i != wheel && other > config->least_count;
        for (int k = 0; k < WHEEL_COUNT; k++) {
            turns = turns && (k == i || 4 * size_of(moved(config, state, frame, k)) < other);
        }
        const bool draws = i != wheel && fixed_greater(fabsf(state->pulse_A[i] / n), least_A) && fixed_greater(least_A, fabsf(mine_A));
        state->turned |= other > config->least_count ? 1u << (uint32_t)i : 0u;
        if (draws) {
            failures |= (uint32_t)SELF_TEST_WHEEL_ORDER;
            result->wheels |= 1u << (uint32_t)i;
        } else if (turns) { // or mine is dead, and the rover rolled: the pulses of the others will tell
            state->instead[wheel] |= 1u << (uint32_t)i;
        }
    }
    if (failures == 0u) {
        const bool flows = fixed_greater(fabsf(mine_A), least_A);
        failures |= !flows ? (uint32_t)SELF_TEST_MOTOR_OPEN : mine_A < 0.0f ? (uint32_t)SELF_TEST_CURRENT_SIGN : 0u;
        if (size_of(mine) > config->least_count) {
            failures |= mine < 0 ? (uint32_t)SELF_TEST_ENCODER_SIGN : 0u;
        } else if (state->instead[wheel] == 0u) {
            failures |= flows ? (uint32_t)SELF_TEST_ENCODER_DEAD : 0u;
        }
    }
    result->failures |= failures;
    result->wheels |= failures != 0u ? 1u << (uint32_t)wheel : 0u;
}

// Another encoder answered instead of a wheel's own: one that never moved at all is dead, one that answers to others is swapped.
static void judge_order(const self_test_state_t *state, self_test_result_t *result)
{
    for (uint32_t wheel = 0; wheel < WHEEL_COUNT; wheel++) {
        const uint32_t bit = 1u << wheel;
        if (state->instead[wheel] != 0u) {
            const bool swapped = (state->turned & bit) != 0u;
            result->failures |= swapped ? (uint32_t)SELF_TEST_WHEEL_ORDER : (uint32_t)SELF_TEST_ENCODER_DEAD;
            result->wheels |= bit | (swapped ? state->instead[wheel] : 0u);
        }
    }
}

// The rising edge of a pulse, and what it did. True when it is over.
static bool pulse(const self_test_config_t *config, self_test_state_t *state, const sensor_frame_t *frame, const trace_t *trace)
{
    for (int i = 0; i < WHEEL_COUNT; i++) {
        state->pulse_A[i] += fixed_finite(trace->wheel[i].current_A);
    }
    state->pulse_V += fixed_finite(state->duty * trace->battery_voltage_V); // acted since the frame before
    state->pulse_n++;
    bool turned = false;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        turned = turned || size_of(moved(config, state, frame, i)) >= config->enough_count;
    }
    state->duty = config->duty_max * (float)(state->tick + 1) / (float)config->pulse_ticks;
    return turned || state->tick >= config->pulse_ticks;
}

command_t self_test_step(const self_test_config_t *config, const sense_config_t *sense, self_test_state_t *state,
                         const sensor_frame_t *frame, const trace_t *trace, self_test_result_t *result)
{
    command_t command = {.mode = MODE_STOP};
    if (result->done || trace == 0) {
        return command;
    }
    if (!state->seen) {
        state->seen = true;
        begin_phase(state, frame, -1);
    }
    const uint32_t stopping = trace->faults & ~((uint32_t)FAULT_MOTOR_OPEN | FAULT_OVER_CURRENT | FAULT_STALL);
    if (state->wheel < 0) {
        listen(config, state, frame, trace);
        if (++state->tick >= config->rest_ticks) {
            judge_rest(config, state, frame, result);
            const int32_t first = wheel_from(config, 0);
            result->done = result->failures != 0u || first == WHEEL_COUNT; // a rover that fails at rest drives no motor
            begin_phase(state, frame, first);
        }
        return command;
    }
    if (stopping != 0u) {
        result->failures |= (uint32_t)SELF_TEST_STOPPED;
        result->wheels |= trace->fault_wheels;
        result->done = true;
        return command;
    }
    command.mode = MODE_OPEN_LOOP;
    if (state->tick < config->pulse_ticks + config->settle_ticks) {
        const bool over = state->tick > config->pulse_ticks || pulse(config, state, frame, trace);
        if (over && state->tick <= config->pulse_ticks) {
            judge_pulse(config, state, sense, frame, result);
            state->tick = config->pulse_ticks; // settle from here on
            state->duty = 0.0f;
        }
        command.duty[state->wheel] = over ? 0.0f : state->duty;
        state->tick++;
        return command;
    }
    const int32_t next = wheel_from(config, state->wheel + 1);
    if (next < WHEEL_COUNT) {
        begin_phase(state, frame, next);
        return command;
    }
    judge_order(state, result);
    result->done = true;
    command.mode = MODE_STOP;
    return command;
}
