// A motor that turns several wheels: the model's key and its refusals, the motor's balance in closed form, sensitivities, and what a log of
// the simulated rover with two motors gives.
#include "host_tools/check/check.h"
#include "host_tools/lab/decision/candidate.h"
#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/forward/forward.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/gate.h"
#include "host_tools/lab/model/model.h"
#include "host_tools/lab/next/manoeuvre.h"
#include "host_tools/lab/result/addition.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace traction::lab {
namespace {

const std::string rover =
    "[rover]\nmass_kg = 8\nDRIVES\n[wheels]\nradius_m = 0.1\n[motor]\ntorque_constant_Nm_A = 0.5\nresistance_ohm = 1\n"
    "coulomb_Nm = 0.2\n[soil]\nmu = 0.7\nshear_slip = 0.1\n[[wheel]]\nx_m = -0.2\ny_m = 0.3\n[[wheel]]\nx_m = -0.2\ny_m = "
    "-0.3\n[[wheel]]\nx_m = 0.2\ny_m = 0.3\n[[wheel]]\nx_m = 0.2\ny_m = -0.3\n";

std::string with(const std::string &drives, const std::string &more = "") {
    std::string text = rover + more;
    return text.replace(text.find("DRIVES"), 6, drives.empty() ? "" : "drives = " + drives);
}

std::string refusal(const std::string &text) {
    try {
        parse_model(text, "m.toml");
    } catch (const ModelError &error) {
        return error.what();
    }
    return "accepted";
}

std::vector<std::size_t> motors(const Model &model) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) out.push_back(model.motor_of(i));
    return out;
}

TEST(Drives, a_motor_turns_the_wheels_of_its_side_or_those_that_are_named) {
    using Of = std::vector<std::size_t>;
    EXPECT_EQ(motors(parse_model(with(""), "m")), (Of{0, 1, 2, 3}));
    EXPECT_EQ(motors(parse_model(with("[0, 1]"), "m")), (Of{0, 1, 0, 1}));
    EXPECT_EQ(motors(parse_model(with("[2, 3]"), "m")), (Of{2, 3, 2, 3}));
    EXPECT_EQ(motors(parse_model(with("[[2, 0], 1]"), "m")), (Of{2, 1, 2, 1}));
    EXPECT_EQ(motors(parse_model(with("[[0, 1], [2], [3]]"), "m")), (Of{0, 0, 2, 3})); // an axle on one motor
    const std::string six = with("[0, 1]", "[[wheel]]\ny_m = 0.3\n[[wheel]]\ny_m = -0.3\n");
    EXPECT_EQ(motors(parse_model(six, "m")), (Of{0, 1, 0, 1, 0, 1}));
    EXPECT_EQ(motors(parse_model(with("[0, 1]", "[[wheel]]\ndriven = false\n"), "m")), (Of{0, 1, 0, 1, 4})); // a caster
}

TEST(Drives, a_grouping_that_cannot_be_is_refused_with_line_and_mend) {
    const auto told = [](const std::string &drives, const std::string &words, const std::string &more = "") {
        const std::string message = refusal(with(drives, more));
        EXPECT_NE(message.find(words), std::string::npos) << drives << ": " << message;
    };
    told("[0]", "m.toml:3: rover.drives: leaves wheel 1 without a drive; add it to a motor's wheels");
    told("[[0, 2], [1]]", "leaves wheel 3 without a drive");
    told("[[0, 2], [1, 2, 3]]", "has wheel 2 twice; a wheel turns with one motor");
    told("[0, 1, 0]", "has wheel 0 twice");
    told("[0, 2, 1, 5]", "names wheel 5; wheels are 0 to 3");
    told("[0, -1]", "names wheel -1");
    told("2", "is no list of wheels");
    told("[]", "is no list of wheels");
    told("[[], 0, 1]", "has an empty list");
    told("[0, 1.5]", "holds what is no wheel");
    told("[0, 2, 1]", "wheel 4 may turn with wheel 0 or with wheel 2", "[[wheel]]\ny_m = 0.3\n");
    told("[0, 1, 4]", "names wheel 4, which has driven = false", "[[wheel]]\ndriven = false\n");
    told("[0, 1]", "wheel[3].motor: is the motor of a wheel that turns with wheel 1; write it at wheel 1",
         "[wheel.motor]\ncoulomb_Nm = 0.3\n");
    told("[0, 1]", "2 turns with wheel 0, and wiring_resistance is on a motor; write wheel = 0",
         "[[effect]]\nname = \"wiring_resistance\"\nwheel = 2\nresistance_ohm = 0.1\n");
    told("[0, 1]", "3 turns with wheel 1, and grease is on a motor",
         "[[effect]]\nname = \"grease\"\nwheel = 3\nacts_on = \"wheel_friction\"\nexpression = \"k\"\nk = 0.1\n");
    EXPECT_EQ(refusal(with("[0, 1]", "[[effect]]\nname = \"rolling_resistance\"\nwheel = 2\ncoefficient = 0.05\n")), "accepted");
    const Model model = parse_model(with("[0, 1]"), "m");
    EXPECT_THROW(add_effect(model, Dataset{}, "current_gain", 3, ""), ModelError);
}

