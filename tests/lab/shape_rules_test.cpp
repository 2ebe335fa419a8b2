// Rules of structure-free shapes (shape_rules.h) by closed forms, and on rows made by hand of which it is known what they follow.
#include "host_tools/lab/decision/shape_rules.h"
#include "tests/lab/hand_made.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <optional>

#include <cmath>
#include <numbers>
#include <random>

namespace traction::lab {
namespace {

Candidate shape(TermTarget target, Axis axis, std::vector<double> knots) {
    Candidate c;
    c.effect = "shape";
    c.free_shape = true;
    c.target = target, c.axis = axis;
    c.strengths.resize(knots.size());
    c.knots = std::move(knots);
    return c;
}

const std::vector<double> five = {0, 1, 2, 3, 4};
Candidate curve() { return shape(TermTarget::wheel_torque, Axis::wheel_speed, five); }

Assessment falls(std::size_t blocks, double each, double p_value) {
    Assessment a;
    a.p_value = p_value;
    a.block_gain = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(blocks), each);
    a.gain = a.block_gain.sum();
    return a;
}

// 80 shapes in four fifths of the chance of a false alarm, 137 of some wheels in the last fifth, 310 steps in a tenth beside; twice, for
// there are two tests.
TEST(Corrected, p_of_a_curve_is_that_of_its_coefficients_or_of_the_ranks_of_its_falls_times_the_number_tried) {
    EXPECT_NEAR(corrected(curve(), falls(20, -1, 1e-6)), 2 * 80 / 0.8 * 1e-6, 1e-15);
    EXPECT_NEAR(corrected(curve(), falls(20, 1, 0.5)), 2 * 80 / 0.8 * std::ldexp(1, -20), 1e-12);
    EXPECT_NEAR(corrected(on_wheels(curve(), {1}), falls(20, -1, 1e-6)), 2 * 137 / 0.2 * 1e-6, 1e-15);
    for (const Candidate &step : {steps_of(curve()).front(), on_wheels(steps_of(curve()).front(), {1})})
        EXPECT_NEAR(corrected(step, falls(20, -1, 1e-6)), 2 * 310 / 0.1 * 1e-6, 1e-15);
    EXPECT_EQ(corrected(curve(), falls(20, -1, 0.5)), 1);
}

// Student's t of two degrees of freedom has the closed tail (1 - t / sqrt(t^2 + 2)) / 2.
TEST(Corrected, p_of_a_wave_is_that_of_its_coefficients_or_of_the_mean_of_its_falls) {
    Candidate wave = curve();
    wave.order = 3;
    Assessment a = falls(3, 1, 0.5);
    a.gain = 500, a.gain_error = 0.5;
    EXPECT_NEAR(corrected(wave, a), 2 * 80 / 0.8 * 0.5 * (1 - 1000 / std::sqrt(1e6 + 2)), 1e-9);
    a.p_value = 1e-9;
    EXPECT_NEAR(corrected(wave, a), 2 * 80 / 0.8 * 1e-9, 1e-18);
    a.p_value = 0.001, a.gain = -500;
    EXPECT_NEAR(corrected(wave, a), 2 * 80 / 0.8 * 0.001, 1e-12); // what rises is no fall
    a.gain = 500, a.gain_error = 0;
    EXPECT_NEAR(corrected(wave, a), 2 * 80 / 0.8 * 0.001, 1e-12);
    a.gain_error = 0.5, a.block_gain = Eigen::VectorXd::Ones(1); // one block has no scatter
    EXPECT_NEAR(corrected(wave, a), 2 * 80 / 0.8 * 0.001, 1e-12);
}

TEST(Kinds, of_shapes_are_lines_bumps_waves_and_curves) {
    const Candidate line = shape(TermTarget::rolling, Axis::time, {0, 9});
    Candidate bump = shape(TermTarget::wheel_friction, Axis::abs_wheel_speed, {0, 1, 2}), wave = curve(), means = curve();
    bump.strengths.resize(1);
    wave.order = 2;
    means.varies_between_wheels = true;
    EXPECT_TRUE(is_straight(line) && !is_straight(bump) && !is_straight(curve()));
    EXPECT_TRUE(is_bump(bump) && !is_bump(line) && !is_bump(curve()));
    for (const Candidate &c : {line, bump, curve()}) EXPECT_TRUE(is_curve(c));
    EXPECT_FALSE(is_curve(wave));
    EXPECT_FALSE(is_curve(means));
    EXPECT_FALSE(is_curve(shape(TermTarget::wheel_torque, Axis::wheel_speed, {0, 1, 2})));
    EXPECT_TRUE(is_curve(shape(TermTarget::wheel_torque, Axis::wheel_speed, {0, 1, 2, 3})));
    for (const Axis axis : {Axis::direction, Axis::other_current, Axis::axle_current, Axis::side_current})
        EXPECT_TRUE(is_curve(shape(TermTarget::voltage, axis, {0, 1, 2})));
}

TEST(Kinds, of_shapes_over_time_are_sixteen_steps_evenly_apart) {
    Candidate over_time = shape(TermTarget::wheel_friction, Axis::time, {3, 8, 20});
    over_time.effect = "friction(time)";
    over_time.strengths.resize(3);
    for (int j = 0; j < 3; ++j)
        over_time.strengths[static_cast<std::size_t>(j)].slots = {Slot{}},
        over_time.strengths[static_cast<std::size_t>(j)].slots[0].coefficient = j;
    const std::vector<Candidate> steps = steps_of(over_time);
    ASSERT_EQ(steps.size(), 16U);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const Candidate &c = steps[i];
        EXPECT_TRUE(is_step(c) && is_curve(c) && !is_straight(c) && !is_bump(c));
        ASSERT_EQ(c.knots.size(), 2U);
        EXPECT_NEAR(c.knots[0], 3 + static_cast<double>(i + 1) - 0.125, 1e-12);
        EXPECT_NEAR(c.knots[1], 3 + static_cast<double>(i + 1) + 0.125, 1e-12);
        EXPECT_EQ(c.strengths[0].slots[0].coefficient, 1); // of two values the later
        EXPECT_EQ(c.effect, "friction(time), a step at " + std::to_string(i + 4) + " s");
    }
    EXPECT_FALSE(is_step(over_time));
}

