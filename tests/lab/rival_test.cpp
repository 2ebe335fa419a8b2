// Which shapes may stand in a name's place (rival.h): not those that are how the law itself looks.
#include "host_tools/lab/decision/rival.h"
#include "host_tools/lab/decision/shape_scores.h"
#include "sim/physics/effects/catalogue.h"
#include "tests/lab/four_wheels.h"

#include <gtest/gtest.h>
#include <optional>

namespace traction::lab {
namespace {

TEST(Rival, over_what_the_law_depends_on_is_the_law) {
    EXPECT_TRUE(is_own_axis("soil_gradient", Axis::path));
    EXPECT_TRUE(is_own_axis("soil_gradient", Axis::place));
    EXPECT_FALSE(is_own_axis("soil_gradient", Axis::time));
    EXPECT_TRUE(is_own_axis("torque_ripple", Axis::turn));
    EXPECT_TRUE(is_own_axis("wear_in", Axis::time));
    EXPECT_FALSE(is_own_axis("slip_sinkage", Axis::yaw_rate));
    EXPECT_TRUE(is_own_axis("fluid_drag", Axis::abs_speed));
    EXPECT_FALSE(is_own_axis("body_drag", Axis::abs_speed));
}

TEST(Rival, of_a_constant_is_no_shape_of_that_same_number) {
    EXPECT_TRUE(is_constant_of("rolling_resistance", TermTarget::rolling));
    EXPECT_FALSE(is_constant_of("rolling_resistance", TermTarget::wheel_friction));
    EXPECT_FALSE(is_constant_of("soil_gradient", TermTarget::soil_strength));
}

TEST(Rival, knows_laws_of_the_catalogue_alone) {
    for (const std::string &effect : laws_with_axes()) EXPECT_NE(sim::find_effect(effect), nullptr) << effect;
}

// The soil changes along the way of all wheels: that beats a soil that changes under one of them, and not itself.
TEST(Rival, is_outdone_by_a_law_that_predicts_surely_better_than_the_shape_in_its_place) {
    hand_made::FourWheels rover;
    EffectUse hidden;
    hidden.name = "soil_gradient";
    hidden.parameters["change_per_m"].value = 0.03, hidden.parameters["change_per_m"].given = true;
    rover.hide({hidden});
    const auto fitted = [&](const std::vector<EffectUse> &effects) {
        Model model = rover.model;
        model.effects = effects;
        const Physics physics = make_physics(model);
        Problem problem(rover.data, physics, free_parameters(model, physics));
        problem.fit({});
        return problem;
    };
    Problem less = fitted({});
    const Problem last = fitted({hidden});
    const Screen screen(less);
    std::optional<ShapeScore> under_one, along;
    for (const ShapeScore &s : all_shapes(less, screen, true)) {
        if (s.candidate.target != TermTarget::soil_strength || s.candidate.order > 0) continue;
        if (s.candidate.axis == Axis::time && s.candidate.on == std::vector<int>{0}) under_one = s;
        if (s.candidate.axis == Axis::path && s.candidate.on.empty()) along = s;
    }
    ASSERT_TRUE(under_one && along);
    Candidate law;
    law.effect = "soil_gradient", law.touched = stage_all;
    EXPECT_TRUE(outdoes(law, last, less, *under_one));
    EXPECT_FALSE(outdoes(law, last, less, *along));
}

} // namespace
} // namespace traction::lab
