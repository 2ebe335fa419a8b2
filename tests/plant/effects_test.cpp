// The catalogue is consistent, each law is its closed form, and the plant does what catalogue and law say.
#include "sim/physics/effects/acting.h"
#include "sim/plant/plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

namespace {

using namespace traction::sim;

constexpr double rounding = 1e-12; // relative: hand computation carried to 13 digits, a few operations of 2^-53

// ---------------------------------------------------------------- the catalogue

TEST(Catalogue, names_are_unique_and_findable) {
    std::set<std::string_view> names;
    for (const Effect &effect : catalogue()) {
        EXPECT_TRUE(names.insert(effect.name).second) << effect.name;
        EXPECT_EQ(find_effect(effect.name), &effect);
        EXPECT_EQ(effect.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos) << effect.name;
    }
    EXPECT_GE(names.size(), 40u);
    EXPECT_EQ(find_effect("phlogiston"), nullptr);
}

TEST(Catalogue, every_effect_tells_what_it_is_where_it_comes_from_and_what_shows_it) {
    for (const Effect &effect : catalogue())
        for (const std::string_view text : {effect.title, effect.equation, effect.source, effect.signature, effect.reveals})
            EXPECT_GE(text.size(), 6u) << effect.name; // shorter than "u -= R" says nothing
}

TEST(Catalogue, a_strength_may_be_absent_is_plausible_by_default_and_then_worth_finding) {
    for (const Effect &effect : catalogue()) {
        int strengths = 0;
        for (const EffectParameter &p : effect.parameters) {
            if (!p.strength) continue;
            ++strengths;
            EXPECT_LE(p.minimum, 0) << effect.name;
            EXPECT_GT(p.maximum, 0) << effect.name;
            EXPECT_LE(p.typical, p.maximum) << effect.name;
            EXPECT_GT(p.of_interest, 0) << effect.name;
            EXPECT_GE(p.typical, p.of_interest) << effect.name;
            EXPECT_TRUE(p.variants.empty()) << effect.name;
        }
        EXPECT_GE(strengths, 1) << effect.name;
    }
}

TEST(Catalogue, a_shape_stays_within_its_range) {
    for (const Effect &effect : catalogue())
        for (const EffectParameter &p : effect.parameters) {
            if (p.strength) continue;
            for (const double value : p.variants) EXPECT_TRUE(value >= p.minimum && value <= p.maximum) << effect.name;
            EXPECT_TRUE(p.typical >= p.minimum && p.typical <= p.maximum) << effect.name;
        }
}

TEST(Catalogue, a_parameter_carries_its_unit_in_its_name) {
    const std::map<std::string_view, std::string_view> suffix{{"N m", "_Nm"},
                                                              {"N m s", "_Nms"},
                                                              {"rad/s", "_rad_s"},
                                                              {"rad", "_rad"},
                                                              {"K/W", "_K_W"},
                                                              {"s", "_s"},
                                                              {"ohm", "_ohm"},
                                                              {"V", "_V"},
                                                              {"A", "_A"},
                                                              {"N", "_N"},
                                                              {"N/m", "_N_m"},
                                                              {"m", "_m"},
                                                              {"1/m", "_per_m"},
                                                              {"s/m", "_s_m"},
                                                              {"m/s^2", "_m_s2"},
                                                              {"m/s^3", "_m_s3"},
                                                              {"s^2/m", "_s2_m"},
                                                              {"rad s^2/m", "_rad_s2_m"},
                                                              {"1", ""},
                                                              {"1/turn", ""},
                                                              {"s^2/m^2", "_s2_m2"},
                                                              {"s/rad", "_per_rad_s"},
                                                              {"N m s^2", "_Nms2"},
                                                              {"N s^2/m^2", "_Ns2_m2"}};
    for (const Effect &effect : catalogue())
        for (const EffectParameter &p : effect.parameters) {
            const auto known = suffix.find(p.unit);
            ASSERT_NE(known, suffix.end()) << effect.name << " " << p.unit;
            EXPECT_TRUE(p.name.ends_with(known->second)) << effect.name << " " << p.name;
            EXPECT_FALSE(p.meaning.empty()) << effect.name << " " << p.name;
        }
}

TEST(Catalogue, a_value_is_found_by_its_name_or_refused) {
    const ActiveEffect active{.effect = find_effect("stribeck_friction"), .wheel = -1, .values = {0.03, 2}};
    EXPECT_EQ(active.value("torque_Nm"), 0.03);
    EXPECT_EQ(active.value("speed_rad_s"), 2);
    EXPECT_THROW(static_cast<void>(active.value("coefficient")), std::out_of_range);
}

// ---------------------------------------------------------------- the laws, at values computed by hand

TEST(Laws, gear) {
    EXPECT_NEAR(law::stribeck_friction_Nm(0.03, 2, 2), 0.03 / 2.718281828459045, 0.03 * rounding); // at its own speed 1/e is left
    EXPECT_EQ(law::stribeck_friction_Nm(0.03, 2, -1), law::stribeck_friction_Nm(0.03, 2, 1));
    EXPECT_NEAR(law::viscous_friction_Nm(0.005, -4), -0.02, rounding);
    EXPECT_NEAR(law::mesh_loss_Nm(0.1, -0.3), 0.03, rounding);
    EXPECT_NEAR(law::wear_in_Nm(0.05, 30, 30), 0.05 / 2.718281828459045, 0.05 * rounding); // at its own time 1/e is left
    EXPECT_EQ(law::reverse_friction_Nm(0.03, -2), 0.03);
    EXPECT_EQ(law::reverse_friction_Nm(0.03, 2), 0);
    EXPECT_NEAR(law::churning_friction_Nm(6e-4, -5), 0.015, rounding);
    EXPECT_NEAR(law::gear_speed_loss_Nm(0.03, -5, -0.3), 0.045, rounding);
    EXPECT_NEAR(law::torque_ripple_Nm(0.02, 0.01, 2, 1.0471975511965976), 0.02 * -0.5 + 0.01 * 0.8660254037844387, rounding); // 2*60 deg
}

TEST(Laws, teeth_push_beyond_the_play_and_never_pull) {
    EXPECT_EQ(law::backlash_Nm(0.06, 40, 0.05, 0.03, 1), 0);
    EXPECT_NEAR(law::backlash_Nm(0.06, 40, 0.05, 0.04, 1), 40 * 0.01 + 0.05, rounding);
    EXPECT_NEAR(law::backlash_Nm(0.06, 40, 0.05, -0.04, 1), -(40 * 0.01 - 0.05), rounding);
    EXPECT_EQ(law::backlash_Nm(0.06, 40, 0.05, 0.031, -10), 0); // leaving faster than the spring pushes: 0.04 - 0.5 < 0
}

TEST(Laws, motor) {
    EXPECT_NEAR(law::winding_heating_K(20, 0.5, 3.24), 0.81 * 20, rounding); // 0.81 W of copper loss
    EXPECT_NEAR(law::hot_resistance_ohm(3.24, 50), 3.24 * 1.195, rounding);
    EXPECT_NEAR(law::hot_torque_constant(0.265, 50), 0.265 * 0.9, rounding);
    EXPECT_NEAR(law::torque_constant(0.265, -0.2), 0.212, rounding);
    EXPECT_NEAR(law::wiring_resistance_ohm(3.24, 0.4), 3.64, rounding);
    EXPECT_NEAR(law::shared_lead_V(0.5, -0.8), -0.4, rounding);
    EXPECT_TRUE(law::shares_lead(1, true, false) && !law::shares_lead(1, false, true));
    EXPECT_TRUE(law::shares_lead(2, false, true) && !law::shares_lead(2, true, false));
    EXPECT_TRUE(law::shares_lead(3, false, false));
    EXPECT_EQ(law::bridge_dead_time_V(0.4, -0.5), -0.4);
    EXPECT_EQ(law::bridge_dead_time_V(0.4, 0.3), 0.3); // below it all of the drop is lost
    EXPECT_EQ(law::bridge_dead_time_V(0.4, 0), 0);
    EXPECT_EQ(law::bridge_dead_time_V(0.4, -0.5, 0.1), -0.4);               // a soft edge narrower than the loss is none
    EXPECT_NEAR(law::bridge_dead_time_V(0.01, 0.05, 0.1), 0.005, rounding); // halfway up the edge
}

TEST(Laws, ground) {
    EXPECT_EQ(law::rolling_resistance(0.06), 0.06);
    EXPECT_NEAR(law::slip_sinkage(0.2, -0.5), 0.1, rounding);
    EXPECT_NEAR(law::speed_resistance(0.08, -0.5), 0.04, rounding);
    EXPECT_NEAR(law::squared_resistance(0.3, -0.5), 0.075, rounding);
    EXPECT_EQ(law::resistance_patch(0.12, 1, 0.8, 0.999), 0);
    EXPECT_EQ(law::resistance_patch(0.12, 1, 0.8, 1), 0.12);
    EXPECT_EQ(law::resistance_patch(0.12, 1, 0.8, 1.8), 0);
    EXPECT_EQ(law::shear_peak(0.5, 0.2, 0.1), 1); // up to the knee at twice sc
    EXPECT_NEAR(law::shear_peak(0.5, -0.6, 0.1), 1 - 0.5 * 0.4, rounding);
    EXPECT_NEAR(law::shear_peak(2.0, 1.0, 0.1), 0.1, rounding); // never less
    EXPECT_EQ(law::multi_pass(0.25, 0), 1);
    EXPECT_EQ(law::multi_pass(0.25, 1), 1.25);
    EXPECT_EQ(law::soil_patch(0.35, 1, 0.8, 0.999), 1);
    EXPECT_EQ(law::soil_patch(0.35, 1, 0.8, 1), 1.35);
    EXPECT_EQ(law::soil_patch(0.35, 1, 0.8, 1.8), 1);
    EXPECT_NEAR(law::soil_gradient(0.06, -2), 0.88, rounding);
    EXPECT_EQ(law::soil_gradient(-0.2, 20), 0.05); // soil never turns against the wheel
    EXPECT_NEAR(law::sliding_speed_loss(0.5, -2.0), 0.36787944117144233, rounding);
    EXPECT_NEAR(law::relaxation_length_m(0.005, 0.08), 0.085, rounding);
    EXPECT_NEAR(law::shear_stiffness(0.27, 0.5), 0.405, rounding);
    EXPECT_NEAR(law::wheel_radius_m(0.057, 0.1), 0.0627, rounding);
    EXPECT_NEAR(law::lateral_scrub_N(0.4, 7.0), 2.8, rounding);
}

TEST(Laws, loads_and_body_forces) {
    EXPECT_NEAR(law::load_transfer_m(0.05, 0.08), 0.13, rounding);
    EXPECT_NEAR(law::mass_offset_m(0.083, 0.025), 0.058, rounding);
    EXPECT_NEAR(law::mass_offset_Nm(28.2528, -0.025), -0.70632, rounding);
    const auto up = law::grade_m_s2(9.81, 0.5235987755982988, 0), aside = law::grade_m_s2(9.81, 0.5235987755982988, 1.5707963267948966);
    EXPECT_NEAR(up.along_m_s2, -4.905, 1e-11); // half the weight up 30 degrees
    EXPECT_EQ(up.across_m_s2, 0);
    EXPECT_NEAR(aside.along_m_s2, 0, 1e-14);      // across the slope: cos is 6e-17
    EXPECT_NEAR(aside.across_m_s2, 4.905, 1e-11); // turned to the left of the rise, its foot lies to the left
    EXPECT_NEAR(law::tether_drag_N(0.6, 2), -1.2, rounding);
    EXPECT_EQ(law::body_drag_N(1.2, -1), 1.2);
    EXPECT_NEAR(law::fluid_drag_N(8, -0.5), 2, rounding);
}

TEST(Laws, sensors) {
    EXPECT_NEAR(law::accel_bias(0.5, 0.15), 0.65, rounding);
    EXPECT_NEAR(law::accel_drift(0.5, 0.003, 100), 0.8, rounding);
    EXPECT_NEAR(law::accel_tilt(0.5, 9.81, 0.01, 0.4), 0.53924, rounding);
    EXPECT_NEAR(law::accel_scale(1.01, 0.1), 1.11, rounding);
    EXPECT_NEAR(law::accel_place(0.5, 0.1, -0.2, 2, 1.5), 0.4, rounding); // 0.5 - 0.1 * 4 + 0.2 * 1.5
    EXPECT_NEAR(law::gyro_scale(1.01, -0.05), 0.96, rounding);
    EXPECT_NEAR(law::radar_scale(1.01, -0.08), 0.93, rounding);
    EXPECT_NEAR(law::radar_pitch(0.1, -2), 0.8, rounding);
    EXPECT_NEAR(law::current_gain(1, 0.12), 1.12, rounding);
    EXPECT_NEAR(law::current_offset(0.5, -0.08), 0.42, rounding);
    EXPECT_NEAR(law::voltage_gain(1, 0.05), 1.05, rounding);
    EXPECT_NEAR(law::encoder_missed(0.06), 0.94, rounding);
    EXPECT_NEAR(law::camera_scale(1, 0.05), 1.05, rounding);
    EXPECT_NEAR(law::camera_delay_s(0.03, 0.12), 0.15, rounding);
    EXPECT_NEAR(law::actuation_delay_s(0, 0.05), 0.05, rounding);
    EXPECT_NEAR(law::accel_delay_s(0.01, 0.12), 0.13, rounding);
    EXPECT_NEAR(law::accel_lag_s(0.01, 0.12), 0.13, rounding);
    EXPECT_NEAR(law::gyro_delay_s(0, 0.12), 0.12, rounding);
    EXPECT_NEAR(law::radar_delay_s(0.02, 0.25), 0.27, rounding);
    EXPECT_NEAR(law::current_delay_s(0.003, 0.05), 0.053, rounding);
}

// ---------------------------------------------------------------- what they add up to

TEST(Acting, effects_of_one_kind_add_up_shapes_replace_and_one_wheel_is_one) {
    const std::vector<ActiveEffect> all{{find_effect("stribeck_friction"), -1, {0.03, 2}},
                                        {find_effect("stribeck_friction"), 2, {0.01, 4}},
                                        {find_effect("accel_scale"), -1, {0.1}},
                                        {find_effect("accel_scale"), -1, {0.05}}};
    const RoverEffects e = act_together(all);
    EXPECT_EQ(e.wheel[0].stribeck_Nm, 0.03);
    EXPECT_EQ(e.wheel[0].stribeck_speed_rad_s, 2);
    EXPECT_EQ(e.wheel[2].stribeck_Nm, 0.03 + 0.01);
    EXPECT_EQ(e.wheel[2].stribeck_speed_rad_s, 4);
    EXPECT_EQ(e.body.accel_scale, 0.1 + 0.05);
}

TEST(Acting, friction_and_resistance_are_the_sums_of_their_laws) {
    const WheelEffects e{.coulomb_Nm = 0.04, .stribeck_Nm = 0.03, .stribeck_speed_rad_s = 2, .mesh_fraction = 0.1, .rolling = 0.06};
    EXPECT_NEAR(dry_friction_Nm(0.03, e, 2, -0.3, 0), 0.03 + 0.04 + 0.03 + 0.03 / 2.718281828459045, rounding);
    double sum = 0;
    each_resistance(e, BodyEffects{.slip_sinkage = 0.2, .speed_resistance_s_m = 0.08}, 0.5, -0.5, [&](double c) { sum += c; });
    EXPECT_NEAR(sum, 0.06 + 0.1 + 0.04, rounding);
}

TEST(Acting, without_effects_what_was_given_comes_back_bit_for_bit) {
    const WheelEffects e;
    const BodyEffects b;
    for (const double x : {0.1, 0.73, 1e-9}) {
        EXPECT_EQ(dry_friction_Nm(x, e, 3, 0.2, 1), x);
        EXPECT_EQ(motor_constant(x, e, 0), x);
        EXPECT_EQ(circuit_ohm(x, e), x);
        EXPECT_EQ(strength_here(x, b, 1, 2, 1), x);
        EXPECT_EQ(strength_sliding(x, b, 0.3), x);
        EXPECT_EQ(periodic_Nm(e, x, true), 0);
        EXPECT_EQ(periodic_Nm(e, x, false), 0);
        EXPECT_EQ(heating_gap_K(e, x, 3, 0), 0);
        double sum = x;
        each_resistance(e, b, 0.4, 0.5, [&](double c) { sum += c; });
        EXPECT_EQ(sum, x);
    }
}

TEST(Acting, every_parameter_of_the_catalogue_has_a_number_of_its_own) {
    std::vector<const EffectParameter *> all;
    for (const Effect &effect : catalogue())
        for (const EffectParameter &p : effect.parameters) {
            EXPECT_NE(p.in_wheel == nullptr, p.in_body == nullptr) << effect.name << " " << p.name;
            for (const EffectParameter *other : all)
                EXPECT_FALSE(p.in_wheel == other->in_wheel && p.in_body == other->in_body) << effect.name << " " << p.name;
            all.push_back(&p);
        }
}

// ---------------------------------------------------------------- the drive train obeys them

TEST(Drive, current_follows_ohms_law_with_every_electrical_effect_at_once) {
    const DriveParameters p;
    WheelEffects e;
    e.wiring_ohm = 0.4, e.dead_voltage_V = 0.4, e.constant_change = 0.1;
    DriveState s;
    s.motor_speed_rad_s = 5, s.heat_K = 40;
    const double ke = 0.265 * 1.1 * (1 - 0.002 * 40), ohm = 3.24 * (1 + 0.0039 * 40) + 0.4;
    EXPECT_NEAR(drive_current(p, e, s, 0.5, 7.2, 1e-3), (3.6 - ke * 5 - 0.4) / ohm, rounding);
    EXPECT_NEAR(drive_current(p, e, s, -0.5, 7.2, 1e-3), (-3.6 - ke * 5 + 0.4) / ohm, rounding);
    EXPECT_EQ(drive_current(p, e, s, (ke * 5 + 0.39) / 7.2, 7.2, 1e-3), 0); // inside the dead band
}

// Steady state of (17) with these effects: KG*I - b*w - load, which is the dry torque that must be left.
double dry_torque_Nm(const WheelEffects &e, double duty, double load_Nm) {
    const DriveParameters p;
    DriveState s;
    for (int i = 0; i < 20000; ++i) { // 20 s; J over b + KG^2/Ra is 0.22 s
        s.current_A = drive_current(p, e, s, duty, 7.2, 1e-3);
        drive_step(p, e, s, load_Nm, 1e-3);
    }
    return p.torque_constant_Nm_A * s.current_A - (p.viscous_Nms + e.viscous_Nms) * s.wheel_speed_rad_s - load_Nm;
}

TEST(Drive, friction_of_the_gear_adds_up_at_steady_speed) {
    constexpr double settled = 1e-9; // N m: 90 time constants later only rounding of J*dw/dt is left, 5e-3*1e-12/1e-3
    EXPECT_NEAR(dry_torque_Nm({}, 0.5, 0.1), 0.03, settled);
    EXPECT_NEAR(dry_torque_Nm({.coulomb_Nm = 0.04}, 0.5, 0.1), 0.07, settled);
    EXPECT_NEAR(dry_torque_Nm({.viscous_Nms = 0.005}, 0.5, 0.1), 0.03, settled);
    EXPECT_NEAR(dry_torque_Nm({.mesh_fraction = 0.1}, 0.5, 0.1), 0.04, settled);
    EXPECT_NEAR(dry_torque_Nm({.mesh_fraction = 0.1}, 0.5, -0.05), 0.035, settled);
    EXPECT_NEAR(dry_torque_Nm({.coulomb_Nm = 0.04}, -0.5, -0.1), -0.07, settled); // against the motion, both ways
}

TEST(Drive, a_friction_that_varies_over_the_turn_opposes_the_motion_both_ways_and_cogging_does_not) {
    // one turn at a held speed: what the motor must give beyond the constant friction, averaged
    const DriveParameters p;
    const auto taken_J = [&](double order, double speed_rad_s) {
        const WheelEffects e{.ripple_cos_Nm = 0.02, .ripple_order = order};
        double work = 0;
        for (int i = 0; i < 360; ++i) {
            DriveState s;
            s.wheel_angle_rad = s.motor_angle_rad = i * 0.017453292519943295;
            s.wheel_speed_rad_s = s.motor_speed_rad_s = speed_rad_s;
            DriveState plain = s;
            drive_step(p, e, s, 0, 1e-3);
            drive_step(p, {}, plain, 0, 1e-3);
            // where the cosine is positive, the torque that brakes counts, elsewhere the one that helps
            work += (plain.wheel_speed_rad_s - s.wheel_speed_rad_s) * (speed_rad_s > 0 ? 1 : -1) * std::cos(order * s.wheel_angle_rad);
        }
        return work / 360 * p.inertia_kg_m2 / 1e-3; // N m: half the amplitude, the mean of cos^2
    };
    constexpr double within = 1e-3 * 0.02; // the angle moves by 2 mrad within a step, friction's own change of speed likewise
    EXPECT_NEAR(taken_J(-2, 1), 0.01, within);
    EXPECT_NEAR(taken_J(-2, -1), 0.01, within); // a friction
    EXPECT_NEAR(taken_J(2, 1), 0.01, within);
    EXPECT_NEAR(taken_J(2, -1), -0.01, within); // cogging keeps its sign
}

TEST(Drive, windings_warm_up_exponentially) {
    const DriveParameters p;
    const WheelEffects e{.heating_K_W = 20, .heating_time_s = 20};
    DriveState s;
    for (int i = 0; i < 20000; ++i) {
        s.current_A = 0.5;
        drive_step(p, e, s, 0.1, 1e-3);
    }
    const double expected = 0.25 * 3.24 * 20 * (1 - std::exp(-1.0));
    EXPECT_NEAR(s.heat_K, expected, 2.5e-5 * expected); // explicit Euler: dt/(2 tau) relative, in the exponential part
}

TEST(Drive, the_motor_crosses_its_play_freely_and_then_takes_the_wheel_along) {
    const DriveParameters p;
    const WheelEffects e{.play_rad = 0.06};
    DriveState s;
    s.motor_angle_rad = -0.03; // teeth touch on the backward side
    s.current_A = 0.4;
    int steps = 0;
    while (s.wheel_speed_rad_s == 0 && steps < 1000) drive_step(p, e, s, 0, 1e-3), ++steps;
    const double rotor = p.inertia_kg_m2 - p.wheel_inertia_kg_m2, torque = 0.265 * 0.4 - 0.03;
    const double crossing_s = std::sqrt(2 * 0.06 * rotor / torque);  // viscous friction adds b*t/(6 J) = 0.5 %
    EXPECT_NEAR(steps * 1e-3, crossing_s, 1e-3 + 0.01 * crossing_s); // and the answer comes in whole steps
    for (int i = 0; i < 1000; ++i) drive_step(p, e, s, 0, 1e-3);
    EXPECT_NEAR(s.wheel_speed_rad_s, s.motor_speed_rad_s, 0.01 * s.motor_speed_rad_s); // in mesh: ringing is damped out in 0.1 s
    EXPECT_LE(std::fabs(s.motor_angle_rad - s.wheel_angle_rad), 0.031);                // half the play and the teeth's 0.04 Nm / 40 Nm/rad
}

// ---------------------------------------------------------------- the plant obeys them

// Closed forms: load on one front wheel minus its static value, at acceleration a; on one wheel of the heavier side; slope's pull.
double transfer_N(double mass_kg, double accel_m_s2, double height_m, double wheelbase_m) {
    return -mass_kg * accel_m_s2 * height_m / (2 * wheelbase_m);
}
double offset_N(double mass_kg, double gravity_m_s2, double offset_m, double half_base_m) {
    return mass_kg * gravity_m_s2 * offset_m / (4 * half_base_m);
}

ActiveEffect with(std::string_view name, std::vector<double> values, int wheel = -1) {
    return {find_effect(name), wheel, std::move(values)};
}

PlantConfig on(const char *soil, std::vector<ActiveEffect> effects) {
    PlantConfig config;
    config.ground.soil = *find_soil(soil);
    config.effects = std::move(effects);
    return config;
}

void settle(Plant &plant, double time_s) {
    for (int i = 0; i < static_cast<int>(time_s * 1000); ++i) plant.step();
}

TEST(PlantEffects, an_offset_mass_loads_the_wheels_on_its_side) {
    Plant plant(on("concrete", {with("mass_offset_x", {0.025}), with("mass_offset_y", {-0.02})}));
    settle(plant, 2);
    const double weight = 2.88 * 9.81 / 4;
    // the halves pitch freely on their joint: each side splits its own share fore and aft, so the shares multiply
    const double fore = offset_N(2.88, 9.81, 0.025, 0.083) / weight, left = offset_N(2.88, 9.81, -0.02, 0.12) / weight;
    for (std::size_t i = 0; i < 4; ++i) {
        const double expected = weight * (1 + (i >= 2 ? fore : -fore)) * (1 + (i % 2 == 0 ? left : -left));
        // the springs let a half pitch by 5 N/6000 N/m over 0.166 m = 5 mrad: 1 - cos is 1.3e-5 of 11 N, for each of pitch, roll and joint
        EXPECT_NEAR(plant.truth().wheel[i].normal_N, expected, 4.5e-4) << i;
    }
}

TEST(PlantEffects, a_slope_pulls_by_its_law_and_a_high_centre_then_loads_the_lower_wheels) {
    PlantConfig config = on("concrete", {with("grade", {0.1, 0.2}), with("load_transfer", {0.08})});
    config.yaw_rad = 0.7;
    Plant plant(config);
    for (int i = 0; i < 4; ++i) plant.block_wheel(i, true);
    settle(plant, 4);
    double along = 0, front = 0, rear = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        along +=
            plant.truth().wheel[i].traction_N - plant.truth().wheel[i].rolling_share * plant.truth().wheel[i].rolling_N; // both hold it
        (i >= 2 ? front : rear) += plant.truth().wheel[i].normal_N / 2;
    }
    const double pull = 2.88 * law::grade_m_s2(9.81, 0.1, 0.7 - 0.2).along_m_s2;
    EXPECT_LT(pull, -2);             // uphill in front
    EXPECT_NEAR(along, -pull, 0.01); // N: yaw drifts by less than 3 mrad while the contact settles, 2.5 N * tan(0.5) * 3 mrad = 4 mN
    EXPECT_NEAR(plant.truth().specific_force_m_s2[0], -pull / 2.88,
                0.015); // the springs tilt it by 0.6 N/(6000 N/m * 83 mm): 1.2 mrad of g
    const double shift = transfer_N(2.88, -pull / 2.88, 0.08, 0.166);
    EXPECT_NEAR((front - rear) / 2, shift, 0.02 * std::fabs(shift)); // the springs' tilt of 1 mrad moves the centre: 1.4 % of the shift
}