TEST(Kinds, of_uneven_ground_are_its_strength_over_time_place_path_and_slip) {
    for (const Axis axis : {Axis::time, Axis::place, Axis::path, Axis::slip}) {
        EXPECT_TRUE(uneven(shape(TermTarget::soil_strength, axis, five)));
        EXPECT_FALSE(uneven(shape(TermTarget::rolling, axis, five)));
        Candidate wave = shape(TermTarget::soil_strength, axis, five);
        wave.order = 1;
        EXPECT_FALSE(uneven(wave));
    }
    EXPECT_FALSE(uneven(shape(TermTarget::soil_strength, Axis::abs_speed, five)));
}

Physics wheels_at(const std::vector<double> &x) {
    Physics p;
    p.wheel.resize(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) p.wheel[i].x = x[i];
    return p;
}

TEST(Groups, of_wheels_are_each_alone_and_those_abreast) {
    using Groups = std::vector<std::vector<int>>;
    Physics p = wheels_at({0.1, 0.1, -0.1, -0.1});
    EXPECT_EQ(wheel_groups(p, false), (Groups{{0}, {0, 1}, {1}, {2}, {2, 3}, {3}}));
    p.motor = {0, 1, 0, 1}; // two motors, one of each side: not abreast of one another alone
    EXPECT_EQ(wheel_groups(p, false).size(), 6U);
    EXPECT_EQ(wheel_groups(p, true), (Groups{{0}, {1}})); // both motors are all motors
    p.motor = {0, 0, 0, 0};
    EXPECT_TRUE(wheel_groups(p, true).empty());
    EXPECT_EQ(wheel_groups(wheels_at({1, 2}), true), (Groups{{0}, {1}}));
    EXPECT_TRUE(wheel_groups(wheels_at({1}), false).empty());
    EXPECT_EQ(wheel_groups(wheels_at({1, 2, 3, 4, 5, 6, 7, 8}), false).size(), 8U);
    EXPECT_TRUE(wheel_groups(wheels_at({1, 2, 3, 4, 5, 6, 7, 8, 9}), false).empty());
}

