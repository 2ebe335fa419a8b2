// What the plant must not depend on: where a drive starts, which way it heads, which side is left, how fine the step is. And what no
// ground does: swallow a wheel that reverses, throw it at a patch's edge, let a parked rover creep.
#include "sim/plant/plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using namespace traction::sim;

namespace {

constexpr ContactLaw laws[] = {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc};
const char *const soft_soils[] = {"gravel", "sand", "dry_sand_literature", "loam", "snow", "lunar_simulant"};

// Every soil of the library that the law knows: hard ground has no sinkage to compute.
std::vector<std::string> soils_of(ContactLaw law) {
    std::vector<std::string> names;
    for (const Soil &soil : soil_library())
        if (law == ContactLaw::aggregated || soil.bekker) names.push_back(soil.name);
    return names;
}

PlantConfig on(const std::string &soil, ContactLaw contact) {
    PlantConfig config;
    config.ground.soil = *find_soil(soil);
    config.ground.contact = contact;
    return config;
}

std::string label(const std::string &soil, ContactLaw contact) { return soil + ", contact " + std::to_string(static_cast<int>(contact)); }

struct Leg {
    double for_s, left, right; // duty
};

struct Pose {
    double x_m = 0, y_m = 0, yaw_rad = 0, charge_As = 0;
};

// Drives the legs; the pose in the frame of the start, `mirrored` with left and right exchanged, `back` with all duties turned.
Pose drive(const PlantConfig &config, const std::vector<Leg> &legs, bool mirrored = false, bool back = false) {
    Plant plant(config);
    Pose out;
    for (const Leg &leg : legs) {
        const double sign = back ? -1 : 1;
        for (int i = 0; i < wheel_count; ++i) {
            const bool left = (i == 0 || i == 2) != mirrored;
            plant.set_duty(i, sign * (left ? leg.left : leg.right));
        }
        for (long k = std::lround(leg.for_s / config.dt_s); k > 0; --k) {
            plant.step();
            for (const WheelTruth &w : plant.truth().wheel) out.charge_As += std::fabs(w.current_A) * config.dt_s;
        }
    }
    const double dx = plant.truth().position_m[0] - config.x_m, dy = plant.truth().position_m[1] - config.y_m;
    const double c = std::cos(config.yaw_rad), s = std::sin(config.yaw_rad);
    out.x_m = c * dx + s * dy, out.y_m = -s * dx + c * dy, out.yaw_rad = plant.truth().yaw_rad - config.yaw_rad;
    return out;
}

const std::vector<Leg> turn_and_back = {{4, 0.5, 0.7}, {1, 0, 0}, {3, -0.6, -0.5}, {3, 0.7, 0.6}};

// Nothing in the laws knows a place, so what is left is rounding, which a path over soft ground carries on: 1e-6 m of 4 m of path.
constexpr double rounding_m = 1e-6;

void expect_same(const Pose &a, const Pose &b, double within, const std::string &what) {
    EXPECT_NEAR(a.x_m, b.x_m, within) << what;
    EXPECT_NEAR(a.y_m, b.y_m, within) << what;
    EXPECT_NEAR(a.yaw_rad, b.yaw_rad, 10 * within) << what;
    EXPECT_NEAR(a.charge_As, b.charge_As, 10 * within) << what;
}

TEST(invariance, a_drive_does_not_depend_on_where_it_starts) {
    for (const ContactLaw law : laws)
        for (const std::string &soil : soils_of(law)) {
            PlantConfig config = on(soil, law);
            const Pose here = drive(config, turn_and_back);
            config.x_m = 0.0131, config.y_m = -3.0073;
            expect_same(here, drive(config, turn_and_back), rounding_m, label(soil, law));
        }
}

TEST(invariance, a_drive_does_not_depend_on_which_way_it_heads) {
    for (const ContactLaw law : laws)
        for (const std::string &soil : soils_of(law)) {
            PlantConfig config = on(soil, law);
            const Pose here = drive(config, turn_and_back);
            config.yaw_rad = 0.7;
            expect_same(here, drive(config, turn_and_back), rounding_m, label(soil, law));
        }
}

TEST(invariance, left_and_right_are_alike) {
    for (const ContactLaw law : laws)
        for (const std::string &soil : soils_of(law)) {
            const Pose one = drive(on(soil, law), turn_and_back);
            Pose other = drive(on(soil, law), turn_and_back, true);
            other.y_m *= -1, other.yaw_rad *= -1;
            expect_same(one, other, rounding_m, label(soil, law));
        }
}

TEST(invariance, ahead_and_back_are_alike) {
    for (const ContactLaw law : laws)
        for (const std::string &soil : soils_of(law)) {
            const Pose one = drive(on(soil, law), turn_and_back);
            Pose other = drive(on(soil, law), turn_and_back, false, true);
            other.x_m *= -1; // driving back with left faster turns the other way about, on the mirrored path
            other.yaw_rad *= -1;
            expect_same(one, other, rounding_m, label(soil, law));
        }
}

TEST(invariance, half_the_step_gives_the_same_drive) {
    // first order in the step: the path (2 m long) moves by what a drive train and a slip state do within a millisecond, 0.5 % of it
    for (const ContactLaw law : laws)
        for (const std::string &soil : soils_of(law)) {
            PlantConfig config = on(soil, law);
            const Pose coarse = drive(config, turn_and_back);
            config.dt_s = 0.0005;
            const Pose fine = drive(config, turn_and_back);
            EXPECT_NEAR(coarse.x_m, fine.x_m, 0.01) << label(soil, law);
            EXPECT_NEAR(coarse.y_m, fine.y_m, 0.01) << label(soil, law);
            EXPECT_NEAR(coarse.charge_As, fine.charge_As, 0.01 * coarse.charge_As) << label(soil, law);
        }
}

// A run that is stopped between any two steps and gone on with is the run.
TEST(invariance, a_run_in_pieces_is_the_whole_run) {
    for (const ContactLaw law : laws)
        for (const std::string &soil : soils_of(law)) {
            Plant whole(on(soil, law)), pieces(on(soil, law));
            unsigned draw = 12345;
            for (const Leg &leg : turn_and_back) {
                const auto ask = [&leg](Plant &plant) {
                    for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, i % 2 == 0 ? leg.left : leg.right);
                };
                const int steps = static_cast<int>(std::lround(leg.for_s * 1000));
                ask(whole);
                for (int k = 0; k < steps; ++k) whole.step();
                for (int done = 0; done < steps;) {
                    draw = draw * 1664525u + 1013904223u;
                    const int piece = std::min(steps - done, 1 + static_cast<int>(draw >> 24));
                    ask(pieces);
                    const std::uint64_t seen = pieces.state_hash(); // looking changes nothing
                    for (int k = 0; k < piece; ++k) pieces.step();
                    EXPECT_NE(pieces.state_hash(), seen);
                    done += piece;
                }
            }
            EXPECT_EQ(whole.state_hash(), pieces.state_hash()) << label(soil, law);
        }
}