// What pushes the body besides the wheels [N], while it drives straight on.
double push_N(Plant &plant) {
    const double mass = 2.88;
    double push = mass * plant.truth().specific_force_m_s2[0];
    for (const WheelTruth &wheel : plant.truth().wheel) push -= wheel.traction_N - wheel.rolling_N;
    return push;
}

TEST(PlantEffects, multi_pass_acts_on_the_wheels_that_follow_in_a_track_and_changes_ends_with_the_direction) {
    for (const double duty : {0.5, -0.5}) {
        Plant plant(on("sand", {with("multi_pass", {0.3})}));
        for (int i = 0; i < 4; ++i) plant.set_duty(i, duty);
        settle(plant, 3);
        for (std::size_t i = 0; i < 4; ++i) { // (20): Ft = Fm f(s), Fm of the sand's own numbers but for the effect
            const Soil &sand = *find_soil("sand");
            const WheelTruth &w = plant.truth().wheel[i];
            const double plain =
                (sand.adhesion_N + sand.fm_per_fn * w.normal_N) * traction_share(sand.law, std::fabs(w.slip), sand.shear_slip);
            const bool follows = (i < 2) == (duty > 0); // rear wheels when it drives ahead
            EXPECT_NEAR(std::fabs(w.traction_N) / plain, follows ? 1.3 : 1.0, 1e-6) << i << " at duty " << duty;
        }
    }
}

