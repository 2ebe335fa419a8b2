// The full terramechanics in the plant: force balance, tracks that remember, and what soft ground does to the rover.
#include "sim/physics/terramechanics.h"
#include "sim/plant/plant.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace traction::sim;

namespace {

PlantConfig soft(const char *soil, ContactLaw contact) {
    PlantConfig config;
    config.ground.soil = *find_soil(soil);
    config.ground.contact = contact;
    return config;
}

void drive(Plant &plant, double duty, int steps) {
    for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, duty);
    for (int k = 0; k < steps; ++k) plant.step();
}

constexpr ContactLaw soft_laws[] = {ContactLaw::bekker, ContactLaw::arc};

TEST(soft_ground, steady_driving_balances_traction_and_resistance) {
    for (const char *name : {"gravel", "sand", "dry_sand_literature", "loam", "snow", "lunar_simulant"})
        for (const ContactLaw law : soft_laws) {
            Plant plant(soft(name, law));
            drive(plant, 0.6, 8000);
            double net = 0, load = 0;
            for (const WheelTruth &w : plant.truth().wheel) net += w.traction_N - w.rolling_N, load += w.normal_N;
            // after 8 s the speed drifts by less than 1 mm/s^2 and the cells of the rut leave a ripple below 1 % of the weight
            EXPECT_NEAR(net, 0, 0.01 * load) << name << " " << static_cast<int>(law);
            EXPECT_NEAR(load, 2.88 * 9.81, 0.01 * load) << name;
        }
}

TEST(soft_ground, at_rest_the_wheels_stand_at_the_depth_of_the_closed_form) {
    for (const ContactLaw law : soft_laws) {
        Plant plant(soft("dry_sand_literature", law));
        drive(plant, 0, 2000);
        const Bekker &b = *find_soil("dry_sand_literature")->bekker;
        const double want = sinkage_under(law == ContactLaw::arc ? arc_force : bekker_force, b, {0.057, 0.042, 0}, 2.88 * 9.81 / 4, 0);
        // the two slip signs at rest differ by their shear stress: a few per cent of the depth in the arc law
        for (const WheelTruth &w : plant.truth().wheel) EXPECT_NEAR(w.sinkage_m, want, 0.05 * want);
    }
}

TEST(soft_ground, rear_wheels_roll_easier_in_the_track_of_the_front_ones) {
    for (const ContactLaw law : soft_laws) {
        Plant plant(soft("sand", law));
        drive(plant, 0.6, 6000);
        const auto &w = plant.truth().wheel;
        EXPECT_LT(w[0].rolling_N, 0.95 * w[2].rolling_N) << static_cast<int>(law);
        EXPECT_LT(w[1].rolling_N, 0.95 * w[3].rolling_N) << static_cast<int>(law);
        EXPECT_GT(w[2].sinkage_m, 0.002);
    }
}

TEST(soft_ground, coming_back_in_the_own_track_costs_less_than_going_out) {
    Plant plant(soft("sand", ContactLaw::bekker));
    drive(plant, 0.6, 5000);
    const double out_N = plant.truth().wheel[2].rolling_N; // leading
    drive(plant, 0, 1000);
    drive(plant, -0.6, 3000);
    const double back_N = plant.truth().wheel[0].rolling_N; // leading now, in the old track
    EXPECT_LT(plant.truth().v_body_m_s[0], -0.1);
    EXPECT_GT(plant.truth().position_m[0], 0.2) << "still on the part rolled before";
    EXPECT_LT(back_N, 0.5 * out_N);
}

TEST(soft_ground, slips_and_slows_more_than_the_aggregated_law_at_the_same_duty) {
    double v[3];
    for (int law = 0; law < 3; ++law) {
        Plant plant(soft("sand", static_cast<ContactLaw>(law)));
        drive(plant, 0.5, 5000);
        v[law] = plant.truth().v_body_m_s[0];
        EXPECT_GT(v[law], 0.1);
    }
    EXPECT_LT(v[1], v[0]);
    EXPECT_LT(v[2], v[0]);
}

TEST(soft_ground, forward_and_backward_mirror_each_other) {
    for (const ContactLaw law : soft_laws) {
        double x[2];
        for (int way = 0; way < 2; ++way) {
            Plant plant(soft("gravel", law));
            drive(plant, way == 0 ? 0.5 : -0.5, 4000);
            x[way] = plant.truth().position_m[0];
        }
        EXPECT_NEAR(-x[1], x[0], 0.005 * x[0]); // cells of the track lie unlike under leading and trailing wheels: up to 1 cm of 2 m
    }
}

} // namespace
