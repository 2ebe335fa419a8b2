// The lab's decision rules one by one, on trials made by hand and on a log of a few seconds: the answer follows from the rule's own words
// (docs/lab_method.md), so that a rule which is changed by accident is noticed within seconds.
#include "host_tools/lab/decision/classes.h"
#include "host_tools/lab/decision/tolerance.h"
#include "host_tools/lab/decision/trial.h"
#include "host_tools/lab/fit/distribution.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "sim/physics/effects/catalogue.h"
#include "tests/lab/generator/generator.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace traction::lab {
namespace {

constexpr double base_error = 1000;

// A candidate of one strength between 0 and 1, worth knowing from 0.1 on.
Candidate candidate(const std::string &effect, int wheel = -1) {
    Candidate c;
    c.effect = effect;
    c.wheel = wheel;
    FreeParameter p;
    p.key = "size";
    p.minimum = 0, p.maximum = 1;
    c.strengths = {p};
    c.of_interest = {0.1};
    c.minimum = {0}, c.maximum = {1};
    return c;
}

// Explains a tenth of the held-out error, evenly over ten blocks, and is sure: it passes.
Trial good(const std::string &effect, int wheel = -1) {
    Trial t;
    t.candidate = candidate(effect, wheel);
    t.value = {0.5}, t.error = {0.05}, t.half_width = {0.11};
    t.gain = 100, t.gain_error = 10, t.best_balance_gain = 0.1;
    t.error_reduction = 110;
    t.p_value = t.own_p_value = 1e-6;
    t.block_gain = Eigen::VectorXd::Constant(10, 10.0);
    t.assessment.projected = Eigen::VectorXd::Unit(3, 0);
    t.refitted = true;
    return t;
}

std::string verdict_of(Trial t, const DiagnoseOptions &options = {}) {
    judge(t, base_error, options);
    return t.verdict;
}

TEST(Judge, passes_what_is_sure_large_and_helps) { EXPECT_EQ(verdict_of(good("a")), "passes"); }

TEST(Judge, asks_for_the_corrected_p_of_its_limit) {
    const DiagnoseOptions options;
    Trial t = good("a");
    t.p_value = 0.99 * options.p_limit;
    EXPECT_EQ(verdict_of(t), "passes");
    t.p_value = options.p_limit; // strictly below
    EXPECT_EQ(verdict_of(t), "not_significant");
    EXPECT_LE(options.p_limit, 0.003); // docs/evidence.md, section 5: at 0.01 uneven ground is named as soil effects
}

TEST(Judge, asks_for_a_fall_of_the_held_out_error_in_all_or_one_balance_or_of_the_priors) {
    const DiagnoseOptions options;
    Trial t = good("a");
    t.gain = 1.01 * options.least_gain * base_error, t.best_balance_gain = 0;
    EXPECT_EQ(verdict_of(t), "passes");
    t.gain = 0.99 * options.least_gain * base_error;
    EXPECT_EQ(verdict_of(t), "not_significant");
    t.best_balance_gain = 1.01 * options.least_gain_one;
    EXPECT_EQ(verdict_of(t), "passes");
    t.best_balance_gain = 0.99 * options.least_gain_one;
    EXPECT_EQ(verdict_of(t), "not_significant");
    t.assessment.spared = 1.01 * options.least_prior_reduction;
    EXPECT_EQ(verdict_of(t), "passes");
    t.assessment.spared = 0.99 * options.least_prior_reduction;
    EXPECT_EQ(verdict_of(t), "not_significant");
}

// Of what is left beyond the sensors' noise: the same effect under ten times the noise explains a smaller share of all, and as much of what
// can be explained. Where hardly anything can, three deviations of white noise.
TEST(Judge, asks_for_a_share_of_what_is_not_noise_and_for_three_deviations_at_least) {
    const DiagnoseOptions options;
    Trial t = good("a");
    t.best_balance_gain = 0;
    const auto with = [&](double gain, double explainable) {
        t.gain = gain;
        judge(t, explainable, options);
        return t.verdict;
    };
    EXPECT_EQ(with(21, 2000), "passes");
    EXPECT_EQ(with(19, 2000), "not_significant");
    EXPECT_EQ(with(9.1, 100), "passes");
    EXPECT_EQ(with(8.9, 100), "not_significant");
    EXPECT_EQ(with(9.1, 0), "passes");
    EXPECT_EQ(with(8.9, 0), "not_significant");
}

TEST(Judge, believes_no_relief_of_priors_and_no_single_balance_where_the_held_out_error_rises) {
    Trial t = good("a");
    t.gain = -1, t.best_balance_gain = 0.5, t.assessment.spared = 100;
    EXPECT_EQ(verdict_of(t), "not_significant");
    t.gain = 0;
    EXPECT_EQ(verdict_of(t), "not_significant");
}

// Ranks of the held-out falls know nothing of the priors: where only the priors are relieved, the coefficient's own test decides.
TEST(Judge, lets_the_ranks_speak_only_where_rows_fell) {
    Trial t = good("a");
    t.own_p_value = 0.5;
    EXPECT_EQ(verdict_of(t), "passes");
    t.gain = 1, t.best_balance_gain = 0, t.assessment.spared = 100;
    EXPECT_EQ(verdict_of(t), "not_significant");
    t.own_p_value = 1e-6;
    EXPECT_EQ(verdict_of(t), "passes");
}

// Sizes of interest are guesses about machines: what takes half of all that is no noise is of interest whatever its size.
TEST(Judge, asks_no_size_of_what_takes_most_of_the_error) {
    const DiagnoseOptions options;
    Trial t = good("a");
    t.value = {0.02}, t.half_width = {0.001};
    t.gain = 99;
    judge(t, 200, options);
    EXPECT_EQ(t.verdict, "too_small");
    t.gain = 101;
    judge(t, 200, options);
    EXPECT_EQ(t.verdict, "passes");
    t.gain = 101, t.value = {-0.02}; // a sign that cannot be is none all the same
    judge(t, 200, options);
    EXPECT_EQ(t.verdict, "wrong_sign");
    CandidateResult named;
    named.candidate = t.candidate, named.value = {0.02}, named.low = {0.019}, named.high = {0.021};
    EXPECT_FALSE(is_solid(named));
    named.matters = true;
    EXPECT_TRUE(is_solid(named));
}

TEST(Judge, refuses_a_wrong_sign_a_size_of_no_interest_and_one_at_its_bound) {
    Trial t = good("a");
    t.value = {-0.5};
    EXPECT_EQ(verdict_of(t), "wrong_sign");
    t.candidate.minimum = {-1}, t.candidate.strengths[0].minimum = -1; // a size that may be either
    EXPECT_EQ(verdict_of(t), "passes");
    t = good("a");
    t.value = {0.0999 + t.half_width[0]}; // surely of interest: the nearer end of the 95 % interval is
    EXPECT_EQ(verdict_of(t), "too_small");
    t.value = {-0.5}, t.half_width = {0.5001}, t.candidate.minimum = {-1}, t.candidate.strengths[0].minimum = -1;
    EXPECT_EQ(verdict_of(t), "too_small"); // the interval holds zero
    t = good("a");
    t.value = {0.1001 + t.half_width[0]};
    EXPECT_EQ(verdict_of(t), "passes");
    t.refitted = false; // of a linear step the size alone
    t.value = {0.0999};
    EXPECT_EQ(verdict_of(t), "too_small");
    t.value = {0.1001};
    EXPECT_EQ(verdict_of(t), "passes");
    t.refitted = true;
    t.value = {1.0};
    EXPECT_EQ(verdict_of(t), "beyond_range");
    t.refitted = false; // a linear step that leaves the range is no fit yet
    EXPECT_EQ(verdict_of(t), "passes");
}

TEST(Size, of_two_strengths_is_their_root_of_squares_and_must_reach_the_larger_size_of_interest) {
    Candidate c = candidate("ripple");
    c.strengths.push_back(c.strengths[0]);
    c.of_interest = {0.1, 0.2};
    EXPECT_TRUE(large_enough(c, {0.16, 0.13}));  // 0.206
    EXPECT_FALSE(large_enough(c, {0.15, 0.13})); // 0.198
}

TEST(Size, is_beyond_its_range_at_a_bound_that_is_no_natural_end) {
    Candidate c = candidate("a");
    EXPECT_FALSE(beyond_range(c, {0.0})); // no effect at all is no bound
    EXPECT_FALSE(beyond_range(c, {0.999}));
    EXPECT_TRUE(beyond_range(c, {1.0}));
    c.strengths[0].minimum = -1;
    EXPECT_TRUE(beyond_range(c, {-1.0}));
    EXPECT_FALSE(beyond_range(c, {-0.999}));
}

std::vector<std::size_t> class_of(const Trial &winner, const Trial &other) {
    return confounded({winner, other}, 0, base_error, base_error, DiagnoseOptions{});
}

// A relaxation length predicts better by not following the encoders' scatter: refused for that, it may not be meant either.
TEST(Class, holds_nothing_that_only_smooths) {
    Trial other = good("b");
    other.gain = 300, other.error_reduction = 310;
    EXPECT_EQ(class_of(good("a"), other).size(), 1U);
    other.smooths = true;
    EXPECT_TRUE(class_of(good("a"), other).empty());
}

// Alike in the log: the same residual, almost the same gain.
TEST(Class, holds_what_cannot_be_told_from_the_winner) {
    Trial other = good("b");
    other.gain = 95;
    EXPECT_EQ(class_of(good("a"), other), std::vector<std::size_t>{1});
}

TEST(Class, holds_nothing_that_explains_clearly_less) {
    Trial other = good("b");
    other.gain = 89, other.error_reduction = 100; // more than a tenth less
    EXPECT_TRUE(class_of(good("a"), other).empty());
}

// 95 of 100, but 0.5 less in each of ten blocks: the difference is sure, unless the two leave the same trace in the residual.
TEST(Class, tells_two_apart_by_blocks_that_agree_unless_their_traces_are_one) {
    Trial other = good("b");
    other.gain = 95, other.error_reduction = 104;
    other.block_gain = Eigen::VectorXd::Constant(10, 9.5);
    EXPECT_EQ(class_of(good("a"), other).size(), 1U); // one trace
    for (const double size : {1.0, 30.0, 0.03}) {     // a trace is one by its direction
        other.assessment.projected = size * Eigen::Vector3d(0.8, 0.6, 0);
        EXPECT_TRUE(class_of(good("a"), other).empty());
        other.assessment.projected = size * Eigen::Vector3d(0.95, 0.31, 0);
        EXPECT_EQ(class_of(good("a"), other).size(), 1U);
    }
    other.assessment.projected = Eigen::Vector3d(-0.95, 0.31, 0); // nearly parallel, whatever its sign
    EXPECT_EQ(class_of(good("a"), other).size(), 1U);
    other.assessment.projected = Eigen::Vector3d(0.8, 0.6, 0);
    for (int b = 0; b < 10; ++b) other.block_gain[b] += b % 2 == 0 ? 5 : -5; // blocks disagree: the difference may be chance
    EXPECT_EQ(class_of(good("a"), other).size(), 1U);
}

TEST(Class, holds_what_explains_more_than_the_winner) {
    Trial other = good("b");
    other.gain = 60, other.error_reduction = 200;
    EXPECT_EQ(class_of(good("a"), other).size(), 1U);
}

TEST(Class, holds_no_one_that_did_not_pass_or_was_not_fitted) {
    Trial other = good("b");
    other.refitted = false;
    EXPECT_TRUE(class_of(good("a"), other).empty());
    other = good("b");
    other.p_value = 0.04; // not by the limit of names; nearly: where it changes the log alike, or explains more
    EXPECT_EQ(class_of(good("a"), other).size(), 1U);
    other.assessment.projected = Eigen::Vector3d(0.8, 0.6, 0);
    EXPECT_EQ(class_of(good("a"), other).size(), 0U);
    other.error_reduction = 200;
    EXPECT_EQ(class_of(good("a"), other).size(), 1U);
    other.p_value = 0.06;
    EXPECT_TRUE(class_of(good("a"), other).empty());
}

// Named by scales of its own: on those of the baseline nobody of its class is sure.
TEST(Class, of_a_winner_that_the_old_scales_were_not_sure_of_holds_whom_they_do_not_think_unlikely) {
    Trial winner = good("a"), other = good("b");
    other.assessment.projected = Eigen::Vector3d(0.8, 0.6, 0);
    for (int b = 0; b < 10; ++b) other.block_gain[b] += b % 2 == 0 ? 5 : -5; // blocks disagree: which of the two it is may be chance
    other.p_value = 0.3;
    EXPECT_TRUE(class_of(winner, other).empty());
    winner.p_value = 0.1, winner.by_rows = true;
    EXPECT_EQ(class_of(winner, other).size(), 1U);
    other.p_value = 0.46;
    EXPECT_TRUE(class_of(winner, other).empty());
}

TEST(Class, of_one_effect_on_two_wheels_is_a_question_on_all_or_one_is_not) {
    EXPECT_EQ(class_of(good("a", 1), good("a", 3)).size(), 1U);
    EXPECT_TRUE(class_of(good("a"), good("a", 3)).empty());
    EXPECT_TRUE(class_of(good("a", 3), good("a")).empty());
}

// What only the data sheet's tolerances decide: rivals may explain half as much.
TEST(Class, is_wider_where_only_priors_decide) {
    Trial winner = good("a"), other = good("b");
    winner.assessment.prior_reduction = 95, winner.best_balance_gain = 0;
    other.gain = 55, other.error_reduction = 60, other.p_value = 0.04;
    EXPECT_EQ(class_of(winner, other).size(), 1U);
    other.gain = 45;
    EXPECT_TRUE(class_of(winner, other).empty());
    winner.best_balance_gain = 0.1; // one balance fell: rows decide, too
    other.gain = 55;
    EXPECT_TRUE(class_of(winner, other).empty());
}

// Where only priors decide, what the rows say of the difference is scatter: unless it is larger than two standard errors of the paired
// blocks nobody is told apart by it, whatever share it is. (A motor constant 13 % off was called a voltage gain, d' 6.1 against 4.4.)
TEST(Class, holds_whom_the_paired_blocks_do_not_tell_from_a_winner_that_only_priors_decide) {
    Trial winner = good("a"), other = good("b");
    winner.assessment.prior_reduction = 95, winner.best_balance_gain = 0;
    other.gain = 25, other.error_reduction = 60;
    other.assessment.projected = Eigen::Vector3d(0.8, 0.6, 0);
    const auto alternating = [&](double by) { // about 2.5: the sum of the ten differences, 75, has the standard error 10 by / 3
        for (int b = 0; b < 10; ++b) other.block_gain[b] = 2.5 + (b % 2 == 0 ? by : -by);
    };
    alternating(1.01 * 11.25);
    EXPECT_EQ(class_of(winner, other).size(), 1U);
    alternating(0.99 * 11.25);
    EXPECT_TRUE(class_of(winner, other).empty());
    alternating(1.01 * 11.25);
    winner.best_balance_gain = 0.1; // one balance fell: the rows decide
    EXPECT_TRUE(class_of(winner, other).empty());
}

// Nearly all that is left is noise: what the winner explains is much of what can be, and little of all. Rivals may explain half as much.
TEST(Class, is_wider_where_noise_hides_most) {
    Trial winner = good("a"), other = good("b");
    winner.best_balance_gain = other.best_balance_gain = 0;
    other.gain = 55, other.error_reduction = 60, other.p_value = 0.04;
    const DiagnoseOptions options;
    const double noisy = 1.01 * winner.gain / options.least_gain, quiet = 0.99 * winner.gain / options.least_gain;
    EXPECT_EQ(confounded({winner, other}, 0, noisy, base_error, options).size(), 1U);
    EXPECT_TRUE(confounded({winner, other}, 0, quiet, base_error, options).empty());
    EXPECT_TRUE(confounded({winner, other}, 0, noisy, 1.01 * other.gain / options.least_gain, options).empty()); // too little by itself
}

Diagnosis with_class(const std::vector<std::string> &members, const std::vector<std::string> &accepted) {
    Diagnosis d;
    d.classes.push_back({members, ""});
    for (const std::string &name : accepted) {
        CandidateResult r;
        r.candidate = candidate(name);
        r.verdict = name == members.front() ? "class" : "named";
        if (name == members.front()) r.class_index = 0;
        d.accepted.push_back(r);
    }
    d.ranking = d.accepted;
    return d;
}

TEST(Class, of_which_all_were_accepted_is_none) {
    Diagnosis d = with_class({"a", "b"}, {"a", "b"});
    separate_accepted(d);
    EXPECT_TRUE(d.classes.empty());
    EXPECT_EQ(d.accepted[0].verdict, "named");
    EXPECT_FALSE(d.accepted[0].class_index);
}

TEST(Class, keeps_the_members_that_were_not_accepted_beside_it) {
    Diagnosis d = with_class({"a", "b", "c"}, {"a", "b"});
    separate_accepted(d);
    ASSERT_EQ(d.classes.size(), 1U);
    EXPECT_EQ(d.classes[0].members, (std::vector<std::string>{"a", "c"}));
    EXPECT_EQ(d.accepted[0].verdict, "class");
    EXPECT_EQ(*d.accepted[0].class_index, 0);
}

TEST(Class, is_joined_by_what_is_in_no_catalogue_or_made_of_it) {
    Diagnosis d = with_class({"a", "b"}, {"a", "x"});
    join_class(d, 0, "soil strength(time)");
    ASSERT_EQ(d.classes.size(), 1U);
    EXPECT_EQ(d.classes[0].members, (std::vector<std::string>{"a", "b", "soil strength(time)"}));
    join_class(d, 1, "friction(time)");
    ASSERT_EQ(d.classes.size(), 2U);
    EXPECT_EQ(d.classes[1].members, (std::vector<std::string>{"x", "friction(time)"}));
    for (const std::vector<CandidateResult> *list : {&d.accepted, &d.ranking}) {
        EXPECT_EQ((*list)[1].verdict, "class");
        EXPECT_EQ((*list)[1].class_index, 1);
        EXPECT_EQ((*list)[0].class_index, 0);
    }
}

TEST(Class, has_the_effects_of_its_members_whatever_their_wheel) {
    Diagnosis d = with_class({"a", "b on wheel 2", "tolerance of x"}, {"a", "c"});
    EXPECT_EQ(members_of(d, d.accepted[0]), (std::vector<std::string>{"a", "b", "tolerance of x"}));
    EXPECT_TRUE(members_of(d, d.accepted[1]).empty());
}

TEST(Class, that_goes_leaves_the_numbers_of_the_others_right) {
    Diagnosis d = with_class({"a", "b"}, {"a"});
    d.classes.push_back({{"x", "y"}, ""});
    CandidateResult r;
    r.candidate = candidate("x");
    r.verdict = "class";
    r.class_index = 1;
    d.accepted.push_back(r);
    remove_class(d, "a");
    ASSERT_EQ(d.classes.size(), 1U);
    EXPECT_EQ(d.classes[0].members.front(), "x");
    EXPECT_FALSE(d.accepted[0].class_index);
    EXPECT_EQ(*d.accepted[1].class_index, 0);
    remove_class(d, "not there");
    EXPECT_EQ(d.classes.size(), 1U);
}

// 40 s of sand: enough blocks for statistics, little work.
struct Short {
    Model model = read_model("models/rover_sand.toml");
    Dataset data;
    Short() {
        generator::GeneratorConfig config;
        config.duration_s = 40;
        config.seed = 3;
        config.hidden = {generator::parse_setting("coulomb_friction:torque_Nm=0.02")};
        data = make_dataset(model, generator::generate(config));
    }
};

const Short &short_log() {
    static const Short one;
    return one;
}

Problem fitted() {
    const Physics physics = make_physics(short_log().model);
    Problem problem(short_log().data, physics, free_parameters(short_log().model, physics));
    problem.fit({});
    return problem;
}

TEST(Screening, tells_what_is_explainable_from_noise) {
    const Problem problem = fitted();
    const Screen screen(problem);
    const double noise = problem.noise_rows().cwiseProduct(problem.row_scale).squaredNorm();
    EXPECT_GT(noise, 0);
    EXPECT_LT(noise, static_cast<double>(problem.row_scale.size())); // no row's scale is below its noise
    EXPECT_NEAR(screen.explainable(), screen.heldout_error() - noise, 1e-9 * noise);
    EXPECT_GT(screen.explainable(), 0); // a friction is missing
    Problem louder = problem;
    louder.residual *= 0.1; // sensors ten times better than stated
    EXPECT_EQ(Screen(louder).explainable(), 0);
}

// Half of the catalogue's effects count as tried: 54 effects, of which near copies of one another count once. A p that is corrected for
// clearly fewer would name one log in seven for each factor of seven.
TEST(Screening, corrects_its_p_for_about_half_of_the_catalogue_and_every_shape_of_an_effect) {
    Problem problem = fitted();
    const Screen screen(problem);
    Columns::Cache cache;
    Columns columns(problem, cache);
    const auto classes = static_cast<double>(sim::catalogue().size());
    int judged = 0;
    for (const Candidate &c : catalogue_candidates(short_log().model, short_log().data, problem.forward().motion())) {
        if (c.strengths.size() != 1) continue;
        const Trial t = screen_candidate(c, screen, columns);
        if (!(t.own_p_value < 1) || !(t.assessment.p_value > 0)) continue;
        const double tried = t.own_p_value / (1.25 * t.assessment.p_value * c.variants); // 1.25: the other fifth is the ranks' share
        EXPECT_GT(tried, 0.35 * classes) << c.label();
        EXPECT_LT(tried, 0.65 * classes) << c.label();
        EXPECT_LE(t.p_value, t.own_p_value) << c.label();
        ++judged;
    }
    EXPECT_GE(judged, 2); // those whose corrected p is below 1
}

TEST(Screening, states_intervals_of_95_percent_by_students_t) {
    Problem problem = fitted();
    const Screen screen(problem);
    Columns::Cache cache;
    Columns columns(problem, cache);
    for (const Candidate &c : catalogue_candidates(short_log().model, short_log().data, problem.forward().motion())) {
        if (c.wheel >= 0) continue;
        const Trial t = screen_candidate(c, screen, columns);
        for (std::size_t j = 0; j < t.error.size(); ++j) {
            if (!(t.error[j] > 0) || !std::isfinite(t.error[j])) continue;
            EXPECT_GE(t.half_width[j], 1.9599 * t.error[j]) << c.label(); // never narrower than the normal's
            EXPECT_NEAR(t.half_width[j] / t.error[j], t_quantile(0.05, std::max(1.0, t.assessment.freedom)), 1e-9) << c.label();
        }
        EXPECT_EQ(t.gain_error, t.assessment.gain_error) << c.label();
        EXPECT_EQ(t.block_gain, t.assessment.block_gain) << c.label();
        const CandidateResult r = result_of(t, screen.heldout_error(), screen);
        EXPECT_EQ(r.candidate.label(), c.label());
        for (std::size_t j = 0; j < t.value.size(); ++j) {
            EXPECT_DOUBLE_EQ(r.low[j], t.value[j] - t.half_width[j]);
            EXPECT_DOUBLE_EQ(r.high[j], t.value[j] + t.half_width[j]);
        }
        const bool known = t.value.size() == 1 && t.error[0] > 0 && std::isfinite(t.error[0]);
        EXPECT_DOUBLE_EQ(known ? r.detectability : 0, known ? std::fabs(t.value[0]) / t.error[0] : 0);
        EXPECT_NEAR(r.gain_high - r.heldout_gain, 1.96 * t.gain_error / screen.heldout_error(), 1e-12);
        EXPECT_NEAR(r.heldout_gain - r.gain_low, 1.96 * t.gain_error / screen.heldout_error(), 1e-12);
    }
}

TEST(Screening, evidence_is_the_three_blocks_that_gain_most_with_their_shares) {
    Problem problem = fitted();
    const Screen screen(problem);
    Trial t = good("a");
    t.block_gain = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(screen.blocks().size()));
    ASSERT_GE(t.block_gain.size(), 6);
    t.block_gain[1] = 6, t.block_gain[2] = -100, t.block_gain[3] = 3, t.block_gain[4] = 1, t.block_gain[5] = 10;
    const CandidateResult r = result_of(t, base_error, screen);
    ASSERT_EQ(r.evidence.size(), 3U);
    EXPECT_EQ(r.evidence[0].first, screen.blocks()[5]);
    EXPECT_DOUBLE_EQ(r.evidence[0].second, 0.5);
    EXPECT_EQ(r.evidence[1].first, screen.blocks()[1]);
    EXPECT_DOUBLE_EQ(r.evidence[1].second, 0.3);
    EXPECT_EQ(r.evidence[2].first, screen.blocks()[3]);
    t.block_gain.setConstant(-1);
    EXPECT_TRUE(result_of(t, base_error, screen).evidence.empty());
}