TEST(Groups, are_told_by_their_wheels) {
    EXPECT_EQ(on_wheels(curve(), {2}).effect, "shape on wheel 2");
    EXPECT_EQ(on_wheels(curve(), {0, 1, 3}).effect, "shape on wheels 0 and 1 and 3");
    EXPECT_TRUE(on_wheels(curve(), {2}).some_wheels);
}

ShapeScore with(const Candidate &c, const std::vector<double> &strength, double error) {
    ShapeScore s;
    s.candidate = c;
    s.assessment.strength = Eigen::Map<const Eigen::VectorXd>(strength.data(), static_cast<Eigen::Index>(strength.size()));
    s.assessment.standard_error = Eigen::VectorXd::Constant(s.assessment.strength.size(), error);
    s.assessment.gain = 25;
    return s;
}

TEST(Description, of_a_curve_has_its_values_and_95_percent_at_its_knots) {
    const Candidate c = shape(TermTarget::rolling, Axis::wheel_speed, {-1, 0, 2});
    const UnknownShape u = describe(with(c, {0.5, -1, 2}, 0.1), 200);
    EXPECT_EQ(u.x, c.knots);
    EXPECT_EQ(u.y, (std::vector<double>{0.5, -1, 2}));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_DOUBLE_EQ(u.low[i], u.y[i] - 0.196);
        EXPECT_DOUBLE_EQ(u.high[i], u.y[i] + 0.196);
    }
    EXPECT_DOUBLE_EQ(u.gain, 0.125);
    EXPECT_EQ(describe(with(c, {0.5, -1, 2}, 0.1), 0).gain, 0);
    EXPECT_DOUBLE_EQ(describe(with(c, {0.5, -1, 2}, 0.1), 0.5).gain, 50);
    EXPECT_EQ(u.balance, "shape");
    EXPECT_EQ(u.variable, axis_name(Axis::wheel_speed));
    EXPECT_EQ(u.unit_x, axis_unit(Axis::wheel_speed));
    EXPECT_EQ(u.target, target_name(TermTarget::rolling));
    EXPECT_EQ(u.expression, shape_expression(c, {0.5, -1, 2}));
    const auto unit = [](TermTarget target) { return describe(with(shape(target, Axis::time, five), {1, 1, 1, 1, 1}, 1), 1).unit_y; };
    EXPECT_EQ(unit(TermTarget::wheel_torque), "N m");
    EXPECT_EQ(unit(TermTarget::rolling), "N");
    EXPECT_EQ(unit(TermTarget::voltage), "V");
    EXPECT_EQ(unit(TermTarget::soil_strength), "1");
    EXPECT_EQ(unit(TermTarget::accel), "m/s^2");
}

TEST(Description, of_a_bump_is_nothing_at_its_ends) {
    Candidate c = shape(TermTarget::wheel_friction, Axis::abs_wheel_speed, {1, 2, 4});
    c.strengths.resize(1);
    const UnknownShape u = describe(with(c, {3}, 0.5), 100);
    EXPECT_EQ(u.y, (std::vector<double>{0, 3, 0}));
    EXPECT_EQ(u.low, (std::vector<double>{0, 3 - 0.98, 0}));
    EXPECT_EQ(u.high, (std::vector<double>{0, 3 + 0.98, 0}));
}

