// What the lab says is true and does not contradict itself: the words of compare, diagnose and next, what is left and its parts, the rows
// that a result carries.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/result/next_result.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/result/series.h"
#include "host_tools/lab/result/story.h"
#include "host_tools/lab/result/words.h"
#include "host_tools/simulate/simulate.h"
#include "tests/lab/generator/generator.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

namespace traction::lab {
namespace {

using generator::GeneratorConfig;
using generator::Soil;

Model sand() { return read_model("models/rover_sand.toml"); }

log::Log generated(const std::string &effect, std::uint64_t seed) {
    GeneratorConfig config;
    config.soil = Soil::sand;
    config.seed = seed;
    config.duration_s = 120;
    if (!effect.empty()) config.hidden.push_back(generator::parse_setting(effect));
    return generator::generate(config);
}

// The plant's drive on sand whose strength varies by `grip` from place to place; nothing is hidden.
log::Log driven(double grip) {
    sim::Scenario scenario = sim::read_scenario("scenarios/demo_sand.toml");
    scenario.plant.ground.grip_noise = grip;
    return simulate(scenario).log;
}

bool has(const std::string &text, const std::string &part) { return text.find(part) != std::string::npos; }

std::size_t widest(const std::string &text) {
    std::size_t most = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        most = std::max(most, static_cast<std::size_t>(std::count_if(
                                  line.begin(), line.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; })));
    return most;
}

struct Asked {
    Model model;
    Dataset data;
    Comparison comparison;
    Diagnosis diagnosis;
    Story story;
};

Asked ask(const log::Log &log) {
    Asked a;
    a.model = sand();
    a.data = make_dataset(a.model, log);
    a.comparison = compare(a.model, a.data, false);
    a.diagnosis = diagnose(a.model, a.data, {});
    if (!a.diagnosis.accepted.empty()) show_after(a.comparison, a.diagnosis.model, a.data);
    a.story = tell(a.comparison, a.diagnosis, nullptr);
    return a;
}

// Grip noise multiplies a wheel's traction, so it leaves what follows the traction: what it adds to the squares is told as the ground's,
// for more than the half, and the ground's part is the largest but only where the ground is uneven.
TEST(Remainder, what_uneven_ground_adds_is_told_as_the_ground) {
    const Remainder even = compare(sand(), make_dataset(sand(), driven(0)), false).left;
    const Remainder uneven = compare(sand(), make_dataset(sand(), driven(0.06)), false).left;
    const auto square = [](double x) { return x * x; };
    const double added = square(uneven.error) - square(even.error);
    ASSERT_GT(added, 1); // more than the sensors' noise: the ground does show
    EXPECT_GT(square(uneven.of(LeftBy::ground)) - square(even.of(LeftBy::ground)), 0.5 * added);
    EXPECT_GT(uneven.of(LeftBy::ground), uneven.of(LeftBy::encoders));
}

TEST(Remainder, its_parts_add_up_to_what_is_left) {
    const Comparison c = compare(sand(), make_dataset(sand(), generated("slip_sinkage:coefficient=0.2", 5)), false);
    double sum = 0;
    for (const double part : c.left.part) {
        EXPECT_GE(part, 0);
        sum += part * part;
    }
    EXPECT_NEAR(std::sqrt(sum), c.adjusted, 1e-9 * c.adjusted); // both are roots of the same mean: rounding alone
    EXPECT_LE(c.left.of(LeftBy::sensors), 1);
}

TEST(Words, a_log_on_which_nothing_is_found_is_never_said_to_hold_something) {
    const Asked a = ask(driven(0.06));
    ASSERT_EQ(a.diagnosis.kind, "nothing") << a.diagnosis.text;
    const std::string all = comparison_text(a.comparison) + story_text(a.story) + diagnosis_text(a.diagnosis);
    EXPECT_FALSE(has(all, "there is something to find")) << all;
    ASSERT_GT(a.comparison.adjusted, 1.6); // not close to the noise, so a reader must be told what to do
    EXPECT_TRUE(has(a.story.next, "traction next --all")) << a.story.next;
    EXPECT_TRUE(has(a.diagnosis.text, "traction next --all")) << a.diagnosis.text;
    EXPECT_TRUE(has(a.story.left, "how the ground varies from place to place")) << a.story.left;
    EXPECT_TRUE(has(a.story.left, "would show there too")) << "what is left is no proof of its cause: " << a.story.left;
}

TEST(Words, what_is_left_after_the_true_effect_is_told_by_its_parts) {
    const Asked a = ask(generated("slip_sinkage:coefficient=0.2", 5));
    ASSERT_EQ(a.diagnosis.effects, std::vector<std::string>{"slip_sinkage"});
    EXPECT_FALSE(has(comparison_text(a.comparison), "something to find"));
    EXPECT_TRUE(has(a.story.left, "is left, of which")) << a.story.left;
    EXPECT_TRUE(has(a.story.headline, "slip_sinkage explains it")) << a.story.headline;
    EXPECT_LT(a.comparison.left_after.error, a.comparison.left.error);
    // one percentage for one thing: the held-out fall, in story and verdict alike, and none in the table of what was tried
    std::ostringstream fall;
    fall << std::lround(fall_percent(a.diagnosis.ladder)) << " %";
    EXPECT_TRUE(has(a.story.sure, fall.str())) << a.story.sure;
    EXPECT_TRUE(has(a.diagnosis.text, fall.str())) << a.diagnosis.text;
    const std::string table = diagnosis_text(a.diagnosis);
    EXPECT_EQ(std::count(table.begin(), table.end(), '%'), 1) << table;
    EXPECT_FALSE(has(table, "not significant"));
}

TEST(Words, fit_the_terminal_and_no_interval_goes_beyond_all_there_is) {
    const Asked a = ask(generated("slip_sinkage:coefficient=0.2", 5));
    for (const std::string &text : {comparison_text(a.comparison), story_text(a.story), diagnosis_text(a.diagnosis)})
        EXPECT_LE(widest(text), terminal_columns) << text;
    nlohmann::json json;
    put_diagnosis(json, a.diagnosis);
    for (const auto &c : json["candidates"]) {
        EXPECT_TRUE(!c["gain_high"].is_number() || c["gain_high"].get<double>() <= 1) << c["effect"];
        EXPECT_FALSE(c["verdict"] == "not_significant" && c["p_value"].get<double>() < 0.003) << c.dump();
    }
}

TEST(Words, a_candidate_of_a_tiny_p_is_not_called_insignificant) {
    Diagnosis d;
    CandidateResult r;
    r.candidate.effect = "accel_scale", r.verdict = "not_significant", r.p_value = 5e-11, r.gain_high = 1.37;
    d.ranking.push_back(r);
    nlohmann::json json;
    put_diagnosis(json, d);
    EXPECT_EQ(json["candidates"][0]["verdict"], "too_little");
    EXPECT_TRUE(has(diagnosis_text(d), "helps too little to matter")) << diagnosis_text(d);
    EXPECT_FALSE(has(diagnosis_text(d, true), "137")) << diagnosis_text(d, true);
    d.ranking[0].p_value = 0.2;
    EXPECT_TRUE(has(diagnosis_text(d), "no sure help"));
}

// Of an error of 5 times the noise, 4 could be explained; 4.2 after the effect is a fifth of that, 1.5 nearly all.
TEST(Words, an_effect_that_takes_little_is_said_to_explain_a_part) {
    Comparison c;
    c.error = 6, c.adjusted = 5, c.left.error = 5;
    c.left_after.error = 4.2, c.left_after.part[static_cast<std::size_t>(LeftBy::ground)] = 4.2;
    Diagnosis d;
    d.kind = "named", d.effects = {"load_transfer"};
    CandidateResult r;
    r.candidate.effect = "load_transfer", r.verdict = "named";
    d.accepted.push_back(r);
    d.ladder = {{"baseline", 5, 5, 1}, {"+ load_transfer", 4.2, 4.2, 1}};
    EXPECT_TRUE(has(tell(c, d, nullptr).headline, "load_transfer explains a part of it")) << tell(c, d, nullptr).headline;
    EXPECT_TRUE(has(tell(c, d, nullptr).next, "the ground or the sensors")) << tell(c, d, nullptr).next; // all others were tried
    EXPECT_FALSE(has(tell(c, d, nullptr).next, "traction next --all")) << tell(c, d, nullptr).next;
    d.not_excited = {{"sinkage", "too little load"}};
    EXPECT_TRUE(has(tell(c, d, nullptr).next, "one of the 1 effects that this log cannot show: traction next --all"))
        << tell(c, d, nullptr).next;
    c.left_after.error = 1.5, d.ladder.back().heldout = 1.5;
    EXPECT_TRUE(has(tell(c, d, nullptr).headline, "load_transfer explains it")) << tell(c, d, nullptr).headline;
    EXPECT_FALSE(has(tell(c, d, nullptr).next, "traction next --all"));
}

TEST(Words, a_model_whose_numbers_the_fit_took_far_is_not_called_good) {
    Comparison c;
    c.error = 3, c.adjusted = 1.1;
    Diagnosis d;
    d.kind = "nothing";
    EXPECT_TRUE(has(tell(c, d, nullptr).good_enough, "Yes, for this log")) << tell(c, d, nullptr).good_enough;
    EXPECT_TRUE(has(tell(c, d, nullptr).next, "use the model")) << tell(c, d, nullptr).next;
    d.moved = {"motor.coulomb_Nm"};
    const Story story = tell(c, d, nullptr);
    EXPECT_TRUE(has(story.good_enough, "Only with motor.coulomb_Nm far from what is stated")) << story.good_enough;
    EXPECT_FALSE(has(story.next, "use the model")) << story.next;
    EXPECT_TRUE(has(story.next, "Check motor.coulomb_Nm")) << story.next;
    EXPECT_FALSE(has(story.headline, "nothing is missing")) << story.headline;

    c.adjusted = 3.3; // nothing explains it, and numbers are far off or at their limits: those first
    d.limits = {{"motor.viscous_Nms", "N m s", 0.2, false, true},
                {"sensors.accel.lag_s", "s", 0.06, false, true},
                {"soil.mu", "1", 0, false, false}};
    const Story unexplained = tell(c, d, nullptr);
    EXPECT_TRUE(has(unexplained.next, "Check motor.viscous_Nms and motor.coulomb_Nm on the machine")) << unexplained.next;
    EXPECT_TRUE(has(unexplained.headline, unexplained.next)) << unexplained.headline;
    d.limits.clear(), d.moved.clear();
    EXPECT_FALSE(has(tell(c, d, nullptr).next, "Check")) << tell(c, d, nullptr).next;
}

TEST(Words, a_wrong_number_is_not_surely_wrong_where_an_effect_acts_as_it_does) {
    const Comparison c;
    Diagnosis d;
    d.kind = "wrong_model", d.text = "Look first at the mass.";
    EXPECT_TRUE(has(tell(c, d, nullptr).good_enough, "no effect is missing")) << tell(c, d, nullptr).good_enough;
    EXPECT_FALSE(has(tell(c, d, nullptr).next, "traction add")) << tell(c, d, nullptr).next;
    d.nearest = {"current_gain"};
    EXPECT_FALSE(has(tell(c, d, nullptr).good_enough, "no effect is missing")) << tell(c, d, nullptr).good_enough;
    EXPECT_TRUE(has(tell(c, d, nullptr).good_enough, "or an effect is missing that acts as it does")) << tell(c, d, nullptr).good_enough;
    EXPECT_TRUE(has(tell(c, d, nullptr).next, "traction add")) << tell(c, d, nullptr).next;
}

TEST(Words, windows_end_with_the_log) {
    const Dataset data = make_dataset(sand(), generated("", 3));
    const double end = data.time(data.count - 1);
    int last = 0;
    for (const BalanceComparison &b : compare(sand(), data, true).balances)
        for (const Worst &w : b.worst) {
            EXPECT_LE(w.t1_s, end + 0.05) << b.name; // half a row's window
            EXPECT_GT(w.t1_s, w.t0_s);
            last += w.t0_s + 5 > end;
        }
    EXPECT_GE(last, 0);
}

TEST(Next, what_a_diagnosis_could_not_see_is_never_said_to_be_told_by_the_log) {
    const Model model = sand();
    const Dataset data = make_dataset(model, driven(0.06));
    const Diagnosis d = diagnose(model, data, {});
    ASSERT_FALSE(d.not_excited.empty());
    const NextExperiment next =
        next_experiment(d, model, data, true, [](const std::string &toml) { return simulate(sim::parse_scenario(toml, "manoeuvre")).log; });
    ASSERT_FALSE(next.questions.empty());
    for (const Question &q : next.questions) EXPECT_NE(q.status, "told") << q.members.front();
    EXPECT_FALSE(has(next_text(next), "should show it already"));
    EXPECT_LE(widest(next_text(next)), terminal_columns) << next_text(next);
}

Balance rows_at(const std::vector<double> &t, double length) {
    Balance b{BalanceKind::current_torque, 0, "wheel0.current_A", "", "A", 1, "", {}, {}, {}, {}, {}};
    for (const double x : t) b.t0_s.push_back(x), b.t1_s.push_back(x + length), b.measured.push_back(0);
    return b;
}

TEST(Gaps, rows_that_were_left_out_are_counted_where_they_are) {
    std::vector<double> t;
    for (int i = 0; i < 200; ++i)
        if (i < 40 || i >= 70) t.push_back(0.05 * i); // 30 rows are missing from 2.0 to 3.5 s
    const std::vector<Gap> gaps = gaps_of(rows_at(t, 0.05), 0, 12);
    ASSERT_EQ(gaps.size(), 2u);
    EXPECT_NEAR(gaps[0].t0_s, 2.0, 1e-9);
    EXPECT_NEAR(gaps[0].t1_s, 3.5, 1e-9);
    EXPECT_EQ(gaps[0].rows, 30);
    EXPECT_NEAR(gaps[1].t1_s, 12, 1e-9); // the log goes on after the last row
    EXPECT_EQ(gaps[1].rows, 40);
    EXPECT_TRUE(gaps_of(rows_at({0, 0.05, 0.1, 0.15, 0.2}, 0.05), 0, 0.25).empty());
}

RC_GTEST_PROP(Series, no_extreme_of_any_column_is_lost_and_nothing_is_made_up, ()) {
    const auto seed = *rc::gen::inRange<unsigned>(0, 1000000);
    const auto n = *rc::gen::inRange<std::size_t>(1, 3000);
    const auto most = *rc::gen::inRange<std::size_t>(20, 800);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> a(n), b(n);
    for (std::size_t i = 0; i < n; ++i) a[i] = normal(random), b[i] = random() % 50 == 0 ? std::nan("") : normal(random) * 100;
    const std::vector<std::size_t> kept = extremes_of({&a, &b}, most);
    RC_ASSERT(std::is_sorted(kept.begin(), kept.end()) && kept.back() < n);
    RC_ASSERT(kept.size() <= std::max(n <= most ? n : 0, most + 2)); // two ends beside the stretches' own
    const std::size_t stretches = n <= most ? n : std::max<std::size_t>(1, most / 4);
    for (std::size_t s = 0; s < stretches; ++s)
        for (const std::vector<double> *column : {&a, &b}) {
            double low = 1e300, high = -1e300, kept_low = 1e300, kept_high = -1e300;
            for (std::size_t i = s * n / stretches; i < (s + 1) * n / stretches; ++i)
                if (!std::isnan((*column)[i])) low = std::min(low, (*column)[i]), high = std::max(high, (*column)[i]);
            for (const std::size_t i : kept)
                if (i >= s * n / stretches && i < (s + 1) * n / stretches && !std::isnan((*column)[i]))
                    kept_low = std::min(kept_low, (*column)[i]), kept_high = std::max(kept_high, (*column)[i]);
            RC_ASSERT(low == kept_low && high == kept_high);
        }
}

TEST(Wrapping, keeps_every_word_and_the_width) {
    const std::string text = wrapped("one two three four five six seven eight nine ten eleven twelve", 4, 20);
    EXPECT_LE(widest(text), 20u);
    EXPECT_EQ(text, "one two three four\n    five six seven\n    eight nine ten\n    eleven twelve\n");
    EXPECT_EQ(wrapped("    indented words", 6), "    indented words\n");
    EXPECT_EQ(strip_text({0, 1, std::nan(""), 2}), "▁▅ █");
}

} // namespace
} // namespace traction::lab
