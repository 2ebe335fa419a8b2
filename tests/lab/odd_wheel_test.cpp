// One wheel that the model misses by far more than the others is told, with a law for it or without; wheels that are alike never are.
#include "four_wheels.h"

#include "host_tools/lab/decision/odd_wheel.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/story.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <optional>

namespace traction::lab {
namespace {

using hand_made::FourWheels;

// Adds to what wheel `wheel` reads by torque (balances 0 to 3) or by voltage (4 to 7), in noises.
void disturb(FourWheels &rover, int wheel, bool electric, const std::function<double(std::size_t)> &noises) {
    Balance &b = rover.data.balance[static_cast<std::size_t>(wheel + (electric ? 4 : 0))];
    for (std::size_t r = 0; r < b.measured.size(); ++r) b.measured[r] += b.noise * noises(r);
}

// One row of eight is off by `size` noises, to and fro: of no shape.
std::function<double(std::size_t)> at_times(double size) {
    return [size](std::size_t r) { return r % 8 == 3 ? (r % 16 == 3 ? size : -size) : 0.0; };
}

Problem fit_of(const FourWheels &rover) { return fitted_problem(rover.model, rover.data); }

TEST(OddWheel, wheels_that_are_alike_have_none) {
    EXPECT_FALSE(odd_wheel(fit_of(FourWheels())));
    FourWheels all;
    for (int i = 0; i < 4; ++i) disturb(all, i, false, at_times(20)), disturb(all, i, true, at_times(20));
    EXPECT_FALSE(odd_wheel(fit_of(all))) << "all of them are missed alike";
}

// e^2 = 1 + size^2 / 8, so that the ratio passes 1.25 by voltage at size 2.12 and 2 by torque at 4.9.
TEST(OddWheel, is_told_from_the_ratio_on_that_no_ground_reaches) {
    struct {
        bool electric;
        double below, beyond;
    } const cases[] = {{true, 1.5, 3}, {false, 4, 6.5}};
    for (const auto &c : cases) {
        FourWheels little, much;
        disturb(little, 2, c.electric, at_times(c.below)), disturb(much, 2, c.electric, at_times(c.beyond));
        EXPECT_FALSE(odd_wheel(fit_of(little))) << c.electric;
        const Problem fitted = fit_of(much);
        const std::optional<OddWheel> odd = odd_wheel(fitted);
        ASSERT_TRUE(odd) << c.electric;
        EXPECT_EQ(odd->wheel, 2);
        EXPECT_EQ(odd->electric, c.electric);
        EXPECT_NEAR(odd->error, std::sqrt(1 + c.beyond * c.beyond / 8), 0.2 * odd->error); // 120 rows of a balance
        EXPECT_NEAR(odd->others, 1, 0.2);
        EXPECT_NEAR(excess_of(*odd, fitted), odd->excess(), 1e-9);
    }
}

// A current that meets its converter's rail now and then: one row of a hundred tells nothing, however far it is off.
TEST(OddWheel, a_few_rows_make_none) {
    FourWheels clipped;
    disturb(clipped, 1, true, [](std::size_t r) { return r == 40 ? 60.0 : 0.0; });
    ASSERT_GE(clipped.data.balance[5].measured.size(), 100U);
    EXPECT_FALSE(odd_wheel(fit_of(clipped)));
    disturb(clipped, 1, true, [](std::size_t r) { return r % 20 == 10 ? 60.0 : 0.0; });
    EXPECT_TRUE(odd_wheel(fit_of(clipped)));
}

TEST(OddWheel, the_farther_beyond_its_limit_is_told) {
    FourWheels both;
    disturb(both, 1, true, at_times(10)), disturb(both, 3, false, at_times(10)); // 3.7 of 1.25 and of 2
    const std::optional<OddWheel> odd = odd_wheel(fit_of(both));
    ASSERT_TRUE(odd);
    EXPECT_EQ(odd->wheel, 1);
    EXPECT_TRUE(odd->electric);
}

TEST(OddWheel, an_effect_is_its_cause_where_it_takes_half_of_the_excess) {
    EXPECT_TRUE(explains_wheel(10, 4));
    EXPECT_FALSE(explains_wheel(10, 6));
}

// A fault that no law and no shape has: the verdict is no "nothing", and no name.
TEST(OddWheel, a_diagnosis_tells_it) {
    FourWheels rover;
    disturb(rover, 2, false, at_times(12));
    const Diagnosis d = diagnose(rover.model, rover.data, {});
    EXPECT_TRUE(d.accepted.empty()) << d.text;
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown);
    EXPECT_TRUE(d.unknown->at_a_guess);
    EXPECT_NE(d.unknown->balance.find("wheel 2"), std::string::npos) << d.unknown->balance;
    EXPECT_TRUE(std::any_of(d.messages.begin(), d.messages.end(),
                            [](const std::string &m) { return m.find("wheel 2 alone is missed by far") != std::string::npos; }));
    const Story story = tell(compare(rover.model, rover.data, false), d, nullptr);
    EXPECT_NE(story.sure.find("one wheel is unlike the others"), std::string::npos) << story.sure; // of the curve it is not
    EXPECT_EQ(story.next.find("Look at that wheel first"), 0U) << story.next;                      // and no law is written from it
}

// "Nothing that this log can show" is said of a log that is explained, not of one that is not.
TEST(OddWheel, where_nothing_is_found_in_what_is_left_that_is_said) {
    FourWheels sound, all;
    for (int i = 0; i < 4; ++i) disturb(all, i, false, at_times(i % 2 == 0 ? 20 : -20)), disturb(all, i, true, at_times(20));
    const auto missing = [](const FourWheels &rover) {
        const Diagnosis d = diagnose(rover.model, rover.data, {});
        EXPECT_EQ(d.kind, "nothing") << d.text;
        return tell(compare(rover.model, rover.data, false), d, nullptr).missing;
    };
    EXPECT_EQ(missing(sound), "Nothing that this log can show.");
    EXPECT_EQ(missing(all), "Nothing that was tried: what is left has another cause.");
}

// A name that takes a small part of what is wrong with its wheel does not stand for it.
TEST(OddWheel, a_name_that_leaves_most_of_it_is_the_nearest) {
    FourWheels rover;
    EffectUse gain;
    gain.name = "current_gain", gain.wheel = 2;
    gain.parameters["change"].value = 0.15;
    rover.hide({gain});
    const Diagnosis alone = diagnose(rover.model, rover.data, {});
    ASSERT_EQ(alone.effects, std::vector<std::string>{"current_gain on wheel 2"}) << alone.text;
    disturb(rover, 2, false, at_times(40));
    const Diagnosis beside = diagnose(rover.model, rover.data, {});
    EXPECT_TRUE(beside.effects.empty()) << beside.text;
    EXPECT_EQ(beside.kind, "unknown") << beside.text;
}

} // namespace
} // namespace traction::lab