TEST(Refit, finds_the_hidden_size_and_its_gain_is_the_fall_of_the_held_out_error) {
    const Problem base = fitted();
    const Screen screen(base);
    Problem columns_of = fitted();
    Columns::Cache cache;
    Columns columns(columns_of, cache);
    for (const Candidate &c : catalogue_candidates(short_log().model, short_log().data, columns_of.forward().motion())) {
        if (c.wheel >= 0 || c.effect != "slip_sinkage") continue; // moves the body: fitted in full
        Trial t = screen_candidate(c, screen, columns);
        refit(t, base, screen);
        EXPECT_TRUE(t.refitted);
        EXPECT_EQ(t.value.size(), c.strengths.size());
        EXPECT_LE(t.error_reduction, screen.error()); // a fall of the error, never more than the error
        EXPECT_EQ(t.baseline.size(), base.theta.size());
        EXPECT_NEAR(t.block_gain.sum(), t.gain - t.assessment.prior_reduction, 1e-6 * screen.heldout_error() + 1e-6);
        EXPECT_NEAR(t.gain_error, sum_error(t.block_gain), 1e-9);
        EXPECT_LE(t.gain, screen.heldout_error());
    }
}

// Candidates that move the body, each from a step of its own size.
struct Scanning {
    Problem base = fitted();
    Screen screen{base};
    Columns::Cache cache;
    std::vector<Candidate> of_catalogue = catalogue_candidates(short_log().model, short_log().data, base.forward().motion());

