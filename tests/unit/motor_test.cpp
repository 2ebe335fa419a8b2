#include "firmware/core/motor.h"
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

motor_config_t rover_motor() { return rover_config_default().motor; }

TEST(Motor, returns_the_traction_that_made_the_current) {
    const motor_config_t config = rover_motor();
    for (double force = -5.6; force <= 5.6; force += 0.7) {
        for (double w = -20.0; w <= 20.0; w += 2.5) {
            for (double dw = -10.0; dw <= 10.0; dw += 5.0) {
                const double sign = w > 0 ? 1 : (w < 0 ? -1 : 0);
                const double gamma = 1.6e-3 * w + 0.03 * sign + 5e-3 * dw + 0.057 * force; // (17), (18) forwards, in double
                const motor_output_t out =
                    motor_measure(&config, static_cast<float>(gamma / 0.265), static_cast<float>(w), static_cast<float>(dw));
                EXPECT_NEAR(out.torque_Nm, gamma, 1e-6 * std::fabs(gamma) + 1e-7); // float rounding
                EXPECT_NEAR(out.traction_N, force, 2e-5);                          // 8 roundings of terms up to 7 N: 8 * 7 * 2^-24 * 6
            }
        }
    }
}

TEST(Motor, loss_opposes_motion_in_both_directions_and_is_continuous_through_rest) {
    const motor_config_t config = rover_motor();
    EXPECT_NEAR(motor_loss_Nm(&config, 10.0f), 0.046, 1e-7);
    EXPECT_NEAR(motor_loss_Nm(&config, -10.0f), -0.046, 1e-7);
    EXPECT_EQ(motor_loss_Nm(&config, 0.0f), 0.0f);
    EXPECT_LT(std::fabs(motor_loss_Nm(&config, 1e-3f) - motor_loss_Nm(&config, -1e-3f)), 1e-3f);
}

TEST(Motor, feed_forward_duty_balances_the_circuit) {
    const motor_config_t config = rover_motor();
    for (double w = -20.0; w <= 20.0; w += 1.0) {
        const double sign = w > 0 ? 1 : (w < 0 ? -1 : 0);
        const double volts = 3.24 * (1.6e-3 * w + 0.03 * sign) / 0.265 + 0.265 * w; // steady state of the circuit
        EXPECT_NEAR(motor_duty_for_speed(&config, static_cast<float>(w), motor_per_supply(7.2f)), volts / 7.2, 1e-6);
    }
    EXPECT_EQ(motor_duty_for_speed(&config, 10.0f, motor_per_supply(0.0f)), 0.0f);
}

TEST(Motor, limited_duty_keeps_the_current_within_its_limit) {
    const motor_config_t config = rover_motor();
    for (float duty = -1.0f; duty <= 1.0f; duty += 0.1f) {
        for (float w = -20.0f; w <= 20.0f; w += 2.0f) {
            const double limited = static_cast<double>(motor_duty_limited(&config, duty, w, motor_per_supply(7.2f), 1.5f));
            const double current = (limited * 7.2 - 0.265 * static_cast<double>(w)) / 3.24;
            EXPECT_LE(std::fabs(current), 1.5 + 1e-5); // float rounding of volts / ohm
        }
    }
    EXPECT_EQ(motor_duty_limited(&config, 0.1f, 0.0f, motor_per_supply(7.2f), 1.5f), 0.1f);
}

TEST(Motor, every_extreme_gives_a_bounded_duty) {
    const motor_config_t config = rover_motor();
    const float inf = std::numeric_limits<float>::infinity();
    for (const float a : {0.0f, 1e-45f, 3e38f, -3e38f, inf, -inf, std::nanf("")}) {
        for (const float b : {0.0f, 7.2f, inf, -inf, std::nanf("")}) {
            EXPECT_LE(std::fabs(motor_duty_for_speed(&config, a, motor_per_supply(b))), 1.0f);
            EXPECT_LE(std::fabs(motor_duty_limited(&config, a, a, b, 1.5f)), 1.0f);
        }
    }
}

TEST(Motor, a_supply_below_a_volt_is_a_broken_wire) {
    EXPECT_NEAR(motor_per_supply(7.2f), 1 / 7.2, 1e-7);
    for (const float bad : {0.0f, 0.5f, -7.2f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
        EXPECT_EQ(motor_per_supply(bad), 0.0f) << bad;
    }
}

} // namespace
