#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace {

sensor_frame_t frame_at(uint32_t tick, int32_t pulses)
{
    sensor_frame_t frame = {};
    frame.tick = tick;
    frame.present = 0xfffu;
    frame.battery_count = 1800;
    frame.radar_samples = 5;
    for (int n = 0; n < 5; ++n) {
        frame.radar_count[n] = static_cast<uint16_t>(512 + 100 * std::cos(2 * clutter::pi * 10 * (5 * tick + static_cast<uint32_t>(n)) / 512));
    }
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        frame.encoder_count[i] = pulses;
        frame.current_count[i] = 2048;
    }
    return frame;
}

TEST(Control, every_pair_of_modes_changes_without_a_jump_in_duty)
{
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

TEST(Control, open_loop_writes_the_duty_it_was_given)
{
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

TEST(Control, an_unknown_mode_stops)
{
    const control_config_t config = rover_config_default();
    control_state_t state;
    control_reset(&config, &state);
    command_t command = {};
    command.mode = static_cast<control_mode_t>(MODE_COUNT);
    const sensor_frame_t frame = frame_at(0, 0);
    EXPECT_FALSE(control_step(&config, &state, &command, &frame).actuator.motor_enable);
}

// 20,000 ticks of frames and commands made of random bits: every output bounded, nothing undefined (preset dev runs it under UBSan).
TEST(Control, is_bounded_for_arbitrary_frames_and_commands)
{
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
            ASSERT_TRUE(trace.actuator.motor_enable || trace.actuator.duty_q15[i] == 0);
        }
    }
}

} // namespace
