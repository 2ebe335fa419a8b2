// What a name is believed by (evidence.h), beside the same by hand: falls of held-out squares, what smooths, what the sheet's numbers
// spare.
#include "host_tools/lab/decision/evidence.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/fit/scatter.h"
#include "host_tools/lab/forward/rounding.h"
#include "tests/lab/four_wheels.h"
#include "tests/lab/linear_machine.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

namespace traction::lab {
namespace {

using namespace hand_made;

Candidate touching(unsigned touched) {
    Candidate c = candidate("an effect");
    c.touched = touched;
    return c;
}

Eigen::VectorXd squares_fall(const HeldOut &a, const HeldOut &b) { return a.residual.cwiseAbs2() - b.residual.cwiseAbs2(); }

TEST(Evidence, of_what_leaves_the_motion_alone_is_the_fall_of_what_is_left_out) {
    LinearMachine m;
    m.hide(r1(), 0.5);
    Problem before(m.data, m.physics, {a0(0.2), r0(0.005)});
    before.fit({});
    Problem with(m.data, m.physics, {a0(0.2), r0(0.005), r1()});
    with.keep_scales(before);
    with.gauss_newton(2);
    const HeldOut left_before = held_out(before), left_with = held_out(with);
    const Evidence e = evidence_of(touching(stage_sensors), before, left_before, with, left_with);
    const Eigen::VectorXd fall = squares_fall(left_before, left_with);
    EXPECT_NEAR(e.scaled.sum, fall.dot(before.row_scale.cwiseAbs2()), 1e-9 * e.scaled.sum);
    EXPECT_NEAR(e.noise.sum, fall.dot(noise_weight(before)), 1e-9 * e.noise.sum);
    EXPECT_TRUE(e.falls() && !e.smooths);
    const Evidence none = evidence_of(touching(stage_sensors), before, left_before, before, left_before);
    EXPECT_EQ(none.scaled.sum, 0);
    EXPECT_FALSE(none.falls() || none.smooths); // it moves nothing, so it cannot smooth
}

TEST(Evidence, falls_in_noises_and_on_the_scales_or_not_at_all) {
    Evidence e;
    for (const auto &[scaled, noise, smooths] : {std::tuple{2.0, 2.0, false}, {2.0, 0.5, false}, {0.5, 2.0, false}, {2.0, 2.0, true}}) {
        e.scaled.sum = scaled, e.noise.sum = noise, e.scaled.error = e.noise.error = 1, e.smooths = smooths;
        EXPECT_EQ(e.falls(), scaled > 1 && noise > 1 && !smooths);
    }
}

// A rover on soft ground that a slope takes downhill; encoders that scatter.
struct Sloped {
    FourWheels rover;
    Candidate grade;
    std::optional<Problem> before, with;
    HeldOut left_before, left_with;
    explicit Sloped(double slope) {
        EffectUse use;
        use.name = "grade";
        for (const char *key : {"slope_rad", "direction_rad"}) use.parameters[key].given = true;
        use.parameters["slope_rad"].value = slope;
        rover.hide({use});
        for (Balance &b : rover.data.balance) b.noise *= 0.5; // half of what is left is no sensor's
        for (WheelInput &w : rover.data.wheel) w.scatter_rad = 0.02;
        before = fitted_problem(rover.model, rover.data);
        for (const Candidate &c : catalogue_candidates(rover.model, rover.data, before->forward().motion()))
            if (c.effect == "grade" && grade.effect.empty()) grade = c;
        Model model = rover.model;
        model.effects.push_back(effect_of(grade, std::vector<double>(grade.strengths.size(), 0)));
        const Physics physics = make_physics(model);
        with.emplace(rover.data, physics, free_parameters(model, physics));
        with->keep_scales(*before);
        left_before = held_out(*before);
        fit();
    }
    void fit() {
        with->gauss_newton(3);
        left_with = held_out(*with);
    }
    Evidence evidence() const { return evidence_of(grade, *before, left_before, *with, left_with); }
    Eigen::VectorXd smoothed(const Problem &by) const {
        const Scatter scatter(*before);
        return (rounding_squares(rover.data, before->physics()) - rounding_squares(rover.data, by.physics())).cwiseProduct(scatter.part);
    }
    double least() const { // a twentieth of what scatter may be of the squares
        const Scatter scatter(*before);
        return 0.05 * rounding_squares(rover.data, before->physics()).cwiseProduct(scatter.part).dot(before->row_scale.cwiseAbs2());
    }
    void soften() { // the ground alone
        for (std::size_t i = 0; i < with->parameters.size(); ++i)
            if (with->parameters[i].owner == "soil") with->theta[static_cast<Eigen::Index>(i)] -= 0.3;
    }
};

// Sensors better than stated: by their noise nothing would be left that the encoders' scatter may be.
TEST(Scatter, may_be_what_another_fit_takes_off_the_rows_where_they_leave_less_than_the_noise_that_is_stated) {
    Sloped s(0.1);
    for (Balance &b : s.rover.data.balance) b.noise *= 100;
    const Scatter alone(*s.before), beside(*s.before, &*s.with);
    EXPECT_EQ(alone.part.maxCoeff(), 0);
    const Eigen::VectorXd weight = s.before->row_scale.cwiseAbs2(), left = s.before->residual.cwiseAbs2(),
                          less = s.with->residual.cwiseAbs2();
    Eigen::Index first = 0, some = 0;
    for (const Balance &b : s.rover.data.balance) {
        const auto n = static_cast<Eigen::Index>(b.measured.size());
        const auto sum = [&](const Eigen::VectorXd &rows) { return rows.segment(first, n).dot(weight.segment(first, n)); };
        if (sum(beside.squares) > 0) {
            const double part = std::clamp((sum(left) - sum(less)) / sum(beside.squares), 0.0, 1.0);
            for (Eigen::Index r = 0; r < n; ++r) EXPECT_NEAR(beside.part[first + r], part, 1e-9) << b.name;
            some += part > 0.01;
        }
        first += n;
    }
    EXPECT_GT(some, 0);
    const Eigen::VectorXd fall = squares_fall(s.left_before, s.left_with), smoothed = beside.smoothed_by(s.rover.data, s.with->physics());
    ASSERT_GT(std::fabs(smoothed.dot(weight)), 1e-3);
    const Evidence e = s.evidence(); // the slope's, which that fit is of
    EXPECT_NEAR(e.scaled.sum, (fall - smoothed).dot(weight), 1e-9 * e.scaled.sum);
}

TEST(Evidence, of_what_moves_the_body_is_less_by_what_it_smooths) {
    Sloped s(0.1);
    ASSERT_FALSE(s.grade.effect.empty());
    const Evidence e = s.evidence();
    const Eigen::VectorXd fall = squares_fall(s.left_before, s.left_with), smoothed = s.smoothed(*s.with);
    ASSERT_GT(std::fabs(smoothed.dot(s.before->row_scale.cwiseAbs2())), 1e-3);
    EXPECT_NEAR(e.scaled.sum, (fall - smoothed).dot(s.before->row_scale.cwiseAbs2()), 1e-9 * e.scaled.sum);
    EXPECT_NEAR(e.noise.sum, (fall - smoothed).dot(noise_weight(*s.before)), 1e-9 * e.noise.sum);
    EXPECT_TRUE(e.falls() && !e.smooths);
}

TEST(Evidence, is_none_below_a_twentieth_of_what_may_be_scatter) {
    Sloped s(0); // nothing is hidden: with the slope it leaves the same
    s.with->theta.head(s.before->theta.size()) = s.before->theta;
    s.with->theta.tail(1).setZero();
    s.with->jacobian.resize(0, 0);
    s.with->linearise();
    const double all = s.left_before.residual.cwiseAbs2().dot(s.before->row_scale.cwiseAbs2()), least = s.least();
    ASSERT_GT(least, 1); // beside what the slope fits of the noise, about a square
    ASSERT_LT(least, 0.5 * all);
    for (const double times : {0.98, 1.02}) {
        s.left_with = s.left_before;
        s.left_with.residual *= std::sqrt(1 - times * least / all);
        EXPECT_EQ(s.evidence().smooths, times < 1) << times;
        EXPECT_EQ(s.evidence().scaled.sum > 0.9 * least, times > 1); // asked on the ground as it was there is none at all
    }
}

// The ground that is fitted beside it is softer, and follows the encoders less: what is left is judged with the ground as it was.
TEST(Evidence, of_a_law_beside_a_softer_ground_is_asked_on_the_ground_as_it_was) {
    for (const double slope : {0.1, 0.0}) {
        Sloped s(slope);
        s.soften();
        s.with->jacobian.resize(0, 0);
        s.with->linearise();
        s.left_with = s.left_before; // so soft, it predicts no better
        ASSERT_GT(s.smoothed(*s.with).dot(s.before->row_scale.cwiseAbs2()), 0);
        const Evidence e = s.evidence();
        EXPECT_EQ(e.smooths, slope == 0);
        const Problem on_ground = held_ground(*s.with, *s.before);
        const Eigen::VectorXd wanted = squares_fall(s.left_before, held_out(on_ground)) - s.smoothed(on_ground);
        EXPECT_NEAR(e.scaled.sum, wanted.dot(s.before->row_scale.cwiseAbs2()), 1e-6);
        EXPECT_NEAR(e.noise.sum, wanted.dot(noise_weight(*s.before)), 1e-6);
        EXPECT_EQ(e.falls(), slope > 0);
    }
}

// A tick of 0.1 s, tau = (0.002 + 6 * 0.05^2 / 4) 3 / 0.3^2 = 0.1917 s: 0.261.
TEST(Evidence, of_an_accelerometers_scale_is_more_than_what_reading_it_once_a_tick_makes) {
    FourWheels rover;
    const Physics physics = make_physics(rover.model);
    EXPECT_NEAR(sawtooth_share(rover.data, physics), 0.5 * 0.1 / 0.1917, 0.001);
    Dataset unknown = rover.data;
    for (WheelInput &w : unknown.wheel) w.voltage_t_s.clear();
    EXPECT_EQ(sawtooth_share(unknown, physics), 0);
    Candidate scale = touching(stage_sensors);
    scale.effect = "accel_scale";
    Candidate other = scale;
    other.effect = "accel_tilt";
    for (const double change : {-0.28, 0.28, 0.35}) { // 1.2 * 0.261 = 0.313
        Physics moved = physics;
        moved.body.accel_scale = change;
        Problem before(rover.data, physics, {}), with(rover.data, moved, {});
        before.linearise(), with.linearise();
        const HeldOut left_before = as_fitted(before), left_with = as_fitted(with);
        EXPECT_EQ(evidence_of(scale, before, left_before, with, left_with).smooths, std::fabs(change) < 0.313) << change;
        EXPECT_FALSE(evidence_of(other, before, left_before, with, left_with).smooths) << change;
    }
}

TEST(Spared, are_the_squared_stated_deviations_that_a_name_leaves) {
    const Dataset data = data_of(1, 4, 0.5);
    Problem before = problem_of(data, {parameter("a", "x", 1, 0.5), parameter("b", "x", 1, 2), parameter("c", "x", 1, 0)},
                                Eigen::MatrixXd::Zero(4, 3), Eigen::VectorXd::Zero(4));
    Problem with = before;
    before.theta << 1.5, -2, 7; // three deviations and one; of the third nothing is stated
    with.theta << 0.5, 0, 0;
    before.parameters[0].alike = with.parameters[0].alike = 4; // counted as stated
    EXPECT_DOUBLE_EQ(spared_by(before, with), 9 + 1 - 1);
    EXPECT_DOUBLE_EQ(spared_by(with, before), -9);
}

TEST(Support, is_of_the_rows_or_of_the_sheet_and_told_beside_a_tolerance_that_does_as_much) {
    const auto evidence = [](double sum) {
        Evidence e;
        e.scaled.sum = e.noise.sum = sum, e.scaled.error = e.noise.error = 1;
        return e;
    };
    ToleranceRival weak{"tolerance of the mass", 0, 1, 0}, strong = weak;
    weak.lead = 100, strong.lead = 0;
    const auto is = [](const Support &s, bool enough, bool as_much) { return s.enough == enough && s.tolerance_as_much == as_much; };
    EXPECT_TRUE(is(support_of(evidence(5), std::nullopt, 0, 9), true, false));
    EXPECT_TRUE(is(support_of(evidence(5), weak, 0, 9), true, false));
    EXPECT_TRUE(is(support_of(evidence(5), strong, 0, 9), true, true));
    EXPECT_FALSE(support_of(evidence(0.5), std::nullopt, 100, 9).enough); // no number is stated: nothing gives way
    EXPECT_TRUE(is(support_of(evidence(0.5), weak, 100, 9), true, true)); // the sheet decides, and is told beside it
    EXPECT_FALSE(support_of(evidence(0.5), weak, 9.4, 9).enough);         // 0.5 + 9.4 > 9 + 1 is not
    EXPECT_TRUE(support_of(evidence(0.5), weak, 9.6, 9).enough);
    EXPECT_FALSE(support_of(evidence(-3), weak, 100, 9).enough); // what is left out is predicted worse
    Evidence smooth = evidence(5);
    smooth.smooths = true;
    EXPECT_TRUE(is(support_of(smooth, weak, 100, 9), false, false));
}

// The search begins anew from where a refit has found the baseline a better place, by nine squares at least.
TEST(Round, begins_anew_only_from_a_place_that_is_better_by_nine_squares) {
    LinearMachine m;
    m.hide(a2(), 0.02);
    const auto at = [&](double off) { // of the optimum, in squares of rows and priors
        Problem p(m.data, m.physics, {a0(0.2), r0(0.05)});
        p.gauss_newton(2);
        Eigen::MatrixXd normal = p.jacobian.transpose() * p.jacobian;
        normal.diagonal() += p.prior_precision();
        p.theta[1] += std::sqrt(off / normal(1, 1));
        return p;
    };
    Problem best = at(0);
    const double least = best.cost();
    EXPECT_NEAR(at(20).cost(), least + 20, 0.01);
    Trial refitted;
    refitted.baseline = best.theta;
    EXPECT_FALSE(fitted_from(refitted, at(8.9)));
    EXPECT_TRUE(fitted_from(refitted, at(9.1)));
    refitted.baseline[0] += 0.05, refitted.baseline[1] = 10; // a place that is none itself, and beyond a bound: what it leads to counts
    const std::optional<Problem> moved = fitted_from(refitted, at(20));
    ASSERT_TRUE(moved);
    Problem anew(m.data, m.physics, {a0(0.2), r0(0.05)});
    anew.fit({});
    EXPECT_LT((moved->theta - anew.theta).norm(), 1e-4); // on scales of its own
    EXPECT_LT((moved->row_scale - anew.row_scale).norm(), 1e-3 * anew.row_scale.norm());
    EXPECT_EQ(moved->jacobian.cols(), 2);
}

} // namespace
} // namespace traction::lab