TEST(Drives, what_is_written_reads_back_to_the_same_machine) {
    for (const char *drives : {"[2, 3]", "[[1, 3], [2, 0]]", "[[3, 0], [1], [2]]"}) {
        Model model = parse_model(with(drives), "m");
        for (std::size_t i = 0; i < 4; ++i) // as a fit leaves it: each motor's own number
            if (model.motor_of(i) == i) model.wheel[i].motor.at("coulomb_Nm").value = 0.2 + 0.01 * static_cast<double>(i);
        const std::string once = model_text(model);
        const Model again = parse_model(once, "m");
        EXPECT_EQ(motors(again), motors(model)) << once;
        EXPECT_EQ(model_text(again), once);
        const Physics a = make_physics(model), b = make_physics(again);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(a.wheel[i].t0, b.wheel[i].t0) << drives;
            EXPECT_EQ(a.wheel[i].t0, a.wheel[model.motor_of(i)].t0) << drives;
        }
    }
}

// Steady wheels at w, motion imposed by hand: rows of the balances that the motors have.
Dataset steady(const Model &model, const std::vector<double> &w_rad_s, bool spins) {
    Dataset data;
    data.step_s = 0.02, data.count = 400;
    data.gap.assign(data.count, 0);
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        WheelInput in;
        const double w = w_rad_s[model.motor_of(i)];
        in.speed_rad_s.assign(data.count, w), in.accel_rad_s2.assign(data.count, 0);
        for (std::size_t k = 0; k < data.count; ++k) in.angle_rad.push_back(w * data.step_s * static_cast<double>(k));
        in.turns_with = model.wheel[i].drive;
        data.wheel.push_back(in);
    }
    data.yaw_free = spins;
    for (std::size_t i = 0; i < model.wheel.size(); ++i) {
        if (model.motor_of(i) != i) continue;
        Balance b;
        b.kind = BalanceKind::current_torque, b.wheel = static_cast<int>(i), b.noise = 0.01;
        for (double t = 6; t < 7.8; t += 0.05) b.t0_s.push_back(t), b.t1_s.push_back(t + 0.05), b.measured.push_back(0);
        data.balance.push_back(b);
    }
    return data;
}

// Straight ahead, steady: the tractions make up for the rolling resistance, so KG I = t0 + sum R Ft = t0 + R c (sum of the motor's loads):
// twice what a motor of one wheel pulls, friction once.
TEST(Drives, a_motor_carries_the_tractions_of_its_wheels_and_one_friction) {
    const double weight = 8 * 9.81, crr = 0.05;
    const auto current = [&](const std::string &drives, double offset_m) {
        Model model = parse_model(with(drives), "m");
        for (WheelSpec &wheel : model.wheel) wheel.soil.at("rolling_coefficient").value = crr;
        Physics physics = make_physics(model);
        physics.body.offset_x_m = offset_m;
        const Dataset data = steady(model, {5, 5, 5, 5}, false);
        return Forward(data).predict(physics);
    };
    // 1e-6: the bracket of the speed search, 1e-9 m/s, on a slope of mu W / (2 sc v) = 550 N s/m
    EXPECT_NEAR(current("[0, 1]", 0)[0], (0.2 + 0.1 * crr * weight / 2) / 0.5, 2e-6);
    EXPECT_NEAR(current("", 0)[0], (0.2 + 0.1 * crr * weight / 4) / 0.5, 2e-6);
    EXPECT_NEAR(current("[[0, 1, 2, 3]]", 0)[0], (0.2 + 0.1 * crr * weight) / 0.5, 2e-6);
    // wherever the weight lies between its wheels, a side's motor carries half of it
    EXPECT_NEAR(current("[0, 1]", 0.1)[0], (0.2 + 0.1 * crr * weight / 2) / 0.5, 2e-6);
}

