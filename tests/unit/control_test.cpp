#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace {

sensor_frame_t frame_at(uint32_t tick, int32_t pulses) {
    sensor_frame_t frame = {};
    frame.tick = tick;
    frame.present = FRAME_ALL;
    frame.battery_count = 1800;
    frame.radar_samples = 5;
    for (int n = 0; n < 5; ++n) {
        frame.radar_count[n] =
            static_cast<uint16_t>(512 + 100 * std::cos(2 * clutter::pi * 10 * (5 * tick + static_cast<uint32_t>(n)) / 512));
    }
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        frame.encoder_count[i] = pulses;
        frame.current_count[i] = 2048;
    }
    return frame;
}

TEST(Control, every_pair_of_modes_changes_without_a_jump_in_duty) {
    const control_config_t config = rover_config_default();
    for (int from = MODE_OPEN_LOOP; from < MODE_COUNT; ++from) {
        for (int to = MODE_WHEEL_SPEED; to < MODE_COUNT; ++to) {
            control_state_t state;
            control_reset(&config, &state);
            command_t command = {};
            command.platform_speed_m_s = 0.17f; // 3 rad/s
            command.slip_wheels = 2;
            command.slip_ref = 0.1f;
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                command.wheel_speed_rad_s[i] = 3;
                command.duty[i] = 0.15f;
            }
            command.mode = static_cast<control_mode_t>(from);
            trace_t trace = {};
            uint32_t tick = 0;
            for (; tick < 200; ++tick) {
                const sensor_frame_t frame = frame_at(tick, static_cast<int32_t>(29 * tick));
                trace = control_step(&config, &state, &command, &frame);
            }
            const trace_t before = trace;
            command.mode = static_cast<control_mode_t>(to);
            const sensor_frame_t frame = frame_at(tick, static_cast<int32_t>(29 * tick));
            trace = control_step(&config, &state, &command, &frame);
            ASSERT_EQ(trace.mode, to);
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                if (from != to) {
                    // One tick of slew through Kp and the feed-forward: (0.2 + 0.009 + 0.037) * 0.6
                    EXPECT_NEAR(trace.wheel[i].duty, before.wheel[i].duty, 0.15f) << from << " to " << to << " wheel " << i;
                }
            }
        }
    }
}

TEST(Control, open_loop_writes_the_duty_it_was_given) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    command_t command = {};
    command.mode = MODE_OPEN_LOOP;
    command.duty[0] = 0.5f;
    command.duty[1] = -2.0f;
    command.duty[2] = std::nanf("");
    const sensor_frame_t frame = frame_at(0, 0);
    const trace_t trace = control_step(&config, &state, &command, &frame);
    EXPECT_EQ(trace.actuator.duty_q15[0], 16384);
    EXPECT_EQ(trace.actuator.duty_q15[1], -32767);
    EXPECT_EQ(trace.actuator.duty_q15[2], 0);
}

TEST(Control, an_unknown_mode_stops) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    command_t command = {};
    command.mode = static_cast<control_mode_t>(MODE_COUNT);
    const sensor_frame_t frame = frame_at(0, 0);
    EXPECT_NE(control_step(&config, &state, &command, &frame).actuator.drive, DRIVE_ON);
}

// 20,000 ticks of frames and commands made of random bits: every output bounded, nothing undefined (preset dev runs it under UBSan).
TEST(Control, is_bounded_for_arbitrary_frames_and_commands) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    clutter::Random random{2026};
    for (uint32_t tick = 0; tick < 20000; ++tick) {
        sensor_frame_t frame = frame_at(tick, static_cast<int32_t>(29 * tick));
        command_t command = {};
        command.mode = static_cast<control_mode_t>(random.next() % MODE_COUNT);
        const auto any = [&random] {
            const auto bits = static_cast<uint32_t>(random.next());
            float value = 0;
            std::memcpy(&value, &bits, sizeof value);
            return value;
        };
        command.platform_speed_m_s = any();
        command.yaw_rate_rad_s = any();
        command.slip_ref = any();
        command.slip_wheels = static_cast<uint8_t>(random.next());
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            command.wheel_speed_rad_s[i] = any();
            command.duty[i] = any();
        }
        if (random.next() % 4 == 0) { // else a healthy frame, so that the loops run too
            frame.present = static_cast<uint32_t>(random.next());
            frame.battery_count = static_cast<uint16_t>(random.next());
            frame.accel_x_count = static_cast<int16_t>(random.next());
            frame.gyro_z_count = static_cast<int16_t>(random.next());
            frame.radar_samples = static_cast<uint8_t>(random.next());
            for (auto &count : frame.radar_count) {
                count = static_cast<uint16_t>(random.next());
            }
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                frame.encoder_count[i] = static_cast<int32_t>(random.next());
                frame.current_count[i] = static_cast<uint16_t>(random.next());
            }
        }
        if (random.next() % 64 == 0) {
            control_reset(&config, &state);
        }
        const trace_t trace = control_step(&config, &state, &command, &frame);
        ASSERT_TRUE(std::isfinite(trace.speed_m_s) && std::isfinite(trace.speed_std_m_s));
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            ASSERT_LE(std::abs(trace.actuator.duty_q15[i]), 32767);
            ASSERT_LE(std::fabs(trace.wheel[i].slip), 1.0f);
            ASSERT_TRUE(std::isfinite(trace.wheel[i].traction_N));
            ASSERT_TRUE(trace.actuator.drive == DRIVE_ON || trace.actuator.duty_q15[i] == 0);
        }
    }
}

