#include "control.h"

#include "fixed.h"

#include <math.h>

// What the control part of a tick reads: measurements and estimates in SI.
typedef struct {
    const command_t *command;
    const sense_output_t *sense;
    circuit_output_t circuit;
    slip_output_t slip[WHEEL_COUNT];
    float speed_m_s;
    float speed_std_m_s;
    float per_supply_1_V;
} estimate_t;

void control_reset(const control_config_t *config, control_state_t *state)
{
    const control_state_t zero = {0};
    *state = zero;
    for (int32_t i = 0; i < WHEEL_COUNT; i++) {
        state->slip_std[i] = 1.0f; // nothing is known
    }
    ground_speed_reset(&config->ground_speed, &state->ground_speed);
}

static float feed_forward(const control_config_t *config, float reference_rad_s, float per_supply_1_V)
{
    return config->feed_forward ? motor_duty_for_speed(&config->motor, reference_rad_s, per_supply_1_V) : 0.0f;
}

// --- estimate

enum { BEYOND_VALUES = 3 }; // in a row: a quarter of a second

// What the body has of it where wheels steer. Like what follows from the curvature, apart from the tick of a rover that does not steer: its
// registers are its own.
static __attribute__((noinline)) float steered_hint_m_s(const control_config_t *config, const sense_output_t *sense)
{
    float ahead_m_s = 0.0f;
    for (int32_t i = 0; i < WHEEL_COUNT; i++) {
        const float rim_m_s = sense->speed_rad_s[i] * config->slip.wheel_radius_m;
        ahead_m_s += steering_forward(&config->steering, i, rim_m_s, sense->gyro_z_rad_s);
    }
    return config->geometry.wheel_share * ahead_m_s;
}

static float rim_hint_m_s(const control_config_t *config, const sense_output_t *sense)
{
    if (steering_there(&config->steering)) {
        return steered_hint_m_s(config, sense);
    }
    const float sum = sense->speed_rad_s[0] + sense->speed_rad_s[1] + sense->speed_rad_s[2] + sense->speed_rad_s[3];
    return config->geometry.wheel_share * sum * config->slip.wheel_radius_m; // a wheel that is not there has speed 0
}

// [rad/s] assumed: half a rim speed of 0.11 m/s of the reference. A wheel that is blocked or spins alone, or a turn on the spot.
static const float part_rad_s = 2.0f;

typedef struct {
    bool part;
    float slowest_m_s; // rim speed, where they part and all turn one way; else 0
} wheels_t;

static wheels_t compare_wheels(const control_config_t *config, const sense_output_t *sense)
{
    float low = 0.0f;
    float high = 0.0f;
    bool first = true;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        const float speed = sense->speed_rad_s[i];
        if (!rover_has_wheel(&config->geometry, i)) {
            continue;
        }
        if (first) {
            low = speed;
            high = speed;
            first = false;
        } else if (fixed_greater(low, speed)) {
            low = speed;
        } else if (fixed_greater(speed, high)) {
            high = speed;
        }
    }
    wheels_t out = {.part = fixed_greater(high - low, part_rad_s), .slowest_m_s = 0.0f};
    if (out.part) {
        const float slowest_rad_s = fixed_greater(low, 0.0f) ? low : fixed_greater(0.0f, high) ? high : 0.0f;
        out.slowest_m_s = slowest_rad_s * config->slip.wheel_radius_m;
    }
    return out;
}

// A quiet window like no echo counts where wheels turn: near zero it is half a noise and half a turn.
static bool turns(const control_config_t *config, float rim_m_s)
{
    return fixed_greater(fabsf(rim_m_s), 0.75f * config->ground_speed.slow_m_s);
}

// [1] of the fastest speed that the template holds, assumed. Rain and whoever walks ahead of the radar tell of such speeds as
// well; a body that is so fast has wheels that turn as fast, or was felt to be thrown.
static const float beyond_share = 0.5f;

