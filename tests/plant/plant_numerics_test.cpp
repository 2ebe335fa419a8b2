// Numerics gates of the plant: parked creep, order of the step, energy balance, repeatability, wheel contact, robustness.
#include "sim/plant/plant.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace traction::sim;

namespace {

PlantConfig on(const char *soil) {
    PlantConfig config;
    config.ground.soil = *find_soil(soil);
    return config;
}

void drive(Plant &plant, double left, double right, int steps) {
    for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, i % 2 == 0 ? left : right);
    for (int k = 0; k < steps; ++k) plant.step();
}

struct Rms {
    double sum = 0, square = 0;
    int count = 0;
    void add(double x) { sum += x, square += x * x, ++count; }
    double about_mean() const { return std::sqrt(std::max(0.0, square / count - (sum / count) * (sum / count))); }
};

// Gates of docs/evidence.md section 6: creep < 0.01 mm/s, accelerometer < 0.01 m/s^2 rms, on a 5 degree slope with locked wheels.
TEST(parked, on_a_slope_neither_creeps_nor_shakes) {
    for (const char *soil : {"concrete", "gravel", "sand", "dry_sand_literature", "loam", "snow", "lunar_simulant"})
        for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc})
            for (double direction : {0.0, 0.8, std::numbers::pi / 2}) {
                PlantConfig config = on(soil);
                config.ground.contact = contact;
                config.ground.slope_rad = 5 * std::numbers::pi / 180;
                config.ground.slope_direction_rad = direction;
                config.rover.centre_height_m = 0.06;
                Plant plant(config);
                for (int i = 0; i < wheel_count; ++i) plant.block_wheel(i, true);
                for (int k = 0; k < 2000; ++k) plant.step();
                const Truth before = plant.truth();
                Rms felt[3];
                for (int k = 0; k < 4000; ++k) {
                    plant.step();
                    for (std::size_t a = 0; a < 3; ++a) felt[a].add(plant.truth().specific_force_m_s2[a]);
                }
                const Truth &after = plant.truth();
                const double creep_m = std::hypot(after.position_m[0] - before.position_m[0], after.position_m[1] - before.position_m[1]);
                EXPECT_LT(creep_m / 4, 1e-5) << soil << " " << static_cast<int>(contact) << " " << direction;
                for (const Rms &axis : felt) EXPECT_LT(axis.about_mean(), 0.01) << soil << " " << static_cast<int>(contact);
            }
}

// First order: differences between successive halvings halve.
TEST(step, halving_dt_halves_the_error) {
    for (const char *soil : {"concrete", "gravel", "sand"}) {
        double x[4], yaw[4];
        for (int h = 0; h < 4; ++h) {
            PlantConfig config = on(soil);
            config.rover.centre_height_m = 0.06;
            config.dt_s = 0.001 / (1 << h);
            config.speed_m_s = 0.2;
            Plant plant(config);
            drive(plant, 0.35, 0.5, 3000 << h);
            x[h] = plant.truth().position_m[0];
            yaw[h] = plant.truth().yaw_rad;
        }
        for (const double *v : {x, yaw}) {
            // ratio 2 + O(dt): the second-order term adds a few percent; order 2 would give 4, a stuck error 1
            EXPECT_NEAR((v[0] - v[1]) / (v[1] - v[2]), 2, 0.25) << soil;
            EXPECT_NEAR((v[1] - v[2]) / (v[2] - v[3]), 2, 0.15) << soil;
        }
        EXPECT_LT(std::fabs(x[0] - x[3]), 1e-3 * std::fabs(x[3])) << soil; // and the error at 1 ms is small
    }
}

