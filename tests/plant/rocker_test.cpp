// Rockers and bogies against statics and geometry: loads by levers, with a wheel raised by virtual work, the body's pitch, energy, and the
// grip that a step asks for with them and with fixed axles. No bound comes from a run.
#include "sim/plant/plant.h"
#include "sim/plant/rocker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

using namespace traction::sim;

namespace {

constexpr double g = 9.81, R = 0.057;
constexpr double mass_kg = 4.32, half_m = 0.15, rocker_kg = 0.35, bogie_kg = 0.4, rocker_x = 0.02, rocker_z = 0.14, bogie_x = -0.08,
                 bogie_z = 0.09;

PlantConfig rover(Layout kind = Layout::six, const char *soil = "concrete", ContactLaw contact = ContactLaw::aggregated) {
    PlantConfig config;
    config.ground.soil = *find_soil(soil);
    config.ground.contact = contact;
    config.ground.grip_noise = 0;
    config.rover.mass_kg = mass_kg, config.rover.half_wheelbase_m = half_m, config.rover.length_m = 0.3, config.rover.height_m = 0.1;
    config.rover.centre_height_m = 0.16;
    LayoutParameters &l = config.rover.layout;
    l.kind = kind, l.rocker = true;
    l.rocker_m = kind == Layout::six ? rocker_x : 0, l.rocker_height_m = rocker_z, l.rocker_kg = rocker_kg;
    if (kind == Layout::six) l.bogie_m = bogie_x, l.bogie_height_m = bogie_z, l.bogie_kg = bogie_kg, l.middle_m = 0.01;
    return config;
}

void drive(Plant &plant, double left, double right, long steps) {
    for (int i = 0; i < wheel_most; ++i) plant.set_duty(i, i % 2 == 0 ? left : right);
    for (long k = 0; k < steps; ++k) plant.step();
}

// Levers, by hand: moments of the rocker (front wheel and the body's half) and of the bogie about the pivot between them. Braked wheels may
// press against each other along the ground; what they do so has the pivot's height for its arm.
TEST(rocker, all_wheels_bear_by_the_levers) {
    for (const char *soil : {"concrete", "sand"})
        for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
            if (contact != ContactLaw::aggregated && std::string(soil) == "concrete") continue; // it has no other
            Plant plant(rover(Layout::six, soil, contact));
            const double body = (mass_kg - 2 * rocker_kg - 2 * bogie_kg) / 2; // its centre at x = 0
            for (const long steps : {1L, 2000L}) {
                drive(plant, 0, 0, steps);
                for (const int side : {0, 1}) {
                    const auto push = [&](int slot) {
                        const WheelTruth &w = plant.truth().slot(slot + side);
                        return w.traction_N - w.rolling_share * w.rolling_N;
                    };
                    const double front =
                        (g * body * (0 - bogie_x) + g * rocker_kg * ((half_m + bogie_x) / 2 - bogie_x) - bogie_z * push(2)) /
                        (half_m - bogie_x);
                    const double rest = g * mass_kg / 2 - front;
                    const double middle =
                        (rest * (bogie_x + half_m) + g * bogie_kg * ((0.01 - half_m) / 2 - bogie_x) - bogie_z * (push(0) + push(4))) /
                        (0.01 + half_m);
                    // the links lean by 1 mm on 0.15 m: places move by that times the pivots' height, 1 mm of 0.1 m
                    EXPECT_NEAR(plant.truth().slot(2 + side).normal_N, front, 0.01 * front) << soil << ' ' << steps;
                    EXPECT_NEAR(plant.truth().slot(4 + side).normal_N, middle, 0.01 * middle) << soil << ' ' << steps;
                    EXPECT_NEAR(plant.truth().slot(side).normal_N, rest - middle, 0.01 * rest) << soil << ' ' << steps;
                    if (steps == 1) {
                        EXPECT_EQ(push(2), 0);
                    }
                }
            }
            EXPECT_LT(std::fabs(plant.truth().v_body_m_s[2]), 1e-5);
        }
}

