// Rovers of one, two and six wheels against closed forms: how they stand (statics), what a bench carriage pulls (the law's curve), about
// what point a rover with a caster turns (rolling without slip), and where the energy goes. No bound comes from a run.
#include "sim/plant/contact.h"
#include "sim/plant/plant.h"

#include "sim/physics/terramechanics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

using namespace traction::sim;

namespace {

PlantConfig rover(Layout kind, const char *soil, ContactLaw contact = ContactLaw::aggregated) {
    PlantConfig config;
    config.ground.soil = *find_soil(soil);
    config.ground.contact = contact;
    config.ground.grip_noise = 0;
    LayoutParameters &layout = config.rover.layout;
    layout.kind = kind, layout.rigid = true;
    if (kind == Layout::six) config.rover.mass_kg = 4.32, config.rover.half_wheelbase_m = 0.15, config.rover.length_m = 0.46;
    if (kind == Layout::caster) config.rover.mass_kg = 1.8, layout.axle_m = 0.03, layout.caster_m = -0.12, layout.caster_rolling = 0.02;
    if (kind == Layout::carriage) config.rover.mass_kg = 0.72;
    return config;
}

void drive(Plant &plant, double left, double right, int steps) {
    for (int i = 0; i < wheel_most; ++i) plant.set_duty(i, i % 2 == 0 ? left : right);
    for (int k = 0; k < steps; ++k) plant.step();
}

std::vector<double> loads(const Plant &plant, Layout kind) {
    std::vector<double> out;
    for (const int slot : wheels_of(kind)) out.push_back(plant.truth().slot(slot).normal_N);
    return out;
}

// A rigid beam on equal springs k at x_i: k (n d + p sum x) = W, k (d sum x + p sum x^2) = 0.
TEST(layout, six_wheels_share_the_weight_as_a_beam_on_springs) {
    for (const double middle_m : {0.0, 0.06, -0.1})
        for (const bool rigid : {true, false}) { // jointed halves are two such beams, alike
            PlantConfig config = rover(Layout::six, "concrete");
            config.rover.layout.middle_m = middle_m, config.rover.layout.rigid = rigid;
            config.yaw_rad = 0.4;
            Plant plant(config);
            const std::array<double, 6> x{-0.15, -0.15, 0.15, 0.15, middle_m, middle_m};
            const double weight = 4.32 * 9.81, sum = 2 * middle_m, square = 4 * 0.15 * 0.15 + 2 * middle_m * middle_m;
            const double k = config.rover.contact_stiffness_N_m, det = 6 * square - sum * sum;
            const double d = weight / k * square / det, p = -weight / k * sum / det;
            const auto expect = [&](const char *when) {
                const auto now = loads(plant, Layout::six);
                // p is 1 mrad at most: a cosine and the shift of the weight change a load by its square and by p times height/arm
                for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(now[i], k * (d + p * x[i]), 0.005) << when << ' ' << middle_m << ' ' << i;
            };
            drive(plant, 0, 0, 1);
            expect("from the first step");
            drive(plant, 0, 0, 1000);
            expect("after a second");
        }
}

// On soil that yields each wheel bears what the law gives at its depth; the depths lie on a line, the loads balance weight and moment.
TEST(layout, six_wheels_sink_as_a_beam_on_the_soils_law) {
    PlantConfig config = rover(Layout::six, "sand", ContactLaw::bekker);
    config.rover.layout.middle_m = 0.06;
    Plant plant(config);
    drive(plant, 0, 0, 1000);
    const Truth &t = plant.truth();
    const SoilConstants constants = soil_constants(*config.ground.soil.bekker, config.rover.wheel_width_m);
    const SoilWheel wheel{config.rover.wheel_radius_m, config.rover.wheel_width_m, config.rover.tyre_hysteresis};
    double weight = 0, moment = 0;
    const std::array<double, 6> x{-0.15, -0.15, 0.15, 0.15, 0.06, 0.06};
    for (int i = 0; i < 6; ++i) {
        const WheelTruth &w = t.slot(i);
        EXPECT_NEAR(w.normal_N, bekker_force(*config.ground.soil.bekker, constants, wheel, {w.sinkage_m, 0, 0}).normal_N, 1e-3) << i;
        weight += w.normal_N, moment += w.normal_N * x[static_cast<std::size_t>(i)];
    }
    EXPECT_NEAR(weight, 4.32 * 9.81, 1e-3);
    EXPECT_NEAR(moment, 0, 1e-3);
    const double share = (0.06 + 0.15) / 0.3; // the middle axle's place between the outer ones
    EXPECT_NEAR(t.slot(4).sinkage_m, (1 - share) * t.slot(0).sinkage_m + share * t.slot(2).sinkage_m, 1e-7);
    EXPECT_LT(t.slot(2).sinkage_m, t.slot(0).sinkage_m - 1e-4); // more wheels in front: the tail sinks
}

TEST(layout, a_caster_bears_by_the_lever_rule) {
    for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc})
        for (const auto &[axle_m, caster_m] : {std::pair{0.03, -0.12}, {-0.05, 0.08}}) {
            PlantConfig config = rover(Layout::caster, "sand", contact);
            config.rover.layout.axle_m = axle_m, config.rover.layout.caster_m = caster_m;
            Plant plant(config);
            for (const int steps : {1, 1000}) {
                drive(plant, 0, 0, steps);
                const double weight = 1.8 * 9.81, borne = weight * axle_m / (axle_m - caster_m);
                const auto now = loads(plant, Layout::caster);
                // the body leans by a few mrad: its arms shorten by the square, 1e-5 of the load
                EXPECT_NEAR(now[2], borne, 1e-3) << static_cast<int>(contact) << ' ' << steps;
                EXPECT_NEAR(now[0], 0.5 * (weight - borne), 1e-3) << static_cast<int>(contact);
                EXPECT_NEAR(now[1], now[0], 1e-6);
            }
        }
}