static bool may_be_beyond(const control_config_t *config, const control_state_t *state, float rim_m_s)
{
    const doppler_template_t *beam = config->doppler.beam;
    const float least_m_s = beam->speed_m_s[beam->speeds - 1] * config->doppler.scale;
    const float known_m_s = fabsf(state->ground_speed.speed_m_s);
    const float told_m_s = fixed_greater(fabsf(rim_m_s), known_m_s) ? fabsf(rim_m_s) : known_m_s;
    const bool wheels = fixed_greater(config->ground_speed.still_m_s, 0.0f); // else nobody contradicts the radar
    return !wheels || fixed_greater(told_m_s, beyond_share * least_m_s);
}

static ground_speed_output_t estimate_speed(const control_config_t *config, control_state_t *state, const sense_output_t *sense,
                                            const sensor_frame_t *frame, trace_t *trace)
{
    const bool radar = (sense->usable & FRAME_RADAR) != 0u;
    const int32_t most = frame->radar_samples < RADAR_SAMPLES_PER_TICK_MAX ? frame->radar_samples : RADAR_SAMPLES_PER_TICK_MAX;
    const doppler_arrival_t arrival = {frame->radar_sequence, sense->elapsed_ticks, radar ? most : 0};
    const int32_t missing = doppler_missing(&config->doppler, &state->doppler, &arrival);
    doppler_gap(&config->doppler, &state->doppler, missing, frame->radar_count[0]);
    const wheels_t wheels = compare_wheels(config, sense);
    doppler_output_t doppler = state->heard;
    doppler.late_samples += missing + arrival.count;
    state->heard = doppler_step(&config->doppler, &state->doppler, frame->radar_count, arrival.count);
    const float rim_m_s = rim_hint_m_s(config, sense);
    if (doppler.fresh) {
        const bool beyond = doppler.beyond && may_be_beyond(config, state, rim_m_s);
        state->beyond = !beyond ? 0 : state->beyond + (state->beyond < BEYOND_VALUES ? 1 : 0);
        state->doppler_m_s = doppler.speed_m_s;
    }
    const ground_speed_input_t input = {
        .accel_x_m_s2 = sense->level_m_s2,
        .doppler_m_s = doppler.speed_m_s,
        .doppler_late_s = doppler.fresh ? (float)doppler.late_samples * config->doppler.per_sample_s : 0.0f,
        .wheel_m_s = rim_m_s,
        .slowest_m_s = wheels.slowest_m_s,
        .wheels_part = wheels.part,
        .accel_valid = (sense->usable & FRAME_ACCEL) != 0u,
        .doppler_fresh = doppler.fresh && !doppler.beyond && !doppler.spoilt && (!doppler.strange || turns(config, rim_m_s)),
        .doppler_quiet = doppler.quiet,
        .doppler_dead = doppler.dead,
        .busy = state->heard.busy || state->heard.fresh,
        .doppler_trust = doppler.trust,
        .doppler_misfit = doppler.misfit,
        .doppler_relieved = doppler.relieved,
        .elapsed_ticks = sense->elapsed_ticks,
        .lean_q8 = sense->lean_q8,
    };
    const ground_speed_output_t speed = ground_speed_step(&config->ground_speed, &state->ground_speed, &input);
    trace->radar_speed_m_s = state->doppler_m_s;
    trace->radar_fresh = doppler.fresh && !doppler.quiet && !doppler.beyond && !doppler.spoilt; // without an echo there is no value
    trace->speed_m_s = speed.speed_m_s;
    trace->speed_std_m_s = speed.std_m_s;
    trace->accel_bias_m_s2 = speed.bias_m_s2;
    trace->standstill = speed.standstill;
    state->sense.standing = speed.standstill;
    state->sense.gyro_q8 = speed.gyro_q8;
    return speed;
}

typedef struct {
    float wheel_m_s[WHEEL_COUNT];
} ground_t;

// Ground speed of the wheels' centres along their heading: the body's, and what the yaw rate adds at half a track to the side; of a wheel
// that steers, what it rolls.
static ground_t wheels_ground(const control_config_t *config, float speed_m_s, float yaw_rate_rad_s)
{
    const float offset = config->geometry.half_track_m * yaw_rate_rad_s;
    const float left_m_s = speed_m_s - offset;
    const float right_m_s = speed_m_s + offset;
    ground_t out = {{left_m_s, right_m_s, left_m_s, right_m_s}};
    if (!steering_there(&config->steering)) {
        return out;
    }
    for (int32_t i = 0; i < WHEEL_COUNT; i++) {
        out.wheel_m_s[i] = steering_rim(&config->steering, i, out.wheel_m_s[i], yaw_rate_rad_s);
    }
    return out;
}