TEST(Description, of_a_step_is_nothing_before_it_and_all_of_it_behind) {
    const Candidate c = steps_of(shape(TermTarget::wheel_friction, Axis::time, {0, 17})).front();
    const UnknownShape u = describe(with(c, {3}, 0.5), 100);
    EXPECT_EQ(u.x, (std::vector<double>{-0.125, 0.875, 1.125, 2.125})); // from a step's way before it to one behind
    EXPECT_EQ(u.y, (std::vector<double>{0, 0, 3, 3}));
    EXPECT_EQ(u.low, (std::vector<double>{0, 0, 3 - 0.98, 3 - 0.98}));
    EXPECT_EQ(u.high, (std::vector<double>{0, 0, 3 + 0.98, 3 + 0.98}));
    EXPECT_EQ(u.expression, "0 + (3)*min(1, max(0, (t - (0.875))/0.25))");
}

TEST(Description, of_a_wave_is_one_turn_of_the_wheel_or_one_wave_of_the_path) {
    for (const Axis axis : {Axis::angle, Axis::path}) {
        Candidate c = shape(TermTarget::wheel_torque, axis, {});
        c.order = 4, c.strengths.resize(2);
        ShapeScore s = with(c, {0.5, -2}, 0.1);
        s.assessment.standard_error[1] = 0.2; // the larger counts
        const UnknownShape u = describe(s, 100);
        ASSERT_EQ(u.x.size(), 37U);
        EXPECT_EQ(u.x.front(), 0);
        EXPECT_NEAR(u.x.back(), 2 * std::numbers::pi / (axis == Axis::angle ? 1 : 4), 1e-12);
        for (std::size_t i = 0; i < u.x.size(); ++i) {
            EXPECT_NEAR(u.x[i], u.x.back() * static_cast<double>(i) / 36, 1e-12);
            EXPECT_NEAR(u.y[i], 0.5 * std::cos(4 * u.x[i]) - 2 * std::sin(4 * u.x[i]), 1e-12);
            EXPECT_NEAR(u.high[i] - u.y[i], 0.392, 1e-12);
            EXPECT_NEAR(u.y[i] - u.low[i], 0.392, 1e-12);
        }
    }
}

TEST(Evidence, repeats_where_it_is_sure_beside_its_scatter_or_very_sure_and_not_of_two_blocks) {
    ShapeScore s;
    s.p_value = 1e-3;
    const auto is = [&](double gain, double error, std::initializer_list<double> blocks) {
        s.assessment.gain = gain, s.assessment.gain_error = error;
        s.assessment.block_gain = Eigen::Map<const Eigen::VectorXd>(blocks.begin(), static_cast<Eigen::Index>(blocks.size()));
        return repeats(s);
    };
    EXPECT_TRUE(is(26, 10, {}));
    EXPECT_FALSE(is(25, 10, {}));
    EXPECT_TRUE(is(10, 10, {50, -1, 60, 2}));  // without 60 and 50 still a gain
    EXPECT_FALSE(is(10, 10, {50, -1, 60, 1})); // none
    EXPECT_FALSE(is(10, 10, {50, 60}));
    EXPECT_TRUE(is(10, 10, {50, 1, 60}));
    s.p_value = 2e-3;
    EXPECT_FALSE(is(10, 10, {50, 1, 60}));
    EXPECT_TRUE(is(26, 10, {50, 1, 60}));
}

// Explains a tenth of 1000, sure, by all of ten blocks alike.
ShapeScore worthy(std::size_t coefficients = 5, double gain = 100) {
    ShapeScore s;
    s.candidate = curve();
    s.candidate.strengths.resize(coefficients);
    s.p_value = 1e-3;
    s.assessment.gain = gain, s.assessment.gain_error = gain / 10;
    s.assessment.block_gain = Eigen::VectorXd::Constant(10, gain / 10);
    return s;
}

std::ptrdiff_t worth(const std::vector<ShapeScore> &scores, double smoothed = 0, bool beside_names = false, double scatter = 0) {
    const ShapeScore *one = worth_a_word(
        scores, [&](const ShapeScore &) { return smoothed; }, beside_names, 1000, scatter, DiagnoseOptions{});
    return one == nullptr ? -1 : one - scores.data();
}