// Rolling without slip: yaw rate (vr - vl)/(2 b), the centre of turning on the axle's line at b (vr + vl)/(vr - vl) to the left.
TEST(layout, with_a_caster_it_turns_about_the_driven_axle) {
    PlantConfig config = rover(Layout::caster, "concrete");
    config.ground.contact = ContactLaw::aggregated;
    Plant plant(config);
    drive(plant, 0.3, 0.45, 3000);
    const Truth &t = plant.truth();
    const double R = config.rover.wheel_radius_m, b = config.rover.half_track_m, rate = t.rate_body_rad_s[2];
    const double vl = R * t.wheel[0].speed_rad_s, vr = R * t.wheel[1].speed_rad_s;
    ASSERT_GT(vr, 1.2 * vl);
    // What slip the forces of this drive need, on (21) with Fm = 5.6 N a wheel and sc = 0.05: the caster drags by less than a tenth of its
    // 3.5 N, 0.2 N a wheel, s = 0.2/5.6 sc = 0.002; sideways M v w shared by two wheels, below 0.9 N, 0.01.
    EXPECT_NEAR(rate, (vr - vl) / (2 * b), 0.002 * (vr + vl) / (2 * b));
    EXPECT_NEAR(t.v_body_m_s[0], 0.5 * (vr + vl), 0.004 * 0.5 * (vr + vl));
    const double axle_aside = t.v_body_m_s[1] + config.rover.layout.axle_m * rate; // of the axle's middle
    EXPECT_LT(std::fabs(axle_aside), 0.01 * t.v_body_m_s[0]);
    EXPECT_GT(std::fabs(t.v_body_m_s[1]), 0.5 * config.rover.layout.axle_m * rate); // the centre of mass does go aside
    EXPECT_NEAR(t.v_body_m_s[0] / rate, b * (vr + vl) / (vr - vl), 0.02 * b * (vr + vl) / (vr - vl));
}