// A rover that rolls without slip at 0.3 m/s as far as its estimate goes: the radar is silent, the wheels' counts are the test's.
class Rolling : public ::testing::Test {
  protected:
    control_config_t config = rover_config_default();
    control_state_t state = {};
    command_t command = {};
    sensor_frame_t frame = {};
    trace_t trace = {};

    void SetUp() override {
        config.safety.required = 0;
        control_reset(&config, &state);
        state.ground_speed.speed_m_s = 0.3f;
        state.ground_speed.p_vv = state.ground_speed.p_bb = 1e-6f; // it is sure of that
        frame.battery_count = 1800;
        frame.present = 0xffu | FRAME_BATTERY;
        for (auto &count : frame.current_count) {
            count = 2048;
        }
    }
    void run(int ticks) {
        for (int k = 0; k < ticks; ++k) {
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                frame.encoder_count[i] += pulses[i];
                // what the motor draws: a winding without current would be called open
                const double emf_V = 0.265 * pulses[i] * 2 * clutter::pi / 60;
                const bool driven = trace.actuator.drive >= DRIVE_BRAKE;
                const double drop_V = driven ? 7.2 * static_cast<double>(trace.wheel[i].duty) - emf_V : 0;
                frame.current_count[i] = static_cast<uint16_t>(2048 + std::lround(drop_V / 3.24 / 0.002));
            }
            trace = control_step(&config, &state, &command, &frame);
            frame.tick++;
        }
    }
    int pulses[WHEEL_COUNT] = {50, 50, 50, 50}; // 5.24 rad/s, 0.298 m/s
};

TEST_F(Rolling, every_wheel_of_the_slip_servo_is_driven_by_its_own_slip_loop_and_says_when_it_is_saturated) {
    command.mode = MODE_SLIP;
    command.slip_wheels = 15;
    command.slip_ref = 0.9f;
    pulses[2] = 40;
    run(300);
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        EXPECT_FALSE(trace.wheel[i].slip_valid); // no echo: the ground speed is hardly known, nor is the slip
        EXPECT_GT(trace.wheel[i].slip_std, 0.25f);
        EXPECT_EQ(trace.wheel[i].duty, 1.0f) << i; // 2 * 1.5 * 0.9 at least: far beyond the limit
        EXPECT_TRUE(trace.wheel[i].saturated) << i;
        EXPECT_EQ(trace.wheel[i].set_speed_rad_s, 0.0f) << i; // no speed loop beside it
    }
    command.slip_ref = 0.0f;
    command.slip_wheels = 5;
    run(1);
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        EXPECT_EQ(trace.wheel[i].set_speed_rad_s != 0.0f, i == 1 || i == 3) << i;
    }
}

TEST_F(Rolling, full_slip_is_asked_for_by_a_bounded_wheel_speed_while_slip_means_nothing) {
    state.ground_speed.speed_m_s = 0;
    config.speed_control.ki_T_rad_m = 0;
    command.mode = MODE_SLIP;
    command.slip_wheels = 15;
    command.slip_ref = 1.0f;
    command.platform_speed_m_s = 0.04f;
    for (int &p : pulses) {
        p = 0;
    }
    run(200);
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        // w(1) would be infinite: ten times what (22) asks for with an error of 0.04 m/s
        EXPECT_NEAR(trace.wheel[i].set_speed_rad_s, 10 * (0.04 / 0.057 + 17.5 * 0.04), 1e-3);
    }
}

