// What is tried and how (candidate.h), on machines and motions made by hand.
#include "host_tools/lab/decision/candidate.h"
#include "host_tools/lab/decision/knots.h"
#include "sim/physics/effects/catalogue.h"
#include "tests/lab/linear_machine.h"

#include <cstdio>
#include <gtest/gtest.h>
#include <tuple>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

namespace traction::lab {
namespace {

using namespace hand_made;

// The rover of table I, times as given, on two wheels.
struct Machine {
    Model model = parse_model("[rover]\nmass_kg = 2.88\nbattery_voltage_V = 7.2\n[wheels]\nradius_m = 0.057\n[motor]\n"
                              "torque_constant_Nm_A = 0.265\nresistance_ohm = 3.24\n"
                              "[[wheel]]\nx_m = 0.083\ny_m = 0.12\n[[wheel]]\nx_m = 0.083\ny_m = -0.12\n",
                              "table_1");
    Dataset data;
    Motion motion;
    Machine() { data.wheel.resize(2); }
    Candidate first(const std::string &effect, int wheel = -1) const {
        for (const Candidate &c : catalogue_candidates(model, data, motion))
            if (c.effect == effect && c.wheel == wheel) return c;
        return {};
    }
    bool has(const std::string &effect) const { return !first(effect).effect.empty(); }
    void times(const char *key, double factor) {
        for (WheelSpec &w : model.wheel)
            for (Parameters *table : {&w.geometry, &w.motor})
                if (const auto found = table->find(key); found != table->end()) found->second.value *= factor;
        if (const auto found = model.rover.find(key); found != model.rover.end()) found->second.value *= factor;
    }
};

const sim::EffectParameter &strength_of(const std::string &effect) {
    const std::vector<sim::EffectParameter> &all = sim::find_effect(effect)->parameters;
    return *std::find_if(all.begin(), all.end(), [](const sim::EffectParameter &p) { return p.strength; });
}

// Of each unit one effect of the catalogue, and by how much its sizes are larger than those of table I.
std::map<std::string, double> scales(const Machine &m) {
    std::map<std::string, double> out;
    for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion)) {
        const sim::EffectParameter &spec = strength_of(c.effect);
        out[std::string(spec.unit)] = c.of_interest[0] / spec.of_interest;
        EXPECT_NEAR(c.maximum[0], spec.maximum * out[std::string(spec.unit)], 1e-9 * c.maximum[0]) << c.label();
        EXPECT_NEAR(c.minimum[0], spec.minimum * out[std::string(spec.unit)], 1e-9 * c.maximum[0]) << c.label();
    }
    return out;
}

double of(const std::map<std::string, double> &all, const std::string &unit) { return all.count(unit) != 0 ? all.at(unit) : 1; }

TEST(Sizes, are_the_catalogues_for_the_rover_that_it_is_of) {
    for (const auto &[unit, factor] : scales(Machine())) EXPECT_EQ(factor, 1) << unit;
    Machine near; // within a third of it
    near.times("mass_kg", 1.45), near.times("resistance_ohm", 0.7);
    for (const auto &[unit, factor] : scales(near)) EXPECT_EQ(factor, 1) << unit;
    for (const double factor : {1.55, 2.5, 0.64, 0.4}) { // another one
        Machine other;
        other.times("mass_kg", factor);
        EXPECT_NEAR(of(scales(other), "N"), factor, 1e-9);
    }
}

// The speeds at which a friction is tried that falls with speed are those of a motor as fast as table I's; a faster one's lie higher.
TEST(Sizes, of_a_speed_go_with_the_top_speed) {
    const auto speeds = [](const Machine &m) {
        std::vector<double> out;
        for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion))
            if (c.effect == "stribeck_friction" && c.wheel < 0) out.push_back(c.variant.at(0).second);
        return out;
    };
    Machine m;
    EXPECT_EQ(speeds(m), (std::vector<double>{0.5, 1, 2, 4}));
    m.times("torque_constant_Nm_A", 0.1);
    const std::vector<double> faster = speeds(m);
    ASSERT_EQ(faster.size(), 4U);
    EXPECT_NEAR(faster.front(), 5, 1e-9);
    EXPECT_NEAR(faster.back(), 40, 1e-9);
}