// At a constant speed the wheels' pull is what all contacts take, the caster's bearing included (2).
TEST(layout, the_driven_wheels_pull_what_the_caster_drags) {
    for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker}) {
        PlantConfig config = rover(Layout::caster, "sand", contact);
        Plant plant(config);
        drive(plant, 0.5, 0.5, 6000);
        const Truth &t = plant.truth();
        const WheelTruth &caster = t.slot(4);
        const SoilWheel ball{config.rover.layout.caster_radius_m, config.rover.wheel_width_m, config.rover.tyre_hysteresis};
        const Soil &soil = config.ground.soil;
        const double ground =
            contact == ContactLaw::aggregated
                ? soil.rolling_coefficient * caster.normal_N
                : bekker_force(*soil.bekker, soil_constants(*soil.bekker, ball.width_m), ball, {caster.sinkage_m, 0, 0}).resistance_N;
        const double drag = ground + 0.02 * caster.normal_N;
        double pull = 0;
        for (int i = 0; i < 2; ++i)
            pull += t.wheel[static_cast<std::size_t>(i)].traction_N - t.wheel[static_cast<std::size_t>(i)].rolling_N;
        EXPECT_GT(t.v_body_m_s[0], 0.1);
        EXPECT_NEAR(pull, drag, 0.002 * drag) << static_cast<int>(contact);
        const double before = plant.energy().rolling;
        double rolled = 0;
        for (int k = 0; k < 500; ++k) {
            plant.step();
            for (const int slot : wheels_of(Layout::caster)) rolled += 0.001 * t.slot(slot).rolling_N * t.slot(slot).ground_speed_m_s;
        }
        EXPECT_NEAR(plant.energy().rolling - before, rolled, 0.002 * rolled); // all of it is rolling, none of it slip
    }
}

// Wheels locked at 0.5 m/s slide at s = -1: Ft = Fm f(1), Fm of the soil but for the effect.
TEST(layout, in_a_track_all_wheels_but_the_leading_ones_follow) {
    for (const Layout kind : {Layout::six, Layout::caster})
        for (const double speed_m_s : {0.5, -0.5}) {
            PlantConfig config = rover(kind, "sand");
            config.effects = {{find_effect("multi_pass"), -1, {0.3}}};
            config.speed_m_s = speed_m_s;
            Plant plant(config);
            for (int i = 0; i < wheel_most; ++i) plant.block_wheel(i, true);
            for (int k = 0; k < 30; ++k) plant.step();
            const Soil &sand = config.ground.soil;
            for (const int slot : wheels_of(kind)) {
                if (is_caster(kind, slot)) continue;
                const WheelTruth &w = plant.truth().slot(slot);
                const double plain =
                    (sand.adhesion_N + sand.fm_per_fn * w.normal_N) * traction_share(sand.law, std::fabs(w.slip), sand.shear_slip);
                const bool leads = kind == Layout::caster || (slot < 4 && (slot >= 2) == (speed_m_s > 0));
                EXPECT_NEAR(std::fabs(w.traction_N) / plain, leads ? 1.0 : 1.3, 1e-6) << slot << " at " << speed_m_s;
            }
        }
}

TEST(layout, a_ball_drags_against_its_velocity_whichever_way_it_rolls) {
    for (double way = 0; way < 6.2; way += 0.37) {
        ContactState state;
        RollingShare share;
        for (int k = 0; k < 200; ++k) share = drag_step(state, 0.1 * std::cos(way), 0.1 * std::sin(way), 0.3, 0.6, 0.001);
        EXPECT_NEAR(share.along, std::cos(way), 1e-6) << way;
        EXPECT_NEAR(share.across, std::sin(way), 1e-6) << way;
    }
}

// However suddenly it is pushed, or turned round: its damping lends no more than the resistance that there is.
TEST(layout, a_ball_that_is_pushed_suddenly_drags_with_its_resistance_at_most) {
    double largest = 0;
    for (double way = 0; way < 6.2; way += 0.37) {
        ContactState state;
        for (int k = 0; k < 60; ++k) {
            const double speed_m_s = k < 20 ? 0.1 : k < 40 ? -0.3 : 0.02;
            const RollingShare share = drag_step(state, speed_m_s * std::cos(way), speed_m_s * std::sin(way), 0.3, 0.6, 0.001);
            const double size = std::hypot(share.along, share.across);
            ASSERT_LE(size, 1 + 1e-12) << way << ' ' << k;
            largest = std::max(largest, size);
        }
    }
    EXPECT_GT(largest, 1 - 1e-12); // it was there
}

