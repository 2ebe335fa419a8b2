// A shape fitted in full: what counts as worth a word, and that its term acts where its name says.
#include "host_tools/lab/decision/shape_refit.h"
#include "host_tools/lab/decision/shape_scores.h"
#include "tests/lab/four_wheels.h"

#include <gtest/gtest.h>
#include <optional>

#include <algorithm>
#include <cmath>
#include <vector>

namespace traction::lab {
namespace {

Fall fall_of(std::vector<double> blocks, double error) {
    Fall fall;
    fall.of_block = Eigen::Map<Eigen::VectorXd>(blocks.data(), static_cast<Eigen::Index>(blocks.size()));
    fall.sum = fall.of_block.sum(), fall.error = error;
    return fall;
}

ShapeFall shape_fall(double share, std::vector<double> blocks, double error) {
    ShapeFall fall;
    fall.whole = fall_of(std::move(blocks), error), fall.share = share;
    return fall;
}

TEST(ShapeFall, is_worth_a_word_where_it_is_sure_and_of_more_than_two_blocks) {
    EXPECT_TRUE(is_worth_a_word(shape_fall(0.036, {5, 5, 5, 5}, 9.9), 0));
    EXPECT_FALSE(is_worth_a_word(shape_fall(0.034, {5, 5, 5, 5}, 9.9), 0));
    EXPECT_FALSE(is_worth_a_word(shape_fall(0.036, {5, 5, 5, 5}, 10.1), 0)); // two errors
    EXPECT_FALSE(is_worth_a_word(shape_fall(0.5, {50, 50, -1, 0.5}, 9), 0)); // two blocks carry it
    EXPECT_TRUE(is_worth_a_word(shape_fall(0.5, {50, 50, -1, 1.5}, 9), 0));
}

TEST(ShapeFall, of_one_balance_counts_beyond_what_scatter_may_be) {
    ShapeFall fall = shape_fall(0.01, {5, 5, 5, 5}, 9);
    fall.balance = fall.whole, fall.balance_share = 0.26;
    EXPECT_TRUE(is_worth_a_word(fall, 0.1));
    EXPECT_FALSE(is_worth_a_word(fall, 0.12));
    fall.balance = fall_of({5, 5, 5, 5}, 10.1);
    EXPECT_FALSE(is_worth_a_word(fall, 0.1)); // not surely
    fall.balance = fall.whole, fall.whole = fall_of({-5, -5, -5, 5}, 9);
    EXPECT_FALSE(is_worth_a_word(fall, 0.1)); // at the cost of the others
}

// Wheel 2 has viscous friction of its own: a shape of torque on it finds its slope, one on another wheel finds nothing.
TEST(ShapeRefit, finds_what_acts_on_one_wheel_and_holds_there_alone) {
    hand_made::FourWheels rover;
    EffectUse hidden;
    hidden.name = "viscous_friction", hidden.wheel = 2;
    hidden.parameters["coefficient_Nms"].value = 0.01, hidden.parameters["coefficient_Nms"].given = true;
    rover.hide({hidden});
    const Physics physics = make_physics(rover.model);
    Problem problem(rover.data, physics, free_parameters(rover.model, physics));
    problem.fit({});
    ShapeScore shape;
    for (const Candidate &c :
         shape_candidates(rover.data, problem.forward().motion(), problem.physics(), problem.forward().winding_current_A()))
        if (c.axis == Axis::wheel_speed && c.target == TermTarget::wheel_torque && c.knots.size() > 3) shape.candidate = c;
    ASSERT_FALSE(shape.candidate.strengths.empty());
    const Scatter scatter(problem);
    const HeldOut left = held_out(problem);
    const auto on = [&](int wheel) {
        ShapeScore one = shape;
        one.candidate = on_wheels(shape.candidate, {wheel});
        const auto count = static_cast<Eigen::Index>(one.candidate.strengths.size());
        one.assessment.strength = Eigen::VectorXd::Zero(count);
        return one;
    };
    const auto fall = [&](int wheel) { return fall_by(on(wheel), with_shape(problem, on(wheel)), problem, left, scatter); };
    const Problem with = with_shape(problem, on(2));
    const auto knots = shape.candidate.knots;
    const Eigen::VectorXd strength = with.theta.tail(static_cast<Eigen::Index>(knots.size()));
    EXPECT_NEAR(std::fabs(strength[strength.size() - 1] - strength[0]), 0.01 * (knots.back() - knots.front()), 0.01) << strength;
    EXPECT_TRUE(is_worth_a_word(fall(2), scatter.share));
    // told as that fit has it: the linear step of `on` is none
    ShapeScore step = on(2);
    step.assessment.standard_error = Eigen::VectorXd::Constant(strength.size(), 9);
    const std::optional<ShapeScore> told = as_refitted(step, problem);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->assessment.strength, strength);
    EXPECT_GT(told->assessment.standard_error.minCoeff(), 0);
    EXPECT_LT(told->assessment.standard_error.maxCoeff(), 0.05);
    ShapeScore nothing = on(1);
    nothing.assessment.standard_error = step.assessment.standard_error;
    EXPECT_FALSE(as_refitted(nothing, problem));
    EXPECT_GT(fall(2).share, 3 * std::max(0.01, fall(1).share));
}

TEST(ShapeRefit, knows_that_what_multiplies_stays_positive) {
    ShapeScore shape;
    shape.candidate.target = TermTarget::soil_strength;
    shape.assessment.strength = Eigen::Vector3d(0.5, -0.99, 2);
    EXPECT_TRUE(is_possible(shape));
    shape.assessment.strength[1] = -1.01;
    EXPECT_FALSE(is_possible(shape));
    shape.candidate.target = TermTarget::wheel_torque; // that is added
    EXPECT_TRUE(is_possible(shape));
    shape.candidate.target = TermTarget::soil_strength, shape.candidate.order = 2; // a wave
    shape.assessment.strength = Eigen::Vector2d(0.8, 0.7);
    EXPECT_FALSE(is_possible(shape));
    shape.assessment.strength = Eigen::Vector2d(0.7, 0.7);
    EXPECT_TRUE(is_possible(shape));
}

// Of a bump the middle one of three values is free.
TEST(ShapeRefit, of_a_bump_moves_its_middle_alone) {
    hand_made::FourWheels rover;
    const Physics physics = make_physics(rover.model);
    Problem problem(rover.data, physics, free_parameters(rover.model, physics));
    problem.fit({});
    const Screen screen(problem);
    std::size_t bumps = 0;
    for (const ShapeScore &s : all_shapes(problem, screen)) {
        if (!is_bump(s.candidate)) continue;
        ++bumps;
        Physics at = physics;
        s.candidate.prepare(at);
        ASSERT_EQ(at.terms.size(), 1U) << s.candidate.effect;
        s.candidate.strengths[0].add(at, 0.5);
        EXPECT_EQ(at.terms[0].coefficients, (std::vector<double>{0, 0.5, 0})) << s.candidate.effect;
    }
    EXPECT_GT(bumps, 0U);
}

} // namespace
} // namespace traction::lab