// A wheel with a radius of its own slips by what its rim differs from the other's: on ground where they grip, the two of a motor then work
// against each other, and the motor carries the sum of R Ft.
TEST(Drives, each_wheel_of_a_motor_keeps_its_own_radius_slip_and_load) {
    Model model = parse_model(with("[0, 1]"), "m");
    Physics physics = make_physics(model);
    for (const std::size_t i : {2U, 3U}) physics.wheel[i].radius_change = 0.02;
    const Dataset data = steady(model, {5, 5}, false);
    Motion motion;
    integrate(data, physics, motion, nullptr, true);
    const std::size_t k = 380;
    const double v = motion.v_m_s[k];
    EXPECT_GT(v, 0.5), EXPECT_LT(v, 0.51); // between the two rims
    for (std::size_t i = 0; i < 4; ++i) {
        const double rim = i < 2 ? 0.5 : 0.51;
        EXPECT_NEAR(motion.wheel[i].slip[k], (rim - v) / std::max(rim, v), 1e-6) << i; // (1) of wheel_laws.h
    }
    const double rear = motion.wheel[0].traction_N[k], front = motion.wheel[2].traction_N[k];
    EXPECT_NEAR(rear, -front, 1e-3); // nothing else pulls: within what a step of the search leaves
    EXPECT_GT(front, 1);
    const Eigen::VectorXd rows = Forward(data).predict(physics);
    EXPECT_NEAR(rows[0], (0.2 + 0.1 * rear + 0.102 * front) / 0.5, 1e-3);
}

// On the spot, at -w and w: front and rear wheel of a side share a speed, hence, equally loaded, a slip and a traction.
TEST(Drives, on_the_spot_front_and_rear_wheel_of_a_side_do_the_same) {
    Model model = parse_model(with("[0, 1]"), "m");
    const Physics physics = make_physics(model);
    const Dataset data = steady(model, {-4, 4}, true);
    Motion motion;
    integrate(data, physics, motion, nullptr, true);
    const std::size_t k = 380;
    EXPECT_GT(motion.yaw_rate_rad_s[k], 0.1);
    EXPECT_NEAR(motion.v_m_s[k], 0, 1e-6); // by symmetry
    for (const std::size_t side : {0U, 1U}) {
        EXPECT_NEAR(motion.wheel[side].slip[k], motion.wheel[side + 2].slip[k], 1e-6);
        EXPECT_NEAR(motion.wheel[side].traction_N[k], motion.wheel[side + 2].traction_N[k], 1e-6);
    }
    const Eigen::VectorXd rows = Forward(data).predict(physics);
    const double pull = 2 * motion.wheel[1].traction_N[k];
    EXPECT_NEAR(rows[rows.size() - 1], (0.2 + 0.1 * pull) / 0.5, 1e-6); // the right motor's
}

const sim::RoverDescription &two_motors() {
    static const sim::RoverDescription description = sim::read_rover_file("rovers/two_motors.toml");
    return description;
}

Model model_on(const std::string &soil) { return parse_model(traction::model_text(two_motors(), soil), "two motors"); }

log::Log driven(const std::string &soil, const std::string &effect, std::uint64_t seed = 3) {
    sim::Scenario scenario = sim::read_scenario("scenarios/two_motors.toml");
    scenario.plant.ground.soil = *sim::find_soil(soil);
    SimulateOptions options;
    options.seed = seed;
    if (!effect.empty()) options.effects.push_back(sim::parse_effect(effect));
    return simulate(scenario, options).log;
}