// A root and a division: of one wheel, in ticks without a transform or a search.
static void doubt_slip(const control_config_t *config, control_state_t *state, const estimate_t *estimate, const ground_t *ground)
{
    if (state->heard.busy || state->heard.fresh) {
        return;
    }
    const int32_t i = state->slip_turn & (WHEEL_COUNT - 1);
    state->slip_std[i] = slip_std(&config->slip, estimate->sense->speed_rad_s[i], ground->wheel_m_s[i], estimate->speed_std_m_s);
    state->slip_turn = (i + 1) & (WHEEL_COUNT - 1);
}

static void estimate_wheels(const control_config_t *config, control_state_t *state, estimate_t *estimate, trace_t *trace)
{
    const ground_t ground = wheels_ground(config, estimate->speed_m_s, estimate->sense->gyro_z_rad_s);
    doubt_slip(config, state, estimate, &ground);
    for (int i = 0; i < WHEEL_COUNT; i++) {
        if (!rover_has_wheel(&config->geometry, i)) {
            continue;
        }
        wheel_trace_t *wheel = &trace->wheel[i];
        const sense_output_t *sense = estimate->sense;
        const motor_output_t motor = motor_measure(&config->motor, sense->current_A[i], sense->speed_rad_s[i], sense->accel_rad_s2[i]);
        estimate->slip[i] = slip_measure(&config->slip, sense->speed_rad_s[i], ground.wheel_m_s[i]);
        wheel->speed_rad_s = sense->speed_rad_s[i];
        wheel->accel_rad_s2 = sense->accel_rad_s2[i];
        wheel->current_A = sense->current_A[i];
        wheel->torque_Nm = motor.torque_Nm;
        wheel->traction_N = motor.traction_N;
        wheel->slip = estimate->slip[i].slip;
        wheel->slip_std = state->slip_std[i];
        wheel->slip_valid = estimate->slip[i].valid && !fixed_greater(state->slip_std[i], config->slip.valid_std);
        wheel->encoder_refused = (estimate->circuit.refused & (1u << (uint32_t)i)) != 0u;
    }
}

// --- control

static void drive_wheel_speed(const control_config_t *config, control_state_t *state, const estimate_t *estimate, int i,
                              float reference_rad_s, bool fresh_loop, wheel_trace_t *wheel)
{
    const float speed_rad_s = estimate->sense->speed_rad_s[i];
    if (fresh_loop) {
        wheel_pid_preset(&config->wheel_pid, &state->wheel_pid[i], state->duty[i], speed_rad_s,
                         feed_forward(config, speed_rad_s, estimate->per_supply_1_V));
    }
    const float slewed = wheel_pid_slew(&config->wheel_pid, &state->wheel_pid[i], reference_rad_s);
    const wheel_pid_input_t input = {
        .speed_rad_s = speed_rad_s,
        .accel_rad_s2 = estimate->sense->accel_rad_s2[i],
        .feed_forward = feed_forward(config, slewed, estimate->per_supply_1_V),
    };
    const wheel_pid_output_t out = wheel_pid_step(&config->wheel_pid, &state->wheel_pid[i], &input);
    wheel->set_speed_rad_s = slewed;
    wheel->duty = out.duty;
    wheel->saturated = out.saturated;
}

static void drive_wheel_slip(const control_config_t *config, control_state_t *state, const estimate_t *estimate, int i, float slip_ref,
                             bool fresh_loop, wheel_trace_t *wheel)
{
    const slip_pi_input_t input = {.slip_ref = slip_ref, .slip = estimate->slip[i].slip, .speed_m_s = estimate->speed_m_s};
    if (fresh_loop) {
        slip_pi_preset(&config->slip_pi, &state->slip_pi[i], state->duty[i], &input);
    }
    const slip_pi_output_t out = slip_pi_step(&config->slip_pi, &state->slip_pi[i], &input);
    wheel->duty = out.duty;
    wheel->saturated = out.saturated;
}

