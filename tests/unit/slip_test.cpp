#include "firmware/core/slip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace {

constexpr slip_config_t config = {.wheel_radius_m = 0.057f, .valid_m_s = 0.05f, .valid_std = 0.25f, .rim_std_m_s = 0.0025f};

float slip(float w, float v) { return slip_measure(&config, w, v).slip; }

TEST(Slip, follows_equation_1_for_forward_travel) {
    for (float v = 0.05f; v <= 1.0f; v += 0.05f) {
        for (float w = 1.0f; w <= 25.0f; w += 0.5f) {
            const double rim = 0.057 * static_cast<double>(w);
            const double ground = static_cast<double>(v);
            const double expected = rim >= ground ? 1 - ground / rim : rim / ground - 1; // (1), in double
            EXPECT_NEAR(slip(w, v), expected, 4e-7); // three float roundings of a number below 1: 3 * 2^-24, doubled
        }
    }
}

TEST(Slip, is_odd_under_reversal_of_both) {
    for (float v = -1.0f; v <= 1.0f; v += 0.07f) {
        for (float w = -20.0f; w <= 20.0f; w += 0.7f) {
            EXPECT_EQ(slip(-w, -v), -slip(w, v));
        }
    }
}

TEST(Slip, is_full_where_wheel_and_ground_oppose) {
    EXPECT_EQ(slip(3.0f, -0.2f), 1.0f);
    EXPECT_EQ(slip(-3.0f, 0.2f), -1.0f);
}

TEST(Slip, is_one_for_a_wheel_that_spins_in_place_and_minus_one_for_a_blocked_wheel) {
    EXPECT_EQ(slip(3.0f, 0.0f), 1.0f);
    EXPECT_EQ(slip(0.0f, 0.2f), -1.0f);
    EXPECT_EQ(slip(0.0f, 0.0f), 0.0f);
}

TEST(Slip, is_valid_only_where_one_of_the_speeds_means_something) {
    EXPECT_FALSE(slip_measure(&config, 0.1f, 0.04f).valid);
    EXPECT_TRUE(slip_measure(&config, 0.1f, 0.06f).valid);
    EXPECT_TRUE(slip_measure(&config, 1.0f, 0.0f).valid);
}

TEST(Slip, is_continuous_away_from_rest) {
    // |ds| <= (R |dw| + |dv|) * 2 / max(|R w|, |v|): derived from (1)'s partial derivatives
    for (float v = -1.0f; v <= 1.0f; v += 0.013f) {
        for (float w = -20.0f; w <= 20.0f; w += 0.13f) {
            const float scale = std::fmax(std::fabs(0.057f * w), std::fabs(v));
            if (scale < 0.05f) {
                continue;
            }
            const float step = 1e-4f;
            EXPECT_LE(std::fabs(slip(w, v + step) - slip(w, v)), 2.0f * step / scale + 1e-6f);
        }
    }
}

TEST(Slip, is_bounded_and_defined_for_every_extreme) {
    const float inf = std::numeric_limits<float>::infinity();
    const float extremes[] = {0.0f, -0.0f, 1e-45f, -1e-45f, 1e-38f, 3e38f, -3e38f, inf, -inf, std::nanf(""), 1.0f, -1.0f};
    for (const float w : extremes) {
        for (const float v : extremes) {
            const slip_output_t out = slip_measure(&config, w, v);
            EXPECT_GE(out.slip, -1.0f);
            EXPECT_LE(out.slip, 1.0f);
            if (!std::isfinite(w) || !std::isfinite(v)) {
                EXPECT_FALSE(out.valid);
            }
        }
    }
}

TEST(Slip, is_full_where_the_difference_is_beyond_any_float) {
    EXPECT_EQ(slip(3.4e38f, -3.4e38f), 1.0f);
    EXPECT_EQ(slip(-3.4e38f, 3.4e38f), -1.0f);
}

// (2) against the scatter of slips of noisy speeds. 20000 draws: a standard deviation to 0.5 %; 5 %: what (1) bends within two deviations.
TEST(Slip, its_standard_deviation_is_the_scatter_of_noisy_speeds) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    const double ground_std = 0.01;
    for (const double rim : {0.1, 0.2, 0.3, 0.6, -0.3}) {
        for (const double ground : {0.12, 0.3, 0.5, -0.28}) {
            if (rim * ground < 0 || std::fabs(std::fabs(rim) - std::fabs(ground)) < 0.03) {
                continue; // opposed: s is +-1; at a kink of (1) one side differs from the other
            }
            double sum = 0, square = 0;
            for (int n = 0; n < 20000; ++n) {
                const double w = (rim + 0.0025 * normal(random)) / 0.057, v = ground + ground_std * normal(random);
                const double s = static_cast<double>(slip(static_cast<float>(w), static_cast<float>(v)));
                sum += s;
                square += s * s;
            }
            const double scatter = std::sqrt(square / 20000 - sum * sum / 4e8);
            const float claimed = slip_std(&config, static_cast<float>(rim / 0.057), static_cast<float>(ground), 0.01f);
            EXPECT_NEAR(static_cast<double>(claimed) / scatter, 1, 0.05) << rim << " " << ground;
        }
    }
}

TEST(Slip, its_standard_deviation_is_total_and_at_most_1) {
    const float extremes[] = {
        0.0f, -0.0f, 1e-30f, 1.0f, -3e38f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()};
    for (const float w : extremes) {
        for (const float v : extremes) {
            for (const float std : extremes) {
                const float out = slip_std(&config, w, v, std);
                EXPECT_GE(out, 0.0f) << w << " " << v << " " << std;
                EXPECT_LE(out, 1.0f) << w << " " << v << " " << std;
            }
        }
    }
    EXPECT_EQ(slip_std(&config, 0.0f, 0.0f, 0.1f), 1.0f);
}

} // namespace