// A motor that could pull ten times the machine: a friction matters by what the weight asks for, and its range is the motor's.
TEST(Sizes, of_interest_go_with_the_weight_where_the_motor_is_strong) {
    Machine m;
    m.times("resistance_ohm", 0.1), m.times("mass_kg", 2); // stall torque 10 times table I's, weight times radius 2 times
    for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion)) {
        const sim::EffectParameter &spec = strength_of(c.effect);
        if (spec.unit != "N m" && spec.unit != "N m s" && spec.unit != "N m s^2") continue;
        EXPECT_NEAR(c.of_interest[0] / spec.of_interest, 2, 1e-9) << c.label(); // as fast as table I's
        EXPECT_NEAR(c.maximum[0] / spec.maximum, 10, 1e-9) << c.label();
    }
    m.times("torque_constant_Nm_A", 2); // half as fast: damping matters twice as much, twice as much of it is by the motor 40 / 2
    for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion)) {
        const sim::EffectParameter &spec = strength_of(c.effect);
        if (spec.unit != "N m s") continue;
        EXPECT_NEAR(c.of_interest[0] / spec.of_interest, 4, 1e-9) << c.label();
    }
}

// By what a motor can: stall torque K U / R, damping K^2 / R, stall current U / R, speed U / K, and a rover's weight and half diagonal.
TEST(Sizes, go_with_the_machine) {
    Machine m;
    m.times("torque_constant_Nm_A", 2), m.times("resistance_ohm", 8), m.times("battery_voltage_V", 4), m.times("radius_m", 3);
    m.times("mass_kg", 5), m.times("x_m", 6), m.times("y_m", 6);
    const std::map<std::string, double> by = scales(m);
    EXPECT_NEAR(of(by, "N m"), 1, 1e-12); // 2 * 4 / 8
    EXPECT_NEAR(of(by, "N m s"), 4.0 / 8, 1e-9);
    EXPECT_NEAR(of(by, "A"), 4.0 / 8, 1e-9);
    EXPECT_NEAR(of(by, "K/W"), 8.0 / (4 * 4), 1e-9); // by stall power, U^2 / R
    EXPECT_NEAR(of(by, "ohm"), 8, 1e-9);
    EXPECT_NEAR(of(by, "V"), 4, 1e-9);
    EXPECT_NEAR(of(by, "N"), 5, 1e-9);
    EXPECT_NEAR(of(by, "m"), 6, 1e-9);
    const double faster = 4.0 / 2 * 3; // no-load speed times radius
    for (const auto &[unit, factor] :
         {std::pair{"s/m", 1 / faster}, std::pair{"s^2/m^2", 1 / (faster * faster)}, std::pair{"s/rad", 1.0 / 2},
          std::pair{"N m s^2", 8.0 / 8 / 4}, std::pair{"N s^2/m^2", 5 / (faster * faster)}, std::pair{"N/m", 5.0}})
        EXPECT_NEAR(by.count(unit) != 0 ? by.at(unit) : factor, factor, 1e-9) << unit;
    std::size_t known = 0; // of these seven the catalogue has most
    for (const char *unit : {"s/m", "s^2/m^2", "s/rad", "N m s^2", "N s^2/m^2", "N/m", "N m s"}) known += by.count(unit);
    EXPECT_GE(known, 5U);
    EXPECT_EQ(of(by, "1"), 1);
    EXPECT_EQ(of(by, "m/s^2"), 1);
    m.data.supply_V = {7.2, 7.2, 100}; // what the log says of the battery comes before what the sheet says: its median
    EXPECT_EQ(of(scales(m), "V"), 1);
    m.data.supply_V = {0, 0, 0};
    EXPECT_NEAR(of(scales(m), "V"), 4, 1e-9);
    m.data.supply_V.clear();
    m.model.motion = BodyMotion::imposed; // a bench: nothing drives
    EXPECT_EQ(of(scales(m), "A"), 1);
    EXPECT_NEAR(of(scales(m), "ohm"), 8, 1e-9);
    Machine heavy;
    heavy.times("mass_kg", 1e5); // a slip of the pen
    EXPECT_NEAR(of(scales(heavy), "N"), 1000, 1e-6);
}

