// What control_step does with what it doubts: the platform's speed is steered by less of an error that is not sure, slip's standard
// deviation is one wheel's a tick. Both held to closed forms of the trace's own numbers.
#include "firmware/core/rover_config.h"
#include "firmware/core/slip.h"
#include "tests/unit/clutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

// Wheels that turn at some 3 rad/s, each a little faster than the one before, over ground that passes; a radar where `heard`.
sensor_frame_t rolling_frame(uint32_t tick, bool heard, int turn_count) {
    sensor_frame_t frame = {};
    frame.tick = tick;
    frame.present = FRAME_ALL & ~static_cast<uint32_t>(FRAME_TIME | (heard ? 0 : FRAME_RADAR));
    frame.battery_count = 1800;
    frame.gyro_z_count = static_cast<int16_t>(turn_count);
    frame.radar_samples = heard ? 5 : 0;
    frame.radar_sequence = 1 + 5 * tick;
    for (uint32_t n = 0; n < frame.radar_samples; ++n) {
        frame.radar_count[n] = static_cast<uint16_t>(512 + 100 * std::cos(2 * clutter::pi * 10 * (5 * tick + n) / 512));
    }
    for (int i = 0; i < WHEEL_COUNT; ++i) {
        frame.encoder_count[i] = static_cast<int32_t>(28u * tick + static_cast<uint32_t>(i) * tick / 2);
        frame.current_count[i] = 2100;
    }
    return frame;
}

// v* = ref + min(1, 0.03/std)^2 (v - ref), then (22) without integral: both sides turn at ref/R + Kv (ref - v*).
TEST(ControlClaims, an_error_counts_by_the_square_of_what_the_estimate_is_sure_of) {
    control_config_t config = rover_config_default();
    config.speed_control.ki_T_rad_m = 0;
    config.wheel_pid.slew_T_rad_s = 1e6f;
    config.circuit.contradict_V = 1000; // these wheels turn as they please, and the radar may fall silent: no fault shall end it
    config.circuit.jump_rad_s = 1000;
    config.safety.required = 0;
    config.safety.disagree_m_s = 100;
    config.safety.current_continuous_A2 = 100;
    control_state_t state;
    control_reset(&config, &state);
    int sure = 0, unsure = 0;
    double least_share = 1;
    for (uint32_t tick = 0; tick < 900; ++tick) {
        command_t command = {};
        command.mode = MODE_PLATFORM_SPEED;
        command.platform_speed_m_s = tick / 50 % 2 == 0 ? 0.3f : -0.2f;
        const sensor_frame_t frame = rolling_frame(tick, tick < 500, 0);
        const trace_t trace = control_step(&config, &state, &command, &frame);
        ASSERT_EQ(trace.mode, MODE_PLATFORM_SPEED) << tick << " " << trace.faults;
        const double std = static_cast<double>(trace.speed_std_m_s), ref = static_cast<double>(command.platform_speed_m_s);
        const double share = std > 0.03 ? 0.03 / std * (0.03 / std) : 1;
        const double wheel = ref / 0.057 + 17.5 * share * (ref - static_cast<double>(trace.speed_m_s));
        const double expected = std::fmax(-25, std::fmin(25, wheel));
        for (const wheel_trace_t &of : trace.wheel) {
            EXPECT_NEAR(of.set_speed_rad_s, expected, 1e-3) << tick << " std " << std;
        }
        sure += std < 0.03 ? 1 : 0;
        unsure += std > 0.031 ? 1 : 0;
        least_share = std::fmin(least_share, share);
    }
    EXPECT_GT(sure, 50);
    EXPECT_GT(unsure, 50);
    EXPECT_LT(least_share, 0.3);
}

// One wheel's in a tick that has time, in turn, from that tick's own numbers; so each is at most 80 ms old.
TEST(ControlClaims, what_slip_is_worth_is_made_wheel_by_wheel_and_never_older_than_80_ms) {
    const control_config_t config = rover_config_default();
    for (const int turn_count : {0, 400, -900}) {
        control_state_t state;
        control_reset(&config, &state);
        command_t command = {};
        command.mode = MODE_OPEN_LOOP;
        int age[WHEEL_COUNT] = {}, next = 0, made = 0, invalid = 0;
        float before[WHEEL_COUNT] = {1, 1, 1, 1};
        for (uint32_t tick = 0; tick < 600; ++tick) {
            const sensor_frame_t frame = rolling_frame(tick, true, turn_count);
            const trace_t trace = control_step(&config, &state, &command, &frame);
            int changed = -1;
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                const wheel_trace_t &wheel = trace.wheel[i];
                age[i]++;
                const bool left = i == WHEEL_REAR_LEFT || i == WHEEL_FRONT_LEFT;
                const float ground = trace.speed_m_s + (left ? -0.12f : 0.12f) * trace.gyro_z_rad_s;
                const slip_output_t slip = slip_measure(&config.slip, wheel.speed_rad_s, ground);
                EXPECT_FLOAT_EQ(wheel.slip, slip.slip) << tick << " " << i;
                EXPECT_EQ(wheel.slip_valid, slip.valid && wheel.slip_std <= 0.25f) << tick << " " << i;
                invalid += slip.valid && !wheel.slip_valid ? 1 : 0;
                if (wheel.slip_std == before[i]) {
                    continue;
                }
                EXPECT_EQ(changed, -1) << "two in tick " << tick;
                changed = i;
                EXPECT_FLOAT_EQ(wheel.slip_std, slip_std(&config.slip, wheel.speed_rad_s, ground, trace.speed_std_m_s)) << tick << " " << i;
                before[i] = wheel.slip_std;
                age[i] = 0;
                made++;
            }
            for (const int old : age) {
                EXPECT_TRUE(tick < 100 || old <= 8) << tick; // at first it is 1, whatever it is made of
            }
            if (changed >= 0 && tick > 100) {
                EXPECT_TRUE(next == 0 || changed == next % WHEEL_COUNT) << tick;
                next = changed + 1;
            }
        }
        EXPECT_GT(made, 300);
        EXPECT_GT(invalid, 0);
    }
}

} // namespace
