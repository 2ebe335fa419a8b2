// A drive of one manner: what may be named from one velocity, and that no other drive is judged by it.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/decision/manner.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "tests/lab/generator/generator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace traction::lab {
namespace {

generator::GeneratorConfig machine(const std::string &drive, const std::string &hidden = "") {
    generator::GeneratorConfig config;
    config.soil = generator::Soil::concrete;
    config.drive = drive;
    config.seed = 7;
    config.duration_s = 60;
    if (!hidden.empty()) config.hidden.push_back(generator::parse_setting(hidden));
    return config;
}

Model sheet() { return read_model("tests/lab/campaign/machine_concrete.toml"); }

Dataset data_of(const std::string &drive, const std::string &hidden = "") {
    const Model model = sheet();
    return make_dataset(model, generator::generate(machine(drive, hidden)));
}

// Two wheels that keep 3 and -2 rad/s, `other` of 100 rows at twice that, the first ten at rest.
Dataset steady(int other) {
    Dataset data;
    data.wheel.resize(2);
    for (int k = 0; k < 110; ++k)
        for (std::size_t i = 0; i < 2; ++i) data.wheel[i].speed_rad_s.push_back(k < 10 ? 0 : (i == 0 ? 3 : -2) * (k < 10 + other ? 2 : 1));
    return data;
}

TEST(Manner, three_quarters_at_one_velocity_are_one_manner_and_rest_is_none) {
    EXPECT_TRUE(is_of_one_manner(steady(0)));
    EXPECT_TRUE(is_of_one_manner(steady(24)));
    EXPECT_FALSE(is_of_one_manner(steady(26)));
    Dataset turned = steady(0); // the same speeds, one wheel the other way for half of the time: the rover turns
    for (std::size_t k = 60; k < 110; ++k) turned.wheel[1].speed_rad_s[k] = 2;
    EXPECT_FALSE(is_of_one_manner(turned));
}

TEST(Manner, a_table_an_imposed_speed_and_a_rover_at_rest_are_no_drives_of_one_manner) {
    Dataset table = steady(0), imposed = steady(0), rest = steady(0);
    table.independent_rows = true;
    imposed.body_speed_m_s.assign(110, 0.1);
    for (WheelInput &w : rest.wheel) w.speed_rad_s.assign(110, 0);
    EXPECT_FALSE(is_of_one_manner(table));
    EXPECT_FALSE(is_of_one_manner(imposed));
    EXPECT_FALSE(is_of_one_manner(rest));
}

TEST(Manner, a_cruise_is_one_and_the_plan_that_the_lab_is_judged_by_is_none) {
    EXPECT_TRUE(is_of_one_manner(data_of("cruise")));
    for (const char *drive : {"full", "stairs", "stop_and_go", "shuttle", "curves"})
        EXPECT_FALSE(is_of_one_manner(data_of(drive))) << drive;
}

Candidate on(const std::string &effect, int wheel, unsigned touched) {
    Candidate c;
    c.effect = effect, c.wheel = wheel, c.touched = touched;
    return c;
}

TEST(Manner, one_wheel_alone_and_numbers_at_their_limits_are_not_believed_of_a_cruise) {
    for (const bool cruise : {true, false}) {
        const Model model = sheet();
        const Dataset data = data_of(cruise ? "cruise" : "full");
        Problem problem = fitted_problem(model, data);
        EXPECT_FALSE(conflict(problem, on("rolling_resistance", -1, stage_motion)));
        EXPECT_EQ(conflict(problem, on("rolling_resistance", 1, stage_motion)).has_value(), cruise);
        EXPECT_FALSE(conflict(problem, on("coulomb_friction", 1, 0))); // seen in that wheel's current alone: the other wheels tell
        for (std::size_t i = 0; i < problem.parameters.size(); ++i) {  // every number of the model in turn; a sensor's is no machine's
            const FreeParameter &p = problem.parameters[i];
            if (p.prior <= 0) continue;
            Problem leans = problem;
            for (const double side : {-6.0, 6.0}) {
                leans.theta[static_cast<Eigen::Index>(i)] = side * p.prior;
                leans.within_bounds();
                if (!leans.at_bound(i)) continue;
                EXPECT_EQ(conflict(leans, on("body_drag", -1, stage_motion)).has_value(),
                          cruise && p.owner != "sensors" && p.owner != "soil")
                    << name_of(p) << " " << side;
            }
        }
    }
}

// Where the joint fit ended a number leans on its limit; without the second name it does not, and the first is believed.
TEST(Manner, names_that_lean_on_a_limit_are_taken_back_the_last_first_until_none_does) {
    const Model model = sheet();
    generator::GeneratorConfig config = machine("cruise");
    config.duration_s = 20;
    const Dataset cruise = make_dataset(model, generator::generate(config));
    config.drive = "full";
    const Dataset full = make_dataset(model, generator::generate(config));
    const Physics physics = make_physics(model);
    const Problem sound(cruise, physics, free_parameters(model, physics));
    ASSERT_FALSE(conflict(sound, on("a", -1, stage_motion)));
    Problem leans = sound;
    for (std::size_t i = 0; i < leans.parameters.size(); ++i)
        if (name_of(leans.parameters[i]) == "rover.mass_kg") leans.theta[static_cast<Eigen::Index>(i)] = 7 * leans.parameters[i].prior;
    leans.within_bounds();
    Diagnosis named;
    for (const char *effect : {"a", "b"}) {
        CandidateResult r;
        r.candidate = on(effect, -1, stage_motion), r.verdict = "named";
        named.accepted.push_back(r), named.ranking.push_back(r);
    }
    std::vector<std::size_t> taken;
    const auto ask = [&](Diagnosis d, Problem last, const Problem &without_b, const Problem &without_a) {
        taken.clear();
        reject_conflicts(d, last, [&](std::size_t i) {
            taken.push_back(i);
            d.accepted.erase(d.accepted.begin() + static_cast<std::ptrdiff_t>(i));
            return i == 1 ? without_b : without_a;
        });
        return std::make_pair(d, last);
    };
    using Indices = std::vector<std::size_t>;
    auto [d, last] = ask(named, leans, sound, sound);
    EXPECT_EQ(taken, Indices{1});
    ASSERT_EQ(d.accepted.size(), 1U);
    EXPECT_EQ(d.accepted[0].candidate.effect, "a");
    EXPECT_EQ(d.ranking[0].verdict, "named");
    EXPECT_EQ(d.ranking[1].verdict, "conflict");
    ASSERT_EQ(d.messages.size(), 1U);
    EXPECT_EQ(d.messages[0], "b would explain a part, but only with rover.mass_kg at its limit, and this drive has one manner: not named");
    EXPECT_EQ(last.theta, sound.theta); // what is left is the fit without it
    std::tie(d, last) = ask(named, leans, leans, sound);
    EXPECT_EQ(taken, (Indices{1, 0}));
    EXPECT_EQ(d.ranking[0].verdict, "conflict");
    EXPECT_EQ(d.messages.size(), 2U);
    ask(named, sound, leans, leans);
    EXPECT_TRUE(taken.empty());
    Problem elsewhere(full, physics, free_parameters(model, physics)); // of other drives blocks left out tell
    elsewhere.theta = leans.theta;
    ask(named, elsewhere, leans, leans);
    EXPECT_TRUE(taken.empty());
}

TEST(Manner, a_note_is_told_once) {
    Diagnosis d;
    note_conflict(d, "a", "x");
    note_conflict(d, "a", "x");
    note_conflict(d, "b", "x");
    EXPECT_EQ(d.messages.size(), 2U);
}

// On the carpet of a measured robot body_drag was named first in half of the directions, and predicted the other directions worse than no
// name; a rover that cruises on too much rolling resistance must hear of that before it hears of a drag.
TEST(Manner, of_what_a_cruise_cannot_tell_apart_the_number_that_the_model_states_comes_first) {
    EXPECT_TRUE(changes_stated_number(on("rolling_resistance", -1, stage_motion)));
    EXPECT_FALSE(changes_stated_number(on("rolling_resistance", 0, stage_motion)));
    EXPECT_FALSE(changes_stated_number(on("body_drag", -1, stage_motion)));
    const Model model = sheet();
    for (const char *hidden : {"body_drag:force_N=6", "rolling_resistance:coefficient=0.15"}) {
        const Diagnosis d = diagnose(model, data_of("cruise", hidden), {});
        ASSERT_FALSE(d.effects.empty()) << hidden << ": " << d.text;
        ASSERT_FALSE(d.classes.empty()) << hidden << ": " << d.text; // one velocity: the two are one force
        EXPECT_EQ(d.classes[0].members[0], "rolling_resistance") << hidden;
        EXPECT_EQ(d.effects[0], "rolling_resistance") << hidden;
        EXPECT_NE(std::find(d.classes[0].members.begin(), d.classes[0].members.end(), "body_drag"), d.classes[0].members.end()) << hidden;
    }
}

} // namespace
} // namespace traction::lab