TEST(rocker, four_wheels_on_rockers_share_as_their_places_ask) {
    for (const double pivot_m : {0.0, 0.05}) {
        PlantConfig config = rover(Layout::four);
        config.rover.layout.rocker_m = pivot_m; // the differential hands the body's moment on: its pivot changes no load
        Plant plant(config);
        drive(plant, 0, 0, 1500);
        for (const WheelTruth &w : plant.truth().wheel) EXPECT_NEAR(w.normal_N, g * mass_kg / 4, 0.01 * g * mass_kg / 4) << pivot_m;
    }
}

// The height of the centre of mass over the wheels' heights, by geometry alone: each link turned so that its ends stand where they must.
// Virtual work: what wheel i bears is dV/dz_i.
double potential_J(const std::array<double, 6> &lift) {
    const auto turned = [](double x, double z, double p) {
        return std::array{x * std::cos(p) + z * std::sin(p), -x * std::sin(p) + z * std::cos(p)};
    };
    double V = 0;
    std::array<double, 2> pitch{}, stands{};
    for (std::size_t side = 0; side < 2; ++side) {
        const double rear = lift[side] + R, middle = lift[4 + side] + R, front = lift[2 + side] + R;
        const double p = std::asin((rear - middle) / (0.01 + half_m)); // the bogie's, nose down
        const double joint = rear + turned(bogie_x + half_m, bogie_z - R, p)[1];
        V += g * bogie_kg * (rear + turned((0.01 - half_m) / 2 + half_m, (R + bogie_z) / 2 - R, p)[1]);
        double r = 0; // the rocker's: its far end, from its wheel, must stand at `joint`
        for (int i = 0; i < 50; ++i) {
            const auto miss = [&](double at) { return front + turned(bogie_x - half_m, bogie_z - R, at)[1] - joint; };
            r -= miss(r) / ((miss(r + 1e-6) - miss(r - 1e-6)) / 2e-6);
        }
        V += g * rocker_kg * (front + turned((bogie_x - half_m) / 2, (bogie_z - R) / 2, r)[1]);
        pitch[side] = r, stands[side] = front + turned(rocker_x - half_m, rocker_z - R, r)[1];
    }
    const double body_kg = mass_kg - 2 * rocker_kg - 2 * bogie_kg, mean = 0.5 * (pitch[0] + pitch[1]);
    const double roll =
        std::asin((stands[0] - stands[1]) / (2 * 0.12)); // the centre is in the middle: it sinks by the cosine of its height
    return V + g * body_kg * (0.5 * (stands[0] + stands[1]) + turned(0 - rocker_x, (0.16 - rocker_z), mean)[1] * std::cos(roll));
}

