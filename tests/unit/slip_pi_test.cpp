#include "firmware/core/rover_config.h"
#include "firmware/core/slip_pi.h"

#include <gtest/gtest.h>
#include <tuple>

#include <cmath>
#include <limits>

namespace {

// A wheel at constant ground speed v on soil (20) or concrete (21); the estimator sees the true slip. All in double.
struct SlippingWheel {
    double fm_N, sc;
    bool concrete;
    double v = 0.2;
    double w = 0.2 / 0.057;
    double slip() const { return 0.057 * w >= v ? 1 - v / (0.057 * w) : 0.057 * w / v - 1; }
    double traction() const {
        const double s = std::fabs(slip()) + 1e-12;
        const double f = concrete ? 1 - std::exp(-s / sc) : 1 - sc / s * (1 - std::exp(-s / sc));
        return slip() < 0 ? -fm_N * f : fm_N * f;
    }
    void tick(float asked) {
        const double duty = static_cast<double>(asked);
        for (int i = 0; i < 20; ++i) {
            const double current = (duty * 7.2 - 0.265 * w) / 3.24;
            w += 5e-4 * (0.265 * current - 1.6e-3 * w - 0.03 - 0.057 * traction()) / 5e-3;
        }
    }
};

class OnSoil : public ::testing::TestWithParam<std::tuple<SlippingWheel, double>> {};

TEST_P(OnSoil, settles_at_the_set_point_within_one_and_a_half_seconds) {
    auto [wheel, speed] = GetParam();
    wheel.v = speed;
    wheel.w = speed / 0.057;
    const slip_pi_config_t config = rover_config_default().slip_pi;
    slip_pi_state_t state = {};
    const slip_pi_input_t start = {.slip_ref = 0.4f, .slip = 0, .speed_m_s = static_cast<float>(wheel.v)};
    slip_pi_preset(&config, &state, 0.2f, &start);
    int last_outside = 0;
    double mean = 0;
    for (int k = 0; k < 400; ++k) {
        const slip_pi_input_t input = {
            .slip_ref = 0.4f, .slip = static_cast<float>(wheel.slip()), .speed_m_s = static_cast<float>(wheel.v)};
        wheel.tick(slip_pi_step(&config, &state, &input).duty);
        last_outside = std::fabs(wheel.slip() - 0.4) > 0.04 ? k : last_outside;
        mean += k >= 200 ? wheel.slip() / 200 : 0;
    }
    EXPECT_LT(last_outside, 150); // 1.5 s, to a tenth of the step
    EXPECT_NEAR(mean, 0.4, 0.01); // integral action; half of the goal of 0.02 is left to the estimator
}

INSTANTIATE_TEST_SUITE_P(SlipPi, OnSoil,
                         ::testing::Combine(::testing::Values(SlippingWheel{5.6, 0.05, true}, SlippingWheel{6.8, 0.088, false},
                                                              SlippingWheel{5.1, 0.27, false}),
                                            ::testing::Values(0.1, 0.2, 0.3)));

TEST(SlipPi, is_the_papers_law_without_a_schedule) {
    const slip_pi_config_t config = {.kp = 0.5f, .ki_T = 0.01f, .duty_max = 1, .per_speed_s_m = 0, .gain_min = 1, .gain_max = 1};
    slip_pi_state_t state = {};
    double integral = 0;
    for (int k = 0; k < 50; ++k) {
        const double error = 0.4 - 0.002 * k;
        integral += 0.01 * error; // (23), in double
        const slip_pi_input_t input = {.slip_ref = 0.4f, .slip = 0.002f * static_cast<float>(k), .speed_m_s = 0.7f};
        EXPECT_NEAR(slip_pi_step(&config, &state, &input).duty, 0.5 * error + integral, 1e-5); // 50 float roundings below 1
    }
}

TEST(SlipPi, starts_without_a_jump_from_any_duty) {
    const slip_pi_config_t config = rover_config_default().slip_pi;
    for (float duty = -1.0f; duty <= 1.0f; duty += 0.25f) {
        slip_pi_state_t state = {};
        const slip_pi_input_t input = {.slip_ref = 0.4f, .slip = 0.35f, .speed_m_s = 0.2f};
        slip_pi_preset(&config, &state, duty, &input);
        EXPECT_NEAR(slip_pi_step(&config, &state, &input).duty, duty, 0.11f); // Ki T e, and Kp e where the integral is at its bound
    }
}

TEST(SlipPi, never_exceeds_the_limit_for_any_input) {
    const slip_pi_config_t config = rover_config_default().slip_pi;
    const float inf = std::numeric_limits<float>::infinity();
    const float extremes[] = {0.0f, 1e-45f, -3e38f, 3e38f, inf, -inf, std::nanf(""), 0.4f};
    for (const float a : extremes) {
        for (const float b : extremes) {
            for (const float c : extremes) {
                slip_pi_state_t state = {a};
                const slip_pi_input_t input = {.slip_ref = b, .slip = c, .speed_m_s = a};
                EXPECT_LE(std::fabs(slip_pi_step(&config, &state, &input).duty), 1.0f);
            }
        }
    }
}

TEST(SlipPi, integral_stands_still_beyond_the_limit_and_comes_back_at_once) {
    const slip_pi_config_t config = {.kp = 2, .ki_T = 0.01f, .duty_max = 1, .per_speed_s_m = 0, .gain_min = 1, .gain_max = 1};
    for (const float sign : {1.0f, -1.0f}) {
        slip_pi_state_t state = {.integral = 0.5f * sign};
        const slip_pi_input_t beyond = {.slip_ref = 0.4f * sign, .slip = 0, .speed_m_s = 0.3f}; // 0.8 + 0.5: beyond 1 with small steps
        for (int k = 0; k < 100; ++k) {
            const slip_pi_output_t out = slip_pi_step(&config, &state, &beyond);
            EXPECT_EQ(out.duty, sign);
            EXPECT_TRUE(out.saturated);
        }
        EXPECT_EQ(state.integral, 0.5f * sign); // (2)
        // The integral alone is beyond the limit, the error is small and of the other sign: it is integrated although u stays limited.
        state.integral = 1.0f * sign;
        const slip_pi_config_t weak = {.kp = -0.5f, .ki_T = 0.05f, .duty_max = 1, .per_speed_s_m = 0, .gain_min = 1, .gain_max = 1};
        const slip_pi_input_t back = {.slip_ref = -0.2f * sign, .slip = 0, .speed_m_s = 0.3f};
        slip_pi_step(&weak, &state, &back);
        EXPECT_NEAR(state.integral, 0.99f * sign, 1e-6f);
    }
}

TEST(SlipPi, integrates_both_ways_within_the_limit) {
    const slip_pi_config_t config = {.kp = 0.5f, .ki_T = 0.01f, .duty_max = 1, .per_speed_s_m = 0, .gain_min = 1, .gain_max = 1};
    for (const float error : {-0.3f, 0.3f}) {
        slip_pi_state_t state = {};
        const slip_pi_input_t input = {.slip_ref = error, .slip = 0, .speed_m_s = 0.3f};
        for (int k = 0; k < 10; ++k) {
            slip_pi_step(&config, &state, &input);
        }
        EXPECT_NEAR(state.integral, 0.1f * error, 1e-7f); // ten steps of Ki T e
    }
}

TEST(SlipPi, a_slip_that_is_no_number_gives_no_duty_and_leaves_the_state_alone) {
    const slip_pi_config_t config = rover_config_default().slip_pi;
    slip_pi_state_t state = {.integral = 0.3f};
    const slip_pi_input_t input = {.slip_ref = 0.4f, .slip = std::nanf(""), .speed_m_s = 0.3f};
    EXPECT_EQ(slip_pi_step(&config, &state, &input).duty, 0.0f);
    EXPECT_EQ(state.integral, 0.3f);
}

} // namespace