    Trial trial(const std::string &effect, double part, double reduction) {
        const auto found =
            std::find_if(of_catalogue.begin(), of_catalogue.end(), [&](const Candidate &c) { return c.effect == effect && c.wheel < 0; });
        Trial t;
        t.candidate = *found;
        t.value = {part * t.candidate.maximum[0]};
        t.error_reduction = reduction;
        return t;
    }
    // On all rows, the model's own numbers following linearly.
    double error_at(const Candidate &c, double size, Eigen::VectorXd &change) {
        Physics at = base.physics();
        c.prepare(at);
        c.strengths[0].add(at, size);
        return screen.profiled_error(base.scaled_residual(at, c.touched), change);
    }
};

// docs/lab_method.md, Scan. What is tried of the range, by what the step says of it, and the best of these is where a refit starts.
TEST(Scan, tries_sizes_about_the_step_and_of_the_range_and_starts_at_the_best) {
    Scanning s;
    for (const char *effect : {"body_drag", "slip_sinkage", "relaxation_length"})
        for (const double part : {0.02, 0.3, -0.02}) {
            Trial t = s.trial(effect, part, 0);
            const double largest = t.candidate.maximum[0], linear = t.value[0];
            std::vector<double> sizes = {linear, 2 * linear, 0.5 * largest};
            if (part < 0.1) sizes = {linear, 0.1 * largest, 0.25 * largest, 0.5 * largest};
            const bool bent = strongly_nonlinear(effect);
            if (bent) sizes = {t.candidate.of_interest[0], 0.1 * largest, 0.25 * largest, 0.5 * largest, 0.8 * largest};
            double best = s.screen.error(), start = 0, too_large = 1e300;
            Eigen::VectorXd change, best_change;
            for (double size : sizes) {
                size = std::clamp(size, 0.0, largest); // a drag that pulls is none
                if (size < 0.1 * t.candidate.of_interest[0] || size > too_large) continue;
                const double error = s.error_at(t.candidate, size, change);
                if (!bent && error > 1.02 * s.screen.error()) too_large = std::min(too_large, size);
                if (error < best) best = error, start = size, best_change = change;
            }
            scan(t, s.base, s.screen);
            EXPECT_EQ(t.start.empty(), start == 0) << effect << part;
            EXPECT_NEAR(t.error_reduction, s.screen.error() - best, 1e-6 * best) << effect << part;
            EXPECT_DOUBLE_EQ(t.nonlinear_reduction, t.error_reduction) << effect << part; // the step saw none of it
            if (t.start.empty()) continue;
            EXPECT_DOUBLE_EQ(t.start[0], start) << effect << part;
            EXPECT_LT((t.start_change - best_change).norm(), 1e-9 * (1 + best_change.norm())) << effect << part;
        }
}