TEST(PlantEffects, tether_and_drag_pull_by_their_laws) {
    for (const bool tether : {true, false}) {
        Plant plant(on("gravel", {tether ? with("tether_drag", {0.6}) : with("body_drag", {1.2})}));
        for (int i = 0; i < 4; ++i) plant.set_duty(i, 0.4);
        settle(plant, 5);
        const Truth &truth = plant.truth();
        ASSERT_GT(truth.position_m[0], 0.5);
        const double expected = tether ? law::tether_drag_N(0.6, truth.position_m[0]) : law::body_drag_N(1.2, 1);
        EXPECT_NEAR(push_N(plant), expected, 1e-3); // the tether is taken at the step's start: 0.6 N/m of half a millimetre
    }
}

TEST(PlantEffects, a_patch_is_met_by_each_wheel_where_it_stands) {
    // pull over load and over (20) at the wheel's slip: the strength of the soil under it
    Plant plant(on("sand", {with("soil_patch", {-0.5, 0.3, 10})}));
    for (int i = 0; i < 4; ++i) plant.set_duty(i, 0.5);
    while (plant.truth().path_m < 0.3 && plant.truth().t_s < 20) plant.step(); // front wheels 83 mm inside, rear wheels 83 mm before
    const auto &wheel = plant.truth().wheel;
    const auto share = [&](std::size_t i) {
        return wheel[i].traction_N / (wheel[i].normal_N * traction_share(TractionLaw::janosi, std::fabs(wheel[i].slip), 0.27));
    };
    const double sand = 5.1 / 7;              // table III
    EXPECT_NEAR(share(0), sand, 0.02 * sand); // damping of the contact fades out above 0.2 m/s, below it adds at most 2 %
    EXPECT_NEAR(share(2), 0.5 * sand, 0.02 * sand);
}

