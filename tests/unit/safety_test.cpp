// Every latch of fault_t: its cause is injected into control_step of a driving rover; the reaction and its delay are checked.
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

// A rover whose sensors say that it drives at 3 rad/s with a healthy current.
class DrivingRover : public ::testing::Test {
  protected:
    control_config_t config = rover_config_default();
    control_state_t state = {};
    command_t command = {};
    sensor_frame_t frame = {};
    trace_t trace = {};
    int tick = 0;

    void SetUp() override {
        control_reset(&config, &state);
        command.mode = MODE_WHEEL_SPEED;
        for (float &speed : command.wheel_speed_rad_s) {
            speed = static_cast<float>(29 * 2 * M_PI / 60);
        }
        frame.present = FRAME_ALL;
        frame.battery_count = 1800;
        for (auto &count : frame.current_count) {
            count = 2048 + 150;
        }
        run(100);
        ASSERT_EQ(trace.faults, 0u);
        ASSERT_EQ(trace.actuator.drive, DRIVE_ON);
        ASSERT_NE(trace.actuator.duty_q15[0], 0);
    }
    // A change of the frame made before run() lasts.
    void run(int ticks) {
        for (int i = 0; i < ticks; ++i) {
            frame.tick = static_cast<uint32_t>(tick);
            for (int w = 0; w < WHEEL_COUNT; ++w) {
                frame.encoder_count[w] += turn[w] * std::max(tick - last_tick, 1); // missed ticks are driven, too
            }
            last_tick = tick;
            frame.radar_samples = static_cast<uint8_t>(tick % 8 == 0 ? 6 : 5);
            for (int n = 0; n < frame.radar_samples && !frozen; ++n) {
                phase += 2 * M_PI * 10 / 512;
                frame.radar_count[n] = static_cast<uint16_t>(512 + 100 * std::cos(phase));
            }
            for (int w = 0; w < WHEEL_COUNT; ++w) { // what a motor draws, unless a test has said otherwise
                if (frame.current_count[w] != drawn[w]) continue;
                const double speed_rad_s = turn[w] * 2 * M_PI / 60;
                const double current_A =
                    trace.actuator.drive >= DRIVE_BRAKE ? (7.2 * static_cast<double>(trace.wheel[w].duty) - 0.265 * speed_rad_s) / 3.24 : 0;
                frame.current_count[w] = drawn[w] = static_cast<uint16_t>(2048 + std::lround(current_A / 0.002));
            }
            trace = control_step(&config, &state, &command, &frame);
            ++tick;
        }
    }
    // How many ticks pass until the bridges are released; -1 when they are not within `most`.
    int ticks_until_off(int most) {
        for (int i = 1; i <= most; ++i) {
            run(1);
            if (trace.actuator.drive != DRIVE_ON) {
                for (const int16_t duty : trace.actuator.duty_q15) {
                    EXPECT_EQ(duty, 0);
                }
                EXPECT_EQ(trace.mode, MODE_STOP);
                return i;
            }
        }
        return -1;
    }
    int turn[WHEEL_COUNT] = {29, 29, 29, 29}; // 3 rad/s
    uint16_t drawn[WHEEL_COUNT] = {2048 + 150, 2048 + 150, 2048 + 150, 2048 + 150};
    bool frozen = false;
    int last_tick = -1;
    double phase = 0;
};

TEST_F(DrivingRover, emergency_stop_releases_the_motors_in_its_own_tick) {
    frame.emergency_stop = true;
    EXPECT_EQ(ticks_until_off(10), 1); // asked for: two ticks
    EXPECT_EQ(trace.faults, FAULT_EMERGENCY_STOP);
}

TEST_F(DrivingRover, emergency_stop_stays_latched_until_stop_is_commanded_without_it) {
    frame.emergency_stop = true;
    run(1);
    frame.emergency_stop = false;
    run(500);
    EXPECT_NE(trace.actuator.drive, DRIVE_ON);
    command.mode = MODE_STOP;
    run(1);
    EXPECT_EQ(trace.faults, 0u);
    command.mode = MODE_WHEEL_SPEED;
    run(1);
    EXPECT_EQ(trace.actuator.drive, DRIVE_ON);
}

struct Loss {
    const char *name;
    uint32_t bit, fault;
};
class Losing : public DrivingRover, public ::testing::WithParamInterface<Loss> {};

