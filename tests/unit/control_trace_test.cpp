// What control_step writes into its trace is what its modules say of the trace's own numbers; references beyond their range count as its
// end.
#include "firmware/core/circuit.h"
#include "firmware/core/motor.h"
#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

// Wheels that turn at 3 rad/s and draw current of their own each, over ground that passes at about the same speed.
sensor_frame_t rolling_frame(uint32_t tick) {
    sensor_frame_t frame = {};
    frame.tick = tick;
    frame.present = ~0u; // everything is there, whatever a frame may hold
    frame.battery_count = 1800;
    frame.radar_samples = 5;
    for (uint32_t n = 0; n < 5; ++n)
        frame.radar_count[n] = static_cast<uint16_t>(512 + 100 * std::cos(2 * clutter::pi * 10 * (5 * tick + n) / 512));
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        frame.encoder_count[i] = static_cast<int32_t>(29 * tick);
        frame.current_count[i] = static_cast<uint16_t>(2048 + 40 * (i + 1));
    }
    return frame;
}

double wide_top(const control_config_t &config) { // the fastest speed that the radar's band holds
    const doppler_template_t &beam = *config.doppler.beam;
    return static_cast<double>(beam.speed_m_s[beam.speeds - 1]) * static_cast<double>(config.doppler.scale);
}

std::vector<trace_t> run(command_t command, uint32_t ticks) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    std::vector<trace_t> traces;
    for (uint32_t tick = 0; tick < ticks; ++tick) {
        const sensor_frame_t frame = rolling_frame(tick);
        traces.push_back(control_step(&config, &state, &command, &frame));
    }
    return traces;
}

TEST(ControlTrace, holds_torque_and_traction_of_its_own_current_and_speed) {
    command_t command = {};
    command.mode = MODE_WHEEL_SPEED;
    for (float &speed : command.wheel_speed_rad_s) speed = 3;
    const control_config_t config = rover_config_default();
    for (const trace_t &trace : run(command, 100))
        for (const wheel_trace_t &wheel : trace.wheel) {
            const motor_output_t motor = motor_measure(&config.motor, wheel.current_A, wheel.speed_rad_s, wheel.accel_rad_s2);
            EXPECT_EQ(wheel.torque_Nm, motor.torque_Nm);
            EXPECT_EQ(wheel.traction_N, motor.traction_N);
        }
    const trace_t last = run(command, 100).back();
    for (int i = 1; i < WHEEL_COUNT; ++i) EXPECT_GT(last.wheel[i].torque_Nm, last.wheel[i - 1].torque_Nm); // each its own
}

// The bias is the filter's; a wheel's saturation is forgotten in the first tick without one.
TEST(ControlTrace, holds_the_bias_of_the_accelerometer_and_the_saturation_of_its_own_tick) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    command_t command = {};
    command.mode = MODE_OPEN_LOOP;
    int told = 0;
    for (uint32_t tick = 0; tick < 200; ++tick) {
        sensor_frame_t frame = rolling_frame(tick);
        frame.accel_x_count = 100;
        command.duty[1] = 0.2f;
        command.mode = tick % 20 < 10 ? MODE_WHEEL_SPEED : MODE_STOP;
        for (float &speed : command.wheel_speed_rad_s) speed = 1000; // beyond any duty
        const trace_t trace = control_step(&config, &state, &command, &frame);
        EXPECT_EQ(trace.accel_bias_m_s2, state.ground_speed.bias_m_s2) << tick;
        told += trace.accel_bias_m_s2 < 0.0f || trace.accel_bias_m_s2 > 0.0f ? 1 : 0;
        bool any = false;
        for (const wheel_trace_t &wheel : trace.wheel) any = any || wheel.saturated;
        EXPECT_EQ(state.saturated, any) << tick;
        if (trace.mode == MODE_STOP) {
            EXPECT_FALSE(any) << tick;
        }
    }
    EXPECT_GT(told, 50);
}