// A drive with starts, stops, turns, reversals and rests, 20 s.
constexpr double drive_s = 20;
void command(Plant &plant, double t_s) {
    static constexpr double left[] = {0.15, 0.6, -0.6, 0.8, 0.5, -0.3, 0.0, 0.9, 0.6, 0.2},
                            right[] = {0.15, 0.6, -0.6, 0.8, -0.5, 0.3, 0.0, 0.9, 0.3, 0.2};
    const auto part = static_cast<std::size_t>(std::fmin(t_s / 2, 9));
    for (int i = 0; i < 4; ++i) plant.set_duty(i, i % 2 == 0 ? left[part] : right[part]);
}

std::vector<Truth> drive(const std::vector<ActiveEffect> &effects) {
    Plant plant(on("gravel", effects));
    std::vector<Truth> track;
    for (int i = 0; i < static_cast<int>(drive_s * 1000); ++i) {
        if (i % 10 == 0) command(plant, plant.truth().t_s), track.push_back(plant.truth());
        plant.step();
    }
    return track;
}

// Largest difference in units of one sensor value's noise: current 10 mA, camera 1 mm, gyro 5 mrad/s, accelerometer 20 mm/s^2.
double seen(const std::vector<Truth> &a, const std::vector<Truth> &b) {
    double most = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        for (std::size_t i = 0; i < 4; ++i) most = std::fmax(most, std::fabs(a[k].wheel[i].current_A - b[k].wheel[i].current_A) / 0.01);
        most = std::fmax(most, std::fabs(a[k].position_m[0] - b[k].position_m[0]) / 0.001);
        most = std::fmax(most, std::fabs(a[k].rate_body_rad_s[2] - b[k].rate_body_rad_s[2]) / 0.005);
        most = std::fmax(most, std::fabs(a[k].specific_force_m_s2[0] - b[k].specific_force_m_s2[0]) / 0.02);
    }
    return most;
}

std::vector<double> usual(const Effect &effect) {
    std::vector<double> values;
    for (const EffectParameter &p : effect.parameters) values.push_back(p.typical);
    return values;
}

// Sensors and the HAL apply the others. Absence at zero: plant_effects_test.
bool acts_in_the_plant(const Effect &effect) { return effect.acts_on != ActsOn::sensor && effect.name != "actuation_delay"; }

TEST(PlantEffects, each_is_seen_by_some_sensor_at_its_usual_size_and_one_wheel_is_not_all) {
    const std::vector<Truth> plain = drive({});
    for (const Effect &effect : catalogue()) {
        if (!acts_in_the_plant(effect)) continue;
        const std::vector<Truth> all = drive({{&effect, -1, usual(effect)}});
        EXPECT_GT(seen(plain, all), 3) << effect.name; // three standard deviations of one value
        if (!effect.per_wheel) continue;
        const std::vector<Truth> one = drive({{&effect, 1, usual(effect)}});
        EXPECT_GT(seen(plain, one), 3) << effect.name;
        EXPECT_GT(seen(all, one), 3) << effect.name;
    }
}

} // namespace