TEST_P(Losing, a_silent_sensor_releases_the_motors_within_100_ms) {
    frame.present &= ~GetParam().bit;
    const int ticks = ticks_until_off(30);
    EXPECT_GT(ticks, 2);  // one lost frame is forgiven
    EXPECT_LE(ticks, 10); // 100 ms
    EXPECT_EQ(trace.faults, GetParam().fault);
}

INSTANTIATE_TEST_SUITE_P(Safety, Losing,
                         ::testing::Values(Loss{"encoder0", FRAME_ENCODER_0, FAULT_ENCODER_LOST},
                                           Loss{"encoder3", FRAME_ENCODER_0 << 3u, FAULT_ENCODER_LOST},
                                           Loss{"current0", FRAME_CURRENT_0, FAULT_CURRENT_LOST},
                                           Loss{"current3", FRAME_CURRENT_0 << 3u, FAULT_CURRENT_LOST},
                                           Loss{"battery", FRAME_BATTERY, FAULT_BATTERY_LOST}, Loss{"accel", FRAME_ACCEL, FAULT_ACCEL_LOST},
                                           Loss{"gyro", FRAME_GYRO, FAULT_GYRO_LOST}, Loss{"radar", FRAME_RADAR, FAULT_RADAR_LOST}),
                         [](const auto &loss) { return loss.param.name; });

TEST_F(DrivingRover, one_silent_tick_of_every_sensor_is_forgiven) {
    frame.present = 0;
    run(1);
    frame.present = FRAME_ALL;
    run(50);
    EXPECT_EQ(trace.faults, 0u);
}

TEST_F(DrivingRover, a_sensor_that_the_rover_does_not_have_is_not_missed) {
    config.safety.required &= ~static_cast<uint32_t>(FRAME_GYRO);
    frame.present &= ~static_cast<uint32_t>(FRAME_GYRO);
    run(100);
    EXPECT_EQ(trace.faults, 0u);
}

TEST_F(DrivingRover, an_absurd_sensor_releases_the_motors_within_100_ms) {
    frame.current_count[1] = 4095;
    EXPECT_LE(ticks_until_off(30), 10);
    EXPECT_EQ(trace.faults, FAULT_ABSURD_SENSOR | FAULT_CURRENT_LOST);
}

TEST_F(DrivingRover, an_old_command_releases_the_motors_within_100_ms) {
    for (uint32_t age = 1; age <= 10; ++age) {
        command.age_ticks = age;
        run(1);
    }
    EXPECT_NE(trace.actuator.drive, DRIVE_ON);
    EXPECT_EQ(trace.faults, FAULT_COMMAND_TIMEOUT);
}

TEST_F(DrivingRover, missed_ticks_release_the_motors_and_a_single_one_does_not) {
    tick += 1;
    run(1);
    EXPECT_EQ(trace.faults, 0u);
    run(200);
    tick += 11;
    run(1);
    EXPECT_EQ(trace.faults, FAULT_MISSED_TICKS);
    EXPECT_NE(trace.actuator.drive, DRIVE_ON);
}

TEST_F(DrivingRover, a_clock_that_stands_still_releases_the_motors) {
    tick -= 1;
    run(1);
    EXPECT_EQ(trace.faults, FAULT_MISSED_TICKS);
}

TEST_F(DrivingRover, a_low_battery_releases_the_motors_after_half_a_second_and_a_dip_does_not) {
    frame.battery_count = 1300; // 5.2 V
    run(40);
    EXPECT_EQ(trace.faults, 0u);
    frame.battery_count = 1800;
    run(1);
    frame.battery_count = 1300;
    const int ticks = ticks_until_off(100);
    EXPECT_GE(ticks, 49); // 0.5 s
    EXPECT_LE(ticks, 53);
    EXPECT_EQ(trace.faults, FAULT_LOW_BATTERY);
}

