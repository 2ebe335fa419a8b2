// follow_motion_test.cpp - a wheel that is counted is smoothed widely where it runs evenly, and narrowly where it starts.
#include "host_tools/lab/inputs/follow_motion.h"
#include "host_tools/lab/inputs/smooth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

using namespace traction::lab;

namespace {

constexpr double tick_s = 0.01, narrow_s = 0.055, wide_s = 0.55, start_s = 10;
constexpr double count_rad = 2 * std::numbers::pi / 6000;
constexpr std::size_t samples = 2000;

// At 1.037 rad/s for ten seconds, then, within 0.2 s, at 2.041.
double speed_at(double t) { return 1.037 + 1.004 * std::clamp((t - start_s) / 0.2, 0.0, 1.0); }

struct Counted {
    std::vector<double> t_s, angle_rad;
    WheelInput input;
    std::vector<double> asked;
    MotionAtWidth cubics;
    // swing_rad_s: of the speed, eight times a turn.
    explicit Counted(double widest_s, double scatter_rad = count_rad / std::sqrt(12.0), double swing_rad_s = 0) {
        double angle = 0;
        for (std::size_t i = 0; i < samples; ++i) {
            t_s.push_back(static_cast<double>(i) * tick_s);
            angle_rad.push_back(std::floor(angle / count_rad) * count_rad);
            angle += (0.5 * (speed_at(t_s.back()) + speed_at(t_s.back() + tick_s)) + swing_rad_s * std::sin(8 * angle)) * tick_s;
        }
        input.scatter_rad = scatter_rad, input.sample_s = tick_s, input.half_s = widest_s;
        cubics = follow_motion(input, narrow_s, tick_s, [&](double width) {
            asked.push_back(width);
            return at(width);
        });
    }
    MotionAtWidth at(double width) const {
        MotionAtWidth m;
        Smooth parabolas = smooth_at(t_s, angle_rad, 0, tick_s, samples, width, 2);
        m.parabolas.angle_rad = std::move(parabolas.value), m.parabolas.speed_rad_s = std::move(parabolas.slope);
        m.cubics.speed_rad_s = smooth_at(t_s, angle_rad, 0, tick_s, samples, width, 3).slope;
        m.parabolas.accel_rad_s2 = m.cubics.accel_rad_s2 = std::vector<double>(samples, width);
        return m;
    }
};

// Root mean square error of a speed from `from` to `to`.
double error_of(const std::vector<double> &speed, double from, double to) {
    double sum = 0, n = 0;
    for (std::size_t k = 0; k < speed.size(); ++k)
        if (const double t = static_cast<double>(k) * tick_s; t >= from && t < to) sum += std::pow(speed[k] - speed_at(t), 2), ++n;
    return std::sqrt(sum / n);
}

// Two wheels of a side, one of which seems to run evenly: bent by other widths they would slip against each other.
TEST(FollowMotion, wheels_of_a_side_take_the_narrowest_of_theirs) {
    Counted calm(0.4), lively(0.4);
    const auto motion = [](Counted &wheel) {
        return motion_at_widths(wheel.input, narrow_s, tick_s, [&](double width) { return wheel.at(width); });
    };
    MotionAtWidths of_calm = motion(calm), of_lively = motion(lively);
    const std::vector<double> own = lively.input.width_s;
    ASSERT_FALSE(own.empty());
    calm.input.width_s.assign(samples, 0.4);
    agree_on_widths({&calm.input, &lively.input});
    EXPECT_EQ(calm.input.width_s, own);
    EXPECT_EQ(lively.input.width_s, own);
    take_widths(calm.input, std::move(of_calm)), take_widths(lively.input, std::move(of_lively));
    EXPECT_EQ(calm.input.speed_rad_s, lively.input.speed_rad_s);
    // a width that a wheel was not smoothed by: the next narrower that it was
    Counted other(0.4);
    MotionAtWidths of_other = motion(other);
    other.input.width_s.assign(samples, 1.2 * narrow_s);
    take_widths(other.input, std::move(of_other));
    EXPECT_EQ(other.input.speed_rad_s, other.at(narrow_s).parabolas.speed_rad_s);
    EXPECT_EQ(other.input.width_s, std::vector<double>(samples, narrow_s));
}

} // namespace