std::vector<float> duties(float slip_ref) {
    command_t command = {};
    command.mode = MODE_SLIP;
    command.platform_speed_m_s = 0.17f;
    command.slip_wheels = 2;
    command.slip_ref = slip_ref;
    std::vector<float> out;
    for (const trace_t &trace : run(command, 300)) out.push_back(trace.wheel[1].duty);
    return out;
}

TEST(ControlTrace, a_slip_reference_beyond_one_counts_as_one) {
    EXPECT_EQ(duties(-1.05f), duties(-1));
    EXPECT_EQ(duties(1.05f), duties(1));
    EXPECT_NE(duties(-0.9f), duties(-1)); // and it is the reference that drives
    EXPECT_NE(duties(0.9f), duties(1));
    EXPECT_EQ(duties(std::nanf("")), duties(0));
}

// A drive of frames as a rover's, in which whatever may happen does: wheels that part, sensors that fail, samples that are lost, faults.
struct Frames {
    clutter::Random random{61};
    double rate[WHEEL_COUNT] = {}, place[WHEEL_COUNT] = {}, phase = 0;
    uint32_t sequence = 1;
    bool one_in(unsigned n) { return random.next() % n == 0; }
    sensor_frame_t next(uint32_t tick, bool rough) {
        sensor_frame_t frame = {};
        frame.tick = tick;
        frame.present = FRAME_ALL;
        frame.battery_count = static_cast<uint16_t>(1700 + random.next() % 200);
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            if (tick % 150 == 0) rate[i] = (random.uniform() - 0.4) * (one_in(2) ? 10 : 90);
            if (tick % 150 == 75) rate[i] = rate[0] + 4 * random.uniform();
            place[i] += rate[i];
            frame.encoder_count[i] = static_cast<int32_t>(place[i]);
            frame.current_count[i] = static_cast<uint16_t>(2048 + 40 * (i + 1) + random.next() % 30);
        }
        const double Hz = tick % 600 < 300 ? 12 : 45;
        frame.radar_sequence = sequence;
        frame.radar_samples = static_cast<uint8_t>(tick % 8 == 0 ? 6 : 5);
        sequence += frame.radar_samples + (one_in(60) ? 1 + static_cast<uint32_t>(random.next() % 9) : 0);
        for (int n = 0; n < frame.radar_samples; ++n) {
            phase += 2 * clutter::pi * Hz / 512 + 0.1 * random.normal();
            frame.radar_count[n] = static_cast<uint16_t>(512 + 100 * std::cos(phase) + 3 * random.normal());
        }
        frame.accel_x_count = static_cast<int16_t>(20 * random.normal());
        frame.accel_z_count = 2450;
        frame.gyro_z_count = static_cast<int16_t>(200 * std::sin(tick * 0.01));
        frame.gyro_y_count = static_cast<int16_t>(20 * random.normal());
        if (rough && one_in(20)) frame.present &= ~(1u << random.next() % 20);
        if (rough && one_in(200)) frame.emergency_stop = true;
        if (rough && one_in(50)) frame.encoder_count[random.next() % 4] += 300;
        return frame;
    }
};

control_config_t on_three_wheels() {
    control_config_t config = rover_config_default();
    config.geometry.wheels = 0xd; // no rear right one
    config.geometry.wheel_share = 1.0f / 3;
    return config;
}

control_config_t on_steered_wheels() {
    control_config_t config = rover_config_default();
    config.steering = {.front_m = 0.32f, .rear_m = 0, .limit_1_m = 1.76f};
    return config;
}