TEST_F(DrivingRover, over_current_limits_that_wheel_alone_after_its_i2t) {
    command.mode = MODE_OPEN_LOOP;
    command.duty[2] = 1;
    turn[2] = 5;                          // 0.5 rad/s: no stall, and (7.2 V - 0.14 V)/3.24 ohm
    frame.current_count[2] = 2048 + 1100; // 2.2 A: (2.2^2 - 1.5^2) t = 8 at 3.09 s
    run(300);
    EXPECT_EQ(trace.faults, 0u);
    run(15);
    EXPECT_EQ(trace.faults, FAULT_OVER_CURRENT);
    EXPECT_EQ(trace.actuator.drive, DRIVE_ON);
    for (float &duty : command.duty) {
        duty = 1;
    }
    run(1);
    const double current =
        (static_cast<double>(trace.wheel[2].duty) * 7.2 - 0.265 * static_cast<double>(trace.wheel[2].speed_rad_s)) / 3.24;
    EXPECT_NEAR(current, 1.5, 0.01);       // the continuous current; float rounding and Q15
    EXPECT_TRUE(trace.wheel[2].saturated); // the limiter is a limit like any other: no integral may wind up against it
    EXPECT_EQ(trace.wheel[1].duty, 1.0f);
}

// What brakes heats as what drives: i2t knows no sign.
TEST_F(DrivingRover, a_current_against_the_drive_counts_by_its_square) {
    config.circuit.contradict_V = 1000; // these currents fit no circuit
    command.mode = MODE_OPEN_LOOP;
    frame.current_count[2] = 2048 - 1100; // -2.2 A
    run(300);
    EXPECT_EQ(trace.faults, 0u);
    run(15);
    EXPECT_EQ(trace.faults, FAULT_OVER_CURRENT);
    EXPECT_EQ(trace.fault_wheels, 4u);
}

TEST_F(DrivingRover, a_stalled_wheel_is_limited_after_a_second) {
    turn[0] = 0;
    frame.current_count[0] = 2048 + 800;
    run(99);
    EXPECT_EQ(trace.faults, 0u);
    run(5);
    EXPECT_EQ(trace.faults, FAULT_STALL);
    EXPECT_EQ(trace.actuator.drive, DRIVE_ON);
    EXPECT_LE(trace.wheel[0].duty, 1.5f * 3.24f / 7.2f + 1e-3f);
}

TEST_F(DrivingRover, an_overheated_winding_releases_the_motors) {
    config.safety.i2t_max_A2_ticks = 1e9f; // so that temperature alone decides
    frame.current_count[3] = 2048 + 1100;
    // 2.2 A: 15.7 W * 12 K/W = 188 K after many 60 s; 95 K after 60 ln(188/(188 - 95)) = 42 s
    run(4000);
    EXPECT_EQ(trace.faults & FAULT_OVER_TEMPERATURE, 0u);
    run(500);
    EXPECT_NE(trace.faults & FAULT_OVER_TEMPERATURE, 0u);
    EXPECT_NE(trace.actuator.drive, DRIVE_ON);
}

TEST_F(DrivingRover, a_radar_faster_than_every_wheel_explains_releases_the_motors) {
    for (int &step : turn) {
        step = 0;
    }
    for (auto &speed : command.wheel_speed_rad_s) {
        speed = 0;
    }
    config.safety.sigmas = 0;                 // as if the estimate were sure of it
    config.ground_speed.gate_patience = 1000; // and believed nothing else
    config.ground_speed.agile_sure = config.ground_speed.agile_limit = 1e9f;
    for (int k = 0; k < 150 && trace.faults == 0u; ++k) {
        state.ground_speed.p_vv = state.ground_speed.p_bb = 1e-6f;
        state.ground_speed.speed_m_s = 0.8f; // as a radar that hears something else would make it
        run(1);
    }
    EXPECT_EQ(trace.faults, FAULT_SPEED_DISAGREE);
    EXPECT_NE(trace.actuator.drive, DRIVE_ON);
}

TEST_F(DrivingRover, a_radar_that_repeats_one_value_while_the_wheels_turn_is_lost) {
    frozen = true;
    for (auto &count : frame.radar_count) {
        count = 512;
    }
    const int ticks = ticks_until_off(150);
    EXPECT_GE(ticks, 37); // 0.375 s: 6 blocks of 32 samples, and what the first block began with
    EXPECT_LE(ticks, 50);
    EXPECT_EQ(trace.faults, FAULT_RADAR_LOST);
}