TEST(Sizes, of_a_fit_reach_half_of_their_range_beyond_it_but_of_what_a_sheet_states) {
    const Machine m;
    for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion))
        for (std::size_t j = 0; j < c.strengths.size(); ++j) {
            const double span = c.maximum[j] - c.minimum[j],
                         slack = c.effect == "wheel_radius" || c.effect == "torque_constant" ? 0 : span / 2;
            const FreeParameter &p = c.strengths[j];
            EXPECT_NEAR(p.maximum, c.maximum[j] + slack, 1e-12 * span) << c.label();
            EXPECT_NEAR(p.minimum, c.minimum[j] < 0 ? c.minimum[j] - slack : 0, 1e-12 * span) << c.label(); // no drag that pushes
            EXPECT_EQ(c.bounded, slack == 0) << c.label();
            EXPECT_EQ(p.owner, c.effect);
            EXPECT_EQ(p.wheel, c.wheel);
            EXPECT_EQ(p.unit, strength_of(c.effect).unit);
            EXPECT_EQ(p.touched, c.touched);
            const bool remembers = find_handle(c.effect)->remembers; // integrated anew: a step that is seen beside its search
            EXPECT_NEAR(p.step, remembers ? std::max(1e-3 * span, 0.2 * c.of_interest[j]) : 1e-7 * span, 1e-15) << c.label();
            EXPECT_NEAR(c.step[j], remembers ? std::max(c.of_interest[j], 0.05 * c.maximum[j]) : 1e-6 * c.of_interest[j], 1e-15)
                << c.label();
            for (const Slot &slot : p.slots) {
                EXPECT_TRUE((slot.in_body != nullptr) != (slot.in_wheel != nullptr));
                EXPECT_TRUE(slot.in_wheel == nullptr || c.wheel < 0 || slot.wheel == c.wheel) << c.label();
            }
            EXPECT_EQ(p.slots.size(), p.slots[0].in_body != nullptr || c.wheel >= 0 ? 1U : 2U) << c.label();
        }
}

TEST(Wheels, are_asked_one_by_one_of_what_is_per_wheel_and_on_motors_where_the_motor_stands) {
    Machine m;
    const auto wheels = [&](const std::string &effect) {
        std::set<int> out;
        for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion))
            if (c.effect == effect) out.insert(c.wheel);
        return out;
    };
    EXPECT_EQ(wheels("coulomb_friction"), (std::set<int>{-1, 0, 1}));
    EXPECT_EQ(wheels("body_drag"), (std::set<int>{-1}));
    m.model.wheel[1].drive = 0; // one motor turns both
    EXPECT_EQ(wheels("coulomb_friction"), (std::set<int>{-1, 0}));
    EXPECT_EQ(wheels("rolling_resistance"), (std::set<int>{-1, 0, 1}));
    m.model.wheel.resize(1), m.model.wheel[0].drive = -1, m.data.wheel.resize(1);
    EXPECT_EQ(wheels("coulomb_friction"), (std::set<int>{-1})); // of one wheel all are that one
}

TEST(Variants, are_every_combination_of_shapes_with_either_sign_where_there_are_two) {
    const Machine m;
    std::vector<double> orders, speeds;
    for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion)) {
        if (c.wheel >= 0) continue;
        if (c.effect == "torque_ripple") orders.push_back(c.variant.at(0).second);
        if (c.effect == "stribeck_friction") speeds.push_back(c.variant.at(0).second);
    }
    const auto spec = [](const char *effect, const char *key) {
        for (const sim::EffectParameter &p : sim::find_effect(effect)->parameters)
            if (p.name == key) return p;
        return sim::EffectParameter();
    };
    std::vector<double> both = spec("torque_ripple", "order").variants;
    for (const double x : spec("torque_ripple", "order").variants) both.push_back(-x);
    EXPECT_EQ(orders, both);
    EXPECT_EQ(speeds, spec("stribeck_friction", "speed_rad_s").variants);
}

TEST(Variants, are_counted_by_shapes_times_wheels) {
    const Machine m;
    std::map<std::string, int> count;
    const std::vector<Candidate> all = catalogue_candidates(m.model, m.data, m.motion);
    for (const Candidate &c : all) ++count[c.effect];
    for (const Candidate &c : all) EXPECT_EQ(c.variants, count[c.effect]) << c.label();
    EXPECT_GT(count["torque_ripple"], 9); // three at least, on both wheels and on either
}

