// Four wheels side by side (sim/plant/abreast.h) against the same wheels one after another: every bit.
#include "sim/plant/abreast.h"

#include "sim/physics/effects/catalogue.h"
#include "sim/plant/plant.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <string>

namespace traction::sim {
namespace {

// The audit needs what only the way wheel by wheel keeps; without it a plain rover goes side by side.
struct Pair {
    explicit Pair(PlantConfig config) : apart(config), abreast((config.audit = false, config)) {}
    template <typename Do> void both(const Do &what) { what(apart), what(abreast); }
    Plant apart, abreast;
};

void expect_same_truth(const Truth &a, const Truth &b) {
    for (std::size_t i = 0; i < wheel_count; ++i) {
        const WheelTruth &x = a.wheel[i], &y = b.wheel[i];
        for (const double WheelTruth::*field :
             {&WheelTruth::angle_rad, &WheelTruth::speed_rad_s, &WheelTruth::motor_angle_rad, &WheelTruth::motor_speed_rad_s,
              &WheelTruth::current_A, &WheelTruth::duty, &WheelTruth::traction_N, &WheelTruth::rolling_N, &WheelTruth::rolling_share,
              &WheelTruth::lateral_N, &WheelTruth::steer_rad, &WheelTruth::normal_N, &WheelTruth::slip, &WheelTruth::sinkage_m,
              &WheelTruth::ground_speed_m_s, &WheelTruth::winding_temperature_C})
            ASSERT_EQ(std::bit_cast<std::uint64_t>(x.*field), std::bit_cast<std::uint64_t>(y.*field)) << "wheel " << i;
    }
    ASSERT_EQ(a.position_m, b.position_m);
    ASSERT_EQ(a.specific_force_m_s2, b.specific_force_m_s2);
    ASSERT_EQ(a.battery_voltage_V, b.battery_voltage_V);
}

// Forward, round a bend, standing, backward, released: every branch of the laws, at rest and sliding.
void drive_both(Pair &pair) {
    const std::array<std::array<double, 2>, 7> plan{{{0.5, 0.5}, {0.7, 0.2}, {0, 0}, {-0.5, -0.5}, {1, -1}, {0.1, 0.1}, {0.02, 0}}};
    for (std::size_t n = 0; n < plan.size(); ++n) {
        pair.both([&](Plant &plant) {
            for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, plan[n][static_cast<std::size_t>(i % 2)]);
            plant.set_enabled(n != 5);
            plant.sag_supply(n == 3 ? 1 : 0);
        });
        for (int k = 0; k < 250; ++k) {
            pair.both([](Plant &plant) { plant.step(); });
            if (k % 17 == 0) expect_same_truth(pair.apart.truth(), pair.abreast.truth());
            if (testing::Test::HasFatalFailure()) return;
        }
    }
    EXPECT_EQ(pair.apart.state_hash(), pair.abreast.state_hash());
}

ActiveEffect effect(const char *id, double strength, int wheel = -1) {
    const Effect *found = find_effect(id);
    EXPECT_NE(found, nullptr) << id;
    ActiveEffect active{.effect = found, .wheel = wheel, .values = {}};
    for (const EffectParameter &p : found->parameters) active.values.push_back(p.typical);
    active.values[0] = strength;
    return active;
}

PlantConfig on(const Soil &soil, ContactLaw contact) {
    PlantConfig config;
    config.ground.soil = soil;
    config.ground.contact = contact;
    config.ground.grip_noise = 0.06;
    config.ground.seed = 7;
    return config;
}

TEST(abreast, every_soil_and_law_gives_the_bits_of_wheel_by_wheel) {
    for (const Soil &soil : soil_library())
        for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
            SCOPED_TRACE(soil.name + ' ' + std::to_string(static_cast<int>(contact)));
            Pair pair(on(soil, contact));
            drive_both(pair);
            EXPECT_EQ(pair.abreast.energy().motor, 0); // it went side by side: nobody counted
            EXPECT_NE(pair.apart.energy().motor, 0);
        }
}