// Wheel speed that has slip `slip_ref` at the ground speed at which a rolling wheel turns at `rolling_rad_s`; limited by wheel_max.
static float speed_for_slip(const control_config_t *config, float rolling_rad_s, float slip_ref)
{
    const float limit = config->speed_control.wheel_max_rad_s;
    const float along = rolling_rad_s >= 0.0f ? slip_ref : -slip_ref; // slip is signed in the body frame
    const float ratio = along >= 0.0f ? 1.0f / fixed_clamp(1.0f - along, 0.1f, 1.0f) : 1.0f + along;
    return fixed_clamp(rolling_rad_s * ratio, -limit, limit);
}

// [m/s] assumed: twice what a calm estimate claims. Beyond it an error of the platform's speed counts less, by the square: what the
// estimate doubts itself must not throw the wheels about.
static const float sure_m_s = 0.03f;

static float speed_to_steer_by(control_state_t *state, const estimate_t *estimate, float reference_m_s)
{
    if (!fixed_greater(estimate->speed_std_m_s, sure_m_s)) {
        return estimate->speed_m_s;
    }
    if (fixed_bits(estimate->speed_std_m_s) != fixed_bits(state->steer_std_m_s)) { // a division is dear: not in every tick
        const float ratio = sure_m_s / fixed_clamp(estimate->speed_std_m_s, sure_m_s, 10.0f);
        state->steer_std_m_s = estimate->speed_std_m_s;
        state->steer_share = ratio * ratio;
    }
    return reference_m_s + state->steer_share * (estimate->speed_m_s - reference_m_s);
}

// The curvature that is steered, and the yaw rate that goes with it at the speed that is asked for: a rover that steers cannot turn more.
static __attribute__((noinline)) float steer(const control_config_t *config, control_state_t *state, const command_t *command)
{
    const speed_control_config_t *most = &config->speed_control;
    const float speed_m_s = fixed_clamp(fixed_finite(command->platform_speed_m_s), -most->speed_max_m_s, most->speed_max_m_s);
    const float yaw = fixed_clamp(fixed_finite(command->yaw_rate_rad_s), -most->yaw_rate_max_rad_s, most->yaw_rate_max_rad_s);
    state->curvature_1_m = steering_curvature(&config->steering, speed_m_s, yaw);
    return state->curvature_1_m * speed_m_s;
}

// The reference of a wheel that rolls round the bend, from that of its side.
static __attribute__((noinline)) float steered_rad_s(const control_config_t *config, int32_t wheel, float side_rad_s, float yaw_rate_rad_s)
{
    const float limit = config->speed_control.wheel_max_rad_s;
    const float rim_m_s = steering_rim(&config->steering, wheel, side_rad_s * config->geometry.wheel_radius_m, yaw_rate_rad_s);
    return fixed_clamp(rim_m_s * config->speed_control.per_radius_1_m, -limit, limit);
}