TEST(Variants, are_put_where_the_effect_stands_and_nowhere_else) {
    const Machine m;
    const auto prepared = [&](Candidate c) {
        Physics p = make_physics(m.model);
        c.prepare(p);
        return p;
    };
    Candidate c = m.first("stribeck_friction", 1);
    c.variant = {{"speed_rad_s", 7.5}};
    EXPECT_EQ(prepared(c).wheel[1].stribeck_speed_rad_s, 7.5);
    EXPECT_NE(prepared(c).wheel[0].stribeck_speed_rad_s, 7.5);
    c.wheel = -1;
    EXPECT_EQ(prepared(c).wheel[0].stribeck_speed_rad_s, 7.5);
    c.variant = {{"another", 7.5}};
    EXPECT_NE(prepared(c).wheel[0].stribeck_speed_rad_s, 7.5);
    c.effect = "of nobody", c.variant = {{"speed_rad_s", 7.5}};
    EXPECT_NE(prepared(c).wheel[0].stribeck_speed_rad_s, 7.5);
    Candidate patch = m.first("body_drag");
    patch.effect = "soil_patch", patch.variant = {{"start_m", 2}, {"length_m", 3}};
    EXPECT_EQ(prepared(patch).body.patch_start_m, 2);
    EXPECT_EQ(prepared(patch).body.patch_length_m, 3);
    EXPECT_NE(prepared(patch).body.heavy_start_m, 2);
}

TEST(Shown, can_be_a_ripple_in_turns_and_what_lags_in_changes) {
    Machine m;
    EXPECT_TRUE(m.has("torque_ripple") && m.has("accel_delay") && m.has("accel_lag")); // a drive that is planned
    m.data.count = 1000, m.data.step_s = 0.01;
    const auto turned = [&](double turns) {
        for (WheelInput &w : m.data.wheel) w.angle_rad = {0, 2 * std::numbers::pi * turns, 1};
        std::set<double> orders;
        for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion))
            if (c.effect == "torque_ripple") orders.insert(std::fabs(c.variant[0].second));
        return orders;
    };
    EXPECT_TRUE(turned(0.9).empty()); // one turn at least
    for (const double turns : {1.01, 1.6, 2.9, 3.1})
        for (const double order : turned(100))
            EXPECT_EQ(turned(turns).count(order) == 1, turns > std::max(1.0, 3 / order)) << turns << order;
    const auto changes = [&](int count, double by) {
        for (WheelInput &w : m.data.wheel) { // of a fifth of a second each
            w.angle_rad = {0, 100}, w.speed_rad_s.assign(1000, 10);
            for (int i = 0; i < count; ++i)
                for (int k = 0; k < 20; ++k) w.speed_rad_s[static_cast<std::size_t>(100 + 40 * i + k)] = 10 - by;
        }
        EXPECT_EQ(m.has("relaxation_length"), m.has("accel_lag"));
        return std::make_tuple(m.has("accel_delay"), m.has("accel_lag"), m.has("radar_delay"), m.has("accel_bias"));
    };
    EXPECT_EQ(changes(2, 2), std::make_tuple(true, true, true, true)); // there and back, twice
    EXPECT_EQ(changes(1, 2), std::make_tuple(false, false, false, true));
    EXPECT_EQ(changes(2, 1.1), std::make_tuple(true, true, true, true)); // a tenth of the largest
    EXPECT_EQ(changes(2, 0.9), std::make_tuple(false, false, false, true));
    m.data.wheel[0].speed_rad_s.assign(1000, 10); // the other still does
    EXPECT_FALSE(m.has("accel_lag"));
    changes(2, 2);
    m.data.wheel[0].speed_rad_s.assign(1000, 10);
    EXPECT_TRUE(m.has("accel_lag"));
}

TEST(Patches, are_none_where_the_rover_hardly_went) {
    Machine m;
    const auto count = [&](double path, const char *effect) {
        m.motion.path_m = {0, path};
        std::map<double, int> out;
        for (const Candidate &c : catalogue_candidates(m.model, m.data, m.motion))
            if (c.effect == effect && c.wheel < 0) ++out[c.variant[1].second];
        return out;
    };
    EXPECT_TRUE(count(0.3, "soil_patch").empty());
    EXPECT_EQ(count(0.42, "soil_patch").size(), 1U); // a quarter of a metre is three fifths of it
    EXPECT_TRUE(count(0.41, "soil_patch").empty());
    const std::map<double, int> ten = count(10, "soil_patch"), heavy = count(10, "resistance_patch");
    ASSERT_EQ(ten.size(), 6U);
    EXPECT_EQ(ten.count(2.5 * 2.5 / 1.5), 1U); // as much longer again, and no longer than three fifths of the way
    EXPECT_EQ(ten.at(0.25), 24);               // starts every 24th of the way, half of the last within it
    EXPECT_EQ(ten.at(2.5), 7);                 // from 0 to 7.5 m by half of 2.5
    EXPECT_EQ(ten.at(1), 19);
    ASSERT_EQ(heavy.size(), 4U);
    EXPECT_EQ(heavy.at(2), 9);
    EXPECT_EQ(heavy.at(4), 4); // from 0 to 6 m
}

