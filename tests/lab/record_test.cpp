// What a diagnosis writes down (record.h, verdict.cpp, classes.h), on rounds made by hand.
#include "host_tools/lab/decision/classes.h"
#include "host_tools/lab/decision/patch_edges.h"
#include "host_tools/lab/decision/record.h"
#include "tests/lab/hand_made.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

namespace traction::lab {
namespace {

using hand_made::candidate;
using Labels = std::vector<std::string>;

Trial trial(const std::string &effect, const std::string &verdict, double gain = 10) {
    Trial t;
    t.candidate = candidate(effect);
    t.value = {0.5}, t.error = {0.1}, t.half_width = {0.2};
    t.verdict = verdict, t.gain = gain, t.gain_error = 2;
    t.p_value = 0.5;
    t.block_gain = Eigen::VectorXd::Zero(10);
    return t;
}

const Problem &problem() {
    static const Dataset data = hand_made::data_of(1, 100, 0.5);
    static const Problem one = hand_made::problem_of(data, {}, Eigen::MatrixXd(100, 0), Eigen::VectorXd::Ones(100));
    return one;
}
const Screen &screen() {
    static const Screen one(problem());
    return one;
}

TEST(Excited, is_what_three_sizes_of_interest_change_by_two_deviations_alone_and_beside_the_rest) {
    const auto noted = [](double column_norm, double error, double p = 0.5, int wheel = -1) {
        Trial t = trial("a", "not_significant");
        t.candidate.wheel = wheel;
        t.assessment.column_norm = column_norm, t.error = {error}, t.p_value = p; // 0.3 is three times of interest
        Diagnosis d;
        note_not_excited(d, {t});
        return d.not_excited.empty() ? std::string() : d.not_excited[0].first + ": " + d.not_excited[0].second;
    };
    EXPECT_EQ(noted(6.7, 0.1), "");
    EXPECT_EQ(noted(6.6, 0.1), "a: a size three times that of interest changes the log by 2.0 standard deviations");
    EXPECT_EQ(noted(1, 0.1), "a: a size three times that of interest changes the log by 0.3 standard deviations");
    EXPECT_EQ(noted(100, 0.149), "");
    EXPECT_EQ(noted(100, 0.25),
              "a: it would hide behind the model's own uncertain parameters: a size three times that of interest is 1.2 standard errors");
    EXPECT_NE(noted(100, 0.151), "");
    EXPECT_EQ(noted(1, 0.1, 0.049), ""); // the log says something of it
    EXPECT_NE(noted(1, 0.1, 0.05), "");
    for (const int wheel : {0, 1, 2}) EXPECT_EQ(noted(1, 0.1, 0.5, wheel), ""); // of one wheel nothing is said
}

TEST(Excited, are_two_strengths_of_which_one_is) {
    Trial t = trial("a", "not_significant");
    t.candidate.of_interest = {0.1, 0.5};
    t.assessment.column_norm = 2, t.error = {1, 0.7}; // 0.6 and 3 deviations; 0.3 and 2.1 errors
    Diagnosis d;
    note_not_excited(d, {t});
    EXPECT_TRUE(d.not_excited.empty());
    t.error = {1, 0.8};
    note_not_excited(d, {t});
    ASSERT_EQ(d.not_excited.size(), 1U);
    EXPECT_NE(d.not_excited[0].second.find("is 0.3 standard errors"), std::string::npos); // of the first
    t.candidate.of_interest.clear();
    note_not_excited(d, {t});
    EXPECT_EQ(d.not_excited.size(), 1U); // of what has no size of interest nothing is said
}

Labels verdicts(const std::vector<CandidateResult> &list) {
    Labels out;
    for (const CandidateResult &r : list) out.push_back(r.verdict);
    return out;
}

TEST(Record, of_a_winner_without_rival_or_class_is_a_name) {
    Diagnosis d;
    d.not_excited = {{"d", ""}, {"e", ""}};
    std::vector<Trial> trials = {trial("a", "passes"),       trial("slip_sinkage", "passes", 30),
                                 trial("b", "not_held_out"), trial("d", "not_significant"),
                                 trial("e", "too_small"),    trial("c", "too_small")};
    record(d, trials, 1, {}, "", 200, screen(), true);
    EXPECT_EQ(verdicts(d.ranking), (Labels{"not_needed", "named", "not_needed", "not_excited", "too_small", "too_small"}));
    ASSERT_EQ(d.accepted.size(), 1U);
    EXPECT_EQ(d.accepted[0].candidate.label(), "slip_sinkage");
    EXPECT_FALSE(d.accepted[0].class_index);
    EXPECT_DOUBLE_EQ(d.accepted[0].heldout_gain, 30.0 / 200);
    EXPECT_TRUE(d.classes.empty());
    ASSERT_EQ(d.model.effects.size(), 1U);
    EXPECT_EQ(d.model.effects[0].name, "slip_sinkage");
    EXPECT_EQ(d.model.effects[0].parameters.at("size").value, 0.5);
    trials[3].candidate.wheel = 0; // not excited on all wheels: of one nothing is said
    record(d, trials, 0, {}, "", 200, screen(), false);
    EXPECT_EQ(d.ranking.size(), 6U); // of the first round alone
    EXPECT_EQ(d.accepted.size(), 2U);
    EXPECT_EQ(d.model.effects.size(), 2U);
    Diagnosis again;
    again.not_excited = d.not_excited;
    record(again, trials, 0, {}, "", 200, screen(), true);
    EXPECT_EQ(again.ranking[3].verdict, "not_significant");
}

TEST(Record, of_a_winner_with_a_class_or_a_tolerance_beside_it_is_a_class) {
    Diagnosis d;
    const std::vector<Trial> trials = {trial("a", "passes"), trial("slip_sinkage", "passes"), trial("b", "passes"), trial("c", "passes")};
    record(d, trials, 1, {0, 3}, "tolerance of x", 200, screen(), true);
    EXPECT_EQ(verdicts(d.ranking), (Labels{"class", "class", "not_needed", "class"}));
    ASSERT_EQ(d.classes.size(), 1U);
    EXPECT_EQ(d.classes[0].members, (Labels{"slip_sinkage", "a", "c", "tolerance of x"}));
    EXPECT_EQ(d.classes[0].separate_by, sim::find_effect("slip_sinkage")->reveals);
    for (const std::size_t i : {0U, 1U, 3U}) EXPECT_EQ(d.ranking[i].class_index, 0);
    EXPECT_FALSE(d.ranking[2].class_index);
    record(d, trials, 0, {}, "tolerance of y", 200, screen(), false);
    ASSERT_EQ(d.classes.size(), 2U);
    EXPECT_EQ(d.classes[1].members, (Labels{"a", "tolerance of y"}));
    EXPECT_EQ(d.classes[1].separate_by, ""); // no effect of the catalogue
    EXPECT_EQ(d.accepted[1].verdict, "class");
    EXPECT_EQ(d.accepted[1].class_index, 1);
    record(d, trials, 2, {3}, "", 200, screen(), false);
    EXPECT_EQ(d.classes[2].members, (Labels{"b", "c"}));
}

TEST(Record, of_a_round_without_a_winner_names_none) {
    Diagnosis d;
    const std::vector<Trial> trials = {trial("a", "passes"), trial("b", "not_held_out"), trial("c", "too_small")};
    record(d, trials, 3, {}, "", 200, screen(), true);
    EXPECT_EQ(verdicts(d.ranking), (Labels{"not_held_out", "not_held_out", "too_small"}));
    EXPECT_TRUE(d.accepted.empty() && d.classes.empty() && d.model.effects.empty());
}

TEST(Result, tells_gain_interval_and_detectability_by_their_definitions) {
    Trial t = trial("slip_sinkage", "passes", 30);
    t.candidate.strengths.push_back(t.candidate.strengths[0]), t.candidate.strengths.push_back(t.candidate.strengths[0]);
    t.value = {0.5, -2, 3}, t.error = {0.1, 0.25, std::numeric_limits<double>::infinity()}, t.half_width = {0.2, 0.5, 9};
    t.p_value = 0.25;
    CandidateResult r = result_of(t, 200, screen());
    EXPECT_EQ(r.low, (std::vector<double>{0.3, -2.5, -6}));
    EXPECT_EQ(r.high, (std::vector<double>{0.7, -1.5, 12}));
    EXPECT_DOUBLE_EQ(r.detectability, 8); // the surest of its sizes
    EXPECT_DOUBLE_EQ(r.gain_squares, 30);
    EXPECT_DOUBLE_EQ(r.gain_low, (30 - 1.96 * 2) / 200);
    EXPECT_DOUBLE_EQ(r.gain_high, (30 + 1.96 * 2) / 200);
    EXPECT_EQ(r.p_value, 0.25);
    EXPECT_EQ(r.verdict, "passes");
    EXPECT_EQ(r.explains, sim::find_effect("slip_sinkage")->signature);
    EXPECT_TRUE(r.evidence.empty());
    t.error = {0, 0, 0};
    for (const double error : {0.5, 2.0}) // a share of whatever the error is
        EXPECT_NEAR(result_of(t, error, screen()).heldout_gain, t.gain / error, 1e-12 * t.gain);
    r = result_of(t, 0, screen());
    EXPECT_EQ(r.detectability, 0);
    EXPECT_EQ(r.heldout_gain, 0);
    t.block_gain[7] = 6, t.block_gain[1] = 2; // of blocks of 5 s, in the order of what they gain
    r = result_of(t, 0, screen());
    ASSERT_EQ(r.evidence.size(), 2U);
    EXPECT_EQ(r.evidence[0].first, std::make_pair(35.0, 40.0));
    EXPECT_DOUBLE_EQ(r.evidence[0].second, 0.75);
    EXPECT_EQ(r.evidence[1].first, std::make_pair(5.0, 10.0));
    t.block_gain << 0.5, 0.25, 4, -9, 0.1, 3, 0, 0, 0.15, 0; // the three that gain the most, of all that gain
    r = result_of(t, 0, screen());
    ASSERT_EQ(r.evidence.size(), 3U);
    EXPECT_EQ(r.evidence[2].first, std::make_pair(0.0, 5.0));
    EXPECT_DOUBLE_EQ(r.evidence[2].second, 0.5 / 8);
    EXPECT_FALSE(r.sheet_alone);
    t.sheet_alone = 25;
    EXPECT_EQ(result_of(t, 0, screen()).sheet_alone, 25);
}

CandidateResult named(const std::string &effect, int wheel = -1) {
    CandidateResult r;
    r.candidate = candidate(effect, wheel), r.verdict = "named";
    return r;
}

TEST(Seen, is_what_was_found_or_may_be_meant_on_whatever_wheel) {
    Diagnosis d;
    d.classes = {{{"a", "b on wheel 2"}, ""}};
    d.nearest = {"c", "d on wheel 1"};
    d.accepted = {named("e", 3)};
    for (const char *seen : {"a", "b", "c", "d", "e"}) EXPECT_TRUE(was_seen(d, seen)) << seen;
    for (const char *not_seen : {"f", "b on", "on wheel 2", ""}) EXPECT_FALSE(was_seen(d, not_seen)) << not_seen;
    d.classes = {{{"ab", "x"}, ""}}; // of a longer name
    EXPECT_FALSE(was_seen(d, "a"));
}

TEST(Conclusion, is_of_the_kind_that_names_classes_and_shapes_make) {
    const auto kind = [](bool name, bool in_class, bool shape) {
        Diagnosis d;
        if (name) d.accepted = {named("a", 1)};
        if (in_class) d.accepted[0].verdict = "class", d.accepted[0].class_index = 0, d.classes = {{{"a on wheel 1", "b"}, ""}};
        if (shape) d.unknown = UnknownShape();
        conclude(d);
        EXPECT_EQ(d.effects, name ? Labels{"a on wheel 1"} : Labels{});
        EXPECT_EQ(d.text, verdict_text(d));
        return d.kind;
    };
    EXPECT_EQ(kind(false, false, false), "nothing");
    EXPECT_EQ(kind(false, false, true), "unknown");
    EXPECT_EQ(kind(true, false, false), "named");
    EXPECT_EQ(kind(true, true, false), "class");
    EXPECT_EQ(kind(true, false, true), "partial");
    EXPECT_EQ(kind(true, true, true), "partial");
}

TEST(Conclusion, what_was_refused_in_one_round_and_named_in_a_later_one_is_named) {
    Diagnosis d;
    d.ranking = {named("a"), named("b")};
    d.ranking[0].verdict = "nearest", d.ranking[1].verdict = "not_needed";
    d.nearest = {"a"};
    d.accepted = {named("a")};
    conclude(d);
    EXPECT_EQ(d.ranking[0].verdict, "named");
    EXPECT_EQ(d.ranking[1].verdict, "not_needed");
    EXPECT_TRUE(d.nearest.empty());
}

TEST(Conclusion, knows_what_was_seen_and_that_where_nothing_is_found_nothing_is_needed) {
    Diagnosis d;
    d.not_excited = {{"a", "why"}, {"b", "why"}};
    d.ranking = {named("a"), named("b"), named("c")};
    d.ranking[1].verdict = "not_needed";
    d.accepted = {named("a")};
    Diagnosis named_one = d;
    conclude(named_one);
    ASSERT_EQ(named_one.not_excited.size(), 1U);
    EXPECT_EQ(named_one.not_excited[0].first, "b");
    EXPECT_EQ(named_one.ranking[1].verdict, "not_needed");
    d.accepted.clear();
    Diagnosis shape = d;
    shape.unknown = UnknownShape();
    conclude(shape);
    EXPECT_EQ(shape.ranking[1].verdict, "not_needed");
    conclude(d);
    EXPECT_EQ(d.ranking[1].verdict, "not_held_out");
    EXPECT_EQ(d.ranking[2].verdict, "named");
    EXPECT_EQ(d.not_excited.size(), 2U);
}

TEST(Model, without_an_effect_keeps_it_on_other_wheels) {
    Model model;
    for (const int wheel : {-1, 1, 2}) {
        model.effects.emplace_back();
        model.effects.back().name = wheel == 2 ? "b" : "a", model.effects.back().wheel = wheel;
    }
    const Model without = model_without(model, candidate("a", 1));
    ASSERT_EQ(without.effects.size(), 2U);
    EXPECT_EQ(without.effects[0].wheel, -1);
    EXPECT_EQ(without.effects[1].name, "b");
}

TEST(Shape, parameters_on_a_scale_are_set_free_by_a_factor_of_four_or_a_quarter_turn) {
    sim::EffectParameter spec;
    spec.strength = false, spec.unit = "rad/s", spec.minimum = 0.1, spec.maximum = 100;
    EXPECT_TRUE(is_on_a_scale(spec));
    Parameter p;
    p.value = 2, p.fixed = true;
    set_free(p, spec);
    EXPECT_FALSE(p.fixed);
    EXPECT_DOUBLE_EQ(p.minimum, 0.5);
    EXPECT_DOUBLE_EQ(p.maximum, 8);
    p.value = 40, set_free(p, spec);
    EXPECT_DOUBLE_EQ(p.maximum, 100); // the catalogue's end is nearer
    p.value = 0.2, set_free(p, spec);
    EXPECT_DOUBLE_EQ(p.minimum, 0.1);
    p.value = 400, set_free(p, spec); // a variant of the machine's own scale, beyond the catalogue's: up to twice, and down to its end
    EXPECT_DOUBLE_EQ(p.minimum, 100);
    EXPECT_DOUBLE_EQ(p.maximum, 800);
    p.value = 0.05, set_free(p, spec);
    EXPECT_DOUBLE_EQ(p.minimum, 0.025);
    EXPECT_DOUBLE_EQ(p.maximum, 0.2);
    spec.unit = "rad", p.value = 5, set_free(p, spec); // either way round
    EXPECT_NEAR(p.maximum - p.minimum, std::numbers::pi, 0.1);
    EXPECT_DOUBLE_EQ(0.5 * (p.maximum + p.minimum), 5);
    for (const char *kind : {"1", "1/turn"}) {
        spec.unit = kind;
        EXPECT_FALSE(is_on_a_scale(spec)) << kind;
    }
    spec.unit = "m", spec.strength = true; // fitted anyway
    EXPECT_FALSE(is_on_a_scale(spec));
}

TEST(Ripple, is_known_but_for_what_the_smoothing_takes_at_its_frequency_at_the_wheels_mean_speed) {
    Dataset data;
    data.step_s = 0.02, data.smoothing_half_s = 0.08;
    data.wheel.resize(2);
    data.wheel[0].speed_rad_s = {0, 0.4, 3, -3, 0.5}; // what hardly turns does not count
    data.wheel[1].speed_rad_s = {5, -5};
    const double speed = std::sqrt((2 * 9.0 + 2 * 25.0) / 4);
    Candidate c = candidate("torque_ripple");
    c.variant = {{"order", -4.0}};
    ASSERT_GT(data.acceleration_loss(4 * speed), 0.05);
    EXPECT_DOUBLE_EQ(smoothing_loss(c, data), data.acceleration_loss(4 * speed));
    c.variant.clear();
    EXPECT_EQ(smoothing_loss(c, data), 0);
    c.effect = "backlash", c.variant = {{"order", 4.0}};
    EXPECT_EQ(smoothing_loss(c, data), 0);
    c.effect = "torque_ripple";
    data.wheel[0].speed_rad_s = {0.1}, data.wheel[1].speed_rad_s = {0.5};
    EXPECT_EQ(smoothing_loss(c, data), 0);
}

// 20 rows a second: half of one is 0.025 s.
TEST(Edges, are_searched_by_half_a_row_of_the_mean_speed) {
    Dataset data;
    data.standstill_rad_s = 0.15;
    data.wheel.resize(2);
    data.wheel[0].speed_rad_s = {0, 0.1, 4, -2};
    data.wheel[1].speed_rad_s = {0.15, 3};
    Model model;
    model.wheel.resize(2);
    model.wheel[0].geometry["radius_m"].value = 0.1, model.wheel[1].geometry["radius_m"].value = 0.2;
    EXPECT_DOUBLE_EQ(half_row_m(model, data), 0.025 * (0.4 + 0.2 + 0.6) / 3);
    data.wheel[0].speed_rad_s = data.wheel[1].speed_rad_s = {0};
    EXPECT_EQ(half_row_m(model, data), 0);
}

TEST(Words, of_nothing_tell_the_error_that_stands_and_how_many_could_not_be_seen) {
    Diagnosis d;
    d.kind = "nothing";
    d.ladder = {{"baseline", 1.5, 2.5, 1}, {"x", 1, 1, 1}};
    d.not_excited = {{"x", ""}};
    EXPECT_EQ(verdict_text(d), "Nothing found that the log supports; the error stands at 2.50 x noise on what was not fitted (1.50 in the "
                               "fit). 1 effects could not have been seen in it: traction next --all proposes the drive for them.");
    d.not_excited.clear(), d.ladder.clear();
    EXPECT_EQ(verdict_text(d), "Nothing found that the log supports; the error stands at 0.00 x noise on what was not fitted (0.00 in the "
                               "fit). 0 effects could not have been seen in it.");
}

TEST(Words, of_names_tell_all_of_them_and_by_how_much_the_error_falls) {
    Diagnosis d;
    d.accepted = {named("a"), named("b", 1)};
    d.ladder = {{"baseline", 2, 4, 1}, {"+ a", 1, 3, 1}};
    EXPECT_EQ(verdict_text(d), "The model lacks a and b on wheel 1: on what was not fitted the error falls by 25 %, from 4.000 to 3.000 x "
                               "noise (5 s blocks, each predicted by a refit to the others).");
    d.ladder[1].heldout = 5; // a rise is no negative fall
    EXPECT_NE(verdict_text(d).find("falls by 0 %, from 4.000 to 5.000"), std::string::npos);
    d.ladder.clear();
    EXPECT_NE(verdict_text(d).find("falls by 0 %, from 0.000 to 0.000"), std::string::npos);
    d.accepted.clear();
    d.classes = {{{"a", "b"}, ""}, {{"c", "d", "e"}, ""}};
    EXPECT_EQ(verdict_text(d), " This log cannot tell a from b. This log cannot tell c, d from e.");
    d.classes.clear();
    d.unknown = UnknownShape();
    d.unknown->variable = "time", d.unknown->balance = "friction(time)";
    d.nearest = {"p"};
    EXPECT_EQ(verdict_text(d),
              "Unknown: no effect of the catalogue explains it: what is left depends on time: friction(time). Nearest in the "
              "catalogue, and not named: p.");
}

TEST(Words, of_a_wrong_model_take_every_name_back) {
    Diagnosis d;
    d.ranking = {named("a"), named("b"), named("c"), named("d")};
    d.ranking[1].verdict = "class", d.ranking[1].class_index = 0, d.ranking[2].verdict = "nearest", d.ranking[3].verdict = "too_small";
    d.accepted = {named("a")}, d.classes = {{{"b", "x"}, ""}}, d.effects = {"a"}, d.nearest = {"c"}, d.not_excited = {{"q", ""}};
    d.unknown = UnknownShape();
    d.ladder = {{"baseline", 2, 4, 1}, {"+ a", 1, 3, 1}};
    d.stated_fit = std::make_shared<const Problem>(problem());
    Model stated;
    stated.name = "stated";
    Doubt doubt;
    doubt.error = 12.34, doubt.text = "Look at it";
    name_nothing(d, stated, doubt);
    EXPECT_EQ(verdicts(d.ranking), (Labels{"wrong_model", "wrong_model", "wrong_model", "too_small"}));
    EXPECT_FALSE(d.ranking[1].class_index);
    ASSERT_EQ(d.ladder.size(), 1U);
    EXPECT_EQ(d.ladder[0].label, "baseline");
    EXPECT_TRUE(d.accepted.empty() && d.classes.empty() && d.effects.empty() && d.nearest.empty() && d.not_excited.empty() && !d.unknown);
    EXPECT_EQ(d.model.name, "stated");
    EXPECT_EQ(d.model_fit, d.stated_fit);
    EXPECT_EQ(d.kind, "wrong_model");
    EXPECT_EQ(d.text, "This model does not describe this log: its error is 12.3 x noise, and no effect is named. Look at it.");
    d.ladder.clear();
    name_nothing(d, stated, doubt);
    EXPECT_TRUE(d.ladder.empty());
}

TEST(Words, of_a_wrong_model_tell_what_describes_the_log_as_well_where_its_number_is_right) {
    for (const double left : {1.09, 1.11}) { // beside 1 with the number: as well, and notably worse
        Diagnosis d;
        d.accepted = {named("a"), named("b", 1)};
        d.accepted[0].value = {-0.243};
        d.ladder = {{"baseline", 2, 4, 1}, {"+ a", 1.5, 3, 1}, {"+ b", left, 2, 1}};
        d.stated_fit = std::make_shared<const Problem>(problem());
        Doubt doubt;
        doubt.text = "Look first at the mass", doubt.suspects = {{"the mass", 12, 7, "kg", 1, 1.2, false}};
        name_nothing(d, Model(), doubt);
        EXPECT_TRUE(d.accepted.empty() && d.effects.empty());
        EXPECT_EQ(d.nearest, left < 1.1 ? (Labels{"a", "b on wheel 1"}) : Labels{});
        const char *told =
            "the mass. Where the mass is right as it stands, a (-0.243) and b on wheel 1 (0) would describe it too (1.09 x noise).";
        EXPECT_EQ(d.text.find(told) != std::string::npos, left < 1.1) << d.text;
        EXPECT_EQ(d.text.find("Where") != std::string::npos, left < 1.1) << d.text;
    }
}

TEST(Class, that_lost_its_front_leaves_its_members_as_not_needed_and_its_accepted_as_names) {
    Diagnosis d;
    for (const char *name : {"a", "b", "c", "d"}) {
        d.ranking.push_back(named(name));
        d.ranking.back().verdict = "class", d.ranking.back().class_index = 0;
    }
    d.ranking[3].verdict = "not_significant", d.ranking[3].class_index.reset();
    d.ranking[2].class_index.reset(); // of a class that is gone
    d.classes = {{{"a", "b"}, ""}};
    d.accepted = {d.ranking[0], d.ranking[1]};
    separate_accepted(d);
    EXPECT_TRUE(d.classes.empty());
    EXPECT_EQ(verdicts(d.ranking), (Labels{"named", "named", "not_needed", "not_significant"}));
    EXPECT_FALSE(d.accepted[0].class_index || d.accepted[1].class_index);
    // a member of a class that stands keeps its place though it is no front
    Diagnosis kept;
    kept.classes = {{{"a", "b", "c"}, ""}};
    kept.ranking = {named("a"), named("b"), named("c")};
    for (CandidateResult &r : kept.ranking) r.verdict = "class", r.class_index = 0;
    kept.accepted = {kept.ranking[0]};
    separate_accepted(kept);
    EXPECT_EQ(verdicts(kept.ranking), (Labels{"class", "class", "class"}));
    EXPECT_EQ(kept.ranking[1].class_index, 0);
    remove_class(kept, "b"); // no front
    EXPECT_EQ(kept.classes.size(), 1U);
}

TEST(Class, that_goes_moves_those_behind_it_up_and_not_those_before) {
    Diagnosis d;
    d.classes = {{{"a", "x"}, ""}, {{"b", "x"}, ""}, {{"c", "x"}, ""}};
    for (const char *name : {"a", "b", "c", "none"}) d.ranking.push_back(named(name));
    for (int i = 0; i < 3; ++i) d.ranking[static_cast<std::size_t>(i)].class_index = i;
    remove_class(d, "b");
    ASSERT_EQ(d.classes.size(), 2U);
    EXPECT_EQ(d.classes[1].members.front(), "c");
    EXPECT_EQ(d.ranking[0].class_index, 0);
    EXPECT_FALSE(d.ranking[1].class_index);
    EXPECT_EQ(d.ranking[2].class_index, 1);
    EXPECT_FALSE(d.ranking[3].class_index);
}

// Two effects of two strengths on wheels 0 and 1, increments 1, 2, .. about bases 10, 20, ..; of each parameter half an interval of 0.1 its
// place.
struct Fitted {
    Dataset data = hand_made::data_of(1, 10, 0.5);
    std::vector<ParameterError> errors;
    Problem problem;
    static std::vector<FreeParameter> parameters() {
        std::vector<FreeParameter> list;
        for (const char *owner : {"a", "b"})
            for (const int wheel : {0, 1})
                for (const char *key : {"cos_Nm", "sin_Nm", "edge_m"}) {
                    FreeParameter p = hand_made::parameter(owner, key, 10 * static_cast<double>(list.size() + 1), 0);
                    p.wheel = wheel, p.unit = std::string(key) == "edge_m" ? "m" : "N m";
                    list.push_back(p);
                }
        return list;
    }
    Fitted() : problem(hand_made::problem_of(data, parameters(), Eigen::MatrixXd::Zero(10, 12), Eigen::VectorXd::Zero(10))) {
        for (Eigen::Index i = 0; i < 12; ++i) {
            problem.theta[i] = static_cast<double>(i + 1);
            errors.push_back({0.01, 0.1 * static_cast<double>(i + 1)});
        }
    }
};

// No law is a machine's own: 3 % of a size beside what the rows leave.
double own(double of_rows, double size) { return std::hypot(of_rows, 0.03 * size); }

TEST(Values, of_an_accepted_effect_are_those_of_its_own_parameters) {
    const Fitted f;
    CandidateResult a;
    a.candidate = candidate("b", 0);
    a.candidate.strengths.resize(2);
    a.candidate.strengths[0].key = "sin_Nm", a.candidate.strengths[1].key = "cos_Nm";
    a.value = a.low = a.high = {0, 0};
    take_values(a, f.problem, f.errors, 0);
    EXPECT_EQ(a.value, (std::vector<double>{88, 77})); // the eighth and the seventh: 80 + 8, 70 + 7
    EXPECT_NEAR(a.low[0], 88 - own(0.8, 88), 1e-9);
    EXPECT_NEAR(a.high[0], 88 + own(0.8, 88), 1e-9);
    EXPECT_NEAR(a.high[1], 77 + own(0.7, 77), 1e-9);
    take_values(a, f.problem, f.errors, 0.5); // half of the size is not known beside
    EXPECT_NEAR(a.low[1], 77 - own(0.7 + 38.5, 77), 1e-9);
    EXPECT_NEAR(a.high[1], 77 + own(0.7 + 38.5, 77), 1e-9);
    a.candidate.wheel = 2;
    const std::vector<double> stays = a.value;
    take_values(a, f.problem, f.errors, 0);
    EXPECT_EQ(a.value, stays);
}

TEST(Shape, values_of_the_fit_are_told_and_held) {
    const Fitted f;
    CandidateResult a;
    a.candidate = candidate("a", 1);
    a.candidate.variant = {{"edge_m", 1}, {"sin_Nm", 2}, {"another", 3}};
    take_shape_values(a, f.problem, f.errors);
    ASSERT_EQ(a.shapes.size(), 2U); // the fifth and the sixth: 50 + 5, 60 + 6
    EXPECT_EQ(a.shapes[0].key, "sin_Nm");
    EXPECT_EQ(a.shapes[0].unit, "N m");
    EXPECT_EQ(a.shapes[0].value, 55);
    EXPECT_NEAR(a.shapes[0].low, 55 - own(0.5, 55), 1e-9);
    EXPECT_NEAR(a.shapes[0].high, 55 + own(0.5, 55), 1e-9);
    EXPECT_EQ(a.shapes[1].value, 66);
    EXPECT_NEAR(a.shapes[1].low, 66 - own(0.6, 66), 1e-9);
    EXPECT_NEAR(a.shapes[1].high, 66 + own(0.6, 66), 1e-9);
    EXPECT_EQ(a.candidate.variant[0].second, 66);
    EXPECT_EQ(a.candidate.variant[1].second, 55);
    EXPECT_EQ(a.candidate.variant[2].second, 3);
    Model model;
    for (const int wheel : {0, 1})
        for (const char *name : {"a", "b"}) {
            EffectUse use;
            use.name = name, use.wheel = wheel;
            for (const char *key : {"edge_m", "sin_Nm", "size"}) use.parameters[key].value = 1, use.parameters[key].minimum = 0;
            model.effects.push_back(use);
        }
    fix_shapes(model, a);
    for (const EffectUse &use : model.effects) {
        const bool its = use.name == "a" && use.wheel == 1;
        const Parameter &edge = use.parameters.at("edge_m"), &size = use.parameters.at("size");
        EXPECT_EQ(edge.value, its ? 66 : 1);
        EXPECT_EQ(edge.fixed, its);
        EXPECT_EQ(std::isinf(edge.minimum) && std::isinf(edge.maximum) && edge.minimum < 0 && edge.maximum > 0, its);
        EXPECT_EQ(size.value, 1);
        EXPECT_FALSE(size.fixed);
        if (its) {
            EXPECT_EQ(edge.low, a.shapes[1].low);
            EXPECT_EQ(edge.high, a.shapes[1].high);
            EXPECT_EQ(use.parameters.at("sin_Nm").value, 55);
        }
    }
}

TEST(Shape, parameters_are_freed_of_the_effect_itself_where_it_has_any_on_a_scale) {
    Model model;
    for (const int wheel : {0, 1}) {
        EffectUse use;
        use.name = "stribeck_friction", use.wheel = wheel;
        for (const char *key : {"speed_rad_s", "torque_Nm"}) use.parameters[key].value = 2, use.parameters[key].fixed = true;
        model.effects.push_back(use);
    }
    Candidate c = candidate("stribeck_friction", 1);
    EXPECT_TRUE(free_shapes(model, c, *sim::find_effect("stribeck_friction")));
    EXPECT_TRUE(model.effects[0].parameters.at("speed_rad_s").fixed);
    EXPECT_FALSE(model.effects[1].parameters.at("speed_rad_s").fixed);
    EXPECT_NEAR(model.effects[1].parameters.at("speed_rad_s").maximum, 8, 1e-9);
    EXPECT_TRUE(model.effects[1].parameters.at("torque_Nm").fixed); // a strength
    c.wheel = 2;
    EXPECT_FALSE(free_shapes(model, c, *sim::find_effect("stribeck_friction")));
    EffectUse ripple;
    ripple.name = "torque_ripple";
    ripple.parameters["order"].value = 2;
    model.effects = {ripple};
    EXPECT_FALSE(free_shapes(model, candidate("torque_ripple"), *sim::find_effect("torque_ripple"))); // a kind
}

TEST(Accepted, that_is_taken_back_leaves_the_ladder_the_ranking_and_its_class) {
    Diagnosis d;
    const auto result = [](const char *effect, const char *verdict) {
        CandidateResult r;
        r.candidate = candidate(effect);
        r.verdict = verdict;
        return r;
    };
    d.accepted = {result("a", "class"), result("b", "named")};
    d.ranking = {result("a", "class"), result("b", "named"), result("a", "not_significant"), result("c", "class")};
    d.ladder = {{"baseline", 9, 9, 1}, {"+ a", 5, 5, 1}, {"+ b", 3, 3, 1}};
    d.classes = {{{"a", "c"}, ""}};
    d.accepted[0].class_index = 0;
    take_back(d, 0);
    ASSERT_EQ(d.accepted.size(), 1U);
    EXPECT_EQ(d.accepted[0].candidate.label(), "b");
    ASSERT_EQ(d.ladder.size(), 2U);
    EXPECT_EQ(d.ladder[1].label, "+ b");
    EXPECT_TRUE(d.classes.empty());
    EXPECT_EQ(d.ranking[0].verdict, "not_needed");
    EXPECT_EQ(d.ranking[1].verdict, "named");
    EXPECT_EQ(d.ranking[2].verdict, "not_significant");
    EXPECT_EQ(d.ranking[3].verdict, "class");
    take_back(d, 0);
    EXPECT_EQ(d.ranking[1].verdict, "not_needed");
    EXPECT_TRUE(d.accepted.empty());
    EXPECT_EQ(d.ladder.size(), 1U);
}

TEST(Refined, shapes_are_kept_where_the_fit_is_no_worse_for_them) {
    EXPECT_TRUE(no_worse(2, 2));
    EXPECT_TRUE(no_worse(2.0009, 2));
    EXPECT_FALSE(no_worse(2.0011, 2));
    EXPECT_FALSE(no_worse(std::nan(""), 2));
}

} // namespace
} // namespace traction::lab
