// What is left on all wheels at once, or in the accelerometer or the yaw rate slowly, is told as what moves the body; what wheels have
// apart is not.
#include "four_wheels.h"

#include "host_tools/lab/decision/moves_together.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/story.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <numbers>
#include <optional>
#include <random>

namespace traction::lab {
namespace {

using hand_made::FourWheels;

// Adds to what a balance reads, in noises, by the middle of each row.
void add(FourWheels &rover, std::size_t balance, const std::function<double(double)> &noises) {
    Balance &b = rover.data.balance[balance];
    for (std::size_t r = 0; r < b.measured.size(); ++r) b.measured[r] += b.noise * noises(0.5 * (b.t0_s[r] + b.t1_s[r]));
}

void add_to_all_wheels(FourWheels &rover, const std::function<double(double)> &noises) {
    for (std::size_t i = 0; i < 4; ++i) add(rover, i, noises);
}

std::function<double(double)> wave(double size, double per_s) {
    return [=](double t) { return size * std::sin(2 * std::numbers::pi * per_s * t); };
}

// Of no period and no slope: the same for all who ask with one seed.
std::function<double(double)> chance(double size, unsigned seed) {
    return [=](double t) {
        std::mt19937 random(seed + static_cast<unsigned>(std::lround(1000 * t)));
        return size * std::normal_distribution<double>()(random);
    };
}

std::optional<Together> together(const FourWheels &rover) {
    Problem fitted = fitted_problem(rover.model, rover.data);
    fitted.get_ready();
    return moves_together(fitted);
}

TEST(MovesTogether, a_sound_rover_and_wheels_that_are_missed_apart_have_none) {
    EXPECT_FALSE(together(FourWheels()));
    FourWheels apart;
    for (unsigned i = 0; i < 4; ++i) add(apart, i, chance(8, 7 * i)); // uneven ground under each
    EXPECT_FALSE(together(apart));
    FourWheels one;
    add(one, 2, chance(30, 1)); // its mean over the wheels is beyond 1.2 noises
    EXPECT_FALSE(together(one));
}

// Wheels that go together to a half, and wheels that go together by little of what is known of their currents.
TEST(MovesTogether, both_of_its_limits_are_asked) {
    FourWheels half;
    add_to_all_wheels(half, chance(2, 1));
    for (unsigned i = 0; i < 4; ++i) add(half, i, chance(2, 100 + 7 * i)); // correlation 4/9, mean over the wheels 2.3
    EXPECT_FALSE(together(half));
    for (const double size : {3.0, 5.0}) {
        FourWheels rover;
        add_to_all_wheels(rover, chance(size, 1));
        for (std::size_t i = 0; i < 4; ++i) rover.data.balance[i].noise *= 3; // the log is three times better than it says
        EXPECT_EQ(together(rover).has_value(), size > 4) << size;             // correlation 0.9 and 0.96, mean 1.01 and 1.67
    }
}

// In bends the ground under the sides parts the wheels: what is strong needs less agreement.
TEST(MovesTogether, less_agreement_is_asked_of_what_is_strong) {
    for (const double size : {2.0, 5.0}) { // correlations 0.62 and 0.67, means over the wheels 2.2 and 5.3
        FourWheels rover;
        add_to_all_wheels(rover, chance(size, 1));
        for (unsigned i = 0; i < 4; ++i) add(rover, i, chance(size > 3 ? 3.4 : 1.2, 100 + 7 * i));
        EXPECT_EQ(together(rover).has_value(), size > 3) << size;
    }
}

TEST(MovesTogether, a_push_is_told_with_its_size) {
    FourWheels pushed;
    add_to_all_wheels(pushed, chance(4, 1));
    const std::optional<Together> told = together(pushed);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->what, Together::What::push);
    EXPECT_NEAR(told->error, 4, 0.6);
    EXPECT_GT(told->correlation, 0.85);                       // 16 of 17
    EXPECT_NEAR(told->size, 4 * 4 * 0.01 * 0.3 / 0.05, 0.15); // wheels, noises, A, N m/A over m: 0.96 N
    EXPECT_EQ(told->per_s, 0);
    EXPECT_EQ(told->per_m, 0);
    const UnknownShape shape = shape_of(*told);
    EXPECT_EQ(shape.balance, "force on the body");
    EXPECT_EQ(shape.variable, "nothing that was tried");
    EXPECT_TRUE(shape.at_a_guess);
    EXPECT_NE(together_words(*told).find("a force on the body of"), std::string::npos);
}

TEST(MovesTogether, what_swings_is_told_with_its_frequency_amplitude_and_sign) {
    FourWheels swung;
    add_to_all_wheels(swung, wave(5, 0.23));
    const std::optional<Together> told = together(swung);
    ASSERT_TRUE(told);
    EXPECT_NEAR(told->per_s, 0.23, 0.003); // a fifth of 1/T
    EXPECT_EQ(told->per_m, 0);
    // more current is asked for by what holds back: 5 noises of 0.01 A, 0.3 N m/A, 0.05 m, four wheels
    EXPECT_NEAR(told->amplitude_N, 1.2, 0.15);
    const double at_1s = told->amplitude_N * std::sin(2 * std::numbers::pi * told->per_s * 1 + told->phase_rad);
    EXPECT_NEAR(at_1s, -1.2 * std::sin(2 * std::numbers::pi * 0.23), 0.25);
    const UnknownShape shape = shape_of(*told);
    EXPECT_EQ(shape.variable.find("time (it swings at 0.2"), 0U) << shape.variable;
    EXPECT_FALSE(shape.at_a_guess);
    EXPECT_NE(shape.expression.find("*sin("), std::string::npos) << shape.expression;
}

// A floor of waves of 1.4 m: at a speed that changes it has no period in time.
TEST(MovesTogether, what_depends_on_the_way_is_told_with_its_length) {
    FourWheels waves;
    Problem fitted = fitted_problem(waves.model, waves.data);
    fitted.get_ready();
    const std::vector<double> path = fitted.forward().motion().path_m;
    add_to_all_wheels(waves, [&](double t) { return 5 * std::sin(2 * std::numbers::pi * path[static_cast<std::size_t>(t / 0.1)] / 1.4); });
    const std::optional<Together> told = together(waves);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->per_s, 0);
    EXPECT_NEAR(1 / told->per_m, 1.4, 0.05);
}