TEST(Worth, a_word_is_a_shape_of_two_percent_or_five_beside_names_and_half_of_that_on_some_wheels) {
    EXPECT_EQ(worth({worthy()}), 0);
    EXPECT_EQ(worth({worthy(5, 20.1)}), 0);
    EXPECT_EQ(worth({worthy(5, 20)}), -1);
    EXPECT_EQ(worth({worthy(5, 50.1)}, 0, true), 0);
    EXPECT_EQ(worth({worthy(5, 50)}, 0, true), -1);
    ShapeScore some = worthy(5, 10.1);
    some.candidate.some_wheels = true;
    EXPECT_EQ(worth({some}), 0);
    some.assessment.gain = 10;
    EXPECT_EQ(worth({some}), -1);
    ShapeScore ground = worthy(5, 60.1); // every ground wanders by 6 %
    ground.candidate.target = TermTarget::soil_strength, ground.candidate.axis = Axis::path;
    EXPECT_EQ(worth({ground}), 0);
    ground.assessment.gain = 60;
    EXPECT_EQ(worth({ground}), -1);
    EXPECT_EQ(worth({worthy(5, 75.1)}, 0, false, 0.5), 0); // 15 % of what scatter may be
    EXPECT_EQ(worth({worthy(5, 75)}, 0, false, 0.5), -1);
    ShapeScore unsure = worthy();
    unsure.p_value = 0.02;
    EXPECT_EQ(worth({unsure}), -1);
    unsure.p_value = 0.0199;
    EXPECT_EQ(worth({unsure}), 0);
    unsure.assessment.gain_error = 100; // and does not repeat
    EXPECT_EQ(worth({unsure}), -1);
}

TEST(Worth, a_word_is_little_of_all_that_is_much_of_one_balance_where_it_is_very_sure) {
    ShapeScore s = worthy(5, 1);
    s.balance_fall = 0.151, s.p_value = 0.9e-4;
    EXPECT_EQ(worth({s}), 0);
    EXPECT_EQ(worth({s}, 0, false, 0.01), -1); // beyond what scatter may be there
    s.p_value = 1e-4;
    EXPECT_EQ(worth({s}), -1);
    s.p_value = 0.9e-4, s.balance_fall = 0.15;
    EXPECT_EQ(worth({s}), -1);
}

TEST(Worth, a_word_is_no_shape_that_smooths_and_of_those_that_do_nearly_as_well_the_simplest) {
    EXPECT_EQ(worth({worthy()}, 79), 0); // 21 are left
    EXPECT_EQ(worth({worthy()}, 80), -1);
    EXPECT_EQ(worth({worthy()}, -500), 0); // what roughens is not blamed
    ShapeScore scattered = worthy();       // 26 of scatter 10 repeats, 24 does not, and no three blocks carry it
    scattered.assessment.gain = 100, scattered.assessment.gain_error = 39;
    EXPECT_EQ(worth({scattered}, 2), 0);
    EXPECT_EQ(worth({scattered}, 3), 0) << "ten blocks carry it";
    scattered.assessment.block_gain = Eigen::VectorXd::Zero(10), scattered.assessment.block_gain[0] = 100;
    EXPECT_EQ(worth({scattered}, 2), 0);
    EXPECT_EQ(worth({scattered}, 3), -1);
    EXPECT_EQ(worth({worthy(5, 100), worthy(4, 86)}), 1);
    EXPECT_EQ(worth({worthy(5, 100), worthy(4, 85)}), 0);
    EXPECT_EQ(worth({worthy(5, 100), worthy(5, 99)}), 0);
    EXPECT_EQ(worth({worthy(5, 100), worthy(4, 90), worthy(3, 86)}), 2); // of the first, not of the last
    EXPECT_EQ(worth({worthy(5, 100), worthy(4, 90), worthy(3, 80)}), 1);
}