// Series whose values say which they are: 1000 * kind + 100 * wheel + step.
struct Moved {
    Dataset data;
    Motion motion;
    Physics physics;
    std::vector<std::vector<double>> current;
    static std::vector<double> series(double base) {
        std::vector<double> out;
        for (int k = 0; k < 41; ++k) out.push_back(base + k);
        return out;
    }
    Moved() {
        data.count = 41, data.start_s = 5, data.step_s = 0.1;
        data.wheel.resize(4), motion.wheel.resize(4), physics.wheel.resize(4);
        for (std::size_t i = 0; i < 4; ++i) {
            const double w = 100 * static_cast<double>(i);
            data.wheel[i].speed_rad_s = series(-20 + w), data.wheel[i].voltage_V = series(1000 + w),
            data.wheel[i].travel_rad = series(2000 + w);
            motion.wheel[i].slip = series(3000 + w), motion.wheel[i].load_N = series(4000 + w);
            motion.wheel[i].ground_speed_m_s = series(5000 + w);
            current.push_back(series(6000 + w));
            physics.wheel[i].x = i < 2 ? 1 : -1, physics.wheel[i].y = i % 2 == 0 ? 1 : -1;
        }
        motion.v_m_s = series(-7), motion.accel_m_s2 = series(8000), motion.path_m = series(9000), motion.yaw_rate_rad_s = series(10000);
    }
    std::vector<double> on(Axis axis, bool motors = false) const { return values_on(axis, data, motion, physics, current, motors).values; }
    // Every tenth step of what a wheel has, wheel after wheel.
    template <typename Of> static std::vector<double> wanted(std::vector<std::size_t> wheels, Of &&value, std::size_t step = 10) {
        std::vector<double> out;
        for (const std::size_t i : wheels)
            for (std::size_t k = 0; k < 41; k += step) out.push_back(value(i, k));
        return out;
    }
};

TEST(Axis, takes_every_tenth_value_of_the_series_that_it_is) {
    const Moved m;
    const std::vector<std::size_t> all = {0, 1, 2, 3};
    const auto expect = [&](Axis axis, auto &&value) { EXPECT_EQ(m.on(axis), Moved::wanted(all, value)) << axis_name(axis); };
    const auto k_of = [](std::size_t k) { return static_cast<double>(k); };
    const auto per_wheel = [&](double base) {
        return [=](std::size_t i, std::size_t k) { return base + 100 * static_cast<double>(i) + static_cast<double>(k); };
    };
    expect(Axis::wheel_speed, per_wheel(-20));
    expect(Axis::abs_wheel_speed, [&](std::size_t i, std::size_t k) { return std::fabs(per_wheel(-20)(i, k)); });
    expect(Axis::voltage, per_wheel(1000));
    expect(Axis::reversal, per_wheel(2000));
    expect(Axis::slip, per_wheel(3000));
    expect(Axis::load, per_wheel(4000));
    expect(Axis::direction, per_wheel(5000));
    expect(Axis::current, per_wheel(6000));
    expect(Axis::speed, [&](std::size_t, std::size_t k) { return -7 + k_of(k); });
    expect(Axis::abs_speed, [&](std::size_t, std::size_t k) { return std::fabs(-7 + k_of(k)); });
    expect(Axis::accel, [&](std::size_t, std::size_t k) { return 8000 + k_of(k); });
    expect(Axis::path, [&](std::size_t, std::size_t k) { return 9000 + k_of(k); });
    expect(Axis::place, [&](std::size_t, std::size_t k) { return 9000 + k_of(k); });
    expect(Axis::yaw_rate, [&](std::size_t, std::size_t k) { return 10000 + k_of(k); });
    EXPECT_EQ(m.on(Axis::time), Moved::wanted(
                                    all, [&](std::size_t, std::size_t k) { return 5 + 0.1 * k_of(k); }, 20));
    EXPECT_TRUE(m.on(Axis::angle).empty());
    const auto others = [&](std::vector<std::vector<std::size_t>> sharing) {
        return [=](std::size_t i, std::size_t k) {
            double sum = 0;
            for (const std::size_t j : sharing[i]) sum += 6000 + 100 * static_cast<double>(j) + static_cast<double>(k);
            return sum;
        };
    };
    expect(Axis::axle_current, others({{1}, {0}, {3}, {2}}));
    expect(Axis::side_current, others({{2}, {3}, {0}, {1}}));
    expect(Axis::other_current, others({{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}}));
    Moved table = m;
    table.data.independent_rows = true; // every row is one
    EXPECT_EQ(table.on(Axis::slip).size(), 164U);
    EXPECT_EQ(table.on(Axis::time).size(), 164U);
    Moved missing = m;
    missing.current[1].clear(); // of which nothing is known
    EXPECT_EQ(missing.on(Axis::axle_current), Moved::wanted({0, 2, 3}, [&](std::size_t i, std::size_t k) {
                  return i == 0 ? 0.0 : 6000 + 100 * (i == 2 ? 3.0 : 2.0) + k_of(k);
              }));
}