TEST(MovesTogether, with_the_accelerometer_it_is_a_slope_and_the_accelerometer_alone_is_itself) {
    FourWheels slope;
    add_to_all_wheels(slope, wave(5, 0.06)), add(slope, 9, wave(3, 0.06));
    const std::optional<Together> told = together(slope);
    ASSERT_TRUE(told);
    EXPECT_EQ(told->what, Together::What::slope);
    FourWheels tips;
    add(tips, 9, wave(3, 0.06));
    const std::optional<Together> alone = together(tips);
    ASSERT_TRUE(alone);
    EXPECT_EQ(alone->what, Together::What::accelerometer);
    EXPECT_EQ(shape_of(*alone).target, "sensor.accel");
    FourWheels shakes;
    add(shakes, 9, chance(1.5, 1)); // as much, quickly: noise
    EXPECT_FALSE(together(shakes));
}

TEST(MovesTogether, a_yaw_rate_that_is_missed_slowly_is_a_moment) {
    for (const double size : {4.0, 12.0}) {
        FourWheels rover;
        rover.data.balance[9].kind = BalanceKind::yaw_rate;
        rover.measure(make_physics(rover.model));
        add(rover, 9, wave(size, 0.03));
        const std::optional<Together> told = together(rover);
        ASSERT_EQ(told.has_value(), size > 5 * std::numbers::sqrt2) << size;
        if (told) {
            EXPECT_EQ(told->what, Together::What::turn);
        }
    }
}

TEST(MovesTogether, a_diagnosis_tells_it_and_looks_at_the_rover) {
    FourWheels pushed;
    add_to_all_wheels(pushed, chance(4, 1));
    const Diagnosis d = diagnose(pushed.model, pushed.data, {});
    EXPECT_TRUE(d.accepted.empty()) << d.text;
    EXPECT_EQ(d.kind, "unknown") << d.text;
    ASSERT_TRUE(d.unknown);
    EXPECT_EQ(d.unknown->balance, "force on the body");
    EXPECT_TRUE(std::any_of(d.messages.begin(), d.messages.end(),
                            [](const std::string &m) { return m.find("moves all wheels together") != std::string::npos; }));
    const Story story = tell(compare(pushed.model, pushed.data, false), d, nullptr);
    EXPECT_NE(story.sure.find("something acts on the rover as a whole"), std::string::npos) << story.sure;
    EXPECT_EQ(story.next.find("Look for what acts on the rover itself"), 0U) << story.next;
    EXPECT_TRUE(d.unknown->at_a_guess); // of chance: on nothing that was tried, and no headline says so
    EXPECT_NE(story.headline.find("No effect of the catalogue explains it: force on the body."), std::string::npos) << story.headline;
    EXPECT_NE(story.missing.find("nothing that was tried tells what it depends on"), std::string::npos) << story.missing;
    EXPECT_EQ(story.missing.find("which depends on"), std::string::npos) << story.missing;
}

// A law that moves all wheels is what it is called.
TEST(MovesTogether, a_name_that_explains_it_stands_alone) {
    FourWheels held;
    EffectUse drag;
    drag.name = "body_drag";
    drag.parameters["force_N"].value = 3;
    held.hide({drag});
    const Diagnosis d = diagnose(held.model, held.data, {});
    EXPECT_FALSE(d.accepted.empty()) << d.text;
    EXPECT_FALSE(d.unknown) << d.unknown->balance;
}

} // namespace
} // namespace traction::lab