TEST_F(Rolling, turning_left_slows_both_left_wheels_and_speeds_both_right_ones) {
    command.mode = MODE_PLATFORM_SPEED;
    command.platform_speed_m_s = 0.3f;
    command.yaw_rate_rad_s = 0.5f;
    run(100);
    const float set[] = {trace.wheel[0].set_speed_rad_s, trace.wheel[1].set_speed_rad_s, trace.wheel[2].set_speed_rad_s,
                         trace.wheel[3].set_speed_rad_s};
    EXPECT_EQ(set[WHEEL_REAR_LEFT], set[WHEEL_FRONT_LEFT]);
    EXPECT_EQ(set[WHEEL_REAR_RIGHT], set[WHEEL_FRONT_RIGHT]);
    EXPECT_NEAR(set[WHEEL_REAR_RIGHT] - set[WHEEL_REAR_LEFT], 2 * 0.12 * 0.5 / 0.057, 1e-3); // 2 b psi / R
}

TEST_F(Rolling, soil_sweep_ramps_both_front_wheels_and_rolls_both_rear_ones) {
    command.mode = MODE_SOIL_SWEEP;
    command.platform_speed_m_s = 0.3f;
    run(501);
    for (const int i : {WHEEL_FRONT_LEFT, WHEEL_FRONT_RIGHT}) {
        EXPECT_NEAR(trace.wheel[i].set_speed_rad_s, 0.5 * 0.3 / 0.057, 0.02) << i; // (15): half of t_zero; one tick is 0.005
    }
    for (const int i : {WHEEL_REAR_LEFT, WHEEL_REAR_RIGHT}) {
        EXPECT_NEAR(trace.wheel[i].set_speed_rad_s, 0.3 / 0.057, 0.1) << i; // (16), and what its integral made of an error of 0.002 m/s
    }
}

TEST_F(Rolling, any_one_saturated_wheel_freezes_the_integral_of_the_platform) {
    command.mode = MODE_WHEEL_SPEED;
    for (int wheel = 0; wheel < WHEEL_COUNT; ++wheel) {
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            command.wheel_speed_rad_s[i] = i == wheel ? 25.0f : 5.236f;
        }
        run(200);
        EXPECT_TRUE(state.saturated) << wheel;
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            EXPECT_EQ(trace.wheel[i].saturated, i == wheel) << wheel << " " << i;
        }
        command.mode = MODE_STOP;
        run(1);
        command.mode = MODE_WHEEL_SPEED;
    }
}

TEST_F(Rolling, one_turning_wheel_is_enough_not_to_be_at_rest) {
    for (int wheel = 0; wheel < WHEEL_COUNT; ++wheel) {
        control_reset(&config, &state);
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            pulses[i] = i == wheel ? 10 : 0; // 1 rad/s: a quarter of 0.06 m/s is above 0.006 m/s
        }
        run(100);
        EXPECT_FALSE(trace.standstill) << wheel;
    }
    for (int &p : pulses) {
        p = 0;
    }
    run(100);
    EXPECT_TRUE(trace.standstill);
}

TEST(Control, a_rover_that_hears_nothing_reports_nothing) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    command_t command = {};
    for (uint32_t tick = 0; tick < 7; ++tick) {
        sensor_frame_t frame = {};
        frame.tick = tick;
        const trace_t trace = control_step(&config, &state, &command, &frame);
        EXPECT_EQ(trace.faults, 0u); // before any patience is over
        EXPECT_EQ(trace.speed_m_s, 0);
        EXPECT_EQ(trace.radar_speed_m_s, 0);
        for (const wheel_trace_t &wheel : trace.wheel) {
            EXPECT_EQ(wheel.speed_rad_s, 0);
            EXPECT_EQ(wheel.accel_rad_s2, 0);
            EXPECT_EQ(wheel.current_A, 0);
        }
    }
}

TEST_F(Rolling, accelerometer_and_radar_are_used_when_they_are_there_and_left_alone_when_not) {
    for (const bool there : {false, true}) {
        SetUp();
        frame.present = 0xffu | FRAME_BATTERY | (there ? static_cast<uint32_t>(FRAME_ACCEL | FRAME_RADAR) : 0u);
        frame.accel_x_count = 100; // 0.4 m/s^2
        frame.radar_samples = 5;
        run(20);
        EXPECT_NEAR(trace.speed_m_s, there ? 0.3 + 0.4 * 0.2 : 0.3, 1e-4);
        EXPECT_EQ(state.doppler.filled, there ? 100 : 0);
    }
}