TEST_F(DrivingRover, one_missed_tick_in_150_is_forgiven_for_ever_and_one_in_50_is_not) {
    for (int i = 0; i < 20; ++i) {
        tick += 1;
        run(149);
        EXPECT_EQ(trace.faults, 0u) << i; // one is forgotten per 100 good ticks
    }
    int rounds = 0;
    while (trace.faults == 0u && rounds < 30) {
        tick += 1;
        run(49);
        ++rounds;
    }
    EXPECT_EQ(trace.faults, FAULT_MISSED_TICKS);
    EXPECT_GE(rounds, 6); // five are tolerated
    EXPECT_LE(rounds, 7); // 49 good ticks forget none before the count starts again
}

TEST_F(DrivingRover, a_rising_radar_signal_is_not_a_frozen_one_and_a_radar_that_is_not_there_cannot_freeze) {
    frozen = true; // the fixture leaves the samples alone
    for (int i = 0; i < 150; ++i) {
        for (int n = 0; n < 6; ++n) {
            frame.radar_count[n] = static_cast<uint16_t>(100 + (5 * i + n) % 800); // rises for 160 ticks
        }
        run(1);
        ASSERT_EQ(trace.faults, 0u) << i;
    }
    config.safety.required &= ~static_cast<uint32_t>(FRAME_RADAR);
    frame.present &= ~static_cast<uint32_t>(FRAME_RADAR);
    for (auto &count : frame.radar_count) {
        count = 512;
    }
    run(300);
    EXPECT_EQ(trace.faults, 0u);
}

TEST_F(DrivingRover, a_radar_may_repeat_itself_while_one_wheel_hardly_turns) {
    frozen = true;
    for (auto &count : frame.radar_count) {
        count = 512;
    }
    for (int wheel = 0; wheel < WHEEL_COUNT; ++wheel) {
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            turn[i] = i == wheel ? 20 : 29; // 2.1 rad/s is 0.12 m/s, below 0.15 m/s; 3 rad/s is 0.17 m/s
        }
        run(130);
        EXPECT_EQ(trace.faults & FAULT_RADAR_LOST, 0u) << wheel;
    }
}

TEST_F(DrivingRover, an_emergency_stop_that_nobody_reads_counts_as_pressed) {
    frame.present = FRAME_ALL & ~static_cast<uint32_t>(FRAME_EMERGENCY_STOP);
    run(7); // the patience: the 8th unread tick is one too many
    EXPECT_EQ(trace.faults, 0u);
    run(1);
    EXPECT_EQ(trace.faults, static_cast<uint32_t>(FAULT_EMERGENCY_STOP));
    EXPECT_EQ(trace.actuator.drive, DRIVE_BRAKE);
}

TEST_F(DrivingRover, a_rover_without_that_line_drives) {
    config.safety.required &= ~static_cast<uint32_t>(FRAME_EMERGENCY_STOP);
    frame.present = FRAME_ALL & ~static_cast<uint32_t>(FRAME_EMERGENCY_STOP);
    run(100);
    EXPECT_EQ(trace.faults, 0u);
}

TEST_F(DrivingRover, a_bridge_that_falls_silent_or_complains_is_named_with_its_wheel) {
    run(10);
    frame.present = FRAME_ALL & ~(static_cast<uint32_t>(FRAME_BRIDGE_0) << 2u);
    run(7);
    EXPECT_EQ(trace.faults, 0u);
    run(1);
    EXPECT_EQ(trace.faults, static_cast<uint32_t>(FAULT_BRIDGE));
    EXPECT_EQ(trace.fault_wheels, 4u);
    EXPECT_EQ(trace.actuator.drive, DRIVE_BRAKE);
    command.mode = MODE_STOP;
    frame.present = FRAME_ALL;
    run(1);
    EXPECT_EQ(trace.faults, 0u);
    EXPECT_EQ(trace.fault_wheels, 0u);
    frame.bridge_status[1] = BRIDGE_OVER_TEMPERATURE;
    command.mode = MODE_WHEEL_SPEED;
    run(8);
    EXPECT_EQ(trace.faults, static_cast<uint32_t>(FAULT_BRIDGE));
    EXPECT_EQ(trace.fault_wheels, 2u);
}

TEST_F(DrivingRover, bridges_that_never_spoke_are_not_missed) {
    control_reset(&config, &state);
    frame.present = FRAME_ALL & ~(0xfu * static_cast<uint32_t>(FRAME_BRIDGE_0));
    run(100);
    EXPECT_EQ(trace.faults & FAULT_BRIDGE, 0u);
}