TEST(Drives, the_log_of_two_motors_has_their_signals_alone_and_passes_the_check) {
    for (const char *soil : {"sand", "concrete"}) {
        const log::Log log = driven(soil, "");
        for (int i = 0; i < 4; ++i)
            for (const char *tail : {".speed_rad_s", ".current_A", ".duty"})
                EXPECT_EQ(log.find("wheel" + std::to_string(i) + tail) != nullptr, i < 2) << i << tail;
        const check::Report report = check::check(log, {}, machine_of(model_on(soil)));
        EXPECT_TRUE(report.passed()) << soil;
        for (const check::Finding &f : report.findings) EXPECT_NE(f.severity, check::Severity::error) << f.id << ": " << f.text;
        const Dataset data = make_dataset(model_on(soil), log);
        for (const std::string &message : data.messages) EXPECT_EQ(message.find("wheel 2"), std::string::npos) << message;
        EXPECT_EQ(data.wheel[2].speed_rad_s, data.wheel[0].speed_rad_s);
        EXPECT_EQ(data.wheel[3].angle_rad, data.wheel[1].angle_rad);
    }
}

TEST(Drives, a_log_that_is_of_another_machine_is_told) {
    const log::Log log = driven("sand", "");
    Model own_motors = model_on("sand");
    for (WheelSpec &wheel : own_motors.wheel) wheel.drive = -1;
    const check::Report of_two = check::check(log, {}, machine_of(own_motors)); // header rover.drives
    EXPECT_NE(of_two.find("wheels", ""), nullptr);
    log::Log four = log; // and an encoder on a wheel that the chain turns, which stands for a second
    log::Signal speed = *log.find("wheel0.speed_rad_s");
    speed.name = "wheel2.speed_rad_s";
    four.signals.push_back(speed);
    EXPECT_EQ(check::check(four, {}, machine_of(model_on("sand"))).find("coupled", "wheel2.speed_rad_s"), nullptr); // it agrees
    for (double &w : four.signals.back().value) w *= 0.8;
    const check::Report apart = check::check(four, {}, machine_of(model_on("sand")));
    ASSERT_NE(apart.find("coupled", "wheel2.speed_rad_s"), nullptr);
    EXPECT_EQ(apart.find("coupled", "wheel2.speed_rad_s")->severity, check::Severity::error);
    log::Log current = log;
    log::Signal amps = *log.find("wheel0.current_A");
    amps.name = "wheel2.current_A";
    current.signals.push_back(amps);
    const check::Report told = check::check(current, {}, machine_of(model_on("sand")));
    ASSERT_NE(told.find("coupled", "wheel2.current_A"), nullptr);
    EXPECT_EQ(told.find("coupled", "wheel2.current_A")->severity, check::Severity::warning);
}

// As lab_tangent_test has it for a motor a wheel.
TEST(Drives, sensitivities_are_those_of_whole_integrations) {
    const Model model = model_on("sand");
    const Dataset data = make_dataset(model, driven("sand", ""));
    const Physics physics = make_physics(model);
    Forward forward(data);
    forward.set_base(physics);
    std::size_t seen = 0;
    const auto compare = [&](const Physics &base, const FreeParameter &p, double step, const std::string &what) {
        Physics small = base, moved = base, back = base;
        p.add(small, 1e-3 * step), p.add(moved, step), p.add(back, -step);
        const int wheel = p.slots.size() == 1 && p.slots[0].in_wheel != nullptr ? p.slots[0].wheel : -1;
        const Eigen::VectorXd tangent = (forward.predict_from_base(small, p.touched, wheel) - forward.base()) / (1e-3 * step);
        const Eigen::VectorXd whole = (forward.predict(moved) - forward.predict(back)) / (2 * step);
        // 3 %: curvature over the larger step
        EXPECT_LT((tangent - whole).norm(), 0.03 * whole.norm() + 1e-9) << what << ": " << tangent.norm() << " against " << whole.norm();
        EXPECT_GT(whole.norm(), 0) << what << " moves nothing";
        ++seen;
    };
    for (const FreeParameter &p : free_parameters(model, physics)) {
        if (p.owner == "sensors") continue; // delays of a voltage that jumps have no slope
        compare(physics, p, 20 * p.step, name_of(p));
    }
    for (const Candidate &c : catalogue_candidates(model, data, forward.motion())) {
        const bool whole =
            c.effect == "backlash" || c.effect == "relaxation_length" || c.effect.ends_with("_delay") || c.effect == "accel_lag";
        if (whole || c.effect == "soil_patch" || c.effect == "resistance_patch" || c.effect == "shared_lead") continue;
        if (c.wheel != -1 && c.wheel != 1 && c.wheel != 2) continue;
        Physics base = physics;
        c.prepare(base);
        for (std::size_t j = 0; j < c.strengths.size(); ++j)
            if (c.effect != "bridge_dead_time" && c.effect != "encoder_missed") // the one bends where the other moves rows over an edge
                compare(base, c.strengths[j], 1e-3 * c.of_interest[j], c.label() + " " + c.strengths[j].key);
    }
    EXPECT_GT(seen, 40U);
}