// 20 blocks of 5 s, ten rows each, white noise of 1.
struct Rows {
    Dataset data = hand_made::data_of(1, 200, 0.5);
    Eigen::VectorXd noise = Eigen::VectorXd(200), x = Eigen::VectorXd(200);
    Rows() {
        std::mt19937 random(7);
        std::normal_distribution<double> normal;
        for (double &e : noise) e = normal(random);
        for (double &one : x) one = 2 * (static_cast<double>(random()) / 4294967296.0) - 1;
    }
    // Hats at -1, -0.5, 0, 0.5, 1 of x.
    Eigen::MatrixXd hats() const {
        Eigen::MatrixXd H(200, 5);
        for (Eigen::Index r = 0; r < 200; ++r)
            for (Eigen::Index j = 0; j < 5; ++j) H(r, j) = std::max(0.0, 1 - std::fabs(x[r] + 1 - 0.5 * static_cast<double>(j)) / 0.5);
        return H;
    }
    ShapeScore score(const std::string &name, const Eigen::MatrixXd &columns, double p = 1e-6) const {
        ShapeScore s;
        s.candidate = curve();
        s.candidate.effect = name;
        s.candidate.knots = {-1, -0.5, 0, 0.5, 1};
        s.candidate.strengths.resize(5);
        for (FreeParameter &one : s.candidate.strengths) one = hand_made::parameter(name, "f", 0, 0);
        s.p_value = p;
        s.columns = SparseJacobian(data, columns);
        return s;
    }
    // The least-squares fit of effects of these columns to `truth` and the noise.
    Problem fitted(const std::vector<std::pair<std::string, Eigen::VectorXd>> &effects, const Eigen::VectorXd &truth) const {
        Eigen::MatrixXd J(200, static_cast<Eigen::Index>(effects.size()));
        std::vector<FreeParameter> parameters;
        for (std::size_t i = 0; i < effects.size(); ++i) {
            J.col(static_cast<Eigen::Index>(i)) = effects[i].second;
            parameters.push_back(hand_made::parameter(effects[i].first, "size", 0, 0));
        }
        const Eigen::VectorXd y = truth + noise, theta = J.colPivHouseholderQr().solve(y);
        Problem problem = hand_made::problem_of(data, parameters, J, y - J * theta);
        problem.theta = theta;
        return problem;
    }
};

TEST(Without, an_effect_its_part_is_back_in_the_residual_and_its_columns_are_handed_out) {
    const Rows rows;
    Problem last = rows.fitted({{"a", rows.x}, {"b", rows.x.cwiseAbs()}}, 3 * rows.x);
    last.row_scale *= 2, last.jacobian *= 2; // rows of half a unit
    last.parameters[0].base = 0.25;
    Eigen::MatrixXd columns;
    const Problem less = without_effect(last, hand_made::candidate("a"), columns);
    ASSERT_EQ(less.parameters.size(), 1U);
    EXPECT_EQ(less.parameters[0].owner, "b");
    EXPECT_EQ(less.theta.size(), 1);
    EXPECT_EQ(less.theta[0], last.theta[1]);
    EXPECT_EQ(less.jacobian, last.jacobian.col(1));
    EXPECT_EQ(columns, last.jacobian.col(0));
    EXPECT_LT((less.residual - last.residual - (0.25 + last.theta[0]) * rows.x).norm(), 1e-12);
    const Problem all = without_effect(last, hand_made::candidate("a", 1), columns); // on a wheel: another one
    EXPECT_EQ(all.parameters.size(), 2U);
    EXPECT_EQ(columns.cols(), 0);
    EXPECT_EQ(all.residual, last.residual);
}

TEST(Beside, a_shape_that_holds_it_an_effect_gains_nothing_and_beside_another_what_it_gains_alone) {
    const Rows rows;
    const Problem last = rows.fitted({{"a", rows.x}}, 3 * rows.x);
    Eigen::MatrixXd columns;
    const Problem less = without_effect(last, hand_made::candidate("a"), columns);
    const double own = Screen(less).assess(columns, Eigen::VectorXd::Zero(1), false).gain;
    EXPECT_GT(own, 300); // 9 times the mean of x^2, a third, in 200 rows: 600
    const Assessment held = effect_given_shape(less, columns, rows.score("s", rows.hats())); // a line is in the hats
    EXPECT_LT(held.gain, 0.01 * own);
    Eigen::MatrixXd other = rows.hats();
    other = other.colwise().reverse().eval(); // of another row's x
    EXPECT_GT(effect_given_shape(less, columns, rows.score("s", other)).gain, 0.5 * own);
}

