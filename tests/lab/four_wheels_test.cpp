// Whole diagnoses of a rover of four wheels (four_wheels.h), a sixth of a second each: what is hidden on all wheels or on one is told so.
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"
#include "sim/physics/effects/catalogue.h"
#include "tests/lab/consistent.h"
#include "tests/lab/four_wheels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace traction::lab {
namespace {

using Labels = std::vector<std::string>;

// The effect at this size, its shape parameters at their first station.
EffectUse use_of(const std::string &name, double size, int wheel = -1) {
    EffectUse use;
    use.name = name, use.wheel = wheel;
    bool first = true;
    for (const sim::EffectParameter &p : sim::find_effect(name)->parameters) {
        Parameter &to = use.parameters[std::string(p.name)];
        to.value = p.strength ? (first ? size : 0) : p.variants.empty() ? 0 : p.variants[0], to.given = true;
        first = first && !p.strength;
    }
    return use;
}

Diagnosis told(const std::vector<EffectUse> &hidden, hand_made::FourWheels &rover) {
    rover.hide(hidden);
    Diagnosis d = diagnose(rover.model, rover.data, {});
    expect_consistent(d, rover.model, rover.data);
    return d;
}

// Each that is hidden is an accepted effect or of the class of one, on its own wheel; nothing else is accepted; noise is left; and what is
// told is what a fit of the model finds.
void expect_told(const std::vector<EffectUse> &hidden) {
    hand_made::FourWheels rover;
    const Diagnosis d = told(hidden, rover);
    SCOPED_TRACE(d.text);
    ASSERT_EQ(d.accepted.size(), hidden.size());
    EXPECT_TRUE(!d.unknown && d.nearest.empty());
    for (const EffectUse &use : hidden) {
        const std::string label = use.wheel < 0 ? use.name : use.name + " on wheel " + std::to_string(use.wheel);
        bool found = false;
        for (const CandidateResult &a : d.accepted) {
            if (a.candidate.label() == label) {
                found = true;
                const double size = use.parameters.at(a.candidate.strengths[0].key).value;
                EXPECT_NEAR(a.value[0], size, 3 * (a.high[0] - a.value[0]) / 1.96) << label; // three standard errors
                EXPECT_LT(a.high[0] - a.low[0], std::fabs(size)) << label;
            }
            for (const ConfoundedClass &c : d.classes)
                found = found || (c.members.front() == a.candidate.label() && std::count(c.members.begin(), c.members.end(), label) == 1);
        }
        EXPECT_TRUE(found) << label;
    }
    ASSERT_EQ(d.ladder.size(), hidden.size() + 1);
    ASSERT_EQ(d.model.effects.size(), hidden.size());
    for (std::size_t i = 0; i < hidden.size(); ++i) EXPECT_EQ(d.ladder[i + 1].label, "+ " + d.accepted[i].candidate.label());
    EXPECT_LT(d.ladder.back().heldout, 1.05); // 1200 rows of noise: 2 %, and what is fitted to them
    const Problem anew = fitted_problem(d.model, rover.data);
    EXPECT_NEAR(d.ladder.back().train, overall_error(anew), 2e-3);
    EXPECT_NEAR(d.ladder.back().heldout, held_out(anew).error, 5e-3);
    for (const CandidateResult &a : d.accepted)
        for (std::size_t i = 0; i < anew.parameters.size(); ++i)
            if (const FreeParameter &p = anew.parameters[i]; p.owner == a.candidate.effect && p.wheel == a.candidate.wheel &&
                                                             p.key == a.candidate.strengths[0].key && a.shapes.empty()) {
                EXPECT_NEAR(a.value[0], p.base + anew.theta[static_cast<Eigen::Index>(i)], 0.1 * (a.high[0] - a.low[0]))
                    << a.candidate.label();
            }
}

TEST(FourWheels, of_which_nothing_is_hidden_have_nothing_named) {
    hand_made::FourWheels rover;
    const Diagnosis d = diagnose(rover.model, rover.data, {});
    EXPECT_EQ(d.kind, "nothing") << d.text;
    EXPECT_TRUE(d.messages.empty());
    EXPECT_LT(d.ladder.at(0).heldout, 1.05);
}

TEST(FourWheels, have_what_is_on_all_of_them_told_so) {
    for (const auto &[effect, size] :
         {std::pair{"coulomb_friction", 0.1}, std::pair{"slip_sinkage", 0.6}, std::pair{"mesh_loss", 0.2}, std::pair{"grade", 0.1}})
        expect_told({use_of(effect, size)});
}

TEST(FourWheels, have_what_is_on_one_of_them_told_of_that_one) {
    expect_told({use_of("coulomb_friction", 0.06, 2)});
    expect_told({use_of("torque_ripple", 0.04, 1)});
}

// At the end of the catalogue's range the step and the scan lead elsewhere, and a class of them passes by what it smooths out: the law that
// is fitted from a quarter of its range predicts better and takes its place.
TEST(FourWheels, have_a_law_that_small_steps_do_not_see_told_from_afar) {
    expect_told({use_of("rolling_resistance", 0.3)});
    expect_told({use_of("grade", 0.3)});
}

// What explains the most at first is not needed beside what is hidden: it is dropped and said so, and the errors are those without it.
TEST(FourWheels, have_what_was_named_first_dropped_where_the_hidden_law_does_without) {
    for (const EffectUse &use : {use_of("wheel_radius", -0.2), use_of("wheel_radius", 0.2, 2)}) {
        hand_made::FourWheels rover;
        const Diagnosis d = told({use}, rover);
        EXPECT_EQ(d.effects, Labels{use.wheel < 0 ? "wheel_radius" : "wheel_radius on wheel 2"}) << d.text;
        ASSERT_EQ(d.accepted.size(), 1U);
        EXPECT_NEAR(d.accepted[0].value[0], use.parameters.at("change").value, 0.01); // a twentieth
        std::size_t dropped = 0;
        for (const std::string &m : d.messages)
            dropped += m.ends_with(" was found first, and is not needed beside the others: dropped") ? 1 : 0;
        EXPECT_GE(dropped, 1U);
        ASSERT_EQ(d.ladder.size(), 2U);
        EXPECT_EQ(d.ladder[1].label, "+ " + d.effects[0]);
        const Problem anew = fitted_problem(d.model, rover.data);
        EXPECT_NEAR(d.ladder[1].train, overall_error(anew), 2e-3);
        EXPECT_NEAR(d.ladder[1].heldout, held_out(anew).error, 5e-3);
        EXPECT_EQ(d.model.effects.size(), 1U);
    }
}

TEST(FourWheels, have_two_faults_both_told) {
    expect_told({use_of("grade", 0.1), use_of("coulomb_friction", 0.06, 2)});
    expect_told({use_of("wiring_resistance", 1.0, 1), use_of("wiring_resistance", 1.5, 2)});
    expect_told({use_of("slip_sinkage", 0.6), use_of("torque_ripple", 0.05, 3)});
}

} // namespace
} // namespace traction::lab
