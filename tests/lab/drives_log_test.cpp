// A motor that turns several wheels, in logs of the simulated rover with two motors: what the check and the lab make of them.
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
#include "host_tools/lab/session.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/simulate.h"

#include <array>
#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace traction::lab {
namespace {

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

TEST(DrivesLog, the_log_of_two_motors_has_their_signals_alone_and_passes_the_check) {
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

TEST(DrivesLog, a_log_that_is_of_another_machine_is_told) {
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
TEST(DrivesLog, sensitivities_are_those_of_whole_integrations) {
    const Model model = model_on("sand");
    const Dataset data = make_dataset(model, driven("sand", ""));
    const Physics physics = make_physics(model);
    Forward forward(data);
    forward.set_base(physics);
    std::size_t seen = 0;
    // Front and rear wheel of a side slip alike, so where the weight is between them changes nothing that a motor feels; and no two motors
    // are on one side.
    const auto blind = [](const std::string &what) {
        return what.starts_with("load_transfer") || what.starts_with("mass_offset_x") || what == "shared_lead resistance_ohm of a side";
    };
    const auto compare = [&](const Physics &base, const FreeParameter &p, double step, const std::string &what) {
        Physics small = base, moved = base, back = base;
        p.add(small, 1e-3 * step), p.add(moved, step), p.add(back, -step);
        const int wheel = p.slots.size() == 1 && p.slots[0].in_wheel != nullptr ? p.slots[0].wheel : -1;
        const Eigen::VectorXd tangent = (forward.predict_from_base(small, p.touched, wheel) - forward.base()) / (1e-3 * step);
        const Eigen::VectorXd whole = (forward.predict(moved) - forward.predict(back)) / (2 * step);
        if (blind(what)) {
            EXPECT_NEAR(whole.norm(), 0, 1e-6) << what; // rounding over the step
            return;
        }
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
        if (whole || c.effect == "soil_patch" || c.effect == "resistance_patch") continue;
        if (c.wheel != -1 && c.wheel != 1 && c.wheel != 2) continue;
        Physics base = physics;
        c.prepare(base);
        for (std::size_t j = 0; j < c.strengths.size(); ++j)
            if (c.effect != "bridge_dead_time") // bends
                compare(base, c.strengths[j], 1e-3 * c.of_interest[j],
                        c.label() + " " + c.strengths[j].key +
                            (c.effect == "shared_lead" && base.wheel[0].shared_with == 2 ? " of a side" : ""));
    }
    EXPECT_GT(seen, 40U);
}

TEST(DrivesLog, an_effect_on_a_motor_is_not_added_to_a_wheel_that_turns_with_it) {
    EXPECT_THROW(add_effect(model_on("sand"), Dataset{}, "current_gain", 3, ""), ModelError);
}

TEST(DrivesLog, effects_of_a_motor_are_tried_on_motors_and_those_of_a_wheel_on_wheels) {
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
        for (const Slot &slot : p.slots) EXPECT_TRUE(p.owner != "motor" || slot.wheel < 2) << name_of(p);
    for (const Manoeuvre &m : manoeuvres_of(model)) EXPECT_FALSE(m.each_wheel) << m.title;
    EXPECT_EQ(cannot_drive(model), "");
    std::vector<std::string> notes;
    EXPECT_EQ(sim::parse_scenario(scenario_of(model, {&manoeuvres_of(model).front()}, notes), "next").rover.drives,
              (std::array<int, 2>{0, 1}));
}

TEST(DrivesLog, a_clean_drive_names_nothing) {
    for (const char *soil : {"sand", "concrete"})
        for (const std::uint64_t seed : {3U, 4U}) {
            const Diagnosis d = diagnose(model_on(soil), make_dataset(model_on(soil), driven(soil, "", seed)), {});
            EXPECT_TRUE(d.effects.empty()) << soil << seed << ": " << d.text;
        }
}

TEST(DrivesLog, a_hidden_effect_is_named_on_its_motor) {
    struct Case {
        const char *effect, *name;
    };
    for (const Case &c : {Case{"wiring_resistance:resistance_ohm=0.6,wheel=1", "wiring_resistance on wheel 1"},
                          {"viscous_friction:coefficient_Nms=0.006,wheel=0", "viscous_friction on wheel 0"},
                          {"slip_sinkage:coefficient=0.2", "slip_sinkage"}}) {
        const Diagnosis d = diagnose(model_on("sand"), make_dataset(model_on("sand"), driven("sand", c.effect)), {});
        ASSERT_EQ(d.effects.size(), 1U) << c.effect << ": " << d.text;
        EXPECT_EQ(d.effects[0], c.name) << d.text;
    }
}

// Two motors share the load: that one's sensor tells too much or the other's too little may look alike, and then both are told.
TEST(DrivesLog, a_gain_of_one_motors_current_is_told_with_the_others_at_most) {
    Session session; // as traction diagnose has it: the log is asked for its ground's curve
    session.model = model_on("sand"), session.runs = {driven("sand", "current_gain:change=0.15,wheel=1")};
    ask_the_log(session);
    const Diagnosed asked = diagnose_session(session, {});
    const Diagnosis &d = asked.diagnosis;
    ASSERT_EQ(d.effects.size(), 1U) << d.text;
    std::vector<std::string> told = d.effects;
    if (!d.classes.empty()) told = d.classes[0].members;
    EXPECT_LE(told.size(), 2U) << d.text;
    EXPECT_NE(std::find(told.begin(), told.end(), "current_gain on wheel 1"), told.end()) << d.text;
    for (const std::string &name : told) EXPECT_TRUE(name.starts_with("current_gain on wheel ")) << name;
}

// One current tells what both wheels of a side pull: which of them it is stays open, and that is said.
TEST(DrivesLog, what_one_wheel_of_a_side_does_is_a_question_between_the_wheels_of_its_motor) {
    const Diagnosis d =
        diagnose(model_on("sand"), make_dataset(model_on("sand"), driven("sand", "rolling_resistance:coefficient=0.15,wheel=3")), {});
    ASSERT_EQ(d.classes.size(), 1U) << d.text;
    std::vector<std::string> members = d.classes[0].members;
    std::sort(members.begin(), members.end());
    EXPECT_EQ(members, (std::vector<std::string>{"rolling_resistance on wheel 1", "rolling_resistance on wheel 3"})) << d.text;
}

} // namespace
} // namespace traction::lab