TEST(rocker, with_one_wheel_raised_all_still_bear_what_virtual_work_says) {
    for (const int raised : {2, 4, 0}) { // left: front, middle, rear
        PlantConfig config = rover();
        const double height_m = 0.03, x = raised == 2 ? half_m : raised == 4 ? 0.01 : -half_m;
        auto map = std::make_shared<HeightMap>();
        map->columns = 80, map->rows = 60, map->cell_m = 0.01, map->x_m = -0.4, map->y_m = -0.3;
        for (int j = 0; j < map->rows; ++j)
            for (int i = 0; i < map->columns; ++i) // a block of 8 cm under that wheel alone
                map->height_m.push_back(std::fabs(-0.4 + 0.01 * i - x) < 0.045 && std::fabs(-0.3 + 0.01 * j - 0.12) < 0.08 ? height_m : 0);
        config.ground.terrain.map = map;
        config.rover.drive.coulomb_Nm = 0, config.ground.soil.rolling_coefficient = 0; // wheels that turn freely push nothing along
        Plant plant(config);
        plant.set_enabled(false);
        drive(plant, 0, 0, 4000);
        const Truth &t = plant.truth();
        std::array<double, 6> lift{}, want{};
        lift[static_cast<std::size_t>(raised)] = height_m;
        double weight = 0;
        for (std::size_t i = 0; i < 6; ++i) {
            std::array<double, 6> up = lift, down = lift;
            up[i] += 1e-5, down[i] -= 1e-5;
            want[i] = (potential_J(up) - potential_J(down)) / 2e-5;
            weight += want[i];
        }
        EXPECT_NEAR(weight, mass_kg * g, 1e-3);
        for (int i = 0; i < 6; ++i) {
            // the roll (0.03/0.24 at most) moves links sideways by its square and the wheels' pressing in is 1 mm of 30: 5 %
            EXPECT_NEAR(t.slot(i).normal_N, want[static_cast<std::size_t>(i)], 0.05 * mass_kg * g / 6) << raised << ' ' << i;
            EXPECT_GT(t.slot(i).normal_N, 0.5 * mass_kg * g / 6);
        }
        EXPECT_NEAR(t.rocker_rad[0] + t.rocker_rad[1], 0, 1e-3); // (1)
        EXPECT_GT(std::fabs(t.rocker_rad[0]) + std::fabs(t.bogie_rad[0]), 0.03);
        // the same block under a wheel of fixed axles: 0.03 m over springs of 1.2 mm, so other wheels hang
        PlantConfig fixed = config;
        fixed.rover.layout.rocker = false, fixed.rover.layout.rigid = true;
        Plant stiff(fixed);
        drive(stiff, 0, 0, 3000);
        int hang = 0;
        for (int i = 0; i < 6; ++i) hang += stiff.truth().slot(i).normal_N <= 0;
        EXPECT_GE(hang, 2) << raised;
    }
}

TEST(rocker, the_body_pitches_by_the_mean_of_the_rockers_while_it_drives_over_rough_ground) {
    for (const Layout kind : {Layout::four, Layout::six}) {
        PlantConfig config = rover(kind);
        config.ground.terrain.roughness_m3 = 0.19 * iso_8608_m3('F'); // rough enough for the rockers to turn by degrees
        config.ground.terrain.shortest_m = 0.1;
        config.yaw_rad = 0.4;
        Plant plant(config);
        double widest = 0, off = 0;
        for (int k = 0; k < 8000; ++k) {
            drive(plant, 0.5, 0.5, 1);
            const Truth &t = plant.truth();
            widest = std::max(widest, std::fabs(t.joint_rad)), off = std::max(off, std::fabs(t.rocker_rad[0] + t.rocker_rad[1]) / 2);
        }
        EXPECT_GT(widest, 0.05);
        EXPECT_LT(off, 1e-3); // the rods' slant, and what ODE's constraint leaves between two steps
        EXPECT_GT(plant.truth().v_body_m_s[0], 0.1);
    }
}

TEST(rocker, links_give_no_energy) {
    for (const bool rough : {false, true}) {
        PlantConfig config = rover();
        config.ground.slope_rad = 0.03, config.ground.slope_direction_rad = 0.4;
        if (rough) config.ground.terrain.roughness_m3 = 0.19 * iso_8608_m3('C'), config.ground.terrain.shortest_m = 0.1;
        Plant plant(config);
        const double start = plant.energy().kinetic + plant.energy().potential;
        double throughput = 0, last = 0;
        for (const auto &[left, right] : {std::pair{0.5, 0.5}, {0.6, 0.35}, {-0.4, -0.4}, {-0.3, 0.5}, {0.0, 0.0}}) {
            for (int k = 0; k < 1500; ++k) {
                drive(plant, left, right, 1);
                throughput += std::fabs(plant.energy().motor - last);
                last = plant.energy().motor;
            }
            const Energy &e = plant.energy();
            const double rest = e.motor - (e.friction + e.slip + e.rolling + e.body + e.kinetic + e.potential - start);
            EXPECT_LT(std::fabs(rest), (rough ? 0.02 : 0.001) * throughput)
                << left << (rough ? " rough" : " level"); // as terrain_test, plant_numerics_test
        }
        EXPECT_GT(throughput, 1);
    }
}

// --- a step

constexpr double step_m = 0.6 * R; // its edge touches a wheel at acos(0.4), 66 degrees from below

