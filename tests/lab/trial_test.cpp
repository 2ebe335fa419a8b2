// One candidate tried against one baseline (trial.h) on a machine that is linear in all that is fitted: step, scan and refit have textbook
// answers. What is said of a law that moves the body is asked of one whose stages are only called so.
#include "host_tools/lab/decision/trial.h"
#include "host_tools/lab/fit/distribution.h"
#include "tests/lab/linear_machine.h"

#include <functional>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace traction::lab {
namespace {

using namespace hand_made;

// An offset of the radar's scale from -2 to 2, worth knowing from 0.02 on, beside three stated numbers of the sensors.
struct Asked {
    LinearMachine machine;
    Model model;
    std::vector<FreeParameter> own = {a0(0.2), r0(0.05), g0()};
    std::unique_ptr<Problem> base;
    std::unique_ptr<Screen> screen;
    Candidate c;

    explicit Asked(double hidden, std::size_t rows = 120) : machine(rows) {
        model.motion = BodyMotion::imposed;
        machine.hide(r1(), hidden);
        base = std::make_unique<Problem>(machine.data, make_physics(model), own);
        base->gauss_newton(2);
        screen = std::make_unique<Screen>(*base);
        c.effect = "radar_scale";
        c.strengths = {r1()};
        c.strengths[0].minimum = -2, c.strengths[0].maximum = 2;
        c.of_interest = {0.02};
        c.minimum = {-2}, c.maximum = {2};
        c.step = {1e-3};
        c.touched = stage_sensors;
    }
    Trial stepped(const Candidate &one) {
        Columns::Cache cache;
        Columns columns(*base, cache);
        return screen_candidate(one, *screen, columns);
    }
    Trial stepped() { return stepped(c); }
    // Least squares of rows and priors with the strength at `size`.
    double error_at(double size) const {
        const Eigen::MatrixXd J = machine.columns(own);
        const Eigen::VectorXd y = machine.left() - machine.columns({r1()}) * size, precision = base->prior_precision(),
                              theta = ridge(J, y, Eigen::VectorXd::Ones(y.size()), precision);
        return (y - J * theta).squaredNorm() + theta.cwiseAbs2().dot(precision);
    }
    Eigen::VectorXd joint() const {
        std::vector<FreeParameter> all = own;
        all.push_back(r1());
        Eigen::VectorXd precision = Eigen::VectorXd::Zero(4);
        precision.head(3) = base->prior_precision();
        return ridge(machine.columns(all), machine.left(), Eigen::VectorXd::Ones(machine.rows()), precision);
    }
};

TEST(Step, of_a_candidate_is_the_linear_assessment_with_its_p_corrected_for_all_that_are_tried) {
    Asked a(0.06);
    a.c.variants = 3;
    const Trial t = a.stepped();
    const Assessment by = a.screen->assess(a.machine.columns({r1()}), Eigen::VectorXd::Zero(1), false);
    ASSERT_EQ(t.value.size(), 1U);
    EXPECT_NEAR(t.value[0], by.strength[0], 1e-9);
    EXPECT_NEAR(t.error[0], by.standard_error[0], 1e-9);
    EXPECT_NEAR(t.half_width[0], t_quantile(0.05, by.freedom) * by.standard_error[0], 1e-9);
    EXPECT_NEAR(t.error_reduction, a.screen->error() - a.error_at(t.value[0]), 1e-6);
    EXPECT_NEAR(t.gain, by.gain, 1e-6);
    EXPECT_NEAR(t.gain_error, by.gain_error, 1e-6);
    const double ranks = signed_rank_tail({by.block_gain.begin(), by.block_gain.end()}), tried = 3 * 26;
    EXPECT_NEAR(t.own_p_value, std::min(1.0, 1.25 * tried * by.p_value), 1e-9);
    EXPECT_NEAR(t.p_value, std::min(t.own_p_value, 5 * tried * ranks), 1e-9); // four to one: 1 / 1.25 + 1 / 5 = 1
    EXPECT_FALSE(t.refitted);
    EXPECT_FALSE(t.leaves_active_set);
    EXPECT_EQ(t.candidate.label(), "radar_scale");
}

TEST(Step, that_is_sure_tells_the_balance_that_falls_most) {
    Asked sure(1), unsure(0);
    const Trial t = sure.stepped();
    EXPECT_LT(t.p_value, 0.01);
    EXPECT_NEAR(t.best_balance_gain, sure.screen->best_balance_fall(sure.machine.columns({r1()}), t.assessment), 1e-9);
    EXPECT_GT(t.best_balance_gain, 0.1);
    EXPECT_EQ(unsure.stepped().best_balance_gain, 0);
    int below = 0, above = 0; // sizes whose p is about 0.01
    for (double size = 0.1; size < 1; size += 0.005) {
        Asked near(size);
        const Trial one = near.stepped();
        if (one.p_value > 0.006 && one.p_value < 0.02) {
            EXPECT_EQ(one.best_balance_gain > 0, one.p_value < 0.01) << one.p_value;
            ++(one.p_value < 0.01 ? below : above);
        }
    }
    EXPECT_TRUE(below > 0 && above > 0);
}

TEST(Step, of_a_sign_that_cannot_be_predicts_nothing) {
    Asked a(-0.5);
    EXPECT_GT(a.stepped().error_reduction, 1);
    a.c.minimum = {0};
    const Trial t = a.stepped();
    EXPECT_LT(t.value[0], 0);
    EXPECT_EQ(t.error_reduction, 0);
    EXPECT_GT(t.gain, 1); // what it would gain is told all the same
    Asked other(0.5);
    other.c.minimum = {0};
    EXPECT_GT(other.stepped().error_reduction, 1);
}

// The offset has taken the stated scale to its limit; with it in, the scale goes back.
TEST(Step, that_takes_a_number_off_its_limit_says_so) {
    Asked a(1.5, 400);
    ASSERT_TRUE(a.base->at_bound(1));
    const Trial t = a.stepped();
    EXPECT_TRUE(t.leaves_active_set);
    // though it acts on sensors alone, such a step is no fit: the refit ends at the joint optimum
    Trial fitted = t;
    refit(fitted, *a.base, *a.screen);
    EXPECT_NEAR(fitted.value[0], a.joint()[3], 1e-5);
    EXPECT_LT((fitted.baseline - a.joint().head(3)).norm(), 1e-5);
}

// The error is a parabola of the size about the joint optimum.
struct Scanned : Asked {
    using Asked::Asked;
    Trial at(double value, double of_interest = 0.02, const char *effect = "radar_scale") {
        c.touched = stage_motion;
        c.of_interest = {of_interest};
        c.effect = effect;
        Trial t;
        t.candidate = c;
        t.value = {value};
        scan(t, *base, *screen);
        return t;
    }
    void expect_start(const Trial &t, double size) {
        ASSERT_EQ(t.start.size(), 1U);
        EXPECT_DOUBLE_EQ(t.start[0], size);
        EXPECT_NEAR(t.error_reduction, screen->error() - error_at(size), 1e-6);
        EXPECT_NEAR(t.nonlinear_reduction, t.error_reduction - 0, 1e-6);
        const Eigen::MatrixXd J = machine.columns(own);
        const Eigen::VectorXd y = machine.left() - machine.columns({r1()}) * size;
        EXPECT_LT((base->theta + t.start_change - ridge(J, y, Eigen::VectorXd::Ones(y.size()), base->prior_precision())).norm(), 1e-6);
    }
};

TEST(Scan, begins_at_the_step_twice_the_step_or_half_of_the_range_whichever_is_best) {
    Scanned s(1);
    ASSERT_NEAR(s.joint()[3], 1, 0.15);
    s.expect_start(s.at(0.3), 1.0);  // half of 2
    s.expect_start(s.at(0.55), 1.0); // 0.55 and 1.1 are as near or farther
    s.c.maximum = {0.9};
    s.expect_start(s.at(0.5), 0.9); // twice the step, clamped
    s.c.maximum = {2};
    Scanned down(-1);
    down.c.minimum = {-1.6};
    down.expect_start(down.at(-0.3), -0.8); // half of the range on its side
}

TEST(Scan, of_a_step_to_a_side_that_is_none_goes_over_the_range_that_there_is) {
    Scanned s(1);
    s.c.minimum = {0}, s.c.strengths[0].minimum = 0;
    s.expect_start(s.at(-0.3), 1.0); // half of the range
}

TEST(Scan, of_a_small_step_goes_over_a_tenth_a_quarter_and_a_half_of_the_range) {
    for (const auto &[hidden, start] : {std::pair{0.2, 0.2}, std::pair{0.5, 0.5}, std::pair{1.0, 1.0}}) {
        Scanned s(hidden);
        ASSERT_NEAR(s.joint()[3], hidden, 0.1);
        s.expect_start(s.at(0.01), start);
    }
    Scanned none(0.03); // a step of a tenth and more is no small one: then a tenth is not asked
    const Trial t = none.at(0.21);
    EXPECT_TRUE(t.start.empty() || t.start[0] != 0.2);
    Scanned twice(0.42, 400);
    twice.expect_start(twice.at(0.21), 0.42); // of 0.21, 0.42 and 1; a small step would have been asked at 0.5
}

TEST(Scan, of_a_slope_that_says_little_begins_at_the_size_of_interest_and_goes_to_four_fifths) {
    for (const auto &[hidden, start] : {std::pair{1.6, 1.6}, std::pair{1.0, 1.0}, std::pair{0.05, 0.06}}) {
        Scanned s(hidden, 400);
        s.expect_start(s.at(1e-4, 0.06, "backlash"), start);
    }
    // a first size that is worse stops nothing: what bends may be better farther on
    Scanned s(1.6, 400);
    s.expect_start(s.at(1e-4, -0.9, "relaxation_length"), 1.6);
}

TEST(Scan, ends_where_the_error_has_risen_by_a_fiftieth_and_leaves_out_what_is_of_no_interest) {
    Scanned s(0);
    const Trial t = s.at(0.3);
    EXPECT_TRUE(t.start.empty()); // all sizes are worse
    EXPECT_EQ(t.error_reduction, 0);
    Scanned tiny(0.03, 400);
    EXPECT_FALSE(tiny.at(0.03, 0.29).start.empty());
    EXPECT_TRUE(tiny.at(0.03, 0.31).start.empty() || tiny.at(0.03, 0.31).start[0] > 0.031); // less than a tenth of interest
}

TEST(Scan, is_of_one_strength_that_moves_the_body_and_has_a_range) {
    const auto scanned = [](const std::function<void(Candidate &)> &change) {
        Scanned s(1);
        s.c.touched = stage_motion, s.c.of_interest = {0.02};
        Trial t;
        t.candidate = s.c, t.value = {0.3}, t.error_reduction = 5;
        change(t.candidate);
        scan(t, *s.base, *s.screen);
        return !t.start.empty() || t.error_reduction != 5;
    };
    EXPECT_TRUE(scanned([](Candidate &) {}));
    EXPECT_FALSE(scanned([](Candidate &c) { c.touched = stage_sensors; }));
    EXPECT_FALSE(scanned([](Candidate &c) { c.strengths.push_back(c.strengths[0]); }));
    EXPECT_FALSE(scanned([](Candidate &c) { c.maximum.clear(); }));
}

TEST(Scan, keeps_the_fall_that_the_step_saw_where_the_sizes_see_less) {
    Scanned s(1);
    s.c.touched = stage_motion;
    Trial t = s.stepped();
    const double step = t.error_reduction;
    scan(t, *s.base, *s.screen);
    EXPECT_NEAR(t.error_reduction, step, 1e-6); // the step is the optimum of a parabola
    EXPECT_NEAR(t.nonlinear_reduction, 0, 1e-6);
    Trial less = s.at(0.3);
    const double seen = less.error_reduction;
    less.error_reduction = 0.5 * seen, less.start.clear();
    scan(less, *s.base, *s.screen);
    EXPECT_NEAR(less.error_reduction, seen, 1e-6);
    EXPECT_NEAR(less.nonlinear_reduction, 0.5 * seen, 1e-6);
}

// Whatever the way: the step where that is the fit, beside sensitivities that are kept, or with fresh ones.
TEST(Refit, of_what_is_linear_ends_at_the_joint_regression) {
    for (const unsigned touched : {unsigned(stage_sensors), unsigned(stage_sensors | stage_torque), unsigned(stage_sensors | stage_motion)})
        for (const double start : {1e9, 1e-9, 0.4, -0.7}) {
            Asked a(0.8);
            a.c.touched = touched;
            Trial t = a.stepped();
            if (std::fabs(start) < 1e8) t.start = {start}, t.start_change = Eigen::VectorXd::Zero(3);
            const double step_gain = t.gain, step_fall = t.error_reduction;
            if (touched != stage_sensors) t.error_reduction = t.gain = -1; // reckoned anew, but where the step is the fit
            refit(t, *a.base, *a.screen);
            EXPECT_TRUE(t.refitted);
            ASSERT_EQ(t.value.size(), 1U);
            EXPECT_NEAR(t.value[0], a.joint()[3], 1e-5) << touched << ' ' << start;
            EXPECT_LT((t.baseline - a.joint().head(3)).norm(), 1e-5) << touched << ' ' << start;
            EXPECT_NEAR(t.error_reduction, step_fall, 1e-5); // of a linear machine the step has told all
            EXPECT_NEAR(t.gain, step_gain, 1e-4);
            EXPECT_NEAR(t.gain_error, sum_error(t.block_gain), 1e-9);
            EXPECT_NEAR(t.block_gain.sum() + t.assessment.prior_reduction, t.gain, 1e-6);
        }
}

TEST(Refit, tells_of_its_place_what_the_step_told_from_afar) {
    Asked a(0.8);
    const Trial step = a.stepped();
    a.c.touched = stage_sensors | stage_torque;
    Trial t = a.stepped();
    refit(t, *a.base, *a.screen);
    EXPECT_NEAR(t.error[0], step.error[0], 1e-5);
    EXPECT_NEAR(t.half_width[0], step.half_width[0], 1e-4);
    EXPECT_LT((t.block_gain - step.block_gain).norm(), 1e-4);
    EXPECT_NEAR(t.assessment.spared, step.assessment.spared, 1e-5);
    EXPECT_NEAR(t.assessment.prior_reduction, step.assessment.prior_reduction, 1e-5);
    EXPECT_NEAR(std::log(t.p_value), std::log(step.p_value), 1e-3);
    EXPECT_NEAR(std::log(t.own_p_value), std::log(step.own_p_value), 1e-3);
    EXPECT_EQ(t.assessment.projected.size(), a.machine.rows() + 3); // rows, and a row per prior
    // of blocks left out, the balance that falls most
    std::vector<FreeParameter> all = a.own;
    all.push_back(r1());
    Problem joint(a.machine.data, make_physics(a.model), all);
    joint.gauss_newton(2);
    const std::vector<double> before = a.screen->heldout_by_balance(), after = Screen(joint).heldout_by_balance();
    double most = 0;
    for (std::size_t b = 0; b < 3; ++b) most = std::max(most, 1 - after[b] / before[b]);
    EXPECT_NEAR(t.best_balance_gain, most, 1e-5);
    EXPECT_EQ(most, 1 - after[1] / before[1]); // the radar's
}

TEST(Refit, keeps_within_the_range_and_starts_within_it) {
    Asked a(1.5, 400);
    for (const unsigned touched : {unsigned(stage_sensors | stage_torque), unsigned(stage_sensors | stage_motion)}) {
        a.c.touched = touched;
        a.c.strengths[0].maximum = 0.5, a.c.maximum = {0.5};
        Trial t = a.stepped();
        refit(t, *a.base, *a.screen);
        EXPECT_NEAR(t.value[0], 0.5, 1e-9);
        EXPECT_TRUE(beyond_range(t.candidate, t.value));
    }
}

TEST(Range, of_two_sizes_is_left_by_either) {
    Candidate c = candidate("a");
    c.strengths.push_back(c.strengths[0]);
    EXPECT_FALSE(beyond_range(c, {0.5, 0.5}));
    EXPECT_TRUE(beyond_range(c, {0.5, 1}));
    EXPECT_TRUE(beyond_range(c, {1, 0.5}));
    c.strengths[1].minimum = -3; // of a range of four, a slack of 4e-6
    EXPECT_TRUE(beyond_range(c, {0.5, -3 + 3.9e-6}));
    EXPECT_FALSE(beyond_range(c, {0.5, -3 + 4.1e-6}));
    EXPECT_TRUE(beyond_range(c, {0.5, 1 - 3.9e-6}));
    EXPECT_FALSE(beyond_range(c, {0.5, 1 - 4.1e-6}));
}

TEST(Judge, takes_a_negative_size_of_what_may_have_either_sign_alone) {
    Trial t;
    t.candidate = candidate("a");
    t.candidate.strengths.push_back(t.candidate.strengths[0]);
    t.candidate.of_interest = {0.1, 0.1}, t.candidate.minimum = {-1, 0}, t.candidate.maximum = {1, 1};
    t.gain = 1000, t.p_value = t.own_p_value = 0;
    const auto verdict = [&](std::vector<double> value) {
        t.value = std::move(value);
        judge(t, 2500, {});
        return t.verdict;
    };
    EXPECT_EQ(verdict({-0.5, 0.5}), "passes");
    EXPECT_EQ(verdict({0.5, -0.5}), "wrong_sign");
    EXPECT_EQ(verdict({-0.5, 0}), "passes");
    t.candidate.minimum.clear(); // of which no range is known
    EXPECT_EQ(verdict({-0.5, -0.5}), "passes");
    EXPECT_EQ(verdict({0.07, 0.07}), "too_small"); // together 0.099
    EXPECT_EQ(verdict({0.08, 0.07}), "passes");
    t.candidate.of_interest.clear();
    EXPECT_EQ(verdict({1e-9, 0}), "passes");
}

// A relaxation length of 0.13 m was 0.013 by its linear step, and not asked for that.
TEST(Judge, finds_a_law_that_remembers_too_small_by_its_own_fit_alone) {
    Trial t;
    t.gain = 1000, t.p_value = t.own_p_value = 0, t.value = {0.01};
    for (const bool refitted : {false, true})
        for (const char *effect : {"relaxation_length", "backlash", "body_drag"}) {
            t.candidate = candidate(effect); // of interest from 0.1 on
            t.refitted = refitted, t.half_width = {0};
            judge(t, 2500, {});
            EXPECT_EQ(t.verdict, refitted || !strongly_nonlinear(effect) ? "too_small" : "passes") << effect << " " << refitted;
        }
}

TEST(Nonlinear, are_play_and_lag_alone) {
    EXPECT_TRUE(strongly_nonlinear("backlash") && strongly_nonlinear("relaxation_length"));
    EXPECT_FALSE(strongly_nonlinear("body_drag") || strongly_nonlinear("") || strongly_nonlinear("slip_sinkage"));
}

TEST(Solid, is_an_effect_larger_than_its_uncertainty_in_one_strength_and_of_interest) {
    CandidateResult r;
    r.candidate = candidate("a"); // of interest from 0.1 on
    const auto is = [&](double value, double low, double high) {
        r.value = {value}, r.low = {low}, r.high = {high};
        return is_solid(r);
    };
    EXPECT_TRUE(is(0.5, 0.01, 0.99));
    EXPECT_FALSE(is(0.5, -0.01, 1.01));
    EXPECT_FALSE(is(0.5, 0, 1));
    EXPECT_TRUE(is(-0.5, -0.99, -0.01));
    EXPECT_FALSE(is(0.09, 0.08, 0.1));
    r.candidate.strengths.resize(2), r.candidate.of_interest = {0.1, 0.1};
    r.value = {0.01, 0.5}, r.low = {-0.1, 0.4}, r.high = {0.12, 0.6};
    EXPECT_TRUE(is_solid(r));
    r.low[1] = -0.1;
    EXPECT_FALSE(is_solid(r));
}

// The radar's own scale is of the soil in this machine: held where it stood without the candidate, the candidate takes all that is left.
TEST(Ground, is_held_where_it_stood_and_the_rest_is_fitted_to_it) {
    const Asked asked(0.5);
    std::vector<FreeParameter> all = asked.own;
    all.push_back(r1());
    Problem with(asked.machine.data, asked.base->physics(), all);
    with.keep_scales(*asked.base);
    with.gauss_newton(2);
    Problem before = *asked.base;
    before.theta[1] = 0.3;
    const Problem held = held_ground(with, before);
    EXPECT_NEAR(held.theta[1], 0.3, 1e-12);
    EXPECT_NEAR(held.parameters[1].minimum, held.parameters[1].base + 0.3, 1e-12);
    EXPECT_NEAR(held.parameters[1].maximum, held.parameters[1].base + 0.3, 1e-12);
    // r0 and r1 do the same, by the same rows: their sum stays, less what r0's stated deviation pulls of it
    EXPECT_NEAR(held.theta[1] + held.theta[3], with.theta[1] + with.theta[3], 1e-3);
    EXPECT_GT(std::fabs(with.theta[1] - 0.3), 0.1);
    EXPECT_NEAR(held.theta[0], with.theta[0], 1e-3); // the others are where they were
    EXPECT_EQ(held.parameters[0].minimum, with.parameters[0].minimum);
}

} // namespace
} // namespace traction::lab
