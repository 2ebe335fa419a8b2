// (22) with yaw and integral, and (15), against their closed forms.
#include "firmware/core/soil_sweep.h"
#include "firmware/core/speed_control.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace {

// Numbers that are exact in float, none like another.
constexpr speed_control_config_t config = {.per_radius_1_m = 16,
                                           .half_track_per_radius = 2,
                                           .kv_rad_m = 8,
                                           .ki_T_rad_m = 0.25f,
                                           .integral_max_rad_s = 1,
                                           .speed_max_m_s = 1,
                                           .yaw_rate_max_rad_s = 1.5f,
                                           .wheel_max_rad_s = 24};
constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();

speed_control_output_t step(speed_control_state_t &state, float v_ref, float yaw, float v, bool saturated = false) {
    const speed_control_input_t input = {v_ref, yaw, v, saturated};
    return speed_control_step(&config, &state, &input);
}

TEST(SpeedControl, adds_speed_error_and_turn_as_22_says) {
    speed_control_state_t state = {};
    const speed_control_output_t out = step(state, 0.5f, 0.5f, 0.25f);
    // 0.5*16 + 8*0.25 + 0.25*0.25 -+ 2*0.5
    EXPECT_EQ(out.left_rad_s, 8 + 2 + 0.0625f - 1);
    EXPECT_EQ(out.right_rad_s, 8 + 2 + 0.0625f + 1);
    EXPECT_EQ(state.integral_rad_s, 0.0625f);
}

TEST(SpeedControl, sums_the_error_up_to_its_limit_on_both_sides) {
    for (const float sign : {1.0f, -1.0f}) {
        speed_control_state_t state = {};
        for (int k = 1; k <= 40; ++k) {
            step(state, sign * 0.5f, 0, sign * 0.25f);
            EXPECT_EQ(state.integral_rad_s, sign * std::min(1.0f, 0.0625f * static_cast<float>(k)));
        }
    }
}

TEST(SpeedControl, saturated_it_lets_the_integral_shrink_and_never_grow) {
    for (const float sign : {1.0f, -1.0f}) {
        speed_control_state_t state = {sign * 0.5f};
        step(state, sign * 0.5f, 0, sign * 0.25f, true);
        EXPECT_EQ(state.integral_rad_s, sign * 0.5f); // it would grow
        step(state, sign * 0.5f, 0, sign * 0.75f, true);
        EXPECT_EQ(state.integral_rad_s, sign * 0.4375f); // it shrinks
        state.integral_rad_s = 0;
        step(state, sign * 0.5f, 0, sign * 0.25f, true);
        EXPECT_EQ(state.integral_rad_s, sign * 0.0625f); // from zero nothing is wound up yet
        state.integral_rad_s = sign * 0.5f;
        step(state, sign * 0.5f, 0, sign * 0.25f, false);
        EXPECT_EQ(state.integral_rad_s, sign * 0.5625f);
    }
}

TEST(SpeedControl, limits_references_and_wheel_speeds_on_both_sides) {
    for (const float sign : {1.0f, -1.0f}) {
        speed_control_state_t state = {};
        speed_control_output_t out = step(state, sign * 9, 0, sign * 1); // v* is 1: no error
        EXPECT_EQ(out.left_rad_s, sign * 16);
        EXPECT_EQ(out.right_rad_s, sign * 16);
        out = step(state, 0, sign * 9, 0); // yaw is 1.5
        EXPECT_EQ(out.left_rad_s, sign * -3);
        EXPECT_EQ(out.right_rad_s, sign * 3);
        out = step(state, sign * 1, 0, sign * -3); // 16 + 32 and more
        EXPECT_EQ(out.left_rad_s, sign * 24);
        EXPECT_EQ(out.right_rad_s, sign * 24);
    }
}

TEST(SpeedControl, takes_what_is_no_number_as_its_header_says) {
    speed_control_state_t state = {0.5f};
    speed_control_output_t out = step(state, 0.5f, 0, nan); // v = v*
    EXPECT_EQ(out.left_rad_s, 8.5f);
    EXPECT_EQ(state.integral_rad_s, 0.5f);
    out = step(state, nan, nan, 0);
    EXPECT_EQ(out.left_rad_s, 0.5f);
    EXPECT_EQ(out.right_rad_s, 0.5f);
    state.integral_rad_s = nan;
    out = step(state, 0, 0, 0);
    EXPECT_EQ(out.left_rad_s, 0);
    out = step(state, 0.5f, 0, infinity);
    EXPECT_TRUE(std::isfinite(out.left_rad_s) && std::isfinite(state.integral_rad_s));
}

TEST(SoilSweep, is_blocked_at_first_and_rises_by_15_until_its_time_is_over) {
    constexpr soil_sweep_config_t sweep = {.ramp_1_m = 0.125f, .duration_ticks = 10, .wheel_max_rad_s = 0.25f};
    for (const float sign : {1.0f, -1.0f}) {
        soil_sweep_state_t state = {};
        for (std::uint32_t k = 0; k < 10; ++k) {
            const soil_sweep_output_t out = soil_sweep_step(&sweep, &state, sign * 0.25f);
            EXPECT_EQ(out.front_rad_s, sign * std::min(0.25f, 0.03125f * static_cast<float>(k)));
            EXPECT_FALSE(out.done);
            EXPECT_EQ(state.elapsed_ticks, k + 1);
        }
        for (int k = 0; k < 3; ++k) {
            const soil_sweep_output_t out = soil_sweep_step(&sweep, &state, sign * 0.0625f);
            EXPECT_EQ(out.front_rad_s, sign * 0.078125f); // its last value, of the speed that is wanted now
            EXPECT_TRUE(out.done);
            EXPECT_EQ(state.elapsed_ticks, 10U);
        }
    }
}

TEST(SoilSweep, stands_where_the_speed_is_no_number) {
    constexpr soil_sweep_config_t sweep = {.ramp_1_m = 0.125f, .duration_ticks = 10, .wheel_max_rad_s = 0.25f};
    soil_sweep_state_t state = {5};
    EXPECT_EQ(soil_sweep_step(&sweep, &state, nan).front_rad_s, 0);
    EXPECT_EQ(state.elapsed_ticks, 6U);
    state.elapsed_ticks = 5;
    EXPECT_LE(std::fabs(soil_sweep_step(&sweep, &state, infinity).front_rad_s), 0.25f);
}

} // namespace
