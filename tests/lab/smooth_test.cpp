// smooth_test.cpp - the smoothing of wheel angles is as wide as their scatter demands, and no wider.
#include "host_tools/lab/inputs/smooth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
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

// What shares the sums of a window is what each is by itself, to the bit: dense, where samples lack, and beyond both ends.
TEST(smooth, parabola_and_cubic_of_one_window_and_slopes_of_many_widths_are_those_asked_for_one_by_one) {
    Angles a = turning(2.5, 1.5, 0.02);
    a.t_s.erase(a.t_s.begin() + 300, a.t_s.begin() + 340), a.angle_rad.erase(a.angle_rad.begin() + 300, a.angle_rad.begin() + 340);
    const double start = -0.5, step = 0.02, widths[] = {0.078, 0.2, 0.45};
    const std::size_t count = 1600;
    for (const double half : widths) {
        const ParabolaAndCubic both = smooth_twice(a.t_s, a.angle_rad, start, step, count, half);
        const Smooth two = smooth_at(a.t_s, a.angle_rad, start, step, count, half, 2),
                     three = smooth_at(a.t_s, a.angle_rad, start, step, count, half, 3);
        EXPECT_EQ(both.parabola.value, two.value) << half;
        EXPECT_EQ(both.parabola.slope, two.slope) << half;
        EXPECT_EQ(both.parabola.distance_s, two.distance_s) << half;
        EXPECT_EQ(both.cubic.value, three.value) << half;
        EXPECT_EQ(both.cubic.slope, three.slope) << half;
    }
    std::vector<double> half(count), wanted(count);
    std::vector<std::vector<double>> by_width;
    for (const double width : widths) by_width.push_back(smooth_at(a.t_s, a.angle_rad, start, step, count, width, 2).slope);
    for (std::size_t k = 0; k < count; ++k) half[k] = widths[k / 7 % 3], wanted[k] = by_width[k / 7 % 3][k];
    EXPECT_EQ(slopes_at(a.t_s, a.angle_rad, start, step, half), wanted);
}

// A cubic is followed as such: in closed form, at any width.
TEST(smooth, a_cubic_gives_back_its_own_slope_and_a_parabola_its_own) {
    std::vector<double> t, cube, square;
    for (int i = 0; i < 400; ++i) {
        t.push_back(0.01 * i + 0.002 * std::sin(i)); // unevenly
        cube.push_back(1000 + std::pow(t.back() - 1, 3)), square.push_back(1000 - 2 * t.back() * t.back());
    }
    const Smooth of_cube = smooth_at(t, cube, 0.5, 0.05, 50, 0.2, 3), of_square = smooth_at(t, square, 0.5, 0.05, 50, 0.2, 2);
    for (std::size_t k = 0; k < 50; ++k) {
        const double at = 0.5 + 0.05 * static_cast<double>(k);
        EXPECT_NEAR(of_cube.slope[k], 3 * std::pow(at - 1, 2), 1e-7) << at;
        EXPECT_NEAR(of_square.slope[k], -4 * at, 1e-7) << at;
        EXPECT_NEAR(of_square.value[k], 1000 - 2 * at * at, 1e-8) << at;
    }
}