// What a carriage pulls is what the ground gives less what rolling takes: Fm (1 - sc/s (1 - exp(-s/sc))) - Rr = drawbar.
TEST(layout, a_carriage_settles_where_the_soils_curve_meets_the_drawbar_pull) {
    for (const double drawbar_N : {0.5, 1.5, 2.5}) {
        PlantConfig config = rover(Layout::carriage, "sand");
        config.rover.layout.drawbar_N = drawbar_N;
        config.yaw_rad = 0.7;
        Plant plant(config);
        drive(plant, 0.6, 0.6, 8000);
        const Soil &soil = config.ground.soil;
        const double load = 0.72 * 9.81, Fm = soil.adhesion_N + soil.fm_per_fn * load, sc = soil.shear_slip;
        const auto left = [&](double s) {
            return Fm * (1 - sc / s * (1 - std::exp(-s / sc))) - soil.rolling_coefficient * load - drawbar_N;
        };
        ASSERT_GT(left(1), 0) << "the soil can pull it";
        double low = 1e-6, high = 1;
        while (high - low > 1e-12) (left(0.5 * (low + high)) < 0 ? low : high) = 0.5 * (low + high);
        const WheelTruth &w = plant.truth().wheel[0];
        EXPECT_NEAR(w.slip, low, 1e-3 * low) << drawbar_N; // the drive's time constant is 0.2 s: e^-40 is left
        EXPECT_NEAR(w.normal_N, load, 1e-4);
        EXPECT_NEAR(w.slip, 1 - w.ground_speed_m_s / (config.rover.wheel_radius_m * w.speed_rad_s), 1e-6); // (1)
    }
}

// The same with the soil's own load and traction laws, whose sinkage grows with the slip.
TEST(layout, a_carriage_on_soft_soil_pulls_what_the_law_gives_at_its_slip) {
    for (const ContactLaw contact : {ContactLaw::bekker, ContactLaw::arc})
        for (const double drawbar_N : {0.3, 0.7}) { // the arc law's sand gives 0.96 N at the most
            PlantConfig config = rover(Layout::carriage, "sand", contact);
            config.rover.layout.drawbar_N = drawbar_N;
            Plant plant(config);
            drive(plant, 0.6, 0.6, 8000);
            const auto law = contact == ContactLaw::arc ? arc_force : bekker_force;
            const Bekker &soil = *config.ground.soil.bekker;
            const SoilWheel wheel{config.rover.wheel_radius_m, config.rover.wheel_width_m, config.rover.tyre_hysteresis};
            const WheelTruth &w = plant.truth().wheel[0];
            const double z = sinkage_under(law, soil, wheel, 0.72 * 9.81, w.slip);
            const SoilForce force = law(soil, soil_constants(soil, config.rover.wheel_width_m), wheel, {z, w.slip, 0});
            EXPECT_GT(w.slip, 0.02) << "it must slip for the curve to mean something";
            EXPECT_NEAR(w.sinkage_m, z, 1e-4 * z);
            EXPECT_NEAR(force.traction_N - force.resistance_N, drawbar_N, 0.01 * drawbar_N) << static_cast<int>(contact);
        }
}

TEST(layout, a_carriage_keeps_to_its_rail) {
    PlantConfig config = rover(Layout::carriage, "sand", ContactLaw::bekker);
    config.yaw_rad = 0.7, config.rover.centre_height_m = 0.05;
    config.ground.slope_rad = 0.1, config.ground.slope_direction_rad = 2.0;
    Plant plant(config);
    const double z0 = plant.truth().position_m[2];
    for (const double duty : {0.6, -0.6, 0.0, 1.0}) {
        drive(plant, duty, duty, 1000);
        const Truth &t = plant.truth();
        EXPECT_NEAR(-t.position_m[0] * std::sin(0.7) + t.position_m[1] * std::cos(0.7), 0, 1e-9);
        EXPECT_NEAR(t.yaw_rad, 0.7, 1e-9);
        EXPECT_NEAR(t.pitch_rad, 0, 1e-9);
        EXPECT_NEAR(t.roll_rad, 0, 1e-9);
    }
    EXPECT_GT(std::fabs(plant.truth().position_m[2] - z0), 1e-5); // free in height: slip digs
}