TEST_F(DrivingRover, what_a_fault_stopped_stays_braked_until_something_drives_again) {
    frame.emergency_stop = true;
    run(1);
    EXPECT_EQ(trace.actuator.drive, DRIVE_BRAKE);
    frame.emergency_stop = false;
    command.mode = MODE_STOP;
    run(1);
    EXPECT_EQ(trace.faults, 0u); // the latch is cleared, but on a slope the rover would roll away
    EXPECT_EQ(trace.actuator.drive, DRIVE_BRAKE);
    command.mode = MODE_WHEEL_SPEED;
    run(1);
    EXPECT_EQ(trace.actuator.drive, DRIVE_ON);
    command.mode = MODE_STOP;
    run(1);
    EXPECT_EQ(trace.actuator.drive, DRIVE_COAST); // a stop that was only asked for lets the wheels turn
}

TEST_F(DrivingRover, every_actuator_frame_has_a_number_of_its_own) {
    const uint32_t first = trace.actuator.sequence;
    run(5);
    EXPECT_EQ(trace.actuator.sequence, first + 5u);
}

TEST_F(DrivingRover, the_lamp_is_lit_while_a_fault_is_latched) {
    EXPECT_FALSE(trace.actuator.status_led);
    frame.emergency_stop = true;
    run(1);
    EXPECT_TRUE(trace.actuator.status_led);
}

// SPEED_DISAGREE through the whole tick: 0.5 m/s that only the accelerometer's integral knows of, 0.057 m wheels.
TEST(Disagreement, is_measured_against_the_fastest_wheel) {
    for (int fastest = 0; fastest < WHEEL_COUNT; ++fastest) {
        for (const int pulses : {43, 36}) { // 4.5 and 3.8 rad/s: 1.5 R w + 0.15 is 0.535 and 0.472 m/s
            control_config_t config = rover_config_default();
            config.safety.required = 0;
            config.safety.sigmas = 0;                  // as if the estimate were sure of it
            config.ground_speed.wheel_noise_m_s = 100; // and the wheels told nothing
            control_state_t state;
            control_reset(&config, &state);
            state.ground_speed.speed_m_s = 0.5f;
            command_t command = {};
            command.mode = MODE_OPEN_LOOP;
            sensor_frame_t frame = {};
            frame.battery_count = 1800;
            frame.present = 0xfu | FRAME_BATTERY;
            trace_t trace = {};
            for (uint32_t tick = 0; tick < 200; ++tick) {
                frame.tick = tick;
                for (int i = 0; i < WHEEL_COUNT; ++i) {
                    frame.encoder_count[i] += i == fastest ? pulses : 10;
                }
                trace = control_step(&config, &state, &command, &frame);
            }
            ASSERT_NEAR(trace.speed_m_s, 0.5f, 1e-5f);
            EXPECT_EQ(trace.faults, pulses == 43 ? 0u : static_cast<uint32_t>(FAULT_SPEED_DISAGREE)) << fastest << " " << pulses;
        }
    }
}

// What the estimate says that it does not know is no disagreement: 0.8 m/s beside standing wheels explain 0.15 m/s.
TEST(Disagreement, grants_the_estimate_three_sigma_of_its_own) {
    const control_config_t config = rover_config_default();
    const sensor_frame_t frame = {};
    for (const float std_m_s : {0.21f, 0.22f}) { // 0.65 m/s are three times 0.2167
        safety_config_t safety = config.safety;
        safety.required = 0;
        safety_state_t state = {};
        safety_input_t input = {};
        input.frame = &frame;
        input.ground_speed_m_s = -0.8f;
        input.ground_speed_std_m_s = std_m_s;
        safety_output_t out = {};
        for (int tick = 0; tick < 110; ++tick) {
            out = safety_step(&safety, &state, &input);
        }
        EXPECT_EQ(out.faults & FAULT_SPEED_DISAGREE, std_m_s < 0.2167f ? static_cast<uint32_t>(FAULT_SPEED_DISAGREE) : 0u) << std_m_s;
    }
}