TEST(Scan, keeps_what_the_step_saw_but_of_a_wrong_sign_or_a_slope_that_says_little) {
    Scanning s;
    const double much = 2 * s.screen.error(); // more than any size can take off
    Trial t = s.trial("body_drag", 0.02, much);
    scan(t, s.base, s.screen);
    EXPECT_DOUBLE_EQ(t.error_reduction, much);
    EXPECT_DOUBLE_EQ(t.nonlinear_reduction, 0);
    t = s.trial("body_drag", -0.02, much);
    scan(t, s.base, s.screen);
    EXPECT_LE(t.error_reduction, s.screen.error());
    EXPECT_DOUBLE_EQ(t.nonlinear_reduction, t.error_reduction);
    t = s.trial("relaxation_length", 0.02, much);
    scan(t, s.base, s.screen);
    EXPECT_LE(t.error_reduction, s.screen.error());
}

TEST(Scan, leaves_alone_what_does_not_move_the_body_has_no_range_or_two_strengths) {
    Scanning s;
    const Trial untouched = s.trial("body_drag", 0.02, 7);
    Trial electric = untouched, rangeless = untouched, twofold = untouched;
    electric.candidate.touched = stage_torque;
    rangeless.candidate.maximum.clear();
    twofold.candidate.strengths.push_back(twofold.candidate.strengths[0]);
    for (Trial *t : {&electric, &rangeless, &twofold}) {
        scan(*t, s.base, s.screen);
        EXPECT_TRUE(t->start.empty());
        EXPECT_EQ(t->error_reduction, 7);
        EXPECT_EQ(t->nonlinear_reduction, 0);
    }
}