TEST(energy, balance_closes_within_a_thousandth) {
    for (const char *soil : {"concrete", "gravel", "sand"})
        for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
            PlantConfig config = on(soil);
            config.ground.contact = contact;
            config.ground.slope_rad = 0.05;
            config.ground.slope_direction_rad = 0.3;
            config.rover.centre_height_m = 0.06;
            Plant plant(config);
            const double start = plant.energy().kinetic + plant.energy().potential;
            double throughput = 0, last = 0;
            for (const auto &[left, right] : {std::pair{0.5, 0.5}, {0.6, 0.35}, {-0.4, -0.4}, {-0.5, 0.5}, {0.0, 0.0}})
                for (int k = 0; k < 2000; ++k) {
                    drive(plant, left, right, 1);
                    throughput += std::fabs(plant.energy().motor - last);
                    last = plant.energy().motor;
                }
            const Energy &e = plant.energy();
            const double rest = e.motor - (e.friction + e.slip + e.rolling + e.body + e.kinetic + e.potential - start);
            EXPECT_GT(throughput, 5) << "the run must move energy for the bound to mean something";
            EXPECT_LT(std::fabs(rest), 1e-3 * throughput) << soil << " " << static_cast<int>(contact);
            // the audit is not a tautology: it must come out the same from the truth alone, in straight and turning drive
            const Truth &t = plant.truth();
            EXPECT_GT(e.friction, 0);
            EXPECT_GT(e.rolling, 0);
            EXPECT_NEAR(e.kinetic, 0, 0.5 * 2.88 * (0.05 * 0.05) + 0.1) << t.t_s;
        }
}

// The audit again from the truth alone: what the motors give, less what (17), (18) and (2) take, is the change of kinetic energy.
TEST(energy, straight_drive_balances_from_the_truth_alone) {
    Plant plant(on("sand"));
    drive(plant, 0.5, 0.5, 50);
    const RoverParameters r;
    const auto kinetic = [&r](const Truth &t) {
        double sum = 0.5 * r.mass_kg * t.v_body_m_s[0] * t.v_body_m_s[0];
        for (const WheelTruth &w : t.wheel) sum += 0.5 * r.drive.inertia_kg_m2 * w.speed_rad_s * w.speed_rad_s;
        return sum;
    };
    const double start = kinetic(plant.truth());
    double given = 0, taken = 0;
    for (int k = 0; k < 5000; ++k) {
        const Truth before = plant.truth();
        drive(plant, 0.5, 0.5, 1);
        const Truth &after = plant.truth();
        const double v = 0.5 * (before.v_body_m_s[0] + after.v_body_m_s[0]);
        for (std::size_t i = 0; i < wheel_count; ++i) {
            const WheelTruth &w = after.wheel[i];
            const double spin = 0.5 * (before.wheel[i].speed_rad_s + w.speed_rad_s);
            given += 0.001 * r.drive.torque_constant_Nm_A * w.current_A * spin;
            taken += 0.001 * spin * (r.drive.viscous_Nms * w.speed_rad_s + r.drive.coulomb_Nm);
            taken += 0.001 * (w.traction_N * (r.wheel_radius_m * spin - v) + w.rolling_N * v);
        }
    }
    // rolling_N reverses over 5 mm/s by a clamp and v > 0.05 m/s here; vertical motion on flat ground is nil
    EXPECT_NEAR(given - taken, kinetic(plant.truth()) - start, 1e-3 * given);
}

TEST(energy, the_audit_changes_no_other_number) {
    for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
        PlantConfig config = on("sand");
        config.ground.contact = contact;
        Plant kept(config);
        config.audit = false;
        Plant bare(config);
        for (const auto &[left, right] : {std::pair{0.5, 0.5}, {0.6, 0.3}, {-0.4, -0.4}})
            drive(kept, left, right, 400), drive(bare, left, right, 400);
        EXPECT_EQ(kept.state_hash(), bare.state_hash());
        EXPECT_EQ(kept.truth().specific_force_m_s2, bare.truth().specific_force_m_s2);
        EXPECT_GT(kept.energy().slip, 0);
        EXPECT_EQ(bare.energy().slip, 0);
    }
}