TEST(Names, that_a_shape_explains_are_those_that_keep_less_than_half_of_their_gain_beside_it) {
    const Rows rows;
    const Eigen::VectorXd other = rows.x.reverse();
    const Problem last = rows.fitted({{"a", rows.x}, {"b", other}}, 3 * rows.x + 3 * other);
    const std::vector<Candidate> named = {hand_made::candidate("a"), hand_made::candidate("b")};
    using Indices = std::vector<std::size_t>;
    const ShapeScore s = rows.score("s", rows.hats());
    EXPECT_EQ(explained_by_shape(last, named, "s", {s}), Indices{0});
    EXPECT_EQ(explained_by_shape(last, named, "unknown", {s}), (Indices{0, 1})); // of which nothing is known
    ShapeScore bare = s;
    bare.columns = SparseJacobian();
    EXPECT_EQ(explained_by_shape(last, named, "s", {bare}), (Indices{0, 1}));
}

TEST(Proxy, is_a_name_that_is_not_needed_beside_a_curve_that_explains_surely_more) {
    const Rows rows;
    const DiagnoseOptions options;
    const Eigen::VectorXd cube = rows.x.array().cube(), bend = 8 * cube - 3 * rows.x; // bent far more than any line
    const Problem proxy = rows.fitted({{"line", rows.x}}, bend), right = rows.fitted({{"line", rows.x}}, 5 * rows.x);
    const Candidate line = hand_made::candidate("line");
    const std::vector<ShapeScore> shapes = {rows.score("curve", rows.hats())};
    const std::optional<UnknownShape> cause = confounding_shape(proxy, line, shapes, nullptr, options);
    ASSERT_TRUE(cause);
    EXPECT_EQ(cause->balance, "curve");
    ASSERT_EQ(cause->y.size(), 5U);
    for (std::size_t i = 0; i < 5; ++i) { // through the cubic: hats of half a unit bend by 0.2, and errors of 0.3
        const double at = -1 + 0.5 * static_cast<double>(i);
        EXPECT_NEAR(cause->y[i], 8 * at * at * at - 3 * at, 1.5);
    }
    EXPECT_GT(cause->gain, 0.5);
    EXPECT_FALSE(confounding_shape(right, line, shapes, nullptr, options)); // no freer shape does better than a law that is right
    std::vector<ShapeScore> refused = shapes;                               // not sure, no curve, or nothing known of its columns
    refused[0].p_value = options.shape_p_limit;
    EXPECT_FALSE(confounding_shape(proxy, line, refused, nullptr, options));
    refused = shapes, refused[0].candidate.varies_between_wheels = true;
    EXPECT_FALSE(confounding_shape(proxy, line, refused, nullptr, options));
    refused = shapes, refused[0].columns = SparseJacobian();
    EXPECT_FALSE(confounding_shape(proxy, line, refused, nullptr, options));
    EXPECT_FALSE(confounding_shape(proxy, line, {}, nullptr, options));
}

