// speed_control and soil_sweep: the references that the drive modes give to the wheels.
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

TEST(SpeedControl, is_equation_22_without_its_integral) {
    speed_control_config_t config = rover_config_default().speed_control;
    config.ki_T_rad_m = 0;
    speed_control_state_t state = {};
    for (double v = -0.5; v <= 0.5; v += 0.1) {
        const speed_control_input_t input = {
            .speed_ref_m_s = 0.2f, .yaw_rate_ref_rad_s = 0, .speed_m_s = static_cast<float>(v), .saturated = false};
        const speed_control_output_t out = speed_control_step(&config, &state, &input);
        const double expected = 0.2 / 0.057 + 17.5 * (0.2 - v); // (22)
        EXPECT_NEAR(out.left_rad_s, expected, 1e-5);            // 4 float roundings of numbers below 20
        EXPECT_EQ(out.left_rad_s, out.right_rad_s);
    }
}

TEST(SpeedControl, turns_left_with_faster_right_wheels) {
    const speed_control_config_t config = rover_config_default().speed_control;
    speed_control_state_t state = {};
    const speed_control_input_t input = {.speed_ref_m_s = 0, .yaw_rate_ref_rad_s = 1, .speed_m_s = 0, .saturated = false};
    const speed_control_output_t out = speed_control_step(&config, &state, &input);
    EXPECT_NEAR(out.right_rad_s, 0.12 / 0.057, 1e-6); // b psi / R
    EXPECT_NEAR(out.left_rad_s, -0.12 / 0.057, 1e-6);
}

TEST(SpeedControl, integral_is_frozen_while_saturated_and_bounded_always) {
    const speed_control_config_t config = rover_config_default().speed_control;
    speed_control_state_t state = {};
    speed_control_input_t input = {.speed_ref_m_s = 0.5f, .yaw_rate_ref_rad_s = 0, .speed_m_s = 0, .saturated = false};
    speed_control_step(&config, &state, &input);
    const float once = state.integral_rad_s;
    EXPECT_GT(once, 0);
    input.saturated = true;
    speed_control_step(&config, &state, &input);
    EXPECT_EQ(state.integral_rad_s, once);
    input.saturated = false;
    for (int k = 0; k < 10000; ++k) {
        speed_control_step(&config, &state, &input);
    }
    EXPECT_EQ(state.integral_rad_s, config.integral_max_rad_s);
}

TEST(SpeedControl, is_bounded_for_any_input) {
    const speed_control_config_t config = rover_config_default().speed_control;
    const float inf = std::numeric_limits<float>::infinity();
    for (const float a : {0.0f, 3e38f, -3e38f, inf, -inf, std::nanf("")}) {
        for (const float b : {0.0f, 3e38f, -3e38f, inf, -inf, std::nanf("")}) {
            speed_control_state_t state = {};
            const speed_control_input_t input = {.speed_ref_m_s = a, .yaw_rate_ref_rad_s = b, .speed_m_s = b, .saturated = false};
            const speed_control_output_t out = speed_control_step(&config, &state, &input);
            EXPECT_LE(std::fabs(out.left_rad_s), config.wheel_max_rad_s);
            EXPECT_LE(std::fabs(out.right_rad_s), config.wheel_max_rad_s);
        }
    }
}

TEST(SoilSweep, passes_zero_slip_at_ten_seconds) {
    const soil_sweep_config_t config = rover_config_default().soil_sweep;
    soil_sweep_state_t state = {};
    for (int k = 0; k <= 2000; ++k) {
        const soil_sweep_output_t out = soil_sweep_step(&config, &state, 0.3f);
        const double expected = 0.3 / 0.057 / 10 * (0.01 * k); // (15): dw_a = 0.3/0.057/10 rad/s^2
        EXPECT_NEAR(out.front_rad_s, expected, 1e-6 * expected + 1e-9);
        EXPECT_EQ(out.done, k >= 2000);
    }
    EXPECT_NEAR(soil_sweep_step(&config, &state, 0.3f).front_rad_s, 2 * 0.3 / 0.057, 1e-5);
}

TEST(SpeedControl, integral_shrinks_although_saturated) {
    const speed_control_config_t config = rover_config_default().speed_control;
    for (const float sign : {1.0f, -1.0f}) {
        speed_control_state_t state = {.integral_rad_s = 2.0f * sign};
        const speed_control_input_t input = {
            .speed_ref_m_s = 0.3f * sign, .yaw_rate_ref_rad_s = 0, .speed_m_s = 0.35f * sign, .saturated = true};
        speed_control_step(&config, &state, &input);
        EXPECT_NEAR(state.integral_rad_s, (2.0f - 0.05f * config.ki_T_rad_m) * sign, 1e-6f); // (1)
    }
}

} // namespace