TEST(soft_ground, a_wheel_that_reverses_past_its_start_meets_fresh_soil_as_it_did_going_out) {
    for (const ContactLaw law : {ContactLaw::bekker, ContactLaw::arc})
        for (const char *soil : soft_soils) {
            Plant plant(on(soil, law));
            const auto go = [&](double duty, double for_s) {
                for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, duty);
                double deepest = 0;
                for (int k = 0; k < 1000 * for_s; ++k) {
                    plant.step();
                    for (const WheelTruth &w : plant.truth().wheel) deepest = std::max(deepest, w.sinkage_m);
                }
                return deepest;
            };
            const double out_m = go(0.6, 6);
            go(0, 1);
            const double back_m = go(-0.6, 9);
            EXPECT_LT(plant.truth().position_m[0], -0.2) << label(soil, law);
            // the same soil and duty; what differs is the start out of a rut
            EXPECT_LT(back_m, 1.2 * out_m) << label(soil, law);
        }
}

TEST(soft_ground, a_patch_s_edge_neither_throws_a_wheel_nor_gives_energy) {
    for (const ContactLaw law : {ContactLaw::bekker, ContactLaw::arc})
        for (const bool into_hard : {true, false}) {
            const char *soft = "dry_sand_literature", *hard = "gravel";
            PlantConfig config = on(into_hard ? soft : hard, law);
            config.ground.patches.push_back({.x_min_m = 0.5, .x_max_m = 9, .soil = *find_soil(into_hard ? hard : soft)});
            Plant plant(config);
            for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, 0.5);
            double most_N = 0, gained_J = 0, lowest_J = 1e9;
            int in_air = 0;
            for (int k = 0; k < 8000 && plant.truth().position_m[0] < 1.2; ++k) {
                plant.step();
                if (k < 1000) continue; // settled
                for (const WheelTruth &w : plant.truth().wheel) most_N = std::max(most_N, w.normal_N), in_air += w.normal_N <= 0;
                const Energy &e = plant.energy();
                const double spent_J =
                    e.friction + e.slip + e.rolling + e.body; // may rest in the soil as a spring, never come from it for good
                lowest_J = std::min(lowest_J, spent_J - e.motor + e.kinetic + e.potential);
                gained_J = std::max(gained_J, e.kinetic + e.potential - e.motor + e.friction + e.slip + e.rolling);
            }
            EXPECT_GT(plant.truth().position_m[0], 0.9);
            EXPECT_LT(most_N, 2 * 2.88 * 9.81 / 4) << label(soft, law) << (into_hard ? " into hard" : " out of it");
            EXPECT_EQ(in_air, 0) << label(soft, law) << (into_hard ? " into hard" : " out of it");
            EXPECT_LT(gained_J, 0.02) << label(soft, law) << (into_hard ? " into hard" : " out of it");
        }
}