// The composition that control.h draws, by hand: a radar value reaches the filter with its age in seconds.
TEST_F(Rolling, a_radar_value_reaches_the_filter_with_its_age) {
    frame.present |= FRAME_ACCEL | FRAME_RADAR;
    doppler_state_t doppler = {};
    doppler_output_t heard = {};
    ground_speed_state_t filter = state.ground_speed;
    int fresh = 0;
    float last = 0;
    for (int tick = 0; tick < 300; ++tick) {
        frame.radar_samples = tick % 8 == 0 ? 6 : 5;
        for (int n = 0; n < frame.radar_samples; ++n) {
            frame.radar_count[n] = static_cast<uint16_t>(512 + ((5 * tick + n) * 7919 % 331) - 165);
        }
        frame.accel_x_count = static_cast<int16_t>(tick < 150 ? 20 : -20);
        run(1);
        doppler_output_t value = heard; // by the tick before
        value.late_samples += frame.radar_samples;
        heard = doppler_step(&config.doppler, &doppler, frame.radar_count, frame.radar_samples);
        const float turning =
            trace.wheel[0].speed_rad_s + trace.wheel[1].speed_rad_s + trace.wheel[2].speed_rad_s + trace.wheel[3].speed_rad_s;
        const ground_speed_input_t input = {.accel_x_m_s2 = trace.accel_x_m_s2,
                                            .doppler_m_s = value.speed_m_s,
                                            .doppler_late_s = static_cast<float>(value.late_samples) / 512.0f,
                                            .wheel_m_s = 0.25f * turning * config.slip.wheel_radius_m,
                                            .slowest_m_s = 0.0f,
                                            .wheels_part = false,
                                            .accel_valid = true,
                                            .doppler_fresh = value.fresh && !value.beyond && !value.spoilt,
                                            .doppler_quiet = value.quiet,
                                            .doppler_dead = value.dead,
                                            .busy = heard.busy || heard.fresh,
                                            .doppler_trust = value.trust,
                                            .doppler_misfit = value.misfit,
                                            .doppler_relieved = value.relieved,
                                            .elapsed_ticks = 1,
                                            .lean_q8 = 0};
        const ground_speed_output_t out = ground_speed_step(&config.ground_speed, &filter, &input);
        fresh += value.fresh ? 1 : 0;
        last = value.fresh ? value.speed_m_s : last;
        ASSERT_EQ(trace.speed_m_s, out.speed_m_s) << tick;
        ASSERT_EQ(trace.radar_speed_m_s, last) << tick;
    }
    EXPECT_GT(fresh, 15);
}

// No window: a tone between two bins leaks with 1/d, not with 1/d^3. All bins but zero: a tone beyond the likelihood's band is found.
TEST(PaperConfiguration, hears_as_the_paper_does) {
    const control_config_t config = rover_config_paper();
    EXPECT_EQ(config.doppler.hop, FFT_LENGTH); // a value every 0.5 s
    const int32_t band_end = config.doppler.beam->first_bin + config.doppler.beam->bins;
    ASSERT_LT(band_end, 100);
    for (const double bin : {10.5, 110.0}) {
        doppler_state_t state = {};
        doppler_output_t out = {};
        for (int n = 0; n <= FFT_LENGTH; ++n) {
            const auto count = static_cast<uint16_t>(std::lround(512 + 300 * std::cos(2 * 3.14159265358979 * bin * n / 256)));
            out = doppler_step(&config.doppler, &state, &count, 1);
        }
        ASSERT_TRUE(out.fresh);
        EXPECT_NEAR(out.speed_m_s, bin * 2 * static_cast<double>(config.doppler.beam->paper_m_s_per_Hz), 0.0162 * 1.01); // half a bin
        // ten and a half bins off a tone of amplitude A: (A/pi/10.5)^2 of it without a window, 1e-4 of that under Hann's
        const double peak = static_cast<double>(state.power[10]), far = static_cast<double>(state.power[21]);
        if (bin < 11) {
            EXPECT_GT(far / peak, 1e-3);
        }
    }
}