static void drive_mode(const control_config_t *config, control_state_t *state, const estimate_t *estimate, control_mode_t mode,
                       trace_t *trace)
{
    const command_t *command = estimate->command;
    const bool new_mode = mode != state->mode;
    uint8_t slip_active = 0;
    speed_control_output_t platform = {0.0f, 0.0f};
    float front_rad_s = 0.0f;
    float yaw_rate_rad_s = command->yaw_rate_rad_s;
    const bool steers = steering_there(&config->steering) && (mode == MODE_PLATFORM_SPEED || mode == MODE_SLIP);
    if (steers) {
        yaw_rate_rad_s = steer(config, state, command);
    } else if (mode != MODE_STOP && steering_there(&config->steering)) {
        state->curvature_1_m = 0.0f; // the other modes ask for no bend
    }
    if (new_mode) {
        state->speed_control.integral_rad_s = 0.0f;
        state->soil_sweep.elapsed_ticks = 0;
    }
    if (mode == MODE_PLATFORM_SPEED || mode == MODE_SLIP || mode == MODE_SOIL_SWEEP) {
        const speed_control_input_t input = {
            .speed_ref_m_s = command->platform_speed_m_s,
            .yaw_rate_ref_rad_s = mode == MODE_SOIL_SWEEP ? 0.0f : yaw_rate_rad_s,
            .speed_m_s = speed_to_steer_by(state, estimate, fixed_finite(command->platform_speed_m_s)),
            .saturated = state->saturated,
        };
        platform = speed_control_step(&config->speed_control, &state->speed_control, &input);
    }
    if (mode == MODE_SOIL_SWEEP) {
        const float v_ref = fixed_clamp(fixed_finite(command->platform_speed_m_s), -config->speed_control.speed_max_m_s,
                                        config->speed_control.speed_max_m_s);
        front_rad_s = soil_sweep_step(&config->soil_sweep, &state->soil_sweep, v_ref).front_rad_s;
    }
    for (int i = 0; i < WHEEL_COUNT; i++) {
        if (!rover_has_wheel(&config->geometry, i)) {
            continue; // its duty stays 0
        }
        wheel_trace_t *wheel = &trace->wheel[i];
        const uint8_t bit = (uint8_t)(1u << (uint32_t)i);
        const bool left = i == WHEEL_REAR_LEFT || i == WHEEL_FRONT_LEFT;
        const bool front = i == WHEEL_FRONT_LEFT || i == WHEEL_FRONT_RIGHT;
        const bool had_slip = !new_mode && (state->slip_active & bit) != 0u;
        float side_rad_s = left ? platform.left_rad_s : platform.right_rad_s;
        if (steers) {
            side_rad_s = steered_rad_s(config, i, side_rad_s, yaw_rate_rad_s);
        }
        if (mode == MODE_OPEN_LOOP) {
            wheel->duty = fixed_clamp(fixed_finite(command->duty[i]), -1.0f, 1.0f);
        } else if (mode == MODE_WHEEL_SPEED) {
            const float limit = config->speed_control.wheel_max_rad_s;
            const float reference = fixed_clamp(fixed_finite(command->wheel_speed_rad_s[i]), -limit, limit);
            drive_wheel_speed(config, state, estimate, i, reference, new_mode, wheel);
        } else if (mode == MODE_SLIP && (command->slip_wheels & bit) != 0u) {
            const float slip_ref = fixed_clamp(fixed_finite(command->slip_ref), -1.0f, 1.0f);
            if (estimate->slip[i].valid) {
                slip_active |= bit;
                drive_wheel_slip(config, state, estimate, i, slip_ref, !had_slip, wheel);
            } else {
                drive_wheel_speed(config, state, estimate, i, speed_for_slip(config, side_rad_s, slip_ref), new_mode || had_slip, wheel);
            }
        } else if (mode == MODE_PLATFORM_SPEED || mode == MODE_SLIP) {
            drive_wheel_speed(config, state, estimate, i, side_rad_s, new_mode || had_slip, wheel);
        } else if (mode == MODE_SOIL_SWEEP) {
            drive_wheel_speed(config, state, estimate, i, front ? front_rad_s : side_rad_s, new_mode, wheel);
        }
    }
    state->slip_active = slip_active;
}

// --- safety

static safety_output_t judge(const control_config_t *config, control_state_t *state, const estimate_t *estimate,
                             const sensor_frame_t *frame)
{
    float high_rad_s = 0.0f;
    float low_rad_s = 0.0f;
    float least_rad_s = 0.0f;
    bool first = true;
    safety_input_t input = {
        .frame = frame,
        .contradict = estimate->circuit.contradict,
        .broken = estimate->circuit.broken,
        .ground_speed_std_m_s = estimate->speed_std_m_s,
        .command_age_ticks = estimate->command->age_ticks,
        .command_stop = estimate->command->mode == MODE_STOP,
        .usable = estimate->sense->usable,
        .absurd = estimate->sense->absurd,
        .battery_V = estimate->sense->battery_V,
        .ground_speed_m_s = estimate->speed_m_s,
        .estimator = state->beyond >= BEYOND_VALUES ? (uint32_t)FAULT_SPEED_BEYOND : 0u,
    };
    for (int i = 0; i < WHEEL_COUNT; i++) {
        const float speed_rad_s = estimate->sense->speed_rad_s[i];
        const float turn = fabsf(speed_rad_s);
        input.speed_rad_s[i] = estimate->sense->speed_rad_s[i];
        input.current_A[i] = estimate->sense->current_A[i];
        high_rad_s = fixed_greater(speed_rad_s, high_rad_s) ? speed_rad_s : high_rad_s;
        low_rad_s = fixed_greater(low_rad_s, speed_rad_s) ? speed_rad_s : low_rad_s;
        if (rover_has_wheel(&config->geometry, i)) {
            least_rad_s = first || fixed_greater(least_rad_s, turn) ? turn : least_rad_s;
            first = false;
        }
    }
    input.high_rad_s = high_rad_s;
    input.low_rad_s = low_rad_s;
    input.least_rad_s = least_rad_s;
    return safety_step(&config->safety, &state->safety, &input);
}

