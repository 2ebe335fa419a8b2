// What a fit tells of its parameters (fit/identify.h): at a limit, far from the sheet, dead, flat, correlated; lines in what is left.
#include "host_tools/lab/fit/identify.h"
#include "tests/lab/linear_machine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace traction::lab {
namespace {

using namespace hand_made;
using Labels = std::vector<std::string>;

Problem at(std::vector<FreeParameter> free, const std::vector<double> &theta) {
    static const LinearMachine m(24);
    Problem p(m.data, m.physics, std::move(free));
    p.theta = Eigen::Map<const Eigen::VectorXd>(theta.data(), static_cast<Eigen::Index>(theta.size()));
    return p;
}

TEST(Limits, are_told_of_what_stands_at_its_range_or_at_six_deviations_but_not_of_what_is_not_there) {
    FreeParameter stated = parameter("motor", "x", 1, 0.1, 0, 9), absent = parameter("drag", "y", 0.5, 0, 0, 9),
                  wide = parameter("motor", "z", 0.5, 0.3, 0, 9), narrow = parameter("motor", "n", 0.5, 0.09, 0, 9),
                  own = parameter("motor", "x", 0, 0.1);
    own.own = true, own.wheel = 1, own.unit = "1";
    const std::vector<Limit> none = limits_of(at({stated, absent, wide, own}, {0.5, 0.5, 0, 0}));
    EXPECT_TRUE(none.empty());
    const std::vector<Limit> six = limits_of(at({stated, own}, {0.6, -0.6}));
    ASSERT_EQ(six.size(), 2U);
    EXPECT_EQ(six[0].parameter, "motor.x");
    EXPECT_DOUBLE_EQ(six[0].value, 1.6);
    EXPECT_TRUE(six[0].of_prior);
    EXPECT_DOUBLE_EQ(six[1].value, -0.6); // of a wheel's own what it differs
    EXPECT_EQ(limit_text(six[0]), "motor.x stands at its limit, 1.6 N (six of its prior's deviations): widen it or doubt the model");
    EXPECT_EQ(limit_text(six[1]), "motor.x on wheel 1 stands at its limit, off from the other wheels' by -0.6 (six of its prior's "
                                  "deviations): widen it or doubt the model");
    EXPECT_TRUE(limits_of(at({absent}, {-0.5})).empty()); // an effect of no size
    EXPECT_TRUE(limits_of(at({wide}, {-0.5})).empty());   // known so little that it may be nothing
    const std::vector<Limit> there = limits_of(at({narrow}, {-0.5}));
    ASSERT_EQ(there.size(), 1U); // surely something, and at nothing
    EXPECT_FALSE(there[0].of_prior);
    const std::vector<Limit> most = limits_of(at({absent}, {8.5}));
    ASSERT_EQ(most.size(), 1U);
    EXPECT_EQ(limit_text(most[0]), "drag.y stands at its limit, 9 N: widen it or doubt the model");
}

TEST(MovedFar, is_told_of_what_the_fit_took_beyond_three_stated_deviations) {
    FreeParameter stated = parameter("motor", "x", 1, 0.1, 0, 9), unstated = parameter("drag", "y", 0.5, 0, 0, 9),
                  own = parameter("motor", "x", 0, 0.15);
    own.own = true, own.wheel = 0, own.unit = "1";
    FreeParameter other = own;
    other.wheel = 1;
    EXPECT_TRUE(moved_far(at({stated, unstated}, {0.29, 5})).empty());
    const std::vector<Moved> told = moved_far(at({stated, unstated}, {-0.31, 5}));
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0].parameter, "motor.x");
    EXPECT_EQ(told[0].text,
              "the fit takes motor.x from 1 to 0.69 N, 3.1 of its stated deviations: the model file is wrong there, or something "
              "that acts alike is missing");
    EXPECT_TRUE(moved_far(at({stated}, {0.6})).empty()); // that is told as a limit
    // the mean of two wheels: 0.1 and 0.15/sqrt(2) of deviation make 0.146; 0.3 and 0.2 of 1 are 3.4 of it, 0.3 and 0.1 are 2.7
    EXPECT_EQ(moved_far(at({stated, own, other}, {0.3, 0.2, 0.2})).size(), 1U);
    EXPECT_TRUE(moved_far(at({stated, own, other}, {0.3, 0.1, 0.1})).empty());
}

TEST(MovedFar, has_a_farthest_that_may_stand_at_its_limit_and_is_no_sensors) {
    const FreeParameter stated = parameter("motor", "x", 1, 0.1, 0, 9), other = parameter("soil", "y", 1, 0.2, 0, 9),
                        sensor = parameter("sensors.radar", "scale", 0, 0.01), unstated = parameter("drag", "y", 0.5, 0, 0, 9);
    EXPECT_DOUBLE_EQ(furthest_of_sheet(at({stated, other, sensor, unstated}, {0.1, -0.45, 0.05, 5})), 2.25);
    EXPECT_DOUBLE_EQ(furthest_of_sheet(at({stated, other}, {0.6, 0.2})), 6);
    EXPECT_EQ(furthest_of_sheet(at({sensor, unstated}, {0.05, 5})), 0);
}

TEST(Dead, is_what_moves_the_log_by_less_than_a_tenth_of_a_deviation) {
    const LinearMachine m(24);
    Problem p(m.data, m.physics, {a0(0.2), g0()});
    p.linearise();
    const double norm = p.jacobian.col(0).norm();
    EXPECT_FALSE(is_dead(p, 0));
    p.parameters[0].prior = 0.101 / norm;
    EXPECT_FALSE(is_dead(p, 0));
    p.parameters[0].prior = 0.099 / norm;
    EXPECT_TRUE(is_dead(p, 0));
    p.jacobian.col(1) *= 0.101 / p.jacobian.col(1).norm();
    EXPECT_FALSE(is_dead(p, 1)); // of which nothing is stated: by one, or by its value
    p.jacobian.col(1) *= 0.98;
    EXPECT_TRUE(is_dead(p, 1));
    p.theta[1] = 1.1;
    EXPECT_FALSE(is_dead(p, 1));
}

