// smooth_test.cpp - the smoothing of wheel angles is as wide as their scatter demands, and no wider.
#include "host_tools/lab/inputs/smooth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace traction::lab;

namespace {

constexpr double period_s = 0.03, usual_half_s = 0.078, still_rad_s = 0.15;
constexpr unsigned seed = 7;

struct Angles {
    std::vector<double> t_s, angle_rad;
};

// A wheel at speed_rad_s that swings by swing_rad_s at 1 rad/s; each sample is as old as up to `age_s` (a slow bus behind the clock).
Angles turning(double speed_rad_s, double swing_rad_s, double age_s) {
    Angles a;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> age(0, age_s > 0 ? age_s : 1e-12);
    for (int i = 0; i < 1000; ++i) {
        const double t = i * period_s, read = t - age(random);
        a.t_s.push_back(t);
        a.angle_rad.push_back(speed_rad_s * read - swing_rad_s * std::cos(read));
    }
    return a;
}

double half_of(const Angles &a) { return half_width_for(a.t_s, a.angle_rad, period_s, usual_half_s, still_rad_s, 0.01); }

} // namespace

TEST(smooth, samples_of_unequal_age_widen_the_smoothing_until_the_speed_scatters_by_one_percent) {
    const double speed = 2.5;
    const Angles a = turning(speed, 0, 0.02);
    const double half = half_of(a);
    EXPECT_GT(half, 3 * usual_half_s);
    const auto scatter = [&](double half_width_s) {
        const Smooth s = smooth_at(a.t_s, a.angle_rad, 1, 0.02, 1400, half_width_s, 2);
        double sum = 0;
        for (const double slope : s.slope) sum += (slope - speed) * (slope - speed);
        return std::sqrt(sum / 1400) / speed;
    };
    EXPECT_GT(scatter(usual_half_s), 0.04); // what the usual width leaves
    // 28 s of speeds that are alike over 2 * half = 0.7 s: 40 of their own, so 11 % of the scatter (one sigma), and its estimate another 4
    // %
    EXPECT_NEAR(scatter(half), 0.01, 0.0035);
}

TEST(smooth, a_clean_encoder_keeps_the_usual_width_however_the_wheel_accelerates) {
    EXPECT_EQ(half_of(turning(2.5, 0, 0)), usual_half_s);
    EXPECT_EQ(half_of(turning(2.5, 2, 0)), usual_half_s); // up to 2 rad/s^2
}

TEST(smooth, a_counter_that_is_reset_is_no_scatter) {
    Angles a = turning(2.5, 0, 0);
    for (std::size_t i = 500; i < a.angle_rad.size(); ++i) a.angle_rad[i] -= 37;
    EXPECT_EQ(half_of(a), usual_half_s);
}

TEST(smooth, the_width_is_limited_and_a_standing_wheel_says_nothing) {
    EXPECT_EQ(half_of(turning(2.5, 0, 1.0)), widest_half_s);
    EXPECT_EQ(half_of(turning(0.01, 0, 0.02)), usual_half_s);
}
