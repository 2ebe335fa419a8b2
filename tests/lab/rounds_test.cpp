// A round of the forward selection, rule by rule (rounds.h): who is fitted in full, in which order, who is believed beyond his range.
#include "host_tools/lab/decision/rounds.h"
#include "tests/lab/linear_machine.h"

#include <gtest/gtest.h>
#include <map>
#include <tuple>
#include <utility>

#include <algorithm>
#include <cmath>

namespace traction::lab {
namespace {

using hand_made::candidate;
using Labels = std::vector<std::string>;

// Not fitted yet: `p` by its linear step, which predicts this fall.
Trial trial(const std::string &effect, double p, double reduction, int wheel = -1) {
    Trial t;
    t.candidate = candidate(effect, wheel);
    t.assessment.p_value = p / 100;
    t.p_value = p;
    t.error_reduction = reduction;
    t.value = {0.5};
    t.verdict = "not_significant";
    return t;
}

// Fits by giving each what `gains` says of it; what is not in there does not pass.
struct Refits {
    std::map<std::string, double> gains;
    Labels asked;
    Refit one() {
        return [this](Trial &t) {
            asked.push_back(t.candidate.label());
            t.refitted = true;
            const auto found = gains.find(t.candidate.label());
            if (found != gains.end()) t.gain = found->second;
            t.verdict = found != gains.end() ? "passes" : "not_significant";
            return found != gains.end();
        };
    }
};

Labels likely(std::vector<Trial> trials, int refits, const std::map<std::string, double> &gains = {}) {
    Refits r{gains, {}};
    refit_likely(trials, refits, r.one());
    return r.asked;
}

TEST(Round, keeps_the_variant_of_the_largest_predicted_fall_of_each_effect_and_wheel_in_the_order_they_came) {
    BestVariants best;
    const auto add = [&](const char *effect, int wheel, double reduction, double size) {
        Trial t = trial(effect, 0.1, reduction, wheel);
        t.value = {size};
        best.add(t);
    };
    add("b", -1, 5, 1), add("a", -1, 7, 2), add("b", -1, 6, 3), add("b", 2, 1, 4), add("a", -1, 7, 5), add("b", -1, 4, 6);
    const std::vector<Trial> kept = best.take();
    ASSERT_EQ(kept.size(), 3U);
    EXPECT_EQ(kept[0].candidate.label(), "b");
    EXPECT_EQ(kept[0].value[0], 3); // the larger fall
    EXPECT_EQ(kept[1].value[0], 2); // of two alike the first
    EXPECT_EQ(kept[2].candidate.label(), "b on wheel 2");
    EXPECT_TRUE(best.take().empty());
}

TEST(Round, fits_the_most_sure_first_as_many_as_are_asked_for) {
    const std::vector<Trial> all = {trial("a", 0.03, 20), trial("b", 0.01, 20), trial("c", 0.02, 20)};
    EXPECT_EQ(likely(all, 2), (Labels{"b", "c"}));
    EXPECT_EQ(likely(all, 3), (Labels{"b", "c", "a"}));
    EXPECT_EQ(likely(all, 0), Labels{});
}

// Corrected p of a fifth, and a fall of three deviations of white noise, 9 squares.
TEST(Round, fits_none_that_is_unsure_or_small) {
    EXPECT_EQ(likely({trial("a", 0.19, 20)}, 5), Labels{"a"});
    EXPECT_EQ(likely({trial("a", 0.2, 20)}, 5), Labels{});
    EXPECT_EQ(likely({trial("a", 0.01, 9.1)}, 5), Labels{"a"});
    EXPECT_EQ(likely({trial("a", 0.01, 9)}, 5), Labels{});
}

// What explains less than half of what passed can be neither the winner nor of its class. (Its gain is what counts, not what was
// predicted.)
TEST(Round, fits_no_sure_one_that_explains_less_than_half_of_what_passed) {
    EXPECT_EQ(likely({trial("a", 0.01, 20), trial("b", 0.02, 51)}, 5, {{"a", 100}}), (Labels{"a", "b"}));
    EXPECT_EQ(likely({trial("a", 0.01, 20), trial("b", 0.02, 50)}, 5, {{"a", 100}}), Labels{"a"});
    EXPECT_EQ(likely({trial("a", 0.01, 20), trial("b", 0.02, 12)}, 5), (Labels{"a", "b"})) << "a did not pass";
    EXPECT_EQ(likely({trial("a", 0.01, 200), trial("b", 0.02, 150), trial("c", 0.03, 51)}, 5, {{"a", 100}, {"b", 50}}),
              (Labels{"a", "b", "c"}));
}

// Beyond the most sure, three of the largest predicted fall: of half of what passed where the step cannot be trusted, 0.7 where it is
// nearly sure, 0.9 where it is not; of 27 squares at least.
TEST(Round, then_fits_three_of_larger_predicted_fall) {
    const auto beside = [](double p, double reduction, bool leaves) {
        Trial t = trial("b", p, reduction);
        t.leaves_active_set = leaves;
        return likely({trial("a", 0.001, 20), t}, 1, {{"a", 100}}).size() == 2;
    };
    EXPECT_TRUE(beside(0.5, 91, false));
    EXPECT_FALSE(beside(0.5, 89, false));
    EXPECT_TRUE(beside(0.1, 71, false));
    EXPECT_FALSE(beside(0.1, 69, false));
    EXPECT_FALSE(beside(0.2, 71, false));
    EXPECT_TRUE(beside(0.5, 51, true));
    EXPECT_FALSE(beside(0.5, 49, true));
    EXPECT_EQ(likely({trial("a", 0.5, 27.1)}, 1), Labels{"a"}); // nothing passed
    EXPECT_EQ(likely({trial("a", 0.5, 27)}, 1), Labels{});
    EXPECT_EQ(likely({trial("a", 0.5, 30), trial("b", 0.5, 50), trial("c", 0.5, 40), trial("d", 0.5, 35)}, 0), (Labels{"b", "c", "d"}));
}

TEST(Round, then_fits_three_whose_scan_saw_more_than_the_step_did) {
    const auto seen = [](double nonlinear, double reduction, double passed) {
        Trial t = trial("b", 0.5, reduction);
        t.nonlinear_reduction = nonlinear;
        return likely({trial("a", 0.001, 2 * reduction), t}, 1, {{"a", passed}}).size() == 2;
    };
    EXPECT_TRUE(seen(28, 60, 100));
    EXPECT_FALSE(seen(27, 60, 100)); // 27 squares at least
    EXPECT_FALSE(seen(28, 60, 120)); // half of what passed
    EXPECT_TRUE(seen(31, 100, 150)); // 0.3 of its own fall
    EXPECT_FALSE(seen(30, 100, 150));
    std::vector<Trial> many;
    for (const char *name : {"a", "b", "c", "d", "e", "f", "g"}) {
        many.push_back(trial(name, 0.5, 100 - static_cast<double>(many.size())));
        many.back().nonlinear_reduction = 90;
    }
    EXPECT_EQ(likely(many, 0), (Labels{"a", "b", "c", "d", "e", "f"})); // three by their fall, three by their scan
}

TEST(Round, fits_what_passes_by_its_step_when_the_others_were_refused_the_most_sure_first) {
    std::vector<Trial> trials = {trial("a", 0.03, 1), trial("b", 0.01, 1), trial("c", 0.02, 1), trial("d", 0.001, 1), trial("e", 0.002, 1)};
    for (Trial &t : trials) t.verdict = "passes";
    trials[3].verdict = "too_small";
    trials[4].refitted = true;
    Refits none;
    std::vector<Trial> asked = trials;
    EXPECT_FALSE(refit_passing(asked, 2, none.one()));
    EXPECT_EQ(none.asked, (Labels{"b", "c"}));
    Refits some{{{"b", 10}}, {}};
    asked = trials;
    EXPECT_TRUE(refit_passing(asked, 3, some.one())); // the first passes, the others do not
    EXPECT_EQ(some.asked, (Labels{"b", "c", "a"}));
    EXPECT_EQ(asked[1].verdict, "passes");
    EXPECT_EQ(asked[2].verdict, "not_significant");
}

TEST(Round, from_afar_begins_at_a_quarter_of_the_range_on_every_side_that_there_is) {
    std::vector<double> starts;
    const auto ask = [&](Trial t, double gain) {
        starts.clear();
        t.start_change = Eigen::VectorXd::Ones(3);
        std::vector<Trial> trials = {t};
        const bool any = refit_from_afar(trials, [&](Trial &afar) {
            EXPECT_EQ(afar.start_change.size(), 0); // that of another size
            starts.push_back(afar.start.at(0));
            afar.gain = gain, afar.verdict = gain > 0 ? "passes" : "too_small", afar.value = afar.start;
            return gain > 0;
        });
        return std::make_pair(any, trials[0]);
    };
    Trial t = trial("a", 0.5, 1);
    t.candidate.maximum = {4};
    auto [any, found] = ask(t, 10);
    EXPECT_TRUE(any);
    EXPECT_EQ(starts, std::vector<double>{1});
    EXPECT_EQ(found.value[0], 1); // it stands in the place of the one that did not pass
    std::tie(any, found) = ask(t, 0);
    EXPECT_FALSE(any);
    EXPECT_EQ(found.value[0], 0.5);
    t.candidate.minimum = {-2};
    ask(t, 10);
    EXPECT_EQ(starts, (std::vector<double>{1, -0.5}));
    t.verdict = "passes", t.gain = 11; // passed before, and explains more
    std::tie(any, found) = ask(t, 10);
    EXPECT_FALSE(any);
    EXPECT_EQ(found.value[0], 0.5);
    std::tie(any, found) = ask(t, 12);
    EXPECT_TRUE(any);
    EXPECT_EQ(found.gain, 12);
}

TEST(Round, from_afar_asks_laws_of_one_strength_that_move_the_body_and_all_wheels) {
    const auto asked = [](const Trial &t) {
        std::vector<Trial> trials = {t};
        bool any = false;
        refit_from_afar(trials, [&](Trial &) { return any = true; });
        return any;
    };
    const Trial plain = trial("a", 0.5, 1);
    EXPECT_TRUE(asked(plain));
    Trial wheel = trial("a", 0.5, 1, 0), twofold = plain, rangeless = plain, electric = plain;
    twofold.candidate.strengths.push_back(twofold.candidate.strengths[0]);
    rangeless.candidate.maximum.clear();
    electric.candidate.touched = stage_torque | stage_voltage;
    for (const Trial *t : {&wheel, &twofold, &rangeless, &electric}) EXPECT_FALSE(asked(*t));
}

struct Beyond {
    std::vector<Trial> trials = {trial("in", 0.001, 100), trial("far", 0.001, 100)};
    std::vector<std::string> messages;
    Beyond(double in, double far) {
        for (Trial &t : trials) t.refitted = true;
        trials[0].verdict = "passes", trials[0].gain = in;
        trials[1].verdict = "beyond_range", trials[1].gain = far, trials[1].value = {0.75};
    }
    void judge(double base_error = 1000) { judge_beyond_range(trials, base_error, messages); }
};

// A tenth more than all that keeps within its range, and a tenth of the held-out error.
TEST(Beyond, its_range_a_size_is_believed_only_of_what_explains_much_and_more_than_all_others) {
    Beyond much(200, 221);
    much.judge();
    EXPECT_EQ(much.trials[1].verdict, "passes");
    EXPECT_TRUE(much.trials[1].at_least);
    EXPECT_EQ(
        much.messages,
        Labels{"far explains 22.1 % of the held-out error, but only beyond its range (size at 0.75): read its size as at least that"});
    Beyond hardly(200, 219);
    hardly.judge();
    EXPECT_EQ(hardly.trials[1].verdict, "beyond_range");
    EXPECT_FALSE(hardly.trials[1].at_least);
    EXPECT_EQ(hardly.messages, Labels{"far explains 21.9 % of the held-out error, but only beyond its range (size at 0.75): not named"});
    Beyond less(200, 200);
    less.judge();
    EXPECT_TRUE(less.messages.empty());
    Beyond little(10, 99), enough(10, 101);
    little.judge(), enough.judge();
    EXPECT_FALSE(little.trials[1].at_least);
    EXPECT_TRUE(enough.trials[1].at_least);
}

TEST(Beyond, its_range_nothing_is_believed_of_what_is_bounded_and_the_best_of_several_is_told_once) {
    Beyond bounded(0, 500);
    bounded.trials[1].candidate.bounded = true;
    bounded.judge();
    EXPECT_EQ(bounded.trials[1].verdict, "beyond_range");
    EXPECT_TRUE(bounded.messages.empty());
    Beyond unfitted(900, 500); // what passes by its linear step alone is none to compare with
    unfitted.trials[0].refitted = false;
    unfitted.judge();
    EXPECT_TRUE(unfitted.trials[1].at_least);
    Beyond two(0, 500);
    two.trials.push_back(two.trials[1]);
    two.trials[2].candidate.effect = "farther", two.trials[2].gain = 600;
    two.judge();
    EXPECT_EQ(two.trials[1].verdict, "beyond_range");
    EXPECT_EQ(two.trials[2].verdict, "passes");
    two.trials[2].verdict = "beyond_range"; // the next round
    two.judge();
    EXPECT_EQ(two.messages.size(), 1U);
    two.trials[2].verdict = "not_significant";
    two.judge();
    EXPECT_EQ(two.messages.size(), 2U); // of another one it was not told
}

TEST(Round, begins_anew_from_the_refit_that_fell_most_though_its_own_effect_says_nothing) {
    std::vector<Trial> trials = {trial("a", 0.5, 28), trial("b", 0.5, 40), trial("c", 0.5, 30)};
    for (Trial &t : trials) t.refitted = true;
    EXPECT_EQ(better_place(trials), &trials[1]);
    trials[1].verdict = "passes"; // it is a name
    EXPECT_EQ(better_place(trials), &trials[2]);
    trials[2].p_value = 0.2; // its effect says something
    EXPECT_EQ(better_place(trials), &trials[0]);
    trials[0].error_reduction = 27; // three times nine squares
    EXPECT_EQ(better_place(trials), nullptr);
    trials[0].error_reduction = 28, trials[0].refitted = false;
    EXPECT_EQ(better_place(trials), nullptr);
}

TEST(Round, notices_a_refit_that_ended_half_of_the_size_away_from_where_it_was_sure) {
    Trial t = trial("a", 0.5, 1);
    t.candidate.variant = {{"speed", 2.0}};
    const Earlier earlier{t.candidate.variant, {-1}};
    const auto at = [&](double size) {
        t.value = {size};
        return lost(t, earlier);
    };
    EXPECT_FALSE(at(-1));
    EXPECT_FALSE(at(-1.49));
    EXPECT_TRUE(at(-1.51));
    EXPECT_FALSE(at(-0.51));
    EXPECT_TRUE(at(-0.49));
    EXPECT_TRUE(at(1));
    t.candidate.touched = stage_torque; // of what is linear there is one place
    EXPECT_FALSE(at(1));
    t.candidate.touched = stage_all;
    EXPECT_FALSE(lost(t, Earlier{{{"speed", 3.0}}, {-1}})); // another law
    t.value = {-1, 5};
    EXPECT_TRUE(lost(t, Earlier{t.candidate.variant, {-1, 1}})); // any of its sizes
}

HeldOut held(const Eigen::VectorXd &residual, double error) {
    HeldOut h;
    h.residual = residual;
    h.error = error;
    return h;
}

HeldOut held_at(const std::vector<double> &residual, double error) {
    HeldOut h;
    h.residual.resize(static_cast<Eigen::Index>(residual.size()));
    std::copy(residual.begin(), residual.end(), h.residual.begin());
    h.error = error;
    return h;
}

TEST(Round, keeps_a_name_that_is_solid_and_passes_again_or_without_which_more_is_left_out_wrongly) {
    int asked = 0;
    const auto says = [&](bool it) {
        return [&asked, it] {
            ++asked;
            return it;
        };
    };
    const auto yes = says(true), no = says(false);
    for (const char *verdict : {"passes", "beyond_range"}) {
        EXPECT_TRUE(stays(verdict, true, no, no));
        EXPECT_EQ(asked, 0); // it costs twenty predictions and more
        EXPECT_FALSE(stays(verdict, false, yes, no));
        EXPECT_EQ(std::exchange(asked, 0), 1); // its coefficient is unsure: what it takes alone is asked
    }
    EXPECT_TRUE(stays("not_significant", true, yes, no));
    EXPECT_EQ(std::exchange(asked, 0), 1);
    EXPECT_FALSE(stays("not_significant", true, no, no));
    EXPECT_TRUE(stays("not_significant", true, no, yes));
    EXPECT_FALSE(stays("too_small", false, yes, no));
    EXPECT_TRUE(stays("too_small", false, no, yes));
}

TEST(Round, knows_the_balance_that_is_missed_the_most_in_its_own_noise) {
    const Dataset data = hand_made::data_of(3, 2, 1);
    const Eigen::VectorXd residual = (Eigen::VectorXd(6) << 3, 4, 10, 10, 1, 1).finished(),
                          noise = (Eigen::VectorXd(6) << 1, 1, 5, 5, 0.5, 1).finished();
    EXPECT_DOUBLE_EQ(worst_error(held(residual, 0), data, noise), std::sqrt(12.5)); // (9 + 16) / 2; the others 4 and 2.5
    EXPECT_DOUBLE_EQ(worst_error(held(residual, 0), data, 10 * noise), std::sqrt(0.125));
    Dataset bare = data;
    bare.balance[0].measured.clear(); // holds no row
    EXPECT_DOUBLE_EQ(worst_error(held(residual.tail(4), 0), bare, noise.tail(4)), 2);
    const Dataset single = hand_made::data_of(1, 1, 1);
    EXPECT_DOUBLE_EQ(worst_error(held(Eigen::VectorXd::Constant(1, 3), 0), single, Eigen::VectorXd::Ones(1)), 3);
}

// 0.2 % of all, or 2 % of one balance.
TEST(Round, asks_of_a_name_that_the_error_falls_notably_in_all_or_in_one_balance) {
    const Dataset data = hand_made::data_of(3, 2, 1);
    const Eigen::VectorXd before = (Eigen::VectorXd(6) << 3, 4, 6, 8, 0, 0).finished(); // norms 5, 10, 0
    const auto falls = [&](double first, double second, double error) {
        Eigen::VectorXd after = before;
        after.head(2) *= first, after.segment(2, 2) *= second;
        return falls_notably(held(before, 2), held(after, error), data);
    };
    EXPECT_FALSE(falls(1, 1, 2));
    EXPECT_FALSE(falls(1, 1, 2 * 0.9981));
    EXPECT_TRUE(falls(1, 1, 2 * 0.9979));
    EXPECT_TRUE(falls(1, 0.979, 2));
    EXPECT_FALSE(falls(1, 0.981, 2));
    EXPECT_TRUE(falls(0.97, 1.009, 2)); // another may rise by what is left over
    EXPECT_FALSE(falls(0.97, 1.011, 2));
    EXPECT_TRUE(falls(0.97, 1.011, 1.99));
}

// 1 % of all, or 3 % of one balance: less, and it is the data sheet that speaks.
TEST(Round, knows_a_fall_that_the_sheet_has_no_part_in) {
    const Dataset data = hand_made::data_of(2, 2, 1);
    const HeldOut before = held_at({3, 4, 6, 8}, 2);
    const auto falls = [&](double second, double error) {
        return falls_without_the_sheet(before, held_at({3, 4, 6 * second, 8 * second}, error), data);
    };
    EXPECT_FALSE(falls(1, 2 * 0.991));
    EXPECT_TRUE(falls(1, 2 * 0.989));
    EXPECT_FALSE(falls(0.971, 2));
    EXPECT_TRUE(falls(0.969, 2));
}

// 3 % of all, whatever one balance says.
TEST(Round, asks_more_of_a_law_that_wanders_with_the_ground) {
    for (const char *law : {"soil_patch", "resistance_patch", "soil_gradient", "relaxation_length"})
        EXPECT_TRUE(wanders(candidate(law))) << law;
    for (const char *law : {"slip_sinkage", "soil", "mass_offset_y", ""}) EXPECT_FALSE(wanders(candidate(law))) << law;
    const Dataset data = hand_made::data_of(2, 1, 1);
    const auto falls = [&](double share_left, double first) {
        return falls_notably(held(Eigen::VectorXd::Ones(2), 2), held(Eigen::Vector2d(first, 1), 2 * share_left), data, true);
    };
    EXPECT_FALSE(falls(0.971, 1));
    EXPECT_TRUE(falls(0.969, 1));
    EXPECT_FALSE(falls(0.971, 0.1));
}

TEST(Round, of_another_sensor_is_what_no_number_of_the_sheet_does) {
    for (const char *law : {"radar_pitch", "camera_scale", "gyro_delay"}) EXPECT_TRUE(of_another_sensor(candidate(law))) << law;
    for (const char *law : {"accel_tilt", "current_gain", "voltage_gain", "encoder_missed", "grade", ""})
        EXPECT_FALSE(of_another_sensor(candidate(law))) << law;
}

TEST(Round, stands_beside_a_bent_sheet_by_sure_rows_or_as_another_sensors_of_a_model_that_fits) {
    for (const auto &[law, p, left, stands] : {std::tuple{"rolling_resistance", 1e-9, 3.0, true},
                                               {"rolling_resistance", 1e-7, 1.1, false},
                                               {"gyro_scale", 1e-3, 1.9, true},
                                               {"gyro_scale", 1e-3, 2.1, false},
                                               {"gyro_scale", 1e-9, 2.1, true},
                                               {"accel_tilt", 1e-3, 1.1, false}})
        EXPECT_EQ(stands_beside_bent_sheet(candidate(law), p, left), stands) << law << " " << p << " " << left;
}

TEST(Round, knows_a_law_that_takes_half_of_what_is_no_noise_of_a_model_that_misses_by_far) {
    const auto takes = [](double before, double after) { return takes_most(held_at({}, before), held_at({}, after)); };
    EXPECT_TRUE(takes(3, 2.2));  // 8 squares beyond noise, 3.84
    EXPECT_FALSE(takes(3, 2.3)); // 4.29
    EXPECT_TRUE(takes(2.01, 1));
    EXPECT_FALSE(takes(2, 1)); // not by far
    EXPECT_FALSE(takes(0, 0));
    const Dataset data = hand_made::data_of(2, 2, 1);
    const Eigen::VectorXd noise = Eigen::VectorXd::Constant(4, 0.5);
    const auto of_one = [&](double first, double second) { // from 6 and 1 times a noise of 0.5
        return takes_most_of_one(held_at({3, 3, 0.5, 0.5}, 4), held_at({first, first, second, second}, 4), data, noise);
    };
    EXPECT_TRUE(of_one(2.13, 0.9)); // 36 to 18.1 squares
    EXPECT_FALSE(of_one(2.16, 0));
    EXPECT_FALSE(of_one(3, 0));
}

TEST(Round, asks_scales_of_its_own_of_three_that_are_not_unlikely_and_may_be_told) {
    const auto refitted = [](const char *effect, double p, double reduction, double value = 0.5) {
        Trial t = trial(effect, p, reduction);
        t.refitted = true, t.gain = 1, t.value = {value};
        return t;
    };
    std::vector<Trial> all = {refitted("a", 0.449, 10), refitted("b", 0.451, 90), refitted("c", 0.01, 30), refitted("d", 0.01, 20),
                              refitted("e", 0.01, 15)};
    EXPECT_EQ(worth_scales_of_its_own(all, 0.003, 3), (std::vector<std::size_t>{2, 3, 4}));
    all[3].refitted = false;
    EXPECT_EQ(worth_scales_of_its_own(all, 0.003, 3), (std::vector<std::size_t>{2, 4, 0}));
    all[2].verdict = "too_small"; // was refused for another reason
    EXPECT_EQ(worth_scales_of_its_own(all, 0.003, 3), (std::vector<std::size_t>{4, 0}));
    all[4].gain = 0;
    EXPECT_EQ(worth_scales_of_its_own(all, 0.003, 3), (std::vector<std::size_t>{0}));
    EXPECT_TRUE(worth_scales_of_its_own({refitted("a", 0.01, 10, -0.5)}, 0.003, 3).empty()); // of a sign that cannot be
    EXPECT_TRUE(worth_scales_of_its_own({refitted("a", 0.01, 10, 0.05)}, 0.003, 3).empty()); // of no interest
    EXPECT_TRUE(worth_scales_of_its_own({refitted("a", 0.01, 10, 1)}, 0.003, 3).empty());    // at its limit
    EXPECT_EQ(worth_scales_of_its_own({refitted("soil_patch", 1, 10)}, 0.003, 5.1), (std::vector<std::size_t>{0})); // in few blocks
    EXPECT_TRUE(worth_scales_of_its_own({refitted("soil_patch", 1, 10)}, 0.003, 4.9).empty()); // as uneven ground makes it miss
    EXPECT_TRUE(worth_scales_of_its_own({refitted("soil_gradient", 1, 10)}, 0.003, 5.1).empty());
    EXPECT_TRUE(is_of_few_blocks(refitted("resistance_patch", 0.451, 10), 0.003));
    EXPECT_FALSE(is_of_few_blocks(refitted("resistance_patch", 0.449, 10), 0.003));
}

TEST(Afar, the_one_that_gains_most_and_more_than_the_winner_may_take_its_place) {
    std::vector<Trial> all = {trial("a", 0.1, 1), trial("b", 0.1, 1), trial("c", 0.1, 1)};
    const double gains[] = {30, 50, 40};
    for (std::size_t i = 0; i < 3; ++i) all[i].verdict = "passes", all[i].refitted = true, all[i].gain = gains[i];
    EXPECT_EQ(most_beyond(all, 20), 1U);
    EXPECT_EQ(most_beyond(all, 49.9), 1U);
    EXPECT_EQ(most_beyond(all, 50), 3U); // none
    all[1].refitted = false;
    EXPECT_EQ(most_beyond(all, 20), 2U);
    all[2].verdict = "not_held_out";
    EXPECT_EQ(most_beyond(all, 20), 0U);
    EXPECT_EQ(most_beyond(all, 30), 3U);
    EXPECT_EQ(most_beyond({}, 0), 0U);
}

TEST(Increments, are_taken_of_the_same_parameter_of_the_same_stated_value_alone) {
    const Dataset data = hand_made::data_of(1, 10, 0.5);
    const auto with = [&](const FreeParameter &p, double theta) {
        Problem one = hand_made::problem_of(data, {hand_made::parameter("other", "key", 1, 1), p}, Eigen::MatrixXd::Zero(10, 2),
                                            Eigen::VectorXd::Zero(10));
        one.theta[0] = -1, one.theta[1] = theta;
        return one;
    };
    FreeParameter p = hand_made::parameter("motor", "coulomb_Nm", 0.05, 0.01);
    p.wheel = 2, p.own = true;
    const auto taken = [&](const FreeParameter &from) {
        Problem to = with(p, 7);
        take_increments(to, with(from, 3));
        EXPECT_EQ(to.theta[0], -1);
        return to.theta[1];
    };
    EXPECT_EQ(taken(p), 3);
    FreeParameter q = p;
    q.owner = "wheel";
    EXPECT_EQ(taken(q), 7);
    q = p, q.key = "viscous_Nms";
    EXPECT_EQ(taken(q), 7);
    q = p, q.wheel = 1;
    EXPECT_EQ(taken(q), 7);
    q = p, q.own = false;
    EXPECT_EQ(taken(q), 7);
    q = p, q.base = 0.06;
    EXPECT_EQ(taken(q), 7);
}

// An offset of the radar that the first model has not: of one noise it is sure, of a hundredth it is not, and of the same model it is none.
TEST(Prediction, is_better_where_the_fall_of_what_is_left_out_exceeds_its_scatter_by_either_scales) {
    const auto better = [](double hidden, double scale_of_radar) {
        hand_made::LinearMachine machine;
        machine.hide(hand_made::r1(), hidden);
        Problem before(machine.data, machine.physics, {hand_made::a0(0.1)}),
            after(machine.data, machine.physics, {hand_made::a0(0.1), hand_made::r1()});
        for (Problem *p : {&before, &after}) p->gauss_newton(2);
        if (scale_of_radar != 1) { // rows that the fit's scales count for nothing
            before.row_scale.segment(120, 120) *= scale_of_radar;
            before.row_scale.head(120) *= 1e3;
        }
        return predicts_better(before, after);
    };
    EXPECT_TRUE(better(0.5, 1));
    EXPECT_FALSE(better(1e-4, 1));
    EXPECT_FALSE(better(0.5, 1e-6)); // sure in noises alone
}

} // namespace
} // namespace traction::lab