// A refit ends where no neighbour is better, whatever it started from, and tells of that place what a fit of all parameters has there.
TEST(Refit, ends_at_the_optimum_of_model_and_effect_together) {
    Scanning s;
    Columns columns(s.base, s.cache);
    for (const char *effect : {"body_drag", "viscous_friction", "mesh_loss"}) {
        Trial t = s.trial(effect, 0.02, 0);
        const Candidate c = t.candidate;
        t = screen_candidate(c, s.screen, columns);
        const Trial step = t;
        refit(t, s.base, s.screen);
        if (c.touched == stage_torque || c.touched == stage_sensors) { // linear: the step is the fit
            EXPECT_EQ(t.value, step.value) << effect;
            EXPECT_EQ(t.baseline, s.base.theta + step.assessment.change) << effect;
            continue;
        }
        Physics physics = make_physics(short_log().model);
        c.prepare(physics);
        std::vector<FreeParameter> parameters = s.base.parameters;
        parameters.push_back(c.strengths[0]);
        Problem joint(short_log().data, physics, parameters);
        joint.keep_scales(s.base);
        joint.start_near(s.base);
        joint.theta << t.baseline, t.value[0];
        const double least = joint.cost();
        EXPECT_NEAR(t.error_reduction, s.screen.error() - least, 1e-3 * least) << effect; // what one more linear step may take off
        const Eigen::VectorXd there = joint.theta;
        joint.gauss_newton(8);
        EXPECT_LT(least - joint.cost(), 1e-3 * least) << effect;
        EXPECT_NEAR(joint.theta[there.size() - 1], t.value[0], 0.1 * t.half_width[0] + 1e-9) << effect;
        Trial from_afar = step;
        from_afar.start = {0.1 * c.maximum[0]};
        refit(from_afar, s.base, s.screen);
        EXPECT_NEAR(from_afar.value[0], t.value[0], 0.1 * t.half_width[0] + 1e-9) << effect;
    }
}

