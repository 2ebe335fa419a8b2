// The ODE plant against an independent planar formulation (oracle.h): pose after 10 s within 0.5 % on every ground.
#include "oracle.h"

#include "sim/plant/plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace traction;

namespace {

struct Case {
    double left, right, height_m, slope_rad, slope_direction_rad;
};

constexpr Case cases[] = {
    {0.50, 0.50, 0, 0, 0},         // straight, as the paper takes it
    {0.50, 0.50, 0.0925, 0, 0},    // straight, real height: loads shift
    {0.40, 0.55, 0.06, 0, 0},      // a bend
    {0.55, 0.50, 0.06, 0.04, 0.7}, // a bend on a slope
};

TEST(second_formulation, agrees_in_pose_after_ten_seconds_on_all_grounds) {
    double worst_place = 0, worst_yaw = 0;
    for (const sim::Soil &soil : sim::soil_library())
        for (const Case &c : cases) {
            sim::PlantConfig config;
            config.ground.soil = soil;
            config.ground.slope_rad = c.slope_rad;
            config.ground.slope_direction_rad = c.slope_direction_rad;
            config.rover.centre_height_m = c.height_m;
            config.speed_m_s = 0.3;
            sim::Plant plant(config);
            for (int k = 0; k < 10000; ++k) {
                for (int i = 0; i < 4; ++i) plant.set_duty(i, i % 2 == 0 ? c.left : c.right);
                plant.step();
            }
            oracle::Setup setup;
            const double rise = 9.81 * std::sin(c.slope_rad);
            setup.ground = {soil.law == sim::TractionLaw::burckhardt,
                            soil.adhesion_N,
                            soil.fm_per_fn,
                            soil.lateral_coefficient,
                            soil.shear_slip,
                            soil.rolling_coefficient,
                            rise * std::cos(c.slope_direction_rad),
                            rise * std::sin(c.slope_direction_rad)};
            setup.duty = {c.left, c.right, c.left, c.right};
            setup.speed_m_s = 0.3;
            setup.centre_height_m = c.height_m;
            const oracle::Pose want = oracle::drive(setup, 10);
            const sim::Truth &got = plant.truth();
            const double place = std::hypot(got.position_m[0] - want.x, got.position_m[1] - want.y) / std::fabs(want.path);
            const double yaw = std::fabs(got.yaw_rad - want.yaw) / std::max(1.0, std::fabs(want.yaw));
            // goal of issue 3; the plant's own first-order error at 1 ms is below 0.1 %
            EXPECT_LT(place, 0.005) << soil.name << " case " << &c - cases;
            EXPECT_LT(yaw, 0.005) << soil.name << " case " << &c - cases;
            worst_place = std::max(worst_place, place);
            worst_yaw = std::max(worst_yaw, yaw);
        }
    std::printf("worst pose difference after 10 s: %.3f %% of the path, %.3f %% of the turn\n", 100 * worst_place, 100 * worst_yaw);
}

} // namespace