// Each module, on a copy of its state, is asked what frame and neighbours say, worked out here; state and trace must be what it answers.
TEST(ControlTrace, each_module_is_asked_what_the_frame_and_the_others_say) {
    int parted = 0, rolled = 0, missed = 0, fresh = 0, faulty = 0;
    for (const control_config_t &config : {rover_config_default(), on_three_wheels(), on_steered_wheels()}) {
        Frames frames;
        control_state_t state;
        control_reset(&config, &state);
        const double R = static_cast<double>(config.slip.wheel_radius_m);
        const bool steers = config.steering.limit_1_m > 0;
        const auto has = [&](int i) { return (config.geometry.wheels >> i & 1u) != 0; };
        int beyond = 0;
        for (uint32_t tick = 1; tick <= 900; ++tick) {
            sensor_frame_t frame = frames.next(tick, tick > 300);
            for (int i = 0; i < WHEEL_COUNT; ++i)
                if (!has(i)) frame.encoder_count[i] = 0;
            command_t command = {};
            command.mode = tick % 97 == 0 ? MODE_STOP : static_cast<control_mode_t>(tick / 50 % 6);
            command.platform_speed_m_s = 0.2f;
            command.yaw_rate_rad_s = 0.1f;
            command.slip_ref = 0.3f;
            command.slip_wheels = 9;
            command.age_ticks = tick % 211 == 0 ? 20 : 0;
            for (float &speed : command.wheel_speed_rad_s) speed = 3;
            const control_state_t was = state;
            const trace_t trace = control_step(&config, &state, &command, &frame);

            sense_state_t sense_state = was.sense;
            circuit_state_t circuit_state = was.circuit;
            sense_output_t sense = sense_measure(&config.sense, &sense_state, &frame);
            const circuit_input_t asked = {.duty = was.duty, .driven = was.driven, .look = was.doppler.filled + 6 < FFT_LENGTH};
            const circuit_output_t circuit = circuit_step(&config.circuit, &circuit_state, &asked, &config.sense, &sense_state, &sense);
            EXPECT_EQ(state.circuit.turn, circuit_state.turn) << tick;
            EXPECT_EQ(trace.battery_voltage_V, sense.battery_V);
            EXPECT_EQ(trace.accel_x_m_s2, sense.accel_x_m_s2);
            EXPECT_EQ(trace.gyro_z_rad_s, sense.gyro_z_rad_s);
            EXPECT_EQ(trace.present, frame.present);

            const bool radar = (sense.usable & FRAME_RADAR) != 0;
            doppler_state_t doppler = was.doppler;
            const doppler_arrival_t arrival = {frame.radar_sequence, sense.elapsed_ticks, radar ? frame.radar_samples : 0};
            const int32_t lost = doppler_missing(&config.doppler, &doppler, &arrival);
            doppler_gap(&config.doppler, &doppler, lost, frame.radar_count[0]);
            const doppler_output_t now = doppler_step(&config.doppler, &doppler, frame.radar_count, arrival.count), heard = was.heard;
            missed += lost > 0 ? 1 : 0;
            EXPECT_EQ(state.heard.fresh, now.fresh);
            EXPECT_EQ(state.heard.speed_m_s, now.speed_m_s);
            EXPECT_EQ(state.doppler.sum, doppler.sum);
            EXPECT_EQ(state.doppler.filled, doppler.filled);
            EXPECT_EQ(state.doppler.last, doppler.last);

            double sum = 0, low = 1e9, high = -1e9, least = 1e9;
            int count = 0;
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                if (!has(i)) continue;
                const double w = static_cast<double>(sense.speed_rad_s[i]);
                const auto rim = static_cast<float>(w * R);
                sum += steers ? static_cast<double>(steering_forward(&config.steering, i, rim, sense.gyro_z_rad_s)) : w * R;
                low = std::fmin(low, w), high = std::fmax(high, w), least = std::fmin(least, std::fabs(w));
                count++;
            }
            const bool part = high - low > 2; // [rad/s]
            if (std::fabs(high - low - 2) < 1e-4) continue;
            ground_speed_input_t input = {};
            input.accel_x_m_s2 = sense.level_m_s2;
            input.doppler_m_s = heard.speed_m_s;
            input.doppler_late_s =
                heard.fresh ? static_cast<float>(heard.late_samples + lost + arrival.count) * config.doppler.per_sample_s : 0;
            input.wheel_m_s = static_cast<float>(sum / count);
            input.slowest_m_s = static_cast<float>(!part ? 0 : low > 0 ? low * R : high < 0 ? high * R : 0); // all turn one way
            input.wheels_part = part;
            input.accel_valid = (sense.usable & FRAME_ACCEL) != 0;
            input.doppler_fresh = heard.fresh && !heard.beyond && !heard.spoilt;
            input.doppler_quiet = heard.quiet, input.doppler_dead = heard.dead;
            input.busy = now.busy || now.fresh;
            input.doppler_trust = heard.trust, input.doppler_misfit = heard.misfit, input.doppler_relieved = heard.relieved;
            input.elapsed_ticks = sense.elapsed_ticks;
            input.lean_q8 = sense.lean_q8;
            ground_speed_state_t filter = was.ground_speed;
            const ground_speed_output_t speed = ground_speed_step(&config.ground_speed, &filter, &input);
            ASSERT_NEAR(trace.speed_m_s, speed.speed_m_s, 1e-4) << tick; // the hint is a float's rounding off
            ASSERT_NEAR(trace.speed_std_m_s, speed.std_m_s, 1e-4) << tick;
            EXPECT_NEAR(trace.accel_bias_m_s2, speed.bias_m_s2, 1e-4);
            EXPECT_EQ(trace.standstill, speed.standstill);
            EXPECT_EQ(state.sense.standing, speed.standstill);
            EXPECT_EQ(state.sense.gyro_q8, trace.standstill == speed.standstill ? state.ground_speed.gyro_q8 : -1);
            EXPECT_NEAR(state.ground_speed.wheel_m_s, filter.wheel_m_s, 1e-5);
            EXPECT_EQ(state.ground_speed.chore, filter.chore);
            EXPECT_EQ(state.ground_speed.unheard_ticks, filter.unheard_ticks);
            EXPECT_EQ(state.ground_speed.value_parts, filter.value_parts);
            EXPECT_NEAR(state.ground_speed.value_wheel_m_s, filter.value_wheel_m_s, 1e-5);
            EXPECT_NEAR(state.ground_speed.value_tau_s, filter.value_tau_s, 1e-6);
            EXPECT_EQ(trace.radar_fresh, heard.fresh && !heard.quiet && !heard.beyond && !heard.spoilt);
            EXPECT_EQ(trace.radar_speed_m_s, heard.fresh ? heard.speed_m_s : was.doppler_m_s);
            if (heard.fresh) beyond = heard.beyond ? beyond + 1 : 0;
            fresh += heard.fresh ? 1 : 0, parted += part ? 1 : 0, rolled += input.slowest_m_s != 0 ? 1 : 0;

            // the ground under each wheel's centre, what it slips there, and its motor
            const double yaw = static_cast<double>(trace.gyro_z_rad_s), v = static_cast<double>(trace.speed_m_s);
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                const wheel_trace_t &wheel = trace.wheel[i];
                if (!has(i)) {
                    EXPECT_EQ(wheel.duty, 0);
                    EXPECT_EQ(wheel.torque_Nm, 0);
                    continue;
                }
                auto ground = static_cast<float>(v + (i % 2 == 0 ? -1 : 1) * static_cast<double>(config.geometry.half_track_m) * yaw);
                if (steers) ground = steering_rim(&config.steering, i, ground, trace.gyro_z_rad_s);
                const slip_output_t slip = slip_measure(&config.slip, sense.speed_rad_s[i], ground);
                const motor_output_t motor = motor_measure(&config.motor, sense.current_A[i], sense.speed_rad_s[i], sense.accel_rad_s2[i]);
                EXPECT_EQ(wheel.speed_rad_s, sense.speed_rad_s[i]);
                EXPECT_EQ(wheel.accel_rad_s2, sense.accel_rad_s2[i]);
                EXPECT_EQ(wheel.current_A, sense.current_A[i]);
                EXPECT_EQ(wheel.torque_Nm, motor.torque_Nm);
                EXPECT_EQ(wheel.traction_N, motor.traction_N);
                EXPECT_NEAR(wheel.slip, slip.slip, 1e-4);
                EXPECT_EQ(wheel.slip_std, state.slip_std[i]);
                EXPECT_EQ(wheel.slip_valid, slip.valid && wheel.slip_std <= config.slip.valid_std);
                EXPECT_EQ(wheel.encoder_refused, (circuit.refused >> i & 1u) != 0);
                const bool turn = !input.busy && i == (was.slip_turn & 3);
                EXPECT_NEAR(state.slip_std[i],
                            turn ? slip_std(&config.slip, sense.speed_rad_s[i], ground, trace.speed_std_m_s) : was.slip_std[i],
                            turn ? 1e-4 : 0);
            }

            safety_state_t safety = was.safety;
            safety_input_t judged = {};
            judged.frame = &frame;
            judged.command_age_ticks = command.age_ticks, judged.command_stop = command.mode == MODE_STOP;
            judged.usable = sense.usable, judged.absurd = sense.absurd;
            judged.contradict = circuit.contradict, judged.broken = circuit.broken;
            for (int i = 0; i < WHEEL_COUNT; ++i) judged.speed_rad_s[i] = sense.speed_rad_s[i], judged.current_A[i] = sense.current_A[i];
            judged.battery_V = sense.battery_V;
            judged.ground_speed_m_s = trace.speed_m_s, judged.ground_speed_std_m_s = trace.speed_std_m_s;
            judged.estimator = beyond >= 3 ? static_cast<uint32_t>(FAULT_SPEED_BEYOND) : 0u; // three values in a row
            judged.high_rad_s = static_cast<float>(std::fmax(0, high));
            judged.low_rad_s = static_cast<float>(std::fmin(0, low));
            judged.least_rad_s = static_cast<float>(least);
            const safety_output_t verdict = safety_step(&config.safety, &safety, &judged);
            EXPECT_EQ(trace.faults, verdict.faults) << tick;
            EXPECT_EQ(trace.fault_wheels, verdict.wheels) << tick;
            EXPECT_EQ(state.safety.disagree_s, safety.disagree_s);
            EXPECT_EQ(state.safety.radar_dead_blocks, safety.radar_dead_blocks);
            EXPECT_EQ(state.safety.radar_samples, safety.radar_samples);
            const control_mode_t mode = verdict.motors_off ? MODE_STOP : command.mode;
            EXPECT_EQ(trace.mode, mode);
            const bool braked = mode == MODE_STOP && (verdict.motors_off || was.braking);
            EXPECT_EQ(trace.actuator.drive, mode != MODE_STOP ? DRIVE_ON : braked ? DRIVE_BRAKE : DRIVE_COAST);
            EXPECT_EQ(state.driven, trace.actuator.drive != DRIVE_COAST);
            EXPECT_EQ(trace.actuator.status_led, verdict.faults != 0);
            for (int i = 0; i < WHEEL_COUNT; ++i) EXPECT_NEAR(trace.actuator.duty_q15[i], 32767 * trace.wheel[i].duty, 0.51);
            faulty += verdict.faults != 0 ? 1 : 0;
        }
    }
    EXPECT_GT(std::min({parted, rolled, missed, fresh, faulty}), 20)
        << parted << ' ' << rolled << ' ' << missed << ' ' << fresh << ' ' << faulty;
}

