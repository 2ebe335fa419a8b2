// Wheels that steer, against Ackermann's geometry: angles, turning radius, no scrub where all axles' lines meet, the servo's rate, mirror,
// reversal, energy. No bound comes from a run.
#include "sim/plant/plant.h"
#include "sim/plant/steering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

using namespace traction::sim;

namespace {

constexpr double base_m = 0.16, track_m = 0.11, degree = 3.14159265358979323846 / 180;

LayoutParameters steered(bool front, bool rear, Layout kind = Layout::four) {
    LayoutParameters layout;
    layout.kind = kind, layout.rigid = true;
    layout.steer_front = front, layout.steer_rear = rear;
    layout.steer_max_rad = 35 * degree, layout.steer_rate_rad_s = 60 * degree;
    if (kind == Layout::six) layout.middle_m = 0.02;
    return layout;
}

PlantConfig rover(const LayoutParameters &layout, const char *soil = "concrete", ContactLaw contact = ContactLaw::aggregated) {
    PlantConfig config;
    config.ground.soil = *find_soil(soil);
    config.ground.contact = contact;
    config.ground.grip_noise = 0;
    config.rover.half_wheelbase_m = base_m, config.rover.half_track_m = track_m;
    config.rover.length_m = 0.45;
    config.rover.layout = layout;
    return config;
}

double angle(const LayoutParameters &layout, int slot, double curvature_1_m) {
    return steering_angle_rad(layout, base_m, track_m, slot, curvature_1_m);
}

// The wheels' duty for their rim speeds round a bend: (2) of firmware/core/steering.h, written again.
void drive(Plant &plant, const PlantConfig &config, double duty, double curvature_1_m, double seconds) {
    const LayoutParameters &layout = config.rover.layout;
    plant.set_curvature(curvature_1_m);
    for (const int slot : wheels_of(layout.kind)) {
        const WheelPlace at = wheel_place(layout, base_m, track_m, slot);
        const double x = steers(layout, slot) ? at.ahead_m - steering_pivot_m(layout, base_m) : 0;
        plant.set_duty(slot, duty * std::hypot(1 - at.left_m * curvature_1_m, x * curvature_1_m));
    }
    for (long k = std::lround(seconds / config.dt_s); k > 0; --k) plant.step();
}

TEST(steering, inner_and_outer_wheel_are_turned_by_ackermanns_condition) {
    for (const double curvature : {0.1, 0.8, 1.5, -1.2}) {
        const LayoutParameters front = steered(true, false);
        const auto cot = [](double a) { return std::cos(a) / std::sin(a); };
        // cot(right) - cot(left) = track/wheelbase, whichever is the inner one
        EXPECT_NEAR(cot(angle(front, 3, curvature)) - cot(angle(front, 2, curvature)), 2 * track_m / (2 * base_m), 1e-9);
        EXPECT_EQ(angle(front, 0, curvature), 0);
        for (const LayoutParameters &layout :
             {steered(true, false), steered(false, true), steered(true, true), steered(true, true, Layout::six)})
            for (const int slot : wheels_of(layout.kind)) { // each wheel is square to the line to the centre of turning
                const WheelPlace at = wheel_place(layout, base_m, track_m, slot);
                const double x = at.ahead_m - steering_pivot_m(layout, base_m), y = 1 / curvature - at.left_m,
                             a = angle(layout, slot, curvature);
                if (slot >= 4) continue;
                EXPECT_NEAR(std::cos(a) * x - std::sin(a) * y, 0, 1e-9 * std::fabs(y)) << slot;
            }
        LayoutParameters parallel = front;
        parallel.ackermann = 0;
        EXPECT_NEAR(std::tan(angle(parallel, 2, curvature)), 2 * base_m * curvature, 1e-9);
        EXPECT_EQ(angle(parallel, 2, curvature), angle(parallel, 3, curvature));
    }
}

TEST(steering, its_tightest_bend_is_where_the_inner_wheel_reaches_its_angle) {
    for (const LayoutParameters &layout :
         {steered(true, false), steered(false, true), steered(true, true), steered(true, true, Layout::six)}) {
        const double limit = steering_limit_1_m(layout, base_m, track_m);
        double most = 0, reach = 0;
        for (int slot = 0; slot < 4; ++slot)
            if (steers(layout, slot)) {
                most = std::max(most, std::fabs(angle(layout, slot, limit)));
                reach = std::max(reach, std::fabs(wheel_place(layout, base_m, track_m, slot).ahead_m - steering_pivot_m(layout, base_m)));
            }
        EXPECT_NEAR(most, 35 * degree, 1e-9);
        // tan a = d k/(1 - b k) of the inner wheel, solved for k
        EXPECT_NEAR(limit, std::tan(35 * degree) / (reach + track_m * std::tan(35 * degree)), 1e-9);
    }
    EXPECT_EQ(steering_limit_1_m(LayoutParameters{}, base_m, track_m), 0);
}

TEST(steering, the_servo_turns_at_its_rate_and_holds_what_no_number_asks_for) {
    const LayoutParameters layout = steered(true, false);
    Steering servo(layout, base_m, track_m);
    servo.order(1.2);
    const double whole = std::atan(2 * base_m * 1.2), seconds = whole / (60 * degree);
    double last = 0;
    for (int k = 1; k <= 1000; ++k) {
        servo.step(0.001);
        EXPECT_NEAR(servo.servo_rad(), std::min(whole, 60 * degree * 0.001 * k), 1e-9) << k;
        EXPECT_GE(servo.wheel(2).angle_rad, last); // the inner one, monotonic
        last = servo.wheel(2).angle_rad;
    }
    EXPECT_LT(seconds, 0.5);
    EXPECT_NEAR(servo.wheel(2).angle_rad, angle(layout, 2, 1.2), 1e-9);
    servo.order(1e9);
    for (int k = 0; k < 2000; ++k) servo.step(0.001);
    EXPECT_NEAR(servo.wheel(2).angle_rad, 35 * degree, 1e-6);
    servo.order(std::numeric_limits<double>::quiet_NaN());
    for (int k = 0; k < 2000; ++k) servo.step(0.001);
    EXPECT_EQ(servo.wheel(2).angle_rad, 0);
}

// Rolling without slip: yaw rate k v; the middle of the fixed axle, radius L/tan(delta of the bicycle), does not go aside.
TEST(steering, it_turns_with_the_radius_of_wheelbase_over_tangent) {
    for (const bool front : {true, false})
        for (const double curvature : {0.5, 1.5, -1.5})
            for (const double duty : {0.3, -0.3}) {
                const LayoutParameters layout = steered(front, false == front);
                const PlantConfig config = rover(layout);
                Plant plant(config);
                drive(plant, config, duty, curvature, 4);
                const Truth &t = plant.truth();
                const double v = t.v_body_m_s[0], rate = t.rate_body_rad_s[2], pivot = steering_pivot_m(layout, base_m);
                ASSERT_GT(std::fabs(v), 0.1);
                // What slip the forces need on (21), Fm = 5.6 N a wheel, sc = 0.05: M v^2 k < 2.88 0.13^2 1.5 = 0.08 N on four wheels, a
                // side slip of 0.02/5.6 0.05 = 2e-4; the duties' split differs from the rim speeds' by friction alone, below 0.1 N a wheel:
                // 1e-3.
                const double bicycle = std::atan(2 * base_m * curvature);
                EXPECT_NEAR(v / rate, 2 * base_m / std::tan(bicycle), 0.01 * std::fabs(1 / curvature))
                    << front << ' ' << curvature << ' ' << duty;
                EXPECT_NEAR(t.v_body_m_s[1] + pivot * rate, 0, 0.003 * std::fabs(v)); // of the fixed axle's middle
            }
}

// All axles' lines meet: what the wheels push aside is the centripetal force alone. A skid-steered rover of the same shape drags each wheel
// aside at d psi, front against rear, and the ground answers with forces that have no sum but a moment.
TEST(steering, an_ideal_bend_scrubs_nothing_and_a_skid_steered_one_does) {
    const double curvature = 1.2, duty = 0.15;
    struct Bend {
        double aside_N = 0, centripetal_N = 0, couple_N = 0, lost_J_m = 0; // couple: on each axle, against what the motors turn it by
    };
    const auto bend = [&](const PlantConfig &config) {
        Plant plant(config);
        if (config.rover.layout.steer_front)
            drive(plant, config, duty, curvature, 4);
        else
            for (int k = 0; k < 4000; ++k) {
                for (int i = 0; i < 4; ++i) plant.set_duty(i, duty * (i % 2 == 0 ? 0.5 : 1.5));
                plant.step();
            }
        const double before_J = plant.energy().slip, before_m = plant.truth().path_m;
        for (int k = 0; k < 1000; ++k) plant.step();
        Bend out;
        double moment_Nm = 0;
        for (int slot = 0; slot < 4; ++slot) {
            const WheelTruth &w = plant.truth().slot(slot);
            out.aside_N += std::fabs(w.lateral_N);
            const WheelPlace at = wheel_place(config.rover.layout, base_m, track_m, slot);
            moment_Nm +=
                (w.traction_N - w.rolling_share * w.rolling_N) * (at.ahead_m * std::sin(w.steer_rad) - at.left_m * std::cos(w.steer_rad));
        }
        out.couple_N = std::fabs(moment_Nm) / (2 * base_m);
        out.centripetal_N = config.rover.mass_kg * plant.truth().v_body_m_s[0] * std::fabs(plant.truth().rate_body_rad_s[2]);
        out.lost_J_m = (plant.energy().slip - before_J) / (plant.truth().path_m - before_m);
        return out;
    };
    const Bend ideal = bend(rover(steered(true, true))), skid = bend(rover(LayoutParameters{}));
    // of wheels turned by up to 13 degrees; the inner and outer motors do not pull quite alike, and nothing else is to be balanced
    EXPECT_LT(ideal.aside_N, (ideal.centripetal_N + 2 * ideal.couple_N) / std::cos(13 * degree));
    EXPECT_LT(2 * ideal.couple_N, 0.2);
    EXPECT_GT(skid.aside_N - skid.centripetal_N, 10 * ideal.aside_N);
    EXPECT_LT(ideal.lost_J_m, 0.1 * skid.lost_J_m);
    // parallel wheels cannot all roll: a toe error of half the difference of (1)'s angles works against itself on the steered axle
    LayoutParameters parallel = steered(true, true);
    parallel.ackermann = 0;
    EXPECT_GT(bend(rover(parallel)).aside_N, 5 * ideal.aside_N);
}

TEST(steering, left_and_right_and_ahead_and_back_are_alike) {
    for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc})
        for (const char *soil : {"concrete", "sand", "dry_sand_literature"})
            for (const bool rear : {false, true}) {
                const PlantConfig config = rover(steered(true, rear), soil, contact);
                const auto run = [&](double duty, double curvature) {
                    Plant plant(config);
                    for (const double k : {0.0, curvature, -0.3 * curvature}) drive(plant, config, duty, k, 1.5);
                    return std::array{plant.truth().position_m[0], plant.truth().position_m[1], plant.truth().yaw_rad};
                };
                const auto left = run(0.6, 1.0), right = run(0.6, -1.0), back = run(-0.6, 1.0);
                EXPECT_NEAR(left[0], right[0], 1e-6);
                EXPECT_NEAR(left[1], -right[1], 1e-6);
                EXPECT_NEAR(left[2], -right[2], 1e-5);
                EXPECT_GT(std::fabs(left[2]), 0.1);
                if (!rear) continue; // front and rear alike: backwards it is the same rover, its bend to the same side of the world
                EXPECT_NEAR(left[0], -back[0], 1e-6);
                EXPECT_NEAR(left[1], back[1], 1e-6);
                EXPECT_NEAR(left[2], -back[2], 1e-5);
            }
}

