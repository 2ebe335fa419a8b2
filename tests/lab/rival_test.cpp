// Which shapes may stand in a name's place (rival.h): not those that are how the law itself looks.
#include "host_tools/lab/decision/rival.h"
#include "sim/physics/effects/catalogue.h"

#include <gtest/gtest.h>

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

} // namespace
} // namespace traction::lab