TEST_F(DrivingRover, a_brown_out_stops_the_rover_at_once) {
    frame.battery_count = 1050; // 4.2 V, below 0.8 of 5.4 V
    run(2);
    EXPECT_EQ(trace.faults, 0u);
    run(1);
    EXPECT_EQ(trace.faults, static_cast<uint32_t>(FAULT_BROWN_OUT));
    EXPECT_EQ(trace.actuator.drive, DRIVE_BRAKE);
}

TEST_F(DrivingRover, a_winding_of_unknown_past_starts_warm) {
    safety_warm(&config.safety, &state.safety, nullptr);
    for (const float rise_K : state.safety.rise_K) {
        EXPECT_FLOAT_EQ(rise_K, 76.0f); // 0.8 of 95 K
    }
    const float known[WHEEL_COUNT] = {0.0f, 12.0f, std::nanf(""), 1e9f};
    safety_warm(&config.safety, &state.safety, known);
    EXPECT_EQ(state.safety.rise_K[0], 0.0f);
    EXPECT_EQ(state.safety.rise_K[1], 12.0f);
    EXPECT_FLOAT_EQ(state.safety.rise_K[2], 76.0f);
    EXPECT_EQ(state.safety.rise_K[3], 1000.0f); // too hot to drive
    run(1);
    EXPECT_EQ(trace.faults & FAULT_OVER_TEMPERATURE, static_cast<uint32_t>(FAULT_OVER_TEMPERATURE));
}

TEST_F(DrivingRover, a_dead_front_end_is_named_by_its_missing_noise_and_a_quiet_living_one_is_not) {
    unsigned seed = 5;
    const auto noise = [&seed] { // near normal, of variance 1: twelve uniform numbers
        double sum = -6;
        for (int i = 0; i < 12; ++i) {
            seed = seed * 1664525u + 1013904223u;
            sum += (seed >> 8) / 16777216.0;
        }
        return sum;
    };
    frozen = true;
    for (const double sigma : {1.12, 0.6}) { // the reference's white and flicker noise; below a count, rounding's 1/12 beside it
        for (int k = 0; k < 600 && trace.faults == 0u; ++k) {
            for (auto &count : frame.radar_count) {
                count = static_cast<uint16_t>(std::lround(512 + sigma * noise()));
            }
            run(1);
        }
        EXPECT_EQ(trace.faults, sigma > 1 ? 0u : static_cast<uint32_t>(FAULT_RADAR_LOST)) << sigma;
    }
}

TEST_F(DrivingRover, windings_warm_up_by_their_thermal_model) {
    config.circuit.contradict_V = 1e9f; // currents of the windings alone: no motor draws them at this speed
    for (float &rise : state.safety.rise_K) {
        rise = 0;
    }
    for (auto &count : frame.current_count) {
        count = 2048 + 600; // 1.2 A: below every limit
    }
    run(3000);
    EXPECT_EQ(trace.faults, 0u);
    for (const float rise : state.safety.rise_K) {
        EXPECT_NEAR(rise, 1.44 * 3.24 * 12 * (1 - std::exp(-30.0 / 60)), 0.05); // I^2 Ra R_th (1 - exp(-t/tau)); a step of 40 ms of 60 s
    }
}

TEST_F(DrivingRover, a_battery_that_is_not_measured_is_not_low) {
    config.safety.required &= ~static_cast<uint32_t>(FRAME_BATTERY);
    control_reset(&config, &state);
    frame.present &= ~static_cast<uint32_t>(FRAME_BATTERY);
    run(200);
    EXPECT_EQ(trace.battery_voltage_V, 0.0f);
    EXPECT_EQ(trace.faults, 0u);
}

TEST_F(DrivingRover, a_long_gap_is_forgotten_as_soon_as_a_short_one) {
    for (const int gap : {6, 5000}) {
        tick += gap;
        run(1);
        EXPECT_TRUE((trace.faults & FAULT_MISSED_TICKS) != 0u);
        command.mode = MODE_STOP;
        int ticks = 0;
        while (trace.faults != 0u && ticks < 300) {
            run(1);
            ++ticks;
        }
        EXPECT_EQ(ticks, 100) << gap; // one is forgotten per 100 good ticks; five are tolerated
        run(1000);
        command.mode = MODE_WHEEL_SPEED;
        run(1);
    }
}

} // namespace