TEST(abreast, every_effect_of_the_catalogue_gives_the_bits_of_wheel_by_wheel) {
    int together = 0;
    for (const Effect &one : catalogue()) {
        SCOPED_TRACE(one.name);
        PlantConfig config = on(*find_soil("sand"), ContactLaw::bekker);
        config.rover.centre_height_m = 0.05; // the spin-up nods
        ActiveEffect active{.effect = &one, .wheel = -1, .values = {}};
        for (const EffectParameter &p : one.parameters) active.values.push_back(p.typical);
        config.effects = {active};
        Pair pair(config);
        drive_both(pair);
        together += pair.abreast.energy().motor == 0 ? 1 : 0;
    }
    EXPECT_GT(together, 20); // most of them
}

TEST(abreast, wheels_that_differ_and_a_slope_give_the_bits_of_wheel_by_wheel) {
    for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker}) {
        PlantConfig config = on(*find_soil("gravel"), contact);
        config.ground.slope_rad = 0.08, config.ground.slope_direction_rad = 0.5;
        config.rover.centre_height_m = 0.06;
        for (int i = 0; i < wheel_count; ++i)
            for (const char *id : {"coulomb_friction", "wheel_radius", "rolling_resistance", "winding_heating", "bridge_dead_time"})
                if (find_effect(id) != nullptr) config.effects.push_back(effect(id, 0.01 * (i + 1), i));
        ASSERT_GE(config.effects.size(), 8u);
        Pair pair(config);
        drive_both(pair);
        EXPECT_EQ(pair.abreast.energy().motor, 0);
    }
}

TEST(abreast, a_held_wheel_and_a_broken_wire_in_between_change_no_bit) {
    for (const ContactLaw contact : {ContactLaw::aggregated, ContactLaw::bekker, ContactLaw::arc}) {
        Pair pair(on(*find_soil("sand"), contact));
        for (int k = 0; k < 1200; ++k) {
            pair.both([k](Plant &plant) {
                if (k % 300 == 0)
                    for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, k < 600 ? 0.6 : -0.4);
                plant.block_wheel(1, k >= 200 && k < 330);
                plant.open_motor(2, k >= 500 && k < 640);
                plant.step();
            });
            ASSERT_EQ(pair.apart.state_hash(), pair.abreast.state_hash()) << k; // asked for after every step
        }
        expect_same_truth(pair.apart.truth(), pair.abreast.truth());
    }
}

// Asking what the body does leaves out of the wheels what no sensor reads between ticks, and nothing else.
TEST(abreast, the_truth_of_the_body_is_the_truth) {
    PlantConfig config = on(*find_soil("sand"), ContactLaw::bekker);
    config.audit = false;
    Plant asked(config), other(config);
    for (int k = 0; k < 400; ++k) {
        for (Plant *plant : {&asked, &other}) {
            plant->set_duty(0, 0.5), plant->set_duty(1, 0.4), plant->set_duty(2, 0.5), plant->set_duty(3, 0.4);
            plant->step();
        }
        const Truth quick = other.truth_of_body(), &whole = asked.truth();
        ASSERT_EQ(quick.position_m, whole.position_m);
        ASSERT_EQ(quick.path_m, whole.path_m);
        for (std::size_t i = 0; i < wheel_count; ++i) ASSERT_EQ(quick.wheel[i].current_A, whole.wheel[i].current_A);
    }
    expect_same_truth(asked.truth(), other.truth());
}