TEST(Axis, of_motors_takes_those_and_of_the_wheels_that_one_turns_the_sum_of_loads_and_the_mean_of_the_rest) {
    Moved m;
    EXPECT_EQ(m.on(Axis::slip, true), m.on(Axis::slip));
    m.physics.motor = {0, 1, 0, 1};
    const auto expect = [&](Axis axis, double base, double share) {
        EXPECT_EQ(m.on(axis, true), Moved::wanted({0, 1}, [=](std::size_t i, std::size_t k) {
                      return share * (2 * base + 100 * (2 * static_cast<double>(i) + 2) + 2 * static_cast<double>(k));
                  }));
    };
    expect(Axis::slip, 3000, 0.5);
    expect(Axis::load, 4000, 1);
    expect(Axis::direction, 5000, 0.5);
    EXPECT_EQ(m.on(Axis::wheel_speed, true), Moved::wanted({0, 1}, [](std::size_t i, std::size_t k) {
                  return -20 + 100 * static_cast<double>(i) + static_cast<double>(k);
              }));
    EXPECT_EQ(m.on(Axis::slip).size(), 20U); // of wheels all four
}

TEST(Axis, varies_between_wheels_where_their_means_spread_more_than_each) {
    const auto varies = [](double apart) {
        Moved m;
        for (std::size_t i = 0; i < 4; ++i) m.motion.wheel[i].slip = Moved::series(apart * static_cast<double>(i));
        return values_on(Axis::slip, m.data, m.motion, m.physics, m.current).varies_between_wheels;
    };
    // 0, 10, .. 40: squares of 200 a value within; of the means 0, a, 2a, 3a squares of 1.25 a^2 between
    EXPECT_FALSE(varies(12.6)); // 1.25 * 158.8 = 198.5
    EXPECT_TRUE(varies(12.7));  // 201.6
}

struct Shapes {
    Moved m;
    std::vector<Candidate> all;
    Shapes() {
        for (double &x : m.motion.v_m_s) x = 0.1 * x;
        all = shape_candidates(m.data, m.motion, m.physics, m.current);
    }
    const Candidate *find(const std::string &effect) const {
        for (const Candidate &c : all)
            if (c.effect == effect) return &c;
        return nullptr;
    }
};

TEST(Shapes, have_the_knots_of_their_axis_and_a_straight_line_beside_those_that_may_be_one) {
    const Shapes s;
    const auto knots = [&](Axis axis, bool torque, bool motors) { return knots_on(axis, s.m.on(axis, motors), torque); };
    const Candidate *speed = s.find("resistance(speed)"), *line = s.find("resistance(speed), a straight line"),
                    *current = s.find("torque(motor current)"), *voltage = s.find("voltage(motor current)");
    ASSERT_TRUE(speed && line && current && voltage);
    EXPECT_EQ(speed->knots, knots(Axis::abs_speed, false, false));
    EXPECT_EQ(speed->target, TermTarget::rolling);
    EXPECT_EQ(speed->axis, Axis::abs_speed);
    EXPECT_EQ(speed->touched, target_stages(TermTarget::rolling));
    EXPECT_EQ(speed->strengths.size(), speed->knots.size());
    EXPECT_TRUE(speed->free_shape && line->free_shape);
    EXPECT_EQ(line->knots, (std::vector<double>{speed->knots.front(), speed->knots.back()}));
    EXPECT_EQ(line->strengths.size(), 2U);
    EXPECT_EQ(line->target, TermTarget::rolling);
    EXPECT_EQ(current->knots, knots(Axis::current, true, true)); // where what saturates shows
    EXPECT_EQ(voltage->knots, knots(Axis::current, false, true));
    EXPECT_NE(current->knots, voltage->knots);
    for (const char *straight :
         {"friction(time)", "resistance(time)", "soil strength(time)", "soil strength(speed)", "motor constant(time)"})
        EXPECT_TRUE(s.find(straight) && s.find(std::string(straight) + ", a straight line")) << straight;
    for (const char *curve : {"torque(wheel speed)", "resistance(path)", "radar(speed)", "accelerometer(time)", "winding resistance(time)"})
        EXPECT_TRUE(s.find(curve) && !s.find(std::string(curve) + ", a straight line")) << curve;
    EXPECT_TRUE(s.find("torque(slip)")->varies_between_wheels); // 100 apart, 0 to 40 each
    EXPECT_FALSE(speed->varies_between_wheels);
    Shapes still;
    still.m.motion.yaw_rate_rad_s.assign(41, 0.0);
    still.all = shape_candidates(still.m.data, still.m.motion, still.m.physics, still.m.current);
    EXPECT_FALSE(still.find("resistance(yaw rate)"));
    EXPECT_TRUE(s.find("resistance(yaw rate)"));
    Shapes bare;
    for (WheelInput &w : bare.m.data.wheel) w.voltage_V.clear();
    bare.all = shape_candidates(bare.m.data, bare.m.motion, bare.m.physics, bare.m.current);
    EXPECT_FALSE(bare.find("voltage(motor voltage)"));
}