// Statics of the front wheels at the step's edge, all wheels sliding at grip mu: the mu at which the front just lifts. Unknown are the
// loads and the force at the bogie's pivot; balances of rocker with body, and of bogie, about the pivot.
double grip_on_rockers() {
    const double sine = std::sqrt(1 - 0.16), cosine = 0.4;
    const double body = mass_kg - 2 * rocker_kg - 2 * bogie_kg;
    double low = 0.05, high = 2;
    for (int i = 0; i < 60; ++i) {
        const double mu = 0.5 * (low + high);
        // the edge's force, over its load N: along and up
        const double along = mu * cosine - sine, up = cosine + mu * sine;
        const double ex = half_m + R * sine - bogie_x, ez = R * (1 - cosine) - bogie_z; // from the pivot
        // rocker with body, nose-down moments about the pivot: z Fx - x Fz of the edge, and the weights'
        const double weights = g * (body * (0 - bogie_x) + 2 * rocker_kg * ((half_m + bogie_x) / 2 - bogie_x));
        const double N = weights / (ex * up - ez * along); // all that the front needs to be lifted
        // what the four wheels of the bogies push, from the vertical balance of the whole: they must hold the edge's push back
        const double rest = mass_kg * g - N * up;
        (mu * rest + N * along < 0 ? low : high) = mu;
    }
    return 0.5 * (low + high);
}

// Fixed axles: as soon as the front lifts, the middle wheels hang; front and rear bear all (as terrain_test has it for four wheels).
double grip_on_fixed_axles(const PlantConfig &config) {
    const double sine = std::sqrt(1 - 0.16), cosine = 0.4, height = config.rover.centre_height_m;
    double low = 0.05, high = 2;
    for (int i = 0; i < 60; ++i) {
        const double mu = 0.5 * (low + high), along = mu * cosine - sine, up = cosine + mu * sine;
        const double N = -mu / along; // per load of the rear wheels, from the balance along
        if (along >= 0) {
            high = mu;
            continue;
        }
        const double x = half_m + R * sine, z = -height + R * (1 - cosine);
        const double moment = -half_m + height * mu + x * N * up - z * N * along; // nose up, about the centre of mass
        (moment < 0 ? low : high) = mu;
    }
    return 0.5 * (low + high);
}

// Both rovers of one mass, one wheelbase, one height, on a step of 0.6 R (a wall above 0.69 R stops every wheel here: docs/physics.md).
TEST(rocker, a_step_that_stops_fixed_axles_is_climbed_at_the_grip_that_statics_asks_for) {
    PlantConfig config = rover();
    config.rover.centre_height_m = 0.08;
    const double rockers = grip_on_rockers(), fixed = grip_on_fixed_axles(config);
    std::printf("grip that a step of %.0f mm asks for: rockers %.3f, fixed axles %.3f\n", 1000 * step_m, rockers, fixed);
    ASSERT_LT(1.1 * rockers, 0.9 * fixed);
    config.ground.terrain.profile = {{0.5, 0}, {0.5, step_m}};
    config.ground.soil.adhesion_N = 0, config.ground.soil.rolling_coefficient = 0;
    config.x_m = 0.5 - half_m - R * std::sqrt(1 - 0.16) - 0.001;
    const auto front_at = [&](double grip, bool on_rockers) { // where the front axle gets to
        PlantConfig now = config;
        now.ground.soil.fm_per_fn = grip;
        if (!on_rockers) now.rover.layout.rocker = false, now.rover.layout.rigid = true;
        Plant plant(now);
        for (long k = 0; k < 8000; ++k) { // pushed slowly, so that no run-up helps
            const double duty = std::min(0.6, 0.1e-3 * static_cast<double>(k));
            drive(plant, duty, duty, 1);
        }
        return plant.truth().position_m[0] + half_m - 0.5;
    };
    EXPECT_LT(front_at(0.9 * rockers, true), 0) << "it climbed with too little grip";
    EXPECT_GT(front_at(1.1 * rockers, true), 0) << "it did not climb";
    EXPECT_LT(front_at(1.1 * rockers, false), 0) << "fixed axles climbed with less grip than they need";
}

} // namespace