// However many wheels go at once: states and motions from at rest to far outside what a drive reaches.
TEST(abreast, every_width_of_vectors_gives_the_same_bits) {
    if (!has(Vectors::avx2)) GTEST_SKIP() << "this processor has one width alone";
    std::mt19937_64 random(20261125);
    const auto draw = [&random](Four &four, double low, double high) {
        for (std::size_t i = 0; i < 4; ++i) {
            four[i] = low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
            if (random() % 16 == 0) four[i] = 0;
        }
    };
    int different = 0;
    for (int n = 0; n < 20000; ++n) {
        FourKnown known;
        known.law = n % 2 == 0 ? TractionLaw::janosi : TractionLaw::burckhardt;
        known.adhesion_N = n % 3, known.fm_per_fn = 0.8, known.shear_slip = 0.1, known.lateral_coefficient = 0.7,
        known.rolling_coefficient = 0.03;
        known.stiffness_N_m = 6000, known.damping_Ns_m = 60, known.relaxation_m = 0.005, known.load_kg = 0.7, known.wheel_mass_kg = 0.15;
        known.dt_s = 0.001, known.grip_noise = n % 5 == 0 ? 0 : 0.06, known.grip_length_m = 0.2, known.soil_radius_m = 0.057;
        known.body.scrub = 0.1, known.body.slip_sinkage = 0.2, known.nods = true;
        FourCarriers on;
        FourWheels wide;
        const double fast = n % 4 == 0 ? 0.004 : 2;
        for (Four &one : known.bottom_m) draw(one, -0.2, 0.2);
        draw(known.radius_m, 0.05, 0.06);
        draw(known.wheel.coulomb_Nm, 0, 0.02), draw(known.wheel.mesh_fraction, 0, 0.2), draw(known.wheel.heating_K_W, 0, 9);
        draw(known.wheel.dead_voltage_V, 0, 0.3), draw(known.wheel.rolling, 0, 0.1);
        for (Four &one : on.turn) draw(one, -1, 1);
        for (Four &one : on.at_m) draw(one, -0.1, 0.1);
        for (Four &one : on.velocity_m_s) draw(one, -fast, fast);
        for (Four &one : on.spin_rad_s) draw(one, -fast, fast);
        for (Four &one : on.heading) draw(one, -1, 1);
        draw(wide.slip, -3, 3), draw(wide.side_slip, -2, 2), draw(wide.speed_m_s, 0, fast), draw(wide.rolling, -1, 1);
        draw(wide.angle_rad, -9, 9), draw(wide.speed_rad_s, -20 * fast, 20 * fast), draw(wide.current_A, -2, 2), draw(wide.heat_K, 0, 60);
        for (Four &one : wide.corner) draw(one, -1, 1);
        FourOrders orders{.duty = {}, .supply_V = 7.2, .enabled = n % 7 != 0};
        draw(orders.duty, -1, 1);
        FourGiven given;
        const auto draw_soil = [&draw](double(&four)[4], double low, double high) {
            Four drawn;
            draw(drawn, low, high);
            std::copy_n(drawn.of.data(), 4, four);
        };
        FourSoilForces &soil = given.soil;
        draw_soil(soil.normal_N, -1, 9), draw_soil(soil.largest_N, 0, 6), draw_soil(soil.shear_slip, 0.05, 0.5);
        draw_soil(soil.traction_N, -6, 6), draw_soil(soil.torque_Nm, -0.3, 0.3), draw_soil(soil.resistance_N, 0, 2);
        draw(given.free_N, 0, 2), draw(given.free_Nm, 0, 0.1);
        std::array<double, 12> turns[2];
        std::array<double, 3> moves[2][3];
        std::array<double, 2> headings[2];
        for (std::size_t side = 0; side < 2; ++side) { // the left half is wheel 0's, the right one wheel 1's
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t c = 0; c < 3; ++c) turns[side][4 * k + c] = on.turn[3 * k + c][side];
                moves[side][0][k] = on.at_m[k][side], moves[side][1][k] = on.velocity_m_s[k][side],
                moves[side][2][k] = on.spin_rad_s[k][side];
            }
            for (std::size_t k = 0; k < 2; ++k) headings[side][k] = on.heading[k][side];
        }
        const auto half = [&](std::size_t side) -> HalfNow {
            return {turns[side].data(), moves[side][0].data(), moves[side][1].data(), moves[side][2].data(), headings[side].data()};
        };
        for (const Vectors vectors : {Vectors::narrow, Vectors::avx2}) {
            FourCarriers ridden;
            four_steps_in(vectors).ride(half(0), half(1), ridden);
            for (std::size_t i = 0; i < 4; ++i) {
                for (std::size_t k = 0; k < 9; ++k) ASSERT_EQ(ridden.turn[k][i], on.turn[k][i % 2]);
                for (std::size_t k = 0; k < 3; ++k)
                    ASSERT_TRUE(ridden.at_m[k][i] == on.at_m[k][i % 2] && ridden.velocity_m_s[k][i] == on.velocity_m_s[k][i % 2] &&
                                ridden.spin_rad_s[k][i] == on.spin_rad_s[k][i % 2]);
                for (std::size_t k = 0; k < 2; ++k) ASSERT_EQ(ridden.heading[k][i], on.heading[k][i % 2]);
            }
        }
        FourWheels narrow = wide;
        for (FourWheels *w : {&wide, &narrow}) {
            const FourSteps &steps = four_steps_in(w == &wide ? Vectors::avx2 : Vectors::narrow);
            steps.stand(known, on, *w);
            if (n % 2 == 0) {
                steps.firm(known, on, orders, *w);
            } else {
                steps.slide(known, *w);
                steps.soft(known, on, orders, given, *w);
            }
        }
        static_assert(sizeof(FourWheels) % sizeof(std::uint64_t) == 0);
        constexpr std::size_t count = sizeof(FourWheels) / sizeof(std::uint64_t);
        const auto a = std::bit_cast<std::array<std::uint64_t, count>>(wide), b = std::bit_cast<std::array<std::uint64_t, count>>(narrow);
        different += a == b ? 0 : 1;
    }
    EXPECT_EQ(different, 0);
}