Fall fall_of(double sum, double error) {
    Fall fall;
    fall.sum = sum, fall.error = error;
    return fall;
}

// Rows that say nothing, by themselves; the tolerances give way by 12 squared deviations without the effect.
TEST(Tolerances, decide_for_a_name_by_which_the_held_out_error_rises_by_two_of_its_standard_errors_at_most) {
    const double least = DiagnoseOptions{}.least_prior_reduction, spared = least + 3;
    const Fall scaled = fall_of(0, 1);
    EXPECT_TRUE(tolerances_decide(scaled, fall_of(1, 1), spared, least));
    EXPECT_TRUE(tolerances_decide(scaled, fall_of(-1.99, 1), spared, least));
    EXPECT_FALSE(tolerances_decide(scaled, fall_of(-2.01, 1), spared, least));
    EXPECT_TRUE(tolerances_decide(scaled, fall_of(-2.01, 1.01), spared, least)); // its own standard error
    EXPECT_FALSE(tolerances_decide(scaled, fall_of(-1e-9, 0), spared, least));
}

// What the rows lose is taken off what the tolerances gain, and one of its standard errors.
TEST(Tolerances, decide_only_where_they_gain_surely_more_than_the_least) {
    const double least = DiagnoseOptions{}.least_prior_reduction;
    const Fall noise = fall_of(0, 1);
    EXPECT_TRUE(tolerances_decide(fall_of(0, 1), noise, least + 1.01, least));
    EXPECT_FALSE(tolerances_decide(fall_of(0, 1), noise, least + 0.99, least));
    EXPECT_FALSE(tolerances_decide(fall_of(0, 3), noise, least + 2.99, least));
    EXPECT_FALSE(tolerances_decide(fall_of(-2, 1), noise, least + 2.99, least));
    EXPECT_TRUE(tolerances_decide(fall_of(-2, 1), noise, least + 3.01, least));
}