// A wheel that is limited gets what the continuous current lets through, and says that it wanted more.
TEST(ControlTrace, a_limited_wheel_gets_the_duty_of_its_continuous_current_and_is_saturated) {
    const control_config_t config = rover_config_default();
    for (int limited = -1; limited < WHEEL_COUNT; ++limited)
        for (const float duty : {0.9f, 0.1f, -0.9f}) {
            control_state_t state;
            control_reset(&config, &state);
            command_t command = {};
            command.mode = MODE_OPEN_LOOP;
            for (float &d : command.duty) d = duty;
            if (limited >= 0) state.safety.limited = 1u << limited;
            sensor_frame_t frame = rolling_frame(1);
            for (int &count : frame.encoder_count) count = 0; // at rest
            const trace_t trace = control_step(&config, &state, &command, &frame);
            const double most = 1.5 * 3.24 / 7.2; // of a wheel at rest: I Ra/V
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                const bool cut = i == limited && std::fabs(static_cast<double>(duty)) > most;
                EXPECT_NEAR(trace.wheel[i].duty, cut ? std::copysign(most, static_cast<double>(duty)) : static_cast<double>(duty), 1e-4)
                    << limited << ' ' << i;
                EXPECT_EQ(trace.wheel[i].saturated, cut);
            }
            EXPECT_EQ(state.saturated, limited >= 0 && std::fabs(duty) > 0.8f);
        }
}