TEST(abreast, four_soil_forces_are_those_of_one_wheel_at_any_width) {
    std::mt19937_64 random(20261126);
    const auto draw = [&random](double low, double high) { return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53; };
    for (const Soil &soil : soil_library()) {
        if (!soil.bekker) continue;
        SoilWheel wheel{0.057, 0.042, 0.005, 1, 1.2};
        const SoilConstants constants = soil_constants(*soil.bekker, wheel.width_m);
        for (int n = 0; n < 5000; ++n) {
            double strength[4], slip[4], sinkage_m[4], rut_m[4];
            for (std::size_t i = 0; i < 4; ++i) {
                strength[i] = draw(0.05, 1.5), slip[i] = draw(-1, 1);
                sinkage_m[i] = n % 3 == 0 ? 0 : draw(-0.001, n % 5 == 0 ? 0.08 : 0.02);
                rut_m[i] = random() % 2 == 0 ? 0 : draw(0, 0.02);
            }
            for (const Vectors vectors : {Vectors::narrow, Vectors::avx2}) {
                if (!has(vectors)) continue;
                FourSoilForces out;
                bekker_forces_in(vectors, *soil.bekker, constants, wheel, {strength, sinkage_m, slip, rut_m}, out);
                for (std::size_t i = 0; i < 4; ++i) {
                    wheel.strength = strength[i];
                    const SoilForce one = bekker_force(*soil.bekker, constants, wheel, {sinkage_m[i], slip[i], rut_m[i]});
                    const auto same = [](double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); };
                    ASSERT_TRUE(same(one.normal_N, out.normal_N[i]) && same(one.largest_N, out.largest_N[i]) &&
                                same(one.shear_slip, out.shear_slip[i]) && same(one.traction_N, out.traction_N[i]) &&
                                same(one.resistance_N, out.resistance_N[i]) && same(one.torque_Nm, out.torque_Nm[i]))
                        << soil.name << ' ' << n << ' ' << i;
                }
            }
        }
    }
}

} // namespace
} // namespace traction::sim
