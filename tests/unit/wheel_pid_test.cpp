#include "firmware/core/rover_config.h"
#include "firmware/core/wheel_pid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

// A free wheel behind the circuit of docs/sources.md section 3, integrated with 1 ms steps, measured with one tick's delay by the encoder.
struct Wheel {
    double w = 0;
    double load_Nm = 0;
    bool blocked = false;
    void tick(float asked) {
        const double duty = static_cast<double>(asked);
        for (int i = 0; i < 10; ++i) {
            const double current = (duty * 7.2 - 0.265 * w) / 3.24;
            const double dry = 0.03 * std::fmax(-1.0, std::fmin(1.0, w / 0.05));
            w += 1e-3 * (0.265 * current - 1.6e-3 * w - dry - load_Nm) / 5e-3;
            w = blocked ? 0 : w;
        }
    }
};

wheel_pid_output_t drive(const wheel_pid_config_t &config, wheel_pid_state_t &state, float reference, double w) {
    wheel_pid_slew(&config, &state, reference);
    const wheel_pid_input_t input = {.speed_rad_s = static_cast<float>(w), .accel_rad_s2 = 0, .feed_forward = 0};
    return wheel_pid_step(&config, &state, &input);
}

TEST(WheelPid, settles_without_error_under_load) {
    const wheel_pid_config_t config = rover_config_default().wheel_pid;
    wheel_pid_state_t state = {};
    Wheel wheel;
    wheel.load_Nm = 0.1;
    for (int k = 0; k < 300; ++k) {
        wheel.tick(drive(config, state, 5.0f, wheel.w).duty);
    }
    EXPECT_NEAR(wheel.w, 5.0, 1e-3); // integral action: what is left after 3 s is exp(-3 s * 4.6 rad/s) = 1e-6 of the step
}

TEST(WheelPid, overshoots_less_than_a_tenth_after_a_step) {
    const wheel_pid_config_t config = rover_config_default().wheel_pid;
    wheel_pid_state_t state = {};
    Wheel wheel;
    double peak = 0;
    for (int k = 0; k < 300; ++k) {
        wheel.tick(drive(config, state, 8.0f, wheel.w).duty);
        peak = std::fmax(peak, wheel.w);
    }
    EXPECT_LT(peak, 8.8); // phase margin over 60 deg (docs/firmware.md): overshoot under 9 %
    EXPECT_GT(peak, 7.9);
}

TEST(WheelPid, recovers_at_once_after_being_blocked) {
    const wheel_pid_config_t config = rover_config_default().wheel_pid;
    wheel_pid_state_t state = {};
    Wheel wheel;
    wheel.blocked = true;
    for (int k = 0; k < 1000; ++k) {
        EXPECT_LE(std::fabs(drive(config, state, 5.0f, wheel.w).duty), 1.0f);
    }
    wheel.blocked = false;
    double peak = 0;
    int settled = 0;
    for (int k = 0; k < 200; ++k) {
        wheel.tick(drive(config, state, 5.0f, wheel.w).duty);
        peak = std::fmax(peak, wheel.w);
        settled = std::fabs(wheel.w - 5.0) > 0.25 ? k : settled;
    }
    EXPECT_LT(peak, 6.5);    // an integral wound up over 10 s (I = 4.5) would keep full duty until w is near no-load, 26 rad/s
    EXPECT_LT(settled, 100); // 1 s
}

TEST(WheelPid, starts_without_a_jump_from_any_duty) {
    const wheel_pid_config_t config = rover_config_default().wheel_pid;
    for (float duty = -1.0f; duty <= 1.0f; duty += 0.25f) {
        for (float w = -20.0f; w <= 20.0f; w += 5.0f) {
            wheel_pid_state_t state = {};
            wheel_pid_preset(&config, &state, duty, w, 0.1f);
            wheel_pid_slew(&config, &state, 12.0f);
            const wheel_pid_input_t input = {.speed_rad_s = w, .accel_rad_s2 = 0, .feed_forward = 0.1f};
            // one tick of slew: (Kp + Ki T) * slew T = 0.209 * 0.6
            EXPECT_NEAR(wheel_pid_step(&config, &state, &input).duty, duty, 0.1255f);
        }
    }
}

TEST(WheelPid, never_exceeds_the_limit_for_any_input) {
    const wheel_pid_config_t config = rover_config_default().wheel_pid;
    const float inf = std::numeric_limits<float>::infinity();
    const float extremes[] = {0.0f, 1e-45f, -3e38f, 3e38f, inf, -inf, std::nanf(""), 5.0f};
    for (const float a : extremes) {
        for (const float b : extremes) {
            for (const float c : extremes) {
                wheel_pid_state_t state = {.integral = a, .reference_rad_s = b};
                wheel_pid_slew(&config, &state, c);
                const wheel_pid_input_t input = {.speed_rad_s = b, .accel_rad_s2 = c, .feed_forward = a};
                const wheel_pid_output_t out = wheel_pid_step(&config, &state, &input);
                EXPECT_LE(std::fabs(out.duty), 1.0f);
                if (std::isnan(b)) {
                    EXPECT_EQ(out.duty, 0.0f);
                }
            }
        }
    }
}

TEST(WheelPid, derivative_brakes_by_the_measured_acceleration) {
    wheel_pid_config_t config = rover_config_default().wheel_pid;
    config.kd_s2 = 0.01f;
    for (const float accel : {-3.0f, 0.0f, 5.0f}) {
        wheel_pid_state_t state = {.integral = 0.1f, .reference_rad_s = 2.0f};
        const wheel_pid_input_t input = {.speed_rad_s = 2.0f, .accel_rad_s2 = accel, .feed_forward = 0.2f};
        EXPECT_NEAR(wheel_pid_step(&config, &state, &input).duty, 0.3f - 0.01f * accel, 1e-6f); // (2): three roundings below 1
    }
}

TEST(WheelPid, integral_stands_still_beyond_either_limit_and_comes_back_at_once) {
    const wheel_pid_config_t config = rover_config_default().wheel_pid;
    for (const float sign : {1.0f, -1.0f}) {
        wheel_pid_state_t state = {.integral = 0.5f * sign, .reference_rad_s = 10.0f * sign};
        const wheel_pid_input_t blocked = {.speed_rad_s = 0, .accel_rad_s2 = 0, .feed_forward = 0};
        for (int k = 0; k < 100; ++k) {
            EXPECT_EQ(wheel_pid_step(&config, &state, &blocked).duty, sign);
        }
        EXPECT_EQ(state.integral, 0.5f * sign); // (3)
        state.integral = 1.5f * sign;
        const wheel_pid_input_t fast = {.speed_rad_s = 10.5f * sign, .accel_rad_s2 = 0, .feed_forward = 0};
        wheel_pid_step(&config, &state, &fast);
        EXPECT_NEAR(state.integral, (1.5f - 0.5f * config.ki_T_s) * sign, 1e-6f); // still beyond the limit, but the error brings it back
    }
}

} // namespace
