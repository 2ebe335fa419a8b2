// A sample of the round trip (all 100 seeds: lab_round_trip), and a model that was improved used as a rover.
#include "round_trip.h"

#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/next/manoeuvre.h"
#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/simulate/simulate.h"

#include <gtest/gtest.h>

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

double share(const Tally &t) { return static_cast<double>(t.inside) / t.count; }

TEST(RoundTrip, intervals_hold_the_truth_of_the_independent_rover_about_as_often_as_published) {
    const auto tallies = sample(Source::independent, 201, 206); // seeds that the published rates do not hold
    // published 0.81 of 1000; 60 of them, in logs of ten that err together (design effect 2): 3 sigma is 0.22
    EXPECT_GT(share(tallies.at("all parameters")), 0.59) << table(tallies);
    EXPECT_LT(tallies.at("all parameters").squares / tallies.at("all parameters").count, 9) << table(tallies); // published rms 1.8
    EXPECT_GE(tallies.at("all effects").inside, 4) << table(tallies); // published 0.91: 3 of 6 or fewer in 1 of 80
}

TEST(RoundTrip, intervals_hold_the_truth_of_the_plant_about_as_often_as_published) {
    const auto tallies = sample(Source::plant, 201, 204);
    EXPECT_GT(share(tallies.at("all parameters")), 0.36)
        << table(tallies); // published 0.67 of 900; 36 of them, design effect 2: 3 sigma is 0.33
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