// One motor a side, all at its rear wheel: front and rear wheel turn as one, whatever each meets, and no current flows in a wheel that has
// no motor. Steady: KG I = b w + t0 + R (Ft of both).
TEST(layout, a_motor_of_a_side_turns_its_wheels_as_one_and_carries_both) {
    for (const Layout kind : {Layout::four, Layout::six})
        for (const std::array<int, 2> drives : {std::array{0, 1}, {2, 3}, {2, 1}}) {
            PlantConfig config = rover(kind, "sand");
            config.rover.layout.drives = drives;
            config.rover.layout.rigid = false;
            config.ground.patches.push_back({.x_min_m = 0.2, .x_max_m = 0.4, .y_min_m = 0, .y_max_m = 1, .soil = *find_soil("concrete")});
            Plant plant(config);
            double apart = 0;
            for (int k = 0; k < 4000; ++k) {
                drive(plant, 0.7, 0.5, 1);
                for (const int slot : wheels_of(kind)) {
                    const WheelTruth &w = plant.truth().slot(slot), &m = plant.truth().slot(drives[static_cast<std::size_t>(slot % 2)]);
                    apart = std::fmax(apart, std::fabs(w.speed_rad_s - m.speed_rad_s) + std::fabs(w.angle_rad - m.angle_rad));
                    if (&w != &m) {
                        EXPECT_EQ(w.current_A, 0);
                        EXPECT_EQ(w.duty, 0);
                    }
                }
            }
            EXPECT_EQ(apart, 0);
            for (const int motor : drives) {
                double pull = 0;
                for (const int slot : wheels_of(kind))
                    if (slot % 2 == motor % 2) pull += plant.truth().slot(slot).traction_N;
                const DriveParameters &p = config.rover.drive;
                const WheelTruth &w = plant.truth().slot(motor);
                const double gear = p.viscous_Nms * w.speed_rad_s + p.coulomb_Nm;
                // 1 %: it still turns a little, round a bend
                EXPECT_NEAR(p.torque_constant_Nm_A * w.current_A, gear + config.rover.wheel_radius_m * pull,
                            0.01 * (gear + 0.057 * std::fabs(pull)));
            }
        }
}

// With the same ground everywhere, straight ahead, two motors of twice the strength are four: the same speed to the last digits.
TEST(layout, two_motors_of_twice_the_strength_drive_as_four_do) {
    PlantConfig four = rover(Layout::four, "concrete"), two = four;
    two.rover.layout.drives = {0, 1};
    DriveParameters &p = two.rover.drive;
    p.resistance_ohm /= 2, p.inertia_kg_m2 *= 2, p.viscous_Nms *= 2, p.coulomb_Nm *= 2;
    Plant a(four), b(two);
    for (int k = 0; k < 3000; ++k) drive(a, 0.6, 0.6, 1), drive(b, 0.6, 0.6, 1);
    // front and rear wheels bear alike, so each pair shares a speed anyway: what is left is rounding
    EXPECT_NEAR(a.truth().v_body_m_s[0], b.truth().v_body_m_s[0], 1e-9);
    EXPECT_NEAR(2 * a.truth().wheel[0].current_A, b.truth().wheel[0].current_A, 1e-8);
    EXPECT_GT(a.truth().v_body_m_s[0], 0.2);
}

TEST(layout, a_blocked_wheel_holds_all_that_its_chain_turns) {
    PlantConfig config = rover(Layout::four, "concrete");
    config.rover.layout.drives = {0, 1};
    config.rover.drive.resistance_ohm /= 2; // twice the motor, which can drag the held side round
    Plant plant(config);
    plant.block_wheel(2, true);
    drive(plant, 0.5, 1, 500);
    EXPECT_EQ(plant.truth().wheel[0].speed_rad_s, 0);
    EXPECT_EQ(plant.truth().wheel[2].speed_rad_s, 0);
    EXPECT_GT(plant.truth().wheel[3].speed_rad_s, 1);
    EXPECT_GT(plant.truth().wheel[0].current_A, 0.5); // stalled
}