// From one contradiction with the sheet to another nothing is explained.
TEST(Tolerances, pay_for_no_name_that_takes_a_stated_number_to_its_limit) {
    const double least = DiagnoseOptions{}.least_prior_reduction;
    EXPECT_TRUE(tolerances_pay(least + 0.01, 1, 0, least));
    EXPECT_FALSE(tolerances_pay(least + 0.01, 1, 1, least));
    EXPECT_FALSE(tolerances_pay(1e6, 1, 1, least));
    const Physics physics = make_physics(short_log().model);
    const Problem before(short_log().data, physics, free_parameters(short_log().model, physics));
    std::size_t stated = 0;
    for (std::size_t i = 0; i < before.parameters.size(); ++i) {
        const double prior = before.parameters[i].prior;
        for (const double side : {-7.0, 7.0}) {
            Problem with = before;
            with.theta[static_cast<Eigen::Index>(i)] = side * (prior > 0 ? prior : 1e6);
            with.within_bounds();
            if (!with.at_bound(i)) continue;
            const double off = std::fabs(with.theta[static_cast<Eigen::Index>(i)]);
            const std::size_t counts = prior > 0 && off > 5.999 * prior ? 1 : 0; // a natural end may be nearer, and is none of the sheet's
            EXPECT_EQ(newly_at_limits(before, with), counts) << name_of(before.parameters[i]);
            EXPECT_EQ(newly_at_limits(with, with), 0U) << name_of(before.parameters[i]); // it was there without the name
            EXPECT_EQ(newly_at_limits(with, before), 0U) << name_of(before.parameters[i]);
            Problem named = before; // the name's own size follows; at a limit of its own it is no number of the sheet
            named.parameters.push_back(candidate("a").strengths[0]);
            named.theta.conservativeResize(named.theta.size() + 1);
            named.theta[named.theta.size() - 1] = 1;
            EXPECT_EQ(newly_at_limits(before, named), 0U);
            Problem less = with; // an effect may fix what it stands for: numbers are known by name, not by place
            const std::size_t other = i == 0 ? 1 : 0;
            less.parameters.erase(less.parameters.begin() + static_cast<std::ptrdiff_t>(other));
            for (auto j = static_cast<Eigen::Index>(other); j + 1 < less.theta.size(); ++j) less.theta[j] = less.theta[j + 1];
            less.theta.conservativeResize(less.theta.size() - 1);
            EXPECT_EQ(newly_at_limits(before, less), counts) << name_of(before.parameters[i]);
            stated += counts;
        }
    }
    EXPECT_GT(stated, 10U); // of both sides of a sheet of more than five numbers
    Problem gone = before;  // it was once asked of a fit that had been moved away, and counted nothing
    const Problem kept = std::move(gone);
    EXPECT_THROW(newly_at_limits(before, gone), std::logic_error); // NOLINT(bugprone-use-after-move)
    EXPECT_EQ(newly_at_limits(before, kept), 0U);
}