static control_mode_t mode_of(const command_t *command, bool motors_off)
{
    const bool known = command->mode > MODE_STOP && command->mode < MODE_COUNT;
    return known && !motors_off ? command->mode : MODE_STOP;
}

static void actuate(const control_config_t *config, control_state_t *state, const estimate_t *estimate, const safety_output_t *safety,
                    control_mode_t mode, trace_t *trace)
{
    state->saturated = false;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        wheel_trace_t *wheel = &trace->wheel[i];
        if ((safety->limited & (1u << (uint32_t)i)) != 0u) {
            const float wanted = wheel->duty;
            wheel->duty = motor_duty_limited(&config->motor, wanted, estimate->sense->speed_rad_s[i], estimate->per_supply_1_V,
                                             config->safety.current_continuous_A);
            wheel->saturated = wheel->saturated || fixed_bits(wheel->duty) != fixed_bits(wanted);
        }
        wheel->duty = mode == MODE_STOP ? 0.0f : fixed_clamp(fixed_finite(wheel->duty), -1.0f, 1.0f);
        trace->actuator.duty_q15[i] = fixed_q15_from_float(wheel->duty);
        state->duty[i] = wheel->duty;
        state->saturated = state->saturated || wheel->saturated;
    }
    state->braking = mode == MODE_STOP && (safety->motors_off || state->braking);
    trace->actuator.drive = mode != MODE_STOP ? DRIVE_ON : state->braking ? DRIVE_BRAKE : DRIVE_COAST;
    state->driven = mode != MODE_STOP || state->braking;
    trace->actuator.sequence = ++state->sequence;
    trace->actuator.status_led = safety->faults != 0u;
    trace->actuator.curvature_1_m = state->curvature_1_m;
    trace->mode = mode;
    trace->faults = safety->faults;
    trace->fault_wheels = safety->wheels;
    state->mode = mode;
}

trace_t control_step(const control_config_t *config, control_state_t *state, const command_t *command, const sensor_frame_t *frame)
{
    trace_t trace = {0};
    sense_output_t sense = sense_measure(&config->sense, &state->sense, frame);
    // a look waits in the tick that is dear already: the one that fills a window and transforms it
    const bool dear = state->doppler.filled + 6 >= FFT_LENGTH;
    const circuit_input_t circuit = {.duty = state->duty, .driven = state->driven, .look = !dear};
    trace.tick = frame->tick;
    trace.present = frame->present;
    trace.battery_voltage_V = sense.battery_V;
    trace.accel_x_m_s2 = sense.accel_x_m_s2;
    trace.gyro_z_rad_s = sense.gyro_z_rad_s;

    estimate_t estimate = {.command = command, .sense = &sense, .per_supply_1_V = motor_per_supply(sense.battery_V)};
    estimate.circuit = circuit_step(&config->circuit, &state->circuit, &circuit, &config->sense, &state->sense, &sense);
    const ground_speed_output_t speed = estimate_speed(config, state, &sense, frame, &trace);
    estimate.speed_m_s = speed.speed_m_s;
    estimate.speed_std_m_s = speed.std_m_s;
    estimate_wheels(config, state, &estimate, &trace);

    const safety_output_t safety = judge(config, state, &estimate, frame);
    const control_mode_t mode = mode_of(command, safety.motors_off);
    drive_mode(config, state, &estimate, mode, &trace);
    actuate(config, state, &estimate, &safety, mode, &trace);
    return trace;
}