TEST(repeat, two_runs_give_the_same_bits_and_another_input_does_not) {
    const auto hash = [](double duty) {
        PlantConfig config = on("gravel");
        config.ground.grip_noise = 0.06;
        Plant plant(config);
        drive(plant, duty, 0.5, 4000);
        return plant.state_hash();
    };
    EXPECT_EQ(hash(0.4), hash(0.4));
    EXPECT_NE(hash(0.4), hash(0.4000001));
}

TEST(joint, keeps_four_wheels_on_the_ground) {
    PlantConfig config = on("gravel");
    config.rover.centre_height_m = 0.0925;
    Plant plant(config);
    double least = std::numeric_limits<double>::infinity();
    const double pairs[][2] = {{1, 1}, {-1, -1}, {-0.8, 0.8}, {0.8, -0.8}, {1, 0.2}};
    for (const auto &duty : pairs)
        for (int k = 0; k < 1500; ++k) {
            drive(plant, duty[0], duty[1], 1);
            double sum = 0;
            for (const WheelTruth &w : plant.truth().wheel) {
                least = std::min(least, w.normal_N);
                sum += w.normal_N;
            }
            // vertical acceleration stays below a fifth of gravity
            EXPECT_NEAR(sum, 2.88 * 9.81, 0.2 * 2.88 * 9.81);
        }
    EXPECT_GT(least, 0.5);
}

TEST(static_load, is_a_quarter_of_the_weight) {
    Plant plant(on("concrete"));
    drive(plant, 0, 0, 1000);
    for (const WheelTruth &w : plant.truth().wheel) EXPECT_NEAR(w.normal_N, 2.88 * 9.81 / 4, 1e-3);
}

// A stalled motor: I = duty*V/Ra at the terminals, whatever the ground.
TEST(blocked_wheel, draws_the_stall_current_and_drags) {
    Plant plant(on("concrete"));
    plant.block_wheel(1, true);
    drive(plant, 0.5, 0.5, 3000);
    const Truth &t = plant.truth();
    EXPECT_EQ(t.wheel[1].speed_rad_s, 0);
    EXPECT_NEAR(t.wheel[1].current_A, 0.5 * t.battery_voltage_V / 3.24, 1e-3); // the voltage is one step older
    EXPECT_LT(t.wheel[1].traction_N, 0);
    EXPECT_GT(std::fabs(t.yaw_rad), 0.1);
}

TEST(any_duty, is_clamped_and_never_breaks_the_state) {
    Plant plant(on("sand"));
    for (const double duty : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300, 5.0})
        drive(plant, duty, -duty, 200);
    const Truth &t = plant.truth();
    EXPECT_TRUE(std::isfinite(t.position_m[0]) && std::isfinite(t.yaw_rad) && std::isfinite(t.wheel[3].current_A));
    EXPECT_LE(std::fabs(t.wheel[0].duty), 1);
}

TEST(released_bridges, let_no_current_flow) {
    Plant plant(on("sand"));
    drive(plant, 0.6, 0.6, 1000);
    plant.set_enabled(false);
    drive(plant, 0.6, 0.6, 3000);
    for (const WheelTruth &w : plant.truth().wheel) EXPECT_EQ(w.current_A, 0);
    EXPECT_NEAR(plant.truth().v_body_m_s[0], 0, 1e-3); // friction stops it within three seconds
}

TEST(current_limit, bounds_every_winding_and_inductance_delays_it) {
    PlantConfig config = on("sand");
    config.rover.drive.current_limit_A = 0.4;
    config.rover.drive.inductance_H = 0.05;
    Plant plant(config);
    double most = 0;
    for (int k = 0; k < 1000; ++k) {
        drive(plant, 1, 1, 1);
        for (const WheelTruth &w : plant.truth().wheel) most = std::max(most, w.current_A);
        // L dI/dt = u - R I from rest, implicit Euler: after one step (h/(1 + h R)) u with h = dt/L
        if (k == 0) {
            EXPECT_NEAR(plant.truth().wheel[0].current_A, 0.02 * 7.2 / (1 + 0.02 * 3.24), 1e-3);
        }
    }
    EXPECT_EQ(most, 0.4);
}

} // namespace
