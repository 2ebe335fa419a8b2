// A grip that falls with slip (uneven_grip.h): what it gains wheel by wheel may be the ground, what the wheels have in common is the law.
#include "host_tools/lab/decision/uneven_grip.h"
#include "tests/lab/four_wheels.h"
#include "tests/lab/linear_machine.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace traction::lab {
namespace {

using namespace hand_made;

// Each row of the torque balances is `common`, and `own` more or less at every other wheel; rows of the others are `other`.
struct Ground {
    FourWheels rover;
    Problem before;
    explicit Ground(const FourWheels &of = FourWheels()) : rover(of), before(rover.data, make_physics(rover.model), {}) {
        before.fit({});
        before.row_scale.setConstant(2);
    }
    HeldOut left(double own, double common, double other = 1) const {
        HeldOut held;
        held.residual.resize(before.residual.size());
        Eigen::Index row = 0;
        int wheel = 0;
        for (const Balance &b : rover.data.balance) {
            const bool torque = b.kind == BalanceKind::current_torque;
            for (std::size_t r = 0; r < b.t0_s.size(); ++r) held.residual[row++] = torque ? common + (wheel % 2 == 0 ? own : -own) : other;
            wheel += torque;
        }
        return held;
    }
    SharesTaken taken(const HeldOut &was, const HeldOut &is) const { return shares_taken(before, was, is); }
    bool holds(const std::string &law, const HeldOut &was, const HeldOut &is, int wheel = -1) const {
        return holds_in_common(candidate(law, wheel), before, was, is);
    }
};

TEST(UnevenGrip, takes_shares_of_the_wheels_and_of_all_together) {
    const Ground g;
    const SharesTaken own = g.taken(g.left(3, 4), g.left(0, 4)), common = g.taken(g.left(3, 4), g.left(3, 0));
    EXPECT_NEAR(own.of_wheels, 9 / 25.0, 1e-9);
    EXPECT_NEAR(own.of_all_together, 0, 1e-9);
    EXPECT_NEAR(common.of_wheels, 16 / 25.0, 1e-9);
    EXPECT_NEAR(common.of_all_together, 1, 1e-9);
    EXPECT_NEAR(g.taken(g.left(3, 4, 1), g.left(3, 5, 0)).of_all_together, 1 - 25 / 16.0, 1e-9); // no other balance has a part
}

// What swings within a second is no law of the wheels' mean slip.
TEST(UnevenGrip, takes_means_over_a_second) {
    const Ground g;
    HeldOut swings = g.left(0, 1), still = swings;
    for (Eigen::Index row = 0; row < swings.residual.size(); ++row) swings.residual[row] += row % 2 == 0 ? 5 : -5;
    EXPECT_NEAR(g.taken(swings, still).of_wheels, 0, 0.02);
    EXPECT_NEAR(g.taken(swings, still).of_all_together, 0, 0.02);
}

TEST(UnevenGrip, a_law_of_falling_grip_must_gain_in_common_half_of_what_it_gains_by_wheels) {
    const Ground g;
    const HeldOut was = g.left(3, 4);
    for (const char *law : {"shear_peak", "sliding_speed_loss"}) {
        EXPECT_FALSE(g.holds(law, was, g.left(1, 4)));     // 8 of 25, nothing
        EXPECT_FALSE(g.holds(law, was, g.left(1, 3.8)));   // 9.56 of 25, 1.56 of 16: a quarter of it
        EXPECT_TRUE(g.holds(law, was, g.left(2, 3.6)));    // 8.04 of 25, 3.04 of 16: 0.59 of it
        EXPECT_TRUE(g.holds(law, was, g.left(0, 3.5)));    // 12.75 of 25: more than half
        EXPECT_FALSE(g.holds(law, was, g.left(2.5, 3.4))); // 7.19 of 25: too little of either
        EXPECT_TRUE(g.holds(law, was, g.left(1, 4), 2));   // one wheel's own
    }
    EXPECT_TRUE(g.holds("slip_sinkage", was, g.left(1, 4)));
}

// Where currents of one wheel alone are measured, or of none, nothing is in common.
TEST(UnevenGrip, is_not_asked_of_a_log_with_fewer_than_two_wheels_currents) {
    FourWheels rover;
    std::vector<Balance> &balance = rover.data.balance;
    balance.erase(balance.begin() + 2, balance.begin() + 4);
    const Ground two(rover);
    EXPECT_EQ(two.taken(two.left(3, 4), two.left(3, 4)).wheels, 2);
    EXPECT_FALSE(two.holds("shear_peak", two.left(3, 4), two.left(1, 4)));
    balance.erase(balance.begin() + 1);
    const Ground one(rover);
    EXPECT_TRUE(one.holds("shear_peak", one.left(3, 4), one.left(2.9, 4)));
    balance.erase(balance.begin());
    const Ground none(rover);
    EXPECT_TRUE(none.holds("shear_peak", none.left(3, 4, 2), none.left(3, 4, 1)));
}

} // namespace
} // namespace traction::lab