// Four squared deviations of stated numbers widened by what is left (Birge): at three noises 4 * 9.
TEST(Tolerances, pay_as_the_error_that_is_left_lets_them) {
    EXPECT_TRUE(tolerances_pay(36.1, 3, 0, 9));
    EXPECT_FALSE(tolerances_pay(35.9, 3, 0, 9));
    EXPECT_FALSE(tolerances_pay(8.9, 0.1, 0, 9)); // never less than stated
    EXPECT_TRUE(tolerances_pay(9.1, 1.5, 0, 9));  // 4 * 2.25 = 9
    EXPECT_FALSE(tolerances_pay(3.9, 0.1, 0, 1));
    EXPECT_TRUE(tolerances_pay(4.1, 0.1, 0, 1));
}

// The other way about: numbers that go farther from the sheet by more than that, for less than a tenth of the squares.
TEST(Tolerances, are_strained_by_what_is_no_law_of_the_machine) {
    EXPECT_TRUE(strains_sheet(-36.1, 3.1, 3, 9));
    EXPECT_FALSE(strains_sheet(-35.9, 3.1, 3, 9)); // four of three noises
    EXPECT_TRUE(strains_sheet(-9.1, 0.5, 0.49, 9));
    EXPECT_FALSE(strains_sheet(-8.9, 0.5, 0.49, 9)); // never less than stated
    EXPECT_FALSE(strains_sheet(36.1, 3.1, 3, 9));
    EXPECT_FALSE(strains_sheet(-1e6, 1, 0.948, 9)); // more than a tenth of the squares: what explains as much may
    EXPECT_TRUE(strains_sheet(-1e6, 1, 0.949, 9));
    EXPECT_FALSE(strains_sheet(-1e6, 1.066, 1.038, 9)); // close to the noise: 0.43 of what is not noise
    EXPECT_TRUE(strains_sheet(-1e6, 1.066, 1.041, 9));  // 0.39 of it
    EXPECT_TRUE(strains_sheet(-1e6, 0.99, 0.96, 9));    // where all is noise there is no such share
    EXPECT_TRUE(strains_sheet(-4.1, 0.1, 0.1, 1));
    EXPECT_FALSE(strains_sheet(-3.9, 0.1, 0.1, 1));
}

TEST(SumError, is_the_scatter_of_the_blocks_by_the_root_of_their_number) {
    EXPECT_DOUBLE_EQ(sum_error(Eigen::VectorXd::Constant(8, 3.0)), 0);
    const Eigen::VectorXd v = (Eigen::VectorXd(4) << 1, 3, 1, 3).finished(); // variance 4/3 of each, four of them
    EXPECT_NEAR(sum_error(v), std::sqrt(4 * 4.0 / 3), 1e-12);
}

TEST(Words, say_what_was_found_and_what_was_not) {
    Diagnosis d;
    d.ladder = {{"baseline", 2, 2.5, 1}, {"+ a", 1, 1.25, 1}};
    d.kind = "nothing";
    d.not_excited = {{"x", ""}, {"y", ""}};
    EXPECT_NE(verdict_text(d).find("2.50"), std::string::npos);
    EXPECT_NE(verdict_text(d).find("2 effects"), std::string::npos);
    d = with_class({"a", "b", "c"}, {"a"});
    d.kind = "class";
    d.ladder = {{"baseline", 2, 2.5, 1}, {"+ a", 1, 1.25, 1}};
    const std::string text = verdict_text(d);
    EXPECT_NE(text.find("falls by 50 %, from 2.500 to 1.250 x noise"), std::string::npos) << text;
    EXPECT_NE(text.find("tell a, b from c."), std::string::npos) << text;
    d.unknown = UnknownShape{};
    d.unknown->variable = "time", d.unknown->balance = "friction of the wheels";
    d.nearest = {"p", "q"};
    EXPECT_NE(verdict_text(d).find("only partly: what is left depends on time: friction of the wheels."), std::string::npos)
        << verdict_text(d);
    EXPECT_NE(verdict_text(d).find("and not named: p, q."), std::string::npos) << verdict_text(d);
    d.accepted.clear(), d.classes.clear();
    EXPECT_EQ(verdict_text(d).find("Unknown: no effect of the catalogue"), 0U) << verdict_text(d);
}

} // namespace
} // namespace traction::lab