TEST(parked, a_rover_in_mode_stop_stands_where_friction_holds_it) {
    for (const ContactLaw law : laws) {
        PlantConfig config = on("sand", law);
        config.ground.slope_rad = 0.105; // 6 deg: 2.9 N downhill; rolling resistance and gear friction hold 3.5 N
        Plant plant(config);
        plant.set_enabled(false);
        for (int k = 0; k < 3000; ++k) plant.step();
        const double x0 = plant.truth().position_m[0];
        double accel2 = 0;
        for (int k = 0; k < 5000; ++k) {
            plant.step();
            const double a = plant.truth().specific_force_m_s2[0] - 9.81 * std::sin(0.105);
            accel2 += a * a;
        }
        EXPECT_NEAR(plant.truth().position_m[0], x0, 5e-5) << label("sand", law); // 0.01 mm/s
        EXPECT_LT(std::sqrt(accel2 / 5000), 0.01) << label("sand", law);
    }
}

TEST(parked, locked_wheels_stop_a_rover_and_leave_it_there) {
    for (const char *soil : {"concrete", "sand", "dry_sand_literature"})
        for (const ContactLaw law : laws) {
            if (std::string(soil) == "concrete" && law != ContactLaw::aggregated) continue;
            PlantConfig config = on(soil, law);
            config.speed_m_s = 0.5;
            Plant plant(config);
            for (int k = 0; k < 500; ++k) plant.step();
            for (int i = 0; i < wheel_count; ++i) plant.block_wheel(i, true);
            double furthest = -1e9;
            for (int k = 0; k < 2000; ++k) {
                plant.step();
                furthest = std::max(furthest, plant.truth().position_m[0]);
            }
            EXPECT_LT(furthest - plant.truth().position_m[0], 5e-4)
                << label(soil, law); // the spring of tyre and soil: below half a millimetre
            EXPECT_LT(std::fabs(plant.truth().v_body_m_s[0]), 1e-4) << label(soil, law);
        }
}

} // namespace