TEST(FollowMotion, is_wide_where_a_wheel_runs_evenly_and_narrow_where_it_starts) {
    const Counted c(wide_s);
    ASSERT_EQ(c.input.width_s.size(), samples);
    EXPECT_EQ(c.input.width_s[500], wide_s);
    EXPECT_EQ(c.input.width_s[1500], wide_s);
    EXPECT_LT(c.input.width_s[1000], wide_s / 3);
    EXPECT_LT(c.input.width_s[1020], wide_s / 3);
    const std::vector<double> narrow = c.at(narrow_s).parabolas.speed_rad_s, wide = c.at(wide_s).parabolas.speed_rad_s;
    EXPECT_LT(error_of(c.input.speed_rad_s, 2, 9), 0.2 * error_of(narrow, 2, 9));
    EXPECT_LT(error_of(c.input.speed_rad_s, 9.5, 10.7), 0.2 * error_of(wide, 9.5, 10.7));
}

// All five series are those of the width that is told.
TEST(FollowMotion, takes_everything_at_a_time_from_one_width) {
    const Counted c(wide_s);
    for (const std::size_t k : {500U, 960U, 1000U, 1020U, 1500U}) {
        const MotionAtWidth at = c.at(c.input.width_s[k]);
        EXPECT_EQ(c.input.angle_rad[k], at.parabolas.angle_rad[k]);
        EXPECT_EQ(c.input.speed_rad_s[k], at.parabolas.speed_rad_s[k]);
        EXPECT_EQ(c.input.accel_rad_s2[k], c.input.width_s[k]);
        EXPECT_EQ(c.cubics.cubics.speed_rad_s[k], at.cubics.speed_rad_s[k]);
        EXPECT_EQ(c.cubics.cubics.accel_rad_s2[k], c.input.width_s[k]);
    }
}

TEST(FollowMotion, asks_for_one_width_where_all_are_alike_or_nothing_scatters) {
    for (const Counted &c : {Counted(1.1 * narrow_s), Counted(wide_s, 0)}) {
        EXPECT_EQ(c.asked, std::vector<double>{c.input.half_s});
        EXPECT_TRUE(c.input.width_s.empty());
        EXPECT_EQ(c.input.speed_rad_s, c.at(c.input.half_s).parabolas.speed_rad_s);
    }
    EXPECT_EQ(Counted(wide_s).asked.front(), narrow_s);
    EXPECT_EQ(Counted(wide_s).asked.back(), wide_s);
}

// White scatter falls with the width to 1.5, but a count that a wheel is ahead of its samples only with the width.
TEST(FollowMotion, expects_of_the_widest_a_count_over_its_width) {
    WheelInput in;
    in.scatter_rad = 3e-4, in.sample_s = 0.01;
    EXPECT_NEAR(speed_scatter_rad_s(in, 0.01), 3e-4 * 1.85 * 0.1 / std::pow(0.01, 1.5), 1e-9);
    EXPECT_NEAR(speed_scatter_rad_s(in, 0.5), 3e-4 / 0.5, 1e-12);
}

// Of a drive of twenty seconds, six hundredths of a radian a second; in a longer one less is seen.
TEST(FollowMotion, sees_a_wheel_swing_with_its_own_angle) {
    const double scatter = count_rad / std::sqrt(12.0);
    EXPECT_TRUE(Counted(wide_s, scatter, 0.06).input.swings);
    EXPECT_FALSE(Counted(1.1 * narrow_s, scatter, 0.06).input.swings) << "one width: nothing is hidden by it";
}

// Of white noise a line's power is its mean or so at any order; half a deviation that goes with the angle has 625 times as much of it.
TEST(FollowMotion, knows_a_line_from_scatter_up_to_sixteen_a_turn) {
    constexpr std::size_t n = 10000;
    const auto swings = [](double amplitude, int order) {
        std::mt19937 random(3);
        std::normal_distribution<double> normal;
        std::vector<double> narrow, angle, wide(n, 1.0);
        for (std::size_t k = 0; k < n; ++k) {
            angle.push_back(0.01 * static_cast<double>(k) + 1e-6 * static_cast<double>(k * k));
            narrow.push_back(1 + normal(random) + amplitude * std::cos(order * angle.back()));
        }
        return swings_as_it_turns(narrow, wide, angle, n);
    };
    EXPECT_FALSE(swings(0, 1));
    EXPECT_TRUE(swings(0.5, 1));
    EXPECT_TRUE(swings(0.5, 16));
    EXPECT_FALSE(swings(0.5, 17));
    EXPECT_TRUE(swings(0.12, 8)); // its mean power is 36 of scatter's
    EXPECT_FALSE(swings(0.06, 8));
}
