// A law by which slip lags (lag.h): what it gains where speeds change counts, what it gains where they do not is averaging.
#include "host_tools/lab/decision/lag.h"
#include "tests/lab/four_wheels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace traction::lab {
namespace {

using namespace hand_made;

// At 5 rad/s for half a minute, then up and down between 3 and 9 in steps of 3 s.
FourWheels stepping() {
    FourWheels rover;
    for (WheelInput &w : rover.data.wheel)
        for (std::size_t k = 0; k < w.speed_rad_s.size(); ++k) {
            const double t = rover.data.time(k);
            w.speed_rad_s[k] = t < 30 ? 5 : std::fmod(t, 6) < 3 ? 3 : 9;
        }
    return rover;
}

struct Lagging {
    FourWheels rover = stepping();
    Physics plain = make_physics(rover.model), lags = plain;
    HeldOut left_before, left_with;
    explicit Lagging(double length_m = 0.3) { lags.body.relaxation_m += length_m; }
    Problem problem(const Physics &at) const {
        Problem p(rover.data, at, {});
        p.fit({});
        p.row_scale.setOnes();
        return p;
    }
    // A fall of so much of each row of the torque balances there and elsewhere, of the other rows of `other`.
    bool averages(double at_changes, double elsewhere, double other = 0) {
        const Problem before = problem(plain), with = problem(lags);
        const std::vector<char> changing = changing_steps(rover.data, 12); // 0.3 m at 5 rad/s, the median, of 0.05 m: 1.2 s
        left_before.residual = Eigen::VectorXd::Ones(before.residual.size());
        left_with = left_before;
        Eigen::Index row = 0;
        for (const Balance &b : rover.data.balance)
            for (const double t : b.t0_s) {
                const auto k = static_cast<std::size_t>((t - rover.data.start_s) / rover.data.step_s);
                const double fall = b.kind != BalanceKind::current_torque ? other : changing[k] != 0 ? at_changes : elsewhere;
                left_with.residual[row++] = std::sqrt(1 - fall);
            }
        return only_averages(before, left_before, with, left_with);
    }
};

// 0.3 m at 0.25 m/s take 1.2 s: within three tenths of a blur of 4.1 s no lag is seen, whatever it gains where.
TEST(Lag, within_the_blur_of_the_wheels_speeds_is_averaging) {
    Lagging sharp, blurred;
    for (WheelInput &w : sharp.rover.data.wheel) w.half_s = 3.9;
    for (WheelInput &w : blurred.rover.data.wheel) w.half_s = 4.1;
    EXPECT_FALSE(sharp.averages(0.5, 0.1));
    EXPECT_TRUE(blurred.averages(0.5, 0.1));
    for (WheelPhysics &w : blurred.lags.wheel) w.relaxation = 0.3; // the sheet's own length, which a fit beside another name moves
    blurred.lags.body.relaxation_m = 0;
    EXPECT_FALSE(blurred.averages(0.5, 0.1));
}

TEST(Lag, changes_are_where_a_speed_has_gone_a_tenth_of_the_largest_within_its_time) {
    const FourWheels rover = stepping();
    const std::vector<char> changing = changing_steps(rover.data, 4);
    const auto is = [&](double t) { return changing[static_cast<std::size_t>(std::lround(t / rover.data.step_s))] != 0; };
    for (double jump = 33; jump < 60; jump += 3) {
        EXPECT_FALSE(is(jump - 0.3)) << jump;
        EXPECT_TRUE(is(jump + 0.15) && is(jump + 0.25)) << jump;
        EXPECT_FALSE(is(jump + 0.55)) << jump;
    }
    EXPECT_FALSE(is(10) || is(29));
    const std::vector<char> longer = changing_steps(rover.data, 10);
    EXPECT_TRUE(longer[338] != 0 && longer[343] == 0);
}

TEST(Lag, must_gain_twice_as_much_where_speeds_change) {
    Lagging l;
    EXPECT_FALSE(l.averages(0.3, 0.14));
    EXPECT_TRUE(l.averages(0.3, 0.16));
    EXPECT_TRUE(l.averages(0.1, 0.3));
    EXPECT_TRUE(l.averages(0.3, 0.16, 0.9)); // the radar's and the voltages' rows say nothing of it
    EXPECT_TRUE(l.averages(-0.1, -0.02));
    EXPECT_FALSE(l.averages(0.1, -0.2));
}

TEST(Lag, is_not_asked_of_a_law_that_makes_none_longer) {
    Lagging l;
    l.plain = l.lags;
    EXPECT_FALSE(l.averages(0.1, 0.3));
}

TEST(Lag, is_not_asked_where_nothing_changes) {
    Lagging l;
    for (WheelInput &w : l.rover.data.wheel) w.speed_rad_s.assign(w.speed_rad_s.size(), 5);
    EXPECT_FALSE(l.averages(0.1, 0.3));
}

} // namespace
} // namespace traction::lab
