// A sample of the round trip (all 100 seeds: lab_round_trip), and a model that was improved used as a rover.
#include "round_trip.h"

#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/next/manoeuvre.h"
#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/simulate/simulate.h"

#include <cstdint>
#include <gtest/gtest.h>
#include <map>

namespace traction::round_trip {
namespace {

std::map<std::string, Tally> sample(Source source, std::uint64_t first, std::uint64_t last) {
    std::vector<Estimate> all;
    for (std::uint64_t seed = first; seed <= last; ++seed) {
        const std::vector<Estimate> one = run(source, seed, 120);
        all.insert(all.end(), one.begin(), one.end());
    }
    return tally(all);
}

// What is claimed is 95 %: 0.92 to 0.98 of the intervals hold the truth. A sample cannot show it closer than its own error, which is asked
// of whole logs, for the numbers of one log err together (round_trip.h). The same over a hundred logs: lab_round_trip,
// docs/lab_benchmark.md.
void holds_what_is_claimed(const std::map<std::string, Tally> &tallies, double least = 0.92) {
    for (const char *what : {"all parameters", "all effects"}) {
        const Tally &t = tallies.at(what);
        EXPECT_TRUE(t.as_claimed(least)) << what << ": " << t.share() << " of " << t.count << ", standard error " << t.share_error() << "\n"
                                         << table(tallies);
    }
}

TEST(RoundTrip, intervals_of_95_percent_hold_the_truth_of_the_independent_rover_as_often_as_they_say) {
    holds_what_is_claimed(sample(Source::independent, 201, 208)); // seeds that the published rates do not hold
}

TEST(RoundTrip, intervals_of_95_percent_hold_the_truth_of_a_rover_whose_wheels_differ_as_often_as_they_say) {
    holds_what_is_claimed(sample(Source::apart, 201, 206));
}

// Of the plant a hundred logs hold 0.91 of the numbers and 0.87 of the effects (docs/lab_benchmark.md): the goal of 0.92 is missed there.
TEST(RoundTrip, intervals_of_95_percent_hold_the_truth_of_the_plant_as_often_as_is_published) {
    holds_what_is_claimed(sample(Source::plant, 201, 206), 0.87);
}

Tally of(int logs, int inside, int count) {
    std::vector<Estimate> all;
    for (int log = 0; log < logs; ++log)
        for (int i = 0; i < count; ++i)
            all.push_back(
                {"x", 0, i < inside ? 0.0 : 9.0, i < inside ? -1.0 : 8.0, i < inside ? 1.0 : 10.0, static_cast<std::uint64_t>(log)});
    return tally(all).at("x");
}

TEST(Coverage, is_judged_by_what_a_sample_can_show) {
    EXPECT_TRUE(of(10, 19, 20).as_claimed());   // 0.95 of 200
    EXPECT_TRUE(of(10, 9, 10).as_claimed());    // 0.90 of 100: 2.58 * 0.027 below 0.92 would be 0.85
    EXPECT_FALSE(of(10, 17, 20).as_claimed());  // 0.85 of 200: its limit is 0.87
    EXPECT_FALSE(of(10, 4, 10).as_claimed());   // 0.40, which the bounds of old let pass
    EXPECT_TRUE(of(10, 20, 20).as_claimed());   // all of 200 may be 0.98
    EXPECT_FALSE(of(100, 20, 20).as_claimed()); // all of 2000 may not: such intervals are too wide
}

// Drives the identification plan as this machine and returns the log.
log::Log driven_as(const lab::Model &model, std::uint64_t seed) {
    sim::Scenario scenario = sim::read_scenario("scenarios/identification.toml");
    std::vector<std::string> notes;
    const sim::Scenario machine =
        sim::parse_scenario(lab::scenario_of(model, "as fitted", "[[drive]]\nfor_s = 1\nmode = \"stop\"\n", 1, notes), "as fitted");
    scenario.plant = machine.plant;
    scenario.effects = machine.effects;
    SimulateOptions options;
    options.seed = seed;
    return simulate(scenario, options).log;
}

TEST(ImprovedModel, drives_a_rover_that_it_then_explains_as_well_as_a_model_with_nothing_missing) {
    const lab::Model baseline = lab::read_model("models/rover_sand.toml");
    SimulateOptions options;
    options.seed = 11;
    options.effects.push_back(sim::parse_effect("slip_sinkage:coefficient=0.2"));
    const log::Log learnt_from = simulate(sim::read_scenario("scenarios/identification.toml"), options).log;
    const lab::Added improved = lab::add_effect(baseline, lab::make_dataset(baseline, learnt_from), "slip_sinkage", -1, "");
    ASSERT_TRUE(improved.helps) << improved.text;

    const auto error = [](const lab::Model &model, const log::Log &log) {
        return lab::compare(model, lab::make_dataset(model, log), true).adjusted;
    };
    const log::Log driven = driven_as(improved.model, 12);
    const double floor = error(baseline, driven_as(baseline, 12)); // what ground and formulation leave where nothing is missing
    EXPECT_LT(error(improved.model, driven), 1.1 * floor);         // the ground's grip is drawn alike; the drive is not quite the same
    EXPECT_GT(error(improved.model, driven), 0.9 * floor);
    EXPECT_GT(error(baseline, driven), 1.5 * floor); // and the effect is what makes the difference
}

} // namespace
} // namespace traction::round_trip