TEST(PaperConfiguration, is_the_papers_laws) {
    const control_config_t config = rover_config_paper();
    EXPECT_GT(config.wheel_pid.kd_s2, 0.0f); // a PID: its derivative brakes a wheel that gains speed
    EXPECT_EQ(rover_config_default().wheel_pid.kd_s2, 0.0f);
    speed_control_state_t platform = {};
    const speed_control_input_t error = {.speed_ref_m_s = 0.3f, .yaw_rate_ref_rad_s = 0, .speed_m_s = 0.2f, .saturated = false};
    wheel_pid_state_t wheel = {};
    EXPECT_NEAR(wheel_pid_slew(&config.wheel_pid, &wheel, 20.0f), 20.0f, 1e-5f); // no slew
    for (int k = 0; k < 100; ++k) {
        EXPECT_NEAR(speed_control_step(&config.speed_control, &platform, &error).left_rad_s, 0.3 / 0.057 + 17.5 * 0.1,
                    1e-4); // (22): no integral
    }
    for (const float v : {0.0f, 0.3f, 1.0f}) { // (23): no schedule
        slip_pi_state_t slip = {};
        const slip_pi_input_t input = {.slip_ref = 0.2f, .slip = 0, .speed_m_s = v};
        EXPECT_NEAR(slip_pi_step(&config.slip_pi, &slip, &input).duty, (config.slip_pi.kp + config.slip_pi.ki_T) * 0.2f, 1e-6f);
    }
}

TEST_F(Rolling, below_the_speed_where_slip_means_something_the_wheel_follows_the_speed_that_has_it) {
    config.speed_control.ki_T_rad_m = 0;
    command.mode = MODE_SLIP;
    command.slip_wheels = 15;
    for (int &p : pulses) {
        p = 0;
    }
    for (const float forward : {1.0f, -1.0f}) {
        for (const float slip : {0.5f, -0.5f}) { // of the body's frame: driving forward is positive
            control_reset(&config, &state);
            command.slip_ref = slip * forward;
            command.platform_speed_m_s = 0.04f * forward;
            run(200);
            const double rolling = (0.04 / 0.057 + 17.5 * 0.04) * static_cast<double>(forward); // (22) at rest
            EXPECT_NEAR(trace.wheel[1].set_speed_rad_s, slip > 0 ? rolling / 0.5 : rolling * 0.5, 1e-3)
                << forward << " " << slip; // (1) solved for w
        }
    }
}

TEST_F(Rolling, slip_loop_integrates_from_tick_to_tick) {
    command.mode = MODE_SLIP;
    command.slip_wheels = 1;
    command.slip_ref = 0.02f;
    run(2);
    const float first = trace.wheel[0].duty;
    run(10);
    const double gain = 5 * 0.3, error = 0.02 - static_cast<double>(trace.wheel[0].slip);
    EXPECT_NEAR(trace.wheel[0].duty - first, 10 * 0.09 * gain * error, 1e-4); // ten steps of Ki T g e
}

TEST_F(Rolling, a_turning_rover_slips_by_the_ground_speed_of_each_wheel) {
    frame.present |= FRAME_GYRO;
    frame.gyro_z_count = 1000; // 0.5 rad/s to the left
    command.mode = MODE_STOP;
    run(20);
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        const double ground = 0.3 + (i == WHEEL_REAR_LEFT || i == WHEEL_FRONT_LEFT ? -1 : 1) * 0.12 * 0.5,
                     w = 50 * 100 * 2 * clutter::pi / 6000, rim = 0.057 * w;
        EXPECT_NEAR(trace.wheel[i].slip, rim > ground ? 1 - ground / rim : rim / ground - 1, 1e-4) << i; // (1)
        EXPECT_NEAR(trace.wheel[i].traction_N, -(1.6e-3 * w + 0.03) / 0.057, 1e-4) << i;                 // (18), (19) without current
    }
}

TEST_F(Rolling, without_feed_forward_the_wheel_loop_is_a_plain_pid) {
    config.feed_forward = false;
    command.mode = MODE_WHEEL_SPEED;
    for (float &w : command.wheel_speed_rad_s) {
        w = 5.236f + 0.5f;
    }
    run(50);
    command.mode = MODE_STOP;
    run(1);
    command.mode = MODE_WHEEL_SPEED;
    run(1);
    EXPECT_NEAR(trace.wheel[3].duty, (0.2 + 0.009) * 0.5, 2e-3); // from duty 0: one step of (2), (3) of wheel_pid.h
}

} // namespace