// As plant_numerics_test has it, round bends and with the wheels turning while the rover drives and stands.
TEST(steering, the_energy_closes_within_a_thousandth) {
    for (const char *soil : {"concrete", "sand"})
        for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
            PlantConfig config = rover(steered(true, false), soil, contact);
            config.ground.slope_rad = 0.05, config.ground.slope_direction_rad = 0.3;
            config.rover.centre_height_m = 0.04;
            Plant plant(config);
            const double start = plant.energy().kinetic + plant.energy().potential;
            double throughput = 0, last = 0;
            for (const auto &[duty, curvature] : {std::pair{0.5, 0.0}, {0.5, 1.4}, {0.5, -1.4}, {-0.5, 1.0}, {0.0, -1.0}}) {
                for (int k = 0; k < 100; ++k) {
                    drive(plant, config, duty, curvature, 0.01);
                    throughput += std::fabs(plant.energy().motor - last);
                    last = plant.energy().motor;
                }
                const Energy &e = plant.energy();
                const double rest = e.motor - (e.friction + e.slip + e.rolling + e.body + e.kinetic + e.potential - start);
                EXPECT_LT(std::fabs(rest), 1e-3 * throughput) << soil << ' ' << static_cast<int>(contact) << ' ' << curvature;
            }
        }
}

// Terrain turns the contact forces by the same angle: on a level profile the drive is the plane's.
TEST(steering, on_level_terrain_it_drives_as_on_the_plane) {
    const PlantConfig plane = rover(steered(true, false), "sand");
    PlantConfig level = plane;
    level.ground.terrain.profile = {{100, 0}, {101, 0}};
    Plant a(plane), b(level);
    drive(a, plane, 0.5, 1.2, 3), drive(b, level, 0.5, 1.2, 3);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(a.truth().position_m[k], b.truth().position_m[k], 2e-3); // as terrain_test has it
    EXPECT_NEAR(a.truth().yaw_rad, b.truth().yaw_rad, 0.02);
    EXPECT_GT(a.truth().yaw_rad, 0.3);
}

} // namespace