// SPEED_BEYOND: three values in a row of more speed than the band holds, of a body of which something else tells half as much; a tick
// without a value is none of them.
TEST(ControlTrace, three_values_beyond_the_band_in_a_row_are_a_fault) {
    for (const int between : {0, 1, 12}) {
        control_config_t config = rover_config_default();
        control_state_t state;
        control_reset(&config, &state);
        command_t command = {};
        command.mode = MODE_WHEEL_SPEED;
        uint32_t tick = 0;
        const double top = wide_top(config);
        double known = 0.6 * top;
        const auto value = [&](bool beyond) {
            for (int k = 0; k < between; ++k) {
                const sensor_frame_t frame = rolling_frame(tick++);
                state.heard = {};
                control_step(&config, &state, &command, &frame);
            }
            state.heard = {};
            state.heard.fresh = true;
            state.heard.trust = 1;
            state.heard.beyond = beyond;
            state.heard.speed_m_s = 0.2f;
            state.ground_speed.speed_m_s = static_cast<float>(known);
            const sensor_frame_t frame = rolling_frame(tick++);
            return (control_step(&config, &state, &command, &frame).faults & FAULT_SPEED_BEYOND) != 0;
        };
        for (const bool beyond : {true, true, false, true, false, true, true}) EXPECT_FALSE(value(beyond)) << between;
        EXPECT_TRUE(value(true));
        EXPECT_TRUE(value(true));
        known = 0;
        command.mode = MODE_STOP; // takes the latch away where its cause is gone
        EXPECT_FALSE(value(false));
        for (int k = 0; k < 5; ++k) EXPECT_FALSE(value(true)) << between; // it stands: someone else runs there
        for (const double sign : {1.0, -1.0}) {
            known = 0.48 * sign * top;
            for (int k = 0; k < 5; ++k) EXPECT_FALSE(value(true)) << between;
            known = 0.52 * sign * top;
            for (int k = 0; k < 3; ++k) EXPECT_EQ(value(true), k == 2) << between;
            EXPECT_FALSE(value(false));
        }
        known = 0;
        config.ground_speed.still_m_s = 0; // without wheels nobody contradicts the radar
        for (int k = 0; k < 3; ++k) EXPECT_EQ(value(true), k == 2) << between;
    }
}

// At reset nothing is known of any wheel's slip: a standard deviation of 1, until its turn has come.
TEST(ControlTrace, nothing_is_known_of_any_slip_before_its_first_look) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    for (const float std : state.slip_std) EXPECT_EQ(std, 1);
    command_t command = {};
    for (uint32_t tick = 0; tick < WHEEL_COUNT; ++tick) { // one wheel a tick, in their order
        sensor_frame_t frame = rolling_frame(tick);
        frame.present &= ~static_cast<uint32_t>(FRAME_RADAR);
        const trace_t trace = control_step(&config, &state, &command, &frame);
        for (uint32_t i = tick + 1; i < WHEEL_COUNT; ++i) {
            EXPECT_EQ(trace.wheel[i].slip_std, 1);
            EXPECT_FALSE(trace.wheel[i].slip_valid);
        }
    }
}

} // namespace
