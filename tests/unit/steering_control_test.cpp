// steering.h against its geometry, and the whole tick of a rover that steers.
#include "firmware/core/rover_config.h"
#include "firmware/core/steering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace {

constexpr steering_config_t front = {0.32f, 0.0f, 1.76f};

TEST(Steering, the_curvature_is_yaw_rate_over_speed_within_what_the_wheels_can) {
    EXPECT_FLOAT_EQ(steering_curvature(&front, 0.3f, 0.3f), 1.0f);
    EXPECT_FLOAT_EQ(steering_curvature(&front, -0.3f, 0.3f), -1.0f); // backwards the same turn is steered the other way
    EXPECT_FLOAT_EQ(steering_curvature(&front, 0.3f, 3.0f), 1.76f);
    EXPECT_FLOAT_EQ(steering_curvature(&front, -0.3f, 3.0f), -1.76f);
    EXPECT_FLOAT_EQ(steering_curvature(&front, 0.0f, -0.1f), -1.76f);
    EXPECT_EQ(steering_curvature(&front, 0.0f, 0.0f), 0.0f);
    const float no = std::numeric_limits<float>::quiet_NaN(), huge = std::numeric_limits<float>::infinity();
    for (const float v : {no, huge, -huge, 0.3f, 1e-30f})
        for (const float yaw : {no, huge, -huge, 0.3f, -1e30f}) EXPECT_LE(std::fabs(steering_curvature(&front, v, yaw)), 1.76f);
}

TEST(Steering, a_wheel_rolls_as_its_place_moves) {
    for (const float v : {0.3f, -0.2f, 0.0f})
        for (const float yaw : {0.4f, -0.5f})
            for (int32_t i = 0; i < 4; ++i) {
                const float rim = steering_rim(&front, i, v, yaw);
                const double want = std::hypot(static_cast<double>(v), i >= 2 ? 0.32 * static_cast<double>(yaw) : 0.0);
                EXPECT_NEAR(static_cast<double>(std::fabs(rim)), want, 1e-6);
                EXPECT_GE(rim * v, 0.0f);
                if (v != 0.0f) {
                    EXPECT_NEAR(steering_forward(&front, i, rim, yaw), v, 1e-5f);
                }
            }
    EXPECT_EQ(steering_forward(&front, 2, 0.05f, 0.4f), 0.0f); // slower than the turn alone: nothing is left for the body
    const steering_config_t none = {0.0f, 0.0f, 0.0f};
    EXPECT_EQ(steering_rim(&none, 2, 0.123f, 0.4f), 0.123f);
    const float no = std::numeric_limits<float>::quiet_NaN();
    for (const float value : {no, 1e38f, -1e38f})
        for (const float other : {no, 1e38f, 0.1f}) {
            EXPECT_TRUE(std::isfinite(steering_rim(&front, 2, value, other)) || !(std::fabs(other) > 0.0f));
            EXPECT_TRUE(std::isfinite(steering_forward(&front, 3, value, other)) || !(std::fabs(other) > 0.0f));
        }
}

control_config_t steered() {
    rover_parameters_t parameters;
    rover_parameters_reference(&parameters);
    parameters.value[ROVER_half_wheelbase_m] = 0.16f, parameters.value[ROVER_half_track_m] = 0.11f;
    parameters.value[ROVER_steer_front_m] = 0.32f, parameters.value[ROVER_steer_limit_1_m] = 1.76f;
    control_config_t config;
    control_config_build(&parameters, &config);
    EXPECT_EQ(control_config_check(&parameters, &config).key, nullptr);
    return config;
}

trace_t drive(const control_config_t &config, float speed_m_s, float yaw_rate_rad_s, control_mode_t mode, int ticks = 60) {
    control_state_t state;
    control_reset(&config, &state);
    command_t command{};
    command.mode = mode;
    command.platform_speed_m_s = speed_m_s, command.yaw_rate_rad_s = yaw_rate_rad_s;
    trace_t trace{};
    for (int k = 0; k < ticks; ++k) {
        sensor_frame_t frame{};
        frame.tick = static_cast<uint32_t>(k), frame.elapsed_ticks = 1, frame.present = FRAME_ALL & ~uint32_t{FRAME_TIME};
        for (uint16_t &current : frame.current_count) current = 2048;
        frame.battery_count = 1800;
        frame.radar_samples = 5, frame.radar_sequence = static_cast<uint32_t>(5 * k);
        for (uint16_t &count : frame.radar_count) count = 512;
        trace = control_step(&config, &state, &command, &frame);
    }
    return trace;
}

TEST(Steering, the_order_is_the_curvature_and_every_wheel_is_asked_for_its_own_speed) {
    const control_config_t config = steered();
    const trace_t bend = drive(config, 0.3f, 0.3f, MODE_PLATFORM_SPEED);
    EXPECT_FLOAT_EQ(bend.actuator.curvature_1_m, 1.0f);
    // the speed loop adds the same to both sides of the fixed axle; b psi/R apart they are
    const double left = static_cast<double>(bend.wheel[0].set_speed_rad_s), right = static_cast<double>(bend.wheel[1].set_speed_rad_s),
                 R = 0.057;
    EXPECT_NEAR(right - left, 2 * 0.11 * 0.3 / R, 1e-4);
    EXPECT_NEAR(static_cast<double>(bend.wheel[2].set_speed_rad_s), std::hypot(left, 0.32 * 0.3 / R), 1e-4);
    EXPECT_NEAR(static_cast<double>(bend.wheel[3].set_speed_rad_s), std::hypot(right, 0.32 * 0.3 / R), 1e-4);
    // more than the wheels can be turned: the sides go with the bend that there is
    const trace_t tight = drive(config, 0.3f, 2.0f, MODE_PLATFORM_SPEED);
    EXPECT_FLOAT_EQ(tight.actuator.curvature_1_m, 1.76f);
    EXPECT_NEAR(static_cast<double>(tight.wheel[1].set_speed_rad_s - tight.wheel[0].set_speed_rad_s), 2 * 0.11 * 0.3 * 1.76 / R, 1e-3);
    EXPECT_EQ(drive(config, 0.3f, 0.3f, MODE_WHEEL_SPEED).actuator.curvature_1_m, 0.0f);
    EXPECT_EQ(drive(config, 0.3f, 0.3f, MODE_SOIL_SWEEP).actuator.curvature_1_m, 0.0f);
    EXPECT_EQ(drive(rover_config_default(), 0.3f, 0.3f, MODE_PLATFORM_SPEED).actuator.curvature_1_m, 0.0f);
}

TEST(Steering, half_a_steering_is_refused) {
    rover_parameters_t parameters;
    rover_parameters_reference(&parameters);
    control_config_t config;
    parameters.value[ROVER_steer_front_m] = 0.32f;
    control_config_build(&parameters, &config);
    EXPECT_STREQ(control_config_check(&parameters, &config).key, "steer_limit_1_m");
}

} // namespace