TEST(Shapes, of_a_turn_have_the_orders_that_no_ripple_has_and_waves_of_the_ground_half_a_cycle_of_the_path_apart) {
    const Shapes s; // a path of 40 m
    std::set<double> orders;
    for (const Candidate &c : s.all)
        if (c.axis == Axis::angle) {
            orders.insert(c.order);
            EXPECT_EQ(c.effect, "torque(wheel angle), " + std::to_string(static_cast<int>(c.order)) + " per turn");
            EXPECT_EQ(c.target, TermTarget::wheel_torque);
            EXPECT_EQ(c.touched, stage_torque);
            EXPECT_EQ(c.strengths.size(), 2U);
        }
    EXPECT_EQ(orders, (std::set<double>{5, 7, 9, 10, 12}));
    for (const sim::EffectParameter &p : sim::find_effect("torque_ripple")->parameters)
        for (const double one : p.variants) EXPECT_EQ(orders.count(one), 0U);
    std::map<double, std::set<Axis>> waves; // by cycles per metre
    for (const Candidate &c : s.all)
        if (c.order > 0 && c.target == TermTarget::soil_strength) waves[c.order / (2 * std::numbers::pi)].insert(c.axis);
    ASSERT_EQ(waves.size(), 33U); // 0.8 to 3.4 by 0.08
    double expected = 0.8;
    for (const auto &[cycles, axes] : waves) {
        EXPECT_NEAR(cycles, expected, 1e-9);
        EXPECT_EQ(axes, (std::set<Axis>{Axis::path, Axis::place}));
        char name[80];
        std::snprintf(name, sizeof name, "soil strength(path), a wave of %.2f m", 1 / cycles);
        EXPECT_TRUE(s.find(name)) << name;
        expected += 0.08;
    }
    Shapes brief;
    for (double &x : brief.m.motion.path_m) x = 0.1 * x; // 4 m: 0.65 / 4 apart
    brief.all = shape_candidates(brief.m.data, brief.m.motion, brief.m.physics, brief.m.current);
    EXPECT_EQ(std::count_if(brief.all.begin(), brief.all.end(), [](const Candidate &c) { return c.order > 0 && c.axis == Axis::place; }),
              16);                                       // 2.6 / 0.1625 = 16
    for (double &x : brief.m.motion.path_m) x = 0.2 * x; // less than a metre
    brief.all = shape_candidates(brief.m.data, brief.m.motion, brief.m.physics, brief.m.current);
    EXPECT_TRUE(std::none_of(brief.all.begin(), brief.all.end(), [](const Candidate &c) { return c.axis == Axis::place; }));
}

TEST(Shapes, move_the_last_term_by_steps_of_their_target) {
    const Shapes s;
    for (const Candidate &c : s.all)
        for (std::size_t j = 0; j < c.strengths.size(); ++j) {
            const FreeParameter &p = c.strengths[j];
            EXPECT_EQ(p.owner, c.effect);
            EXPECT_EQ(p.key, "f" + std::to_string(j));
            EXPECT_EQ(p.touched, c.touched);
            ASSERT_EQ(p.slots.size(), 1U);
            EXPECT_EQ(p.slots[0].term, -2);
            EXPECT_EQ(p.slots[0].coefficient, static_cast<int>(j));
            EXPECT_LT(p.minimum, -1e8);
            EXPECT_GT(p.maximum, 1e8);
            const std::string target(target_name(c.target));
            const bool torque = c.target == TermTarget::wheel_torque || c.target == TermTarget::wheel_friction ||
                                c.target == TermTarget::voltage || c.target == TermTarget::accel;
            EXPECT_EQ(p.step, torque ? 5e-7 : 2e-6) << c.effect;
            EXPECT_EQ(c.step[j], p.step);
        }
}

