// Wheel-soil laws against closed forms, the paper's numbers, and an independent quadrature of the contact arc.
#include "sim/physics/effects/catalogue.h"
#include "sim/physics/effects/laws.h"
#include "sim/physics/ground.h"
#include "sim/physics/terramechanics.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <set>

using namespace traction::sim;

namespace {

constexpr double radius_m = 0.057, width_m = 0.042; // table I

TEST(traction_share, is_20_and_21_of_the_paper) {
    for (double sc : {0.05, 0.088, 0.27, 0.5})
        for (double s = 0.001; s <= 1; s += 0.007) {
            // the quotient of (20) loses about sc/s units of 1e-16; the series below q = 1e-3 drops q^3/24 < 5e-11
            EXPECT_NEAR(traction_share(TractionLaw::janosi, s, sc), 1 - sc / s * (1 - std::exp(-s / sc)), 1e-10);
            EXPECT_NEAR(traction_share(TractionLaw::burckhardt, s, sc), 1 - std::exp(-s / sc), 1e-15);
        }
}

TEST(literature_sand, has_the_Fm_and_sc_of_figure_15) {
    const Soil *sand = find_soil("dry_sand_literature");
    ASSERT_NE(sand, nullptr);
    // (5) with l = 4 cm, Fn = 7 N: 0.04*0.042*1040 + 7*tan(28 deg) = 5.469; the paper prints two decimals
    EXPECT_NEAR(sand->adhesion_N + 7 * sand->fm_per_fn, 5.47, 0.005);
    EXPECT_NEAR(sand->shear_slip, 0.5, 1e-12);
}

TEST(paper_grounds, carry_table_III_and_equation_21) {
    EXPECT_NEAR(7 * find_soil("sand")->fm_per_fn, 5.1, 1e-12);
    EXPECT_NEAR(find_soil("sand")->shear_slip, 0.27, 1e-12);
    EXPECT_NEAR(7 * find_soil("gravel")->fm_per_fn, 6.8, 1e-12);
    EXPECT_NEAR(find_soil("gravel")->shear_slip, 0.088, 1e-12);
    EXPECT_NEAR(7 * find_soil("concrete")->fm_per_fn, 5.6, 1e-12);
    for (const Soil &soil : soil_library()) EXPECT_FALSE(soil.source.empty()) << soil.name;
}

// Equations (3), (4) of the header written again, with the library's functions.
TEST(bekker_force, is_the_closed_form) {
    for (const Soil &soil : soil_library()) {
        if (!soil.bekker) continue;
        const Bekker &b = *soil.bekker;
        const SoilConstants constants = soil_constants(b, width_m);
        for (double z : {0.001, 0.005, 0.012})
            for (double s : {-0.6, 0.0, 0.3, 0.9}) {
                const SoilForce f = bekker_force(b, constants, {radius_m, width_m, 0.01}, {z, s, 0});
                const double n = b.n * (1 + b.slip_sinkage * std::fabs(s)), l = std::sqrt(2 * radius_m * z - z * z);
                const double k = b.kc / std::min(l, width_m) + b.kphi;
                const double normal = width_m * k * std::sqrt(2 * radius_m * z) * std::pow(z, n) * (3 - std::min(n, 1.3)) / 3;
                EXPECT_NEAR(f.normal_N / normal, 1, 1e-12) << soil.name;
                const double Fm = l * width_m * b.c_Pa + normal * std::tan(b.phi_rad), sc = b.K_m / l;
                const double Ft = s == 0 ? 0 : std::copysign(Fm * (1 - sc / std::fabs(s) * (1 - std::exp(-std::fabs(s) / sc))), s);
                EXPECT_NEAR(f.traction_N, Ft, 1e-9 * Fm) << soil.name;
                const double Rc = width_m * std::pow(z, n + 1) / (n + 1) * k; // (4)
                const double Kp = std::pow(std::tan(std::numbers::pi / 4 + b.phi_rad / 2), 2);
                EXPECT_NEAR(f.resistance_N, Rc + 0.5 * width_m * b.weight_N_m3 * z * z * Kp + 0.01 * normal, 1e-9 * (Rc + normal));
            }
    }
}

struct Integral {
    double normal = 0, pull = 0, push = 0, torque = 0;
};

// Wong and Reece by brute force: 20000 nodes, library functions, stress by the angle itself.
Integral brute_force(const Bekker &b, double z, double s) {
    Integral sum;
    const int nodes = 20000;
    const double entry = std::acos(1 - z / radius_m), summit = (b.c1 + b.c2 * std::fabs(s)) * entry;
    const double n = b.n * (1 + b.slip_sinkage * std::fabs(s));
    const double k = b.kc / std::min(radius_m * std::sin(entry), width_m) + b.kphi;
    const double ratio = s >= 0 ? 1 - s : 1 / (1 + s), h = entry / nodes;
    for (int i = 0; i < nodes; ++i) {
        const double t = (i + 0.5) * h;
        const double seen = t > summit ? t : entry - t / summit * (entry - summit);
        const double sigma = k * std::pow(radius_m * (std::cos(seen) - std::cos(entry)), n);
        const double j = radius_m * ((entry - t) - ratio * (std::sin(entry) - std::sin(t)));
        const double tau = (b.c_Pa + sigma * std::tan(b.phi_rad)) * (1 - std::exp(-std::fabs(j) / b.K_m)) * (j < 0 ? -1 : 1);
        const double area = radius_m * width_m * h;
        sum.normal += area * (sigma * std::cos(t) + tau * std::sin(t));
        sum.pull += area * tau * std::cos(t);
        sum.push += area * sigma * std::sin(t);
        sum.torque += radius_m * area * tau;
    }
    return sum;
}

TEST(arc_force, agrees_with_a_fine_quadrature) {
    for (const Soil &soil : soil_library()) {
        if (!soil.bekker) continue;
        const SoilConstants constants = soil_constants(*soil.bekker, width_m);
        for (double z : {0.002, 0.008, 0.016})
            for (double s : {-0.4, 0.0, 0.1, 0.4, 0.8}) {
                const SoilForce f = arc_force(*soil.bekker, constants, {radius_m, width_m, 0}, {z, s, 0});
                const Integral fine = brute_force(*soil.bekker, z, s);
                const double bulldozing = 0.5 * width_m * soil.bekker->weight_N_m3 * z * z * constants.passive;
                // midpoint rule on 16 nodes; the kink at the summit costs (1/16)^2 of the stress there: below 1 % of the load
                const double bound = 0.01 * fine.normal;
                EXPECT_NEAR(f.normal_N, fine.normal, bound) << soil.name << " z " << z << " s " << s;
                EXPECT_NEAR(f.traction_N, fine.pull, bound) << soil.name << " z " << z << " s " << s;
                EXPECT_NEAR(f.resistance_N - bulldozing, fine.push, bound) << soil.name << " z " << z << " s " << s;
                EXPECT_NEAR(f.torque_Nm, fine.torque, bound * radius_m) << soil.name << " z " << z << " s " << s;
            }
    }
}

// 2, 4 or 8 nodes at once: every bit of every result.
TEST(arc_force, gives_the_same_bits_in_vectors_of_any_width) {
    EXPECT_TRUE(has(Vectors::narrow));
    std::size_t compared = 0;
    for (const char *name : {"sand", "gravel", "dry_sand_literature", "loam", "snow", "lunar_simulant"}) {
        const Soil &soil = *find_soil(name);
        const SoilConstants constants = soil_constants(*soil.bekker, width_m);
        for (const double z : {1e-4, 3e-3, 0.011, 0.027, 0.049})
            for (const double s : {-1.0, -0.6, -0.07, 0.0, 0.02, 0.3, 0.9999})
                for (const double rut : {0.0, 0.004, 0.02}) {
                    const SoilWheel wheel{radius_m, width_m, 0.005, 0.9, 1.1};
                    const SoilForce narrow = arc_force_in(Vectors::narrow, *soil.bekker, constants, wheel, {z, s, rut});
                    for (const Vectors wide : {Vectors::avx2, Vectors::avx512}) {
                        if (!has(wide)) continue;
                        const SoilForce same = arc_force_in(wide, *soil.bekker, constants, wheel, {z, s, rut});
                        EXPECT_EQ(std::memcmp(&same, &narrow, sizeof narrow), 0) << name << ' ' << z << ' ' << s << ' ' << rut;
                        ++compared;
                    }
                }
    }
    if (compared == 0) GTEST_SKIP() << "this processor has no wider vectors";
}

TEST(slip_sinkage, a_slipping_wheel_sinks_deeper_under_the_same_load) {
    for (const char *name : {"sand", "dry_sand_literature", "lunar_simulant"})
        for (const SoilLawFunction law : {bekker_force, arc_force}) {
            const Bekker &soil = *find_soil(name)->bekker;
            const SoilWheel wheel{radius_m, width_m, 0};
            EXPECT_GT(sinkage_under(law, soil, wheel, 7, 0.6), 1.05 * sinkage_under(law, soil, wheel, 7, 0)) << name;
        }
}

TEST(ruts, a_second_pass_sinks_little_further_and_costs_less) {
    for (const char *name : {"sand", "dry_sand_literature", "loam"})
        for (const SoilLawFunction law : {bekker_force, arc_force}) {
            const Bekker &soil = *find_soil(name)->bekker;
            const SoilWheel wheel{radius_m, width_m, 0};
            const SoilConstants constants = soil_constants(soil, width_m);
            const double first = sinkage_under(law, soil, wheel, 7, 0.1), second = sinkage_under(law, soil, wheel, 7, 0.1, first);
            EXPECT_GT(second, rut_surface_m(soil, constants, first)) << name;
            EXPECT_LT(second - first, 0.5 * first) << name; // a pass adds less than half of what the one before did (Holm 1969: it fades)
            const double fresh = law(soil, constants, wheel, {first, 0.1, 0}).resistance_N;
            EXPECT_LT(law(soil, constants, wheel, {second, 0.1, first}).resistance_N, 0.9 * fresh) << name;
        }
}

TEST(ruts, the_load_is_continuous_where_old_soil_ends) {
    const Bekker &soil = *find_soil("sand")->bekker;
    const SoilConstants constants = soil_constants(soil, width_m);
    const double rut = 0.008, d = 1e-9;
    for (const SoilLawFunction law : {bekker_force, arc_force}) {
        const double below = law(soil, constants, {radius_m, width_m, 0}, {rut - d, 0.1, rut}).normal_N;
        const double above = law(soil, constants, {radius_m, width_m, 0}, {rut + d, 0.1, rut}).normal_N;
        EXPECT_NEAR(above, below, 1e-4); // stiffness below 1e4 N/m times 2e-9 m, with room
        EXPECT_EQ(law(soil, constants, {radius_m, width_m, 0}, {rut_surface_m(soil, constants, rut), 0.1, rut}).normal_N, 0);
    }
}

TEST(catalogue, holds_every_effect_of_the_contract_once_with_sane_ranges) {
    const char *expected[] = {"coulomb_friction",
                              "viscous_friction",
                              "stribeck_friction",
                              "wear_in",
                              "reverse_friction",
                              "churning_friction",
                              "gear_speed_loss",
                              "mesh_loss",
                              "backlash",
                              "torque_ripple",
                              "winding_heating",
                              "wiring_resistance",
                              "shared_lead",
                              "bridge_dead_time",
                              "torque_constant",
                              "rolling_resistance",
                              "slip_sinkage",
                              "speed_resistance",
                              "squared_resistance",
                              "resistance_patch",
                              "shear_peak",
                              "multi_pass",
                              "soil_patch",
                              "soil_gradient",
                              "relaxation_length",
                              "sliding_speed_loss",
                              "shear_stiffness",
                              "wheel_radius",
                              "lateral_scrub",
                              "load_transfer",
                              "mass_offset_x",
                              "mass_offset_y",
                              "grade",
                              "tether_drag",
                              "body_drag",
                              "fluid_drag",
                              "accel_bias",
                              "accel_drift",
                              "accel_scale",
                              "accel_tilt",
                              "accel_delay",
                              "accel_lag",
                              "accel_place",
                              "gyro_scale",
                              "gyro_delay",
                              "radar_delay",
                              "radar_scale",
                              "radar_pitch",
                              "current_gain",
                              "current_offset",
                              "current_delay",
                              "voltage_gain",
                              "encoder_missed",
                              "camera_delay",
                              "camera_scale",
                              "actuation_delay"};
    std::set<std::string_view> names;
    for (const Effect &effect : catalogue()) {
        EXPECT_TRUE(names.insert(effect.name).second) << effect.name;
        for (const std::string_view text : {effect.title, effect.equation, effect.source, effect.signature, effect.reveals})
            EXPECT_FALSE(text.empty()) << effect.name;
        bool strong = false;
        for (const EffectParameter &p : effect.parameters) {
            EXPECT_LT(p.minimum, p.maximum) << effect.name;
            EXPECT_TRUE(p.typical >= p.minimum && p.typical <= p.maximum) << effect.name << "." << p.name;
            if (!p.strength) continue;
            strong = true;
            EXPECT_LE(p.minimum, 0) << effect.name; // zero means absent, so it must be in range
            EXPECT_TRUE(p.of_interest > 0 && p.of_interest <= std::fabs(p.typical)) << effect.name << "." << p.name;
        }
        EXPECT_TRUE(strong) << effect.name;
    }
    for (const char *name : expected) EXPECT_NE(find_effect(name), nullptr) << name;
    EXPECT_EQ(names.size(), std::size(expected));
}

TEST(backlash_law, pushes_only_outside_the_play) {
    EXPECT_EQ(law::backlash_Nm(0.02, 40, 0.05, 0.0099, 5), 0);
    EXPECT_NEAR(law::backlash_Nm(0.02, 40, 0, 0.015, 0), 40 * 0.005, 1e-15);
    EXPECT_NEAR(law::backlash_Nm(0.02, 40, 0, -0.015, 0), -40 * 0.005, 1e-15);
    EXPECT_EQ(law::backlash_Nm(0.02, 40, 0.05, 0.0101, -5), 0) << "teeth never pull";
}

} // namespace