// Two columns of a known angle: their correlation is minus its cosine.
TEST(Identified, is_what_the_rows_tell_more_of_than_the_sheet_does_and_apart) {
    const Dataset data = data_of(1, 3, 1);
    const auto of = [&](double cosine, double prior, double theta) {
        Eigen::MatrixXd J(3, 3);
        J << 10, 10 * cosine, 0, 0, 10 * std::sqrt(1 - cosine * cosine), 0, 0, 0, 1e-3;
        Problem p = problem_of(data, {parameter("m", "x", 1, prior), parameter("m", "y", 1, 0), parameter("m", "z", 1, 0.1)}, J,
                               Eigen::Vector3d::Zero());
        p.theta[1] = theta;
        return identifiability(p);
    };
    const Identifiability apart = of(0.5, 1e6, 5);
    EXPECT_EQ(apart.dead, Labels{"m.z"});
    EXPECT_TRUE(apart.prior_alone.empty() && apart.flat.empty() && apart.correlated.empty());
    EXPECT_NEAR(apart.condition, 1.5 / 0.5, 1e-6); // of unit columns
    const Identifiability close = of(0.96, 1e6, 5);
    ASSERT_EQ(close.correlated.size(), 1U);
    EXPECT_EQ(close.correlated[0].a, "m.x");
    EXPECT_EQ(close.correlated[0].b, "m.y");
    EXPECT_NEAR(close.correlated[0].correlation, -0.96, 1e-6);
    EXPECT_TRUE(of(0.94, 1e6, 5).correlated.empty());
    EXPECT_NEAR(of(-0.96, 1e6, 5).correlated.at(0).correlation, 0.96, 1e-6);
    // alone 0.1 of the rows; beside a prior of p the variance is 1 / (100 + 1 / p^2)
    EXPECT_EQ(of(0, 0.03, 5).prior_alone, Labels{"m.x"}); // 1 / (1 + 0.09) = 0.917 of it
    EXPECT_TRUE(of(0, 0.035, 5).prior_alone.empty());     // 0.89
    EXPECT_EQ(of(0, 1, -0.91).flat, Labels{"m.y"});       // 0.09 +- 0.1
    EXPECT_TRUE(of(0, 1, -0.89).flat.empty());
    EXPECT_EQ(identifiability(problem_of(data, {parameter("m", "z", 1, 0.1)}, Eigen::MatrixXd::Zero(3, 1), Eigen::Vector3d::Zero())).dead,
              Labels{"m.z"});
}

TEST(Identified, is_the_mean_over_wheels_of_what_they_share_and_differ_in) {
    const Dataset data = data_of(2, 2, 1);
    FreeParameter shared = parameter("m", "x", 1, 1), first = parameter("m", "x", 0, 0.1), second = first;
    first.own = second.own = true, first.wheel = 0, second.wheel = 1;
    Eigen::MatrixXd J(4, 3); // each wheel's rows see the sum
    J << 10, 10, 0, 10, 10, 0, 10, 0, 10, 10, 0, 10;
    const Identifiability it = identifiability(problem_of(data, {shared, first, second}, J, Eigen::Vector4d::Zero()));
    EXPECT_TRUE(it.prior_alone.empty()) << it.prior_alone[0]; // their mean is known to 0.05, beside a sheet of 1
    EXPECT_TRUE(it.correlated.empty() && it.dead.empty() && it.flat.empty());
}

TEST(Resonance, is_a_line_in_the_residual_of_a_balance) {
    Dataset data = data_of(2, 1200, 0.05); // 20 rows a second
    Eigen::VectorXd e(2400);
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    for (Eigen::Index r = 0; r < 2400; ++r)
        e[r] = normal(random) + (r < 1200 ? std::sin(2 * std::numbers::pi * 3.0 * 0.05 * static_cast<double>(r)) : 0);
    const Problem p = problem_of(data, {}, Eigen::MatrixXd(2400, 0), e);
    const std::vector<Resonance> found = resonances(p);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].balance, "balance0");
    EXPECT_NEAR(found[0].frequency_Hz, 3, 20.0 / 512); // a line of 512 rows
    EXPECT_GT(found[0].times, 20);                     // half of a square beside 1: 512 / 2 * 1/2 * 2/3 of a Hann window, over the mean
    EXPECT_LT(found[0].times, 300);
    data.independent_rows = true;
    EXPECT_TRUE(resonances(problem_of(data, {}, Eigen::MatrixXd(2400, 0), e)).empty());
    Eigen::VectorXd slow = e; // what wanders is no line: below half a hertz
    for (Eigen::Index r = 0; r < 1200; ++r)
        slow[r] = e[1200 + r] + 5 * std::sin(2 * std::numbers::pi * 0.3 * 0.05 * static_cast<double>(r));
    data.independent_rows = false;
    EXPECT_TRUE(resonances(problem_of(data, {}, Eigen::MatrixXd(2400, 0), slow)).empty());
    const Dataset brief = data_of(1, 150, 0.05);
    EXPECT_TRUE(resonances(problem_of(brief, {}, Eigen::MatrixXd(150, 0), 5 * e.head(150))).empty());
}

} // namespace
} // namespace traction::lab