TEST(Shapes, are_put_into_a_physics_as_a_term_of_nothing_that_their_strengths_then_move) {
    Candidate c = *Shapes().find("resistance(speed)");
    c.wheel = 2;
    Physics p;
    c.prepare(p);
    ASSERT_EQ(p.terms.size(), 1U);
    EXPECT_EQ(p.terms[0].name, c.effect);
    EXPECT_EQ(p.terms[0].target, TermTarget::rolling);
    EXPECT_EQ(p.terms[0].wheel, 2);
    EXPECT_EQ(p.terms[0].coefficients, std::vector<double>(c.strengths.size(), 0));
    c.strengths[1].add(p, 3);
    Signals at;
    at.v = at.V = c.knots[1];
    EXPECT_DOUBLE_EQ(p.terms[0].term->value(at, p.terms[0].coefficients.data()), 3); // a hat at its knot
    Candidate wave;
    wave.free_shape = true, wave.axis = Axis::path, wave.order = 2, wave.strengths.resize(2);
    wave.prepare(p);
    const double coefficients[] = {0.5, 0.25};
    at.x = at.X = 0.7;
    EXPECT_NEAR(p.terms[1].term->value(at, coefficients), 0.5 * std::cos(1.4) + 0.25 * std::sin(1.4), 1e-12);
}

TEST(Expression, names_the_signal_of_its_axis) {
    Candidate c;
    c.knots = {1, 2};
    c.strengths.resize(2);
    std::map<Axis, std::string> names = {{Axis::time, "t"},
                                         {Axis::wheel_speed, "w"},
                                         {Axis::speed, "v"},
                                         {Axis::slip, "s"},
                                         {Axis::load, "Fn"},
                                         {Axis::path, "x"},
                                         {Axis::accel, "a"},
                                         {Axis::current, "I"},
                                         {Axis::yaw_rate, "r"},
                                         {Axis::abs_speed, "abs(v)"},
                                         {Axis::other_current, "Io"},
                                         {Axis::axle_current, "Ia"},
                                         {Axis::side_current, "Is"},
                                         {Axis::abs_wheel_speed, "abs(w)"},
                                         {Axis::voltage, "u"},
                                         {Axis::reversal, "d"},
                                         {Axis::turn, "atan2(sin(theta),cos(theta))"}};
    for (const auto &[axis, name] : names) {
        c.axis = axis;
        EXPECT_EQ(shape_expression(c, {0.5, 2}), "0.5 + (1.5)*min(1, max(0, (" + name + " - (1))/1))");
    }
    c.order = 3, c.axis = Axis::angle;
    EXPECT_EQ(shape_expression(c, {0.5, -2}), "0.5*cos(3*theta) + -2*sin(3*theta)");
}

TEST(Use, of_an_effect_has_its_sizes_and_its_shape_as_it_was_tried) {
    Candidate c = candidate("torque_ripple", 1);
    c.strengths[0].key = "cos_Nm", c.strengths[0].unit = "N m", c.strengths[0].minimum = -2;
    c.variant = {{"order", 3}};
    const EffectUse use = effect_of(c, {0.25});
    EXPECT_EQ(use.name, "torque_ripple");
    EXPECT_EQ(use.wheel, 1);
    ASSERT_EQ(use.parameters.size(), 2U);
    const Parameter &size = use.parameters.at("cos_Nm"), &order = use.parameters.at("order");
    EXPECT_EQ(size.value, 0.25);
    EXPECT_EQ(size.unit, "N m");
    EXPECT_EQ(size.minimum, -2);
    EXPECT_EQ(size.maximum, 1);
    EXPECT_TRUE(size.given && !size.fixed);
    EXPECT_EQ(order.value, 3);
    EXPECT_EQ(order.unit, "1/turn");
    EXPECT_TRUE(order.given && order.fixed);
    c.effect = "my own"; // of no catalogue
    EXPECT_EQ(effect_of(c, {0.25}).parameters.at("order").unit, "");
}

} // namespace
} // namespace traction::lab