// As plant_numerics_test does for four wheels.
TEST(layout, the_energy_closes_within_a_thousandth) {
    for (const auto &[kind, coupled] :
         {std::pair{Layout::six, false}, {Layout::caster, false}, {Layout::carriage, false}, {Layout::four, true}})
        for (const char *soil : {"concrete", "sand"})
            for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
                PlantConfig config = rover(kind, soil, contact);
                config.ground.slope_rad = 0.05, config.ground.slope_direction_rad = 0.3;
                config.rover.centre_height_m = 0.04;
                if (kind == Layout::carriage) config.rover.layout.drawbar_N = 0.5;
                if (coupled) config.rover.layout.drives = {0, 1};
                Plant plant(config);
                const double start = plant.energy().kinetic + plant.energy().potential;
                double throughput = 0, last = 0;
                for (const auto &[left, right] : {std::pair{0.5, 0.5}, {0.6, 0.35}, {-0.4, -0.4}, {-0.5, 0.5}, {0.0, 0.0}}) {
                    for (int k = 0; k < 1000; ++k) {
                        drive(plant, left, right, 1);
                        throughput += std::fabs(plant.energy().motor - last);
                        last = plant.energy().motor;
                    }
                    if (left != 0 && !coupled) continue; // at rest, the spin of coupled wheels would not show
                    const Energy &e = plant.energy();
                    const double rest = e.motor - (e.friction + e.slip + e.rolling + e.body + e.kinetic + e.potential - start);
                    EXPECT_GT(throughput, left == 0 ? 0.5 : 0);
                    EXPECT_LT(std::fabs(rest), 1e-3 * throughput)
                        << static_cast<int>(kind) << ' ' << soil << ' ' << static_cast<int>(contact) << ' ' << left;
                }
            }
}

// A step of a third of the radius under one side: jointed halves tilt apart, a stiff chassis does not, and no run differs from its repeat.
TEST(layout, fixed_axles_do_not_twist_over_a_step_and_runs_repeat) {
    std::array<std::uint64_t, 2> hash{};
    for (const bool rigid : {true, false}) {
        for (std::uint64_t &out : hash) {
            PlantConfig config = rover(Layout::six, "concrete");
            config.rover.layout.rigid = rigid;
            config.ground.terrain.profile = {{0.3, 0}, {0.3, 0.019}};
            config.ground.terrain.profile_direction_rad = 0.5; // one side comes first
            Plant plant(config);
            double twist = 0, highest = 0;
            for (int k = 0; k < 3500; ++k) {
                drive(plant, 0.5, 0.5, 1);
                twist = std::fmax(twist, std::fabs(plant.truth().joint_rad)), highest = std::fmax(highest, plant.truth().position_m[2]);
            }
            EXPECT_GT(highest, 0.012);
            if (rigid)
                EXPECT_LT(twist, 1e-3); // the joint's stop gives way by what its solver leaves
            else
                EXPECT_GT(twist, 0.01);
            out = plant.state_hash();
        }
        EXPECT_EQ(hash[0], hash[1]);
    }
}

// Every layout from rest on rough ground: nothing jumps, nothing falls.
TEST(layout, each_starts_calmly_on_rough_ground) {
    for (const Layout kind : {Layout::six, Layout::caster, Layout::carriage}) {
        PlantConfig config = rover(kind, "concrete");
        config.ground.terrain.roughness_m3 = 0.2 * iso_8608_m3('C');
        config.ground.terrain.shortest_m = 0.1;
        config.yaw_rad = 0.9;
        Plant plant(config);
        double fastest = 0;
        for (int k = 0; k < 500; ++k) {
            drive(plant, 0, 0, 1);
            fastest = std::fmax(fastest, std::fabs(plant.truth().v_body_m_s[2]));
        }
        EXPECT_LT(fastest, 0.15) << static_cast<int>(kind); // a fall of 1 mm: the class's height under a rover
        EXPECT_LT(std::fabs(plant.truth().v_body_m_s[2]), 0.005);
        EXPECT_LT(std::fabs(plant.truth().pitch_rad), 0.1);
    }
}

} // namespace