TEST(Drives, effects_of_a_motor_are_tried_on_motors_and_those_of_a_wheel_on_wheels) {
    const Model model = model_on("sand");
    const Dataset data = make_dataset(model, driven("sand", ""));
    const Physics physics = make_physics(model);
    Motion motion;
    integrate(data, physics, motion, nullptr, true);
    std::vector<int> friction, rolling;
    for (const Candidate &c : catalogue_candidates(model, data, motion)) {
        if (c.effect == "coulomb_friction") friction.push_back(c.wheel);
        if (c.effect == "rolling_resistance") rolling.push_back(c.wheel);
        if (c.effect == "encoder_missed" && c.wheel == 1) {
            ASSERT_EQ(c.strengths[0].slots.size(), 2U); // one encoder: both wheels of the right side turn otherwise
            EXPECT_EQ(c.strengths[0].slots[1].wheel, 3);
        }
    }
    EXPECT_EQ(friction, (std::vector<int>{-1, 0, 1}));
    EXPECT_EQ(rolling, (std::vector<int>{-1, 0, 1, 2, 3}));
    for (const FreeParameter &p : free_parameters(model, physics))
        if (p.owner == "motor")
            for (const Slot &slot : p.slots) EXPECT_LT(slot.wheel, 2) << name_of(p);
    for (const Manoeuvre &m : manoeuvres_of(model)) EXPECT_FALSE(m.each_wheel) << m.title;
    EXPECT_EQ(cannot_drive(model), "");
    std::vector<std::string> notes;
    EXPECT_EQ(sim::parse_scenario(scenario_of(model, {&manoeuvres_of(model).front()}, notes), "next").rover.drives,
              (std::array<int, 2>{0, 1}));
}

TEST(Drives, a_clean_drive_names_nothing) {
    for (const char *soil : {"sand", "concrete"})
        for (const std::uint64_t seed : {3U, 4U}) {
            const Diagnosis d = diagnose(model_on(soil), make_dataset(model_on(soil), driven(soil, "", seed)), {});
            EXPECT_TRUE(d.effects.empty()) << soil << seed << ": " << d.text;
        }
}

TEST(Drives, a_hidden_effect_is_named_on_its_motor_or_its_wheel) {
    struct Case {
        const char *effect, *name;
    };
    for (const Case &c : {Case{"wiring_resistance:resistance_ohm=0.3,wheel=1", "wiring_resistance on wheel 1"},
                          {"coulomb_friction:torque_Nm=0.06,wheel=0", "coulomb_friction on wheel 0"},
                          {"slip_sinkage:coefficient=0.2", "slip_sinkage"}}) {
        const Diagnosis d = diagnose(model_on("sand"), make_dataset(model_on("sand"), driven("sand", c.effect)), {});
        ASSERT_EQ(d.effects.size(), 1U) << c.effect << ": " << d.text;
        EXPECT_EQ(d.effects[0], c.name) << d.text;
    }
}

} // namespace
} // namespace traction::lab