// Doing as well is enough of the shape that was flagged itself, and of no straight line.
TEST(Proxy, of_the_flagged_shape_is_a_name_that_explains_no_less_unless_it_is_needed_beside_it) {
    const Rows rows;
    const DiagnoseOptions options;
    const Problem right = rows.fitted({{"line", rows.x}}, 5 * rows.x);
    const Candidate line = hand_made::candidate("line");
    const std::vector<ShapeScore> two = {rows.score("curve", rows.hats()), rows.score("same", rows.hats())};
    const std::optional<UnknownShape> cause = confounding_shape(right, line, two, &two[1], options);
    ASSERT_TRUE(cause);
    EXPECT_EQ(cause->balance, "same");
    std::vector<ShapeScore> straight = two;
    straight[1].candidate.knots = {-1, 1};
    EXPECT_FALSE(confounding_shape(right, line, straight, &straight[1], options));
    const Eigen::VectorXd bend = rows.x.reverse().cwiseAbs(); // beside a shape of something else the line is needed
    const Problem both = rows.fitted({{"line", rows.x}}, 5 * rows.x + 20 * bend);
    Eigen::MatrixXd of_other = rows.hats().colwise().reverse();
    const std::vector<ShapeScore> other = {rows.score("other", of_other)};
    EXPECT_FALSE(confounding_shape(both, line, other, &other[0], options));
}

TEST(Place, of_several_names_is_for_a_shape_that_does_nearly_as_much_and_of_one_for_what_does_surely_more) {
    const DiagnoseOptions options; // 1.1 times
    EXPECT_TRUE(takes_their_place(2, 95.1, 100, 50, true, options));
    EXPECT_FALSE(takes_their_place(2, 95, 100, 0, false, options));
    EXPECT_TRUE(takes_their_place(1, 110.1, 100, 5, false, options));
    EXPECT_FALSE(takes_their_place(1, 109.9, 100, 1, false, options));
    EXPECT_FALSE(takes_their_place(1, 110.1, 100, 5.1, false, options)); // two standard errors
    EXPECT_FALSE(takes_their_place(1, 199, 100, 1, true, options));      // where the name leaves a shape
    EXPECT_TRUE(takes_their_place(1, 201, 100, 1, true, options));
    EXPECT_FALSE(takes_their_place(1, 201, 100, 51, true, options));
}

TEST(Place, of_names_is_asked_for_by_what_is_sure_no_line_and_does_nearly_as_much) {
    DiagnoseOptions options;
    options.shape_p_limit = 0.02;
    ShapeScore s;
    s.candidate.free_shape = true, s.candidate.knots = {0, 1, 2, 3}, s.candidate.strengths.resize(4);
    s.p_value = 0.019, s.assessment.gain = 96;
    ASSERT_FALSE(is_straight(s.candidate));
    EXPECT_TRUE(may_replace(s, 100, options));
    EXPECT_FALSE(may_replace(s, 101.1, options));
    s.p_value = 0.02;
    EXPECT_FALSE(may_replace(s, 100, options));
    s.p_value = 0, s.candidate.knots = {0, 1}, s.candidate.strengths.resize(2);
    ASSERT_TRUE(is_straight(s.candidate));
    EXPECT_FALSE(may_replace(s, 100, options));
    s.candidate.strengths.resize(1);
    ASSERT_TRUE(is_step(s.candidate));
    EXPECT_FALSE(may_replace(s, 100, options));
}

TEST(Place, of_all_names_but_the_first_goes_and_of_that_one_where_it_holds_less_than_half) {
    std::vector<CandidateResult> accepted(3);
    accepted[0].gain_squares = 40, accepted[1].gain_squares = 60, accepted[2].gain_squares = 1000;
    EXPECT_TRUE(gives_way({0, 2}, accepted, 1));
    EXPECT_TRUE(gives_way({0}, accepted, 81));
    EXPECT_FALSE(gives_way({0}, accepted, 80));
    EXPECT_TRUE(gives_way({1}, accepted, 121)); // the first of those that say the same
    EXPECT_FALSE(gives_way({1}, accepted, 81));
    EXPECT_FALSE(gives_way({}, accepted, 1000));
}

TEST(Left, is_anything_of_which_a_shape_explains_a_hundredth) {
    EXPECT_TRUE(anything_left({worthy(5, 1), worthy(5, 10)}, 1000));
    EXPECT_FALSE(anything_left({worthy(5, 1), worthy(5, 9.9)}, 1000));
    EXPECT_FALSE(anything_left({}, 1000));
}

} // namespace
} // namespace traction::lab
