// The firmware of four wheels on rovers of one, two and six: scenarios of the repository, in lockstep with the plant, on hard and on soft
// ground. The bounds on the speed are those that loop_test has for four wheels.
#include "host_tools/check/check.h"
#include "host_tools/replay/replay_log.h"
#include "host_tools/rover/rover.h"
#include "host_tools/simulate/simulate.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

using namespace traction;

namespace {

sim::Scenario scenario_of(const std::string &name, const std::string &soil = "", sim::ContactLaw contact = sim::ContactLaw::aggregated) {
    sim::Scenario scenario = sim::read_scenario(std::string(TRACTION_ROOT) + "/scenarios/" + name + ".toml");
    if (!soil.empty()) scenario.plant.ground.soil = *sim::find_soil(soil);
    scenario.plant.ground.contact = contact;
    return scenario;
}

SimulationResult run(const sim::Scenario &scenario, std::uint64_t seed = 1) {
    SimulateOptions options;
    options.seed = seed;
    options.truth = true;
    return simulate(scenario, options);
}

double mean(
    const log::Log &log, const std::string &name, double from_s, double to_s,
    const std::function<double(double)> &of = [](double x) { return x; }) {
    const log::Signal &signal = *log.find(name);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < signal.t_s.size(); i++)
        if (signal.t_s[i] > from_s && signal.t_s[i] <= to_s) sum += of(signal.value[i]), count++;
    return sum / count;
}

std::string message_of(const std::function<void()> &call) {
    try {
        call();
    } catch (const sim::ScenarioError &error) {
        return error.what();
    }
    return "accepted";
}

const char *const names[] = {"six_wheels", "two_wheels", "bench_carriage", "two_motors", "ackermann"};

// A speed of 0.3 m/s ahead from 5 to 10 s in all of them.
TEST(Wheels, every_rover_holds_its_speed_on_hard_and_soft_ground_without_a_fault) {
    for (const std::string name : names)
        for (const std::string soil : {"concrete", "sand"})
            for (const sim::ContactLaw contact : {sim::ContactLaw::aggregated, sim::ContactLaw::bekker}) {
                if (soil == "concrete" && contact != sim::ContactLaw::aggregated) continue; // it has no other
                sim::Scenario scenario = scenario_of(name, soil, contact);
                if (contact == sim::ContactLaw::bekker) scenario.plant.rover.layout.drawbar_N *= 0.2; // what that sand bears
                const SimulationResult result = run(scenario);
                const std::string what = name + ' ' + soil + ' ' + std::to_string(static_cast<int>(contact));
                EXPECT_EQ(result.faults, 0u) << what;
                EXPECT_NEAR(mean(result.truth, "truth.speed_m_s", 5, 10), 0.3, 0.3 * 0.045) << what;
                const auto off = [](double v) { return (v - 0.3) * (v - 0.3); };
                EXPECT_LT(std::sqrt(mean(result.truth, "truth.speed_m_s", 5, 10, off)), 0.03) << what;
                EXPECT_LT(std::sqrt(mean(result.log, "estimate.speed_m_s", 5, 10, off)), 0.036) << what;
                if (name != "bench_carriage") {
                    EXPECT_NEAR(mean(result.truth, "truth.speed_m_s", 18.5, 20.9), -0.3, 0.3 * 0.06) << what;
                }
            }
}

TEST(Wheels, a_middle_wheel_follows_its_side) {
    const SimulationResult result = run(scenario_of("six_wheels"));
    const log::Log &truth = result.truth;
    for (int side = 0; side < 2; side++) {
        const auto value = [&](int wheel) { return truth.find("truth.wheel" + std::to_string(wheel) + ".duty")->value; };
        const auto middle = value(4 + side), rear = value(side), front = value(2 + side);
        ASSERT_EQ(middle.size(), rear.size());
        for (std::size_t i = 0; i < middle.size(); i++) EXPECT_NEAR(middle[i], 0.5 * (rear[i] + front[i]), 2e-9); // as written: 1e-9
        EXPECT_GT(mean(truth, "truth.wheel" + std::to_string(4 + side) + ".current_A", 5, 10), 0.1) << "it pulls";
    }
    EXPECT_EQ(result.log.find("wheel4.duty"), nullptr); // the firmware knows four wheels
    EXPECT_EQ(result.log.header.at("rover.wheels"), "6");
}

TEST(Wheels, what_a_rover_has_not_is_neither_logged_nor_waited_for_nor_driven) {
    for (const auto &[name, wheels] : {std::pair{"two_wheels", 2}, {"bench_carriage", 1}, {"two_motors", 2}}) {
        const SimulationResult result = run(scenario_of(name));
        for (int wheel = 0; wheel < 4; wheel++)
            for (const char *signal : {".speed_rad_s", ".current_A", ".duty", ".slip"})
                EXPECT_EQ(result.log.find("wheel" + std::to_string(wheel) + signal) != nullptr, wheel < wheels) << name << wheel << signal;
        const unsigned present = static_cast<unsigned>(result.log.find("frame.present")->value.back());
        EXPECT_EQ(present & 0xfu, (1u << static_cast<unsigned>(wheels)) - 1) << name; // encoders
        const check::Report report = check::check(result.log, {});
        EXPECT_TRUE(report.passed()) << name;
    }
}

// The firmware is told which wheels there are; it does not conclude it from silence: a wheel that falls silent is still a fault.
TEST(Wheels, a_wheel_that_it_has_and_that_falls_silent_is_a_fault) {
    sim::Scenario scenario = scenario_of("two_wheels");
    scenario.sensor_faults.push_back(
        {.sensor = sim::FaultySensor::encoder, .wheel = 1, .kind = sim::FaultKind::dropped, .from_s = 6.0, .to_s = 30.0});
    EXPECT_NE(run(scenario).faults & FAULT_ENCODER_LOST, 0u);
    sim::Scenario deaf = scenario_of("two_wheels"); // told while every wheel turns: the two that there are
    deaf.sensor_faults.push_back({.sensor = sim::FaultySensor::radar, .kind = sim::FaultKind::dead, .from_s = 6.0, .to_s = 30.0});
    EXPECT_NE(run(deaf).faults & FAULT_RADAR_LOST, 0u);
    sim::Scenario blind = scenario_of("two_wheels");
    blind.firmware.believes = sim::RoverDescription(); // it takes itself for a rover of four
    EXPECT_NE(run(blind).faults & FAULT_ENCODER_LOST, 0u);
    sim::Scenario stuck = scenario_of("two_wheels");
    stuck.open_motors.push_back({0, 6.0, 30.0});
    EXPECT_NE(run(stuck).faults & FAULT_MOTOR_OPEN, 0u);
}

TEST(Wheels, the_self_test_pulses_the_wheels_that_are_there) {
    for (const std::string name : names) {
        sim::Scenario scenario = scenario_of(name, "concrete");
        scenario.plant.rover.layout.drawbar_N = 0; // the test wants a rover at rest
        SimulateOptions options;
        options.self_test = true;
        const SimulationResult result = simulate(scenario, options);
        EXPECT_TRUE(result.self_test.done) << name;
        EXPECT_EQ(result.self_test.failures, 0u) << name;
    }
}

TEST(Wheels, a_run_repeats_and_its_log_replays_bit_for_bit) {
    for (const std::string name : {"six_wheels", "two_wheels", "bench_carriage", "two_motors", "ackermann", "rocker_bogie"}) {
        const SimulationResult first = run(scenario_of(name)), again = run(scenario_of(name));
        EXPECT_EQ(first.trace_hash, again.trace_hash) << name;
        const replay::Comparison same = replay::replay_log(first.log, replay::logged_ticks(first.log));
        EXPECT_GT(same.ticks, 1000u) << name;
        EXPECT_EQ(same.differing, 0u) << name << ' ' << same.first_signal;
    }
}

// The firmware takes a quarter of its mass for a wheel's load; a wheel of each of these rovers bears 7.06 N, as the reference's do.
TEST(Wheels, the_firmware_is_told_the_load_of_a_wheel_and_which_there_are) {
    const control_config_t reference = rover_config_default();
    for (const auto &[name, mask, share] : {std::tuple{"six_wheels", 15u, 0.25f}, {"two_wheels", 3u, 0.5f}, {"bench_carriage", 1u, 1.0f}}) {
        const control_config_t config = firmware_config(scenario_of(name).rover);
        EXPECT_EQ(config.geometry.wheels, mask) << name;
        EXPECT_EQ(config.geometry.wheel_share, share) << name;
        EXPECT_NEAR(config.geometry.mass_kg, 2.88f, 1e-5f) << name;
        EXPECT_NEAR(config.safety.stall_current_A, reference.safety.stall_current_A, 1e-4f) << name;
    }
    const control_config_t sides = firmware_config(scenario_of("two_motors").rover); // each motor bears half the rover
    EXPECT_EQ(sides.geometry.wheels, 3u);
    EXPECT_EQ(sides.geometry.wheel_share, 0.5f);
    EXPECT_NEAR(sides.geometry.mass_kg, 2 * 2.88f, 1e-5f); // a quarter of it is that half
    sim::RoverDescription uneven = scenario_of("two_wheels").rover;
    uneven.wheel[0].radius_m = 0.055, uneven.wheel[1].radius_m = 0.061, uneven.wheel[2].radius_m = 0.2; // the third is not there
    EXPECT_NEAR(firmware_config(uneven).geometry.wheel_radius_m, 0.058f, 1e-7f);
    EXPECT_EQ(sim::wheel_differences(uneven).size(), 2u);
}

// Round the bend from 10 to 13 s: curvature 0.4/0.3 a metre, tan delta = 0.32 k/(1 -+ 0.11 k).
TEST(Wheels, a_rover_that_steers_goes_round_its_bend_and_is_told_its_wheels_slip) {
    const SimulationResult result = run(scenario_of("ackermann"));
    EXPECT_EQ(result.faults, 0u);
    const log::Log &truth = result.truth;
    const double k = 0.4 / 0.3;
    EXPECT_NEAR(mean(truth, "truth.wheel2.steer_rad", 11.5, 13), std::atan(0.32 * k / (1 - 0.11 * k)), 1e-4);
    EXPECT_NEAR(mean(truth, "truth.wheel3.steer_rad", 11.5, 13), std::atan(0.32 * k / (1 + 0.11 * k)), 1e-4);
    EXPECT_EQ(truth.find("truth.wheel0.steer_rad"), nullptr);
    EXPECT_NEAR(mean(result.log, "actuator.curvature_1_m", 11.5, 13), k, 1e-5);
    const log::Signal &yaw = *truth.find("truth.yaw_rad");
    const double turned = yaw.value[1299] - yaw.value[1149]; // 11.5 to 13 s
    const double path = mean(truth, "truth.speed_m_s", 11.5, 13) * 1.5;
    // side slip of the centripetal force on (20): below 0.1 N a wheel of 5 N, s = 0.02 sc 2 = 0.01, of both axles alike: 3 % of the
    // curvature
    EXPECT_NEAR(turned / path, k, 0.03 * k);
    for (int wheel = 0; wheel < 4; wheel++) {
        const std::string name = "wheel" + std::to_string(wheel);
        // what the speed estimate may be off by (4.5 %, above) is off in every slip; a firmware that took its wheels to be fixed would read
        // (sqrt(0.256^2 + 0.128^2) - 0.256)/0.286 = 0.10 more at the inner front wheel
        EXPECT_NEAR(mean(result.log, name + ".slip", 11.5, 13), mean(truth, "truth." + name + ".slip", 11.5, 13), 0.045) << name;
    }
    EXPECT_EQ(result.log.header.at("rover.steering"), "front");
    // the lab: no model has such wheels
    EXPECT_THROW((void)model_text(scenario_of("ackermann").rover, "sand"), std::invalid_argument);
    check::Machine machine;
    machine.wheel_y_m = {0.11, -0.11, 0.11, -0.11};
    const check::Report report = check::check(result.log, {}, machine);
    EXPECT_FALSE(report.passed());
    EXPECT_TRUE(check::check(result.log, {}).passed());
    EXPECT_EQ(run(scenario_of("cruise")).log.find("actuator.curvature_1_m"), nullptr);
}

TEST(Wheels, on_rockers_every_wheel_keeps_its_load_over_rough_ground_and_an_edge) {
    const SimulationResult result = run(scenario_of("rocker_bogie"));
    EXPECT_EQ(result.faults, 0u);
    const log::Log &truth = result.truth;
    double widest = 0, off = 0;
    const auto &left = truth.find("truth.rocker0_rad")->value, &right = truth.find("truth.rocker1_rad")->value;
    for (std::size_t i = 0; i < left.size(); i++)
        widest = std::max(widest, std::fabs(left[i])), off = std::max(off, std::fabs(left[i] + right[i]));
    EXPECT_GT(widest, 0.02);
    EXPECT_LT(off, 2e-3); // the body's pitch is their mean
    EXPECT_GT(*std::max_element(truth.find("truth.z_m")->value.begin(), truth.find("truth.z_m")->value.end()) -
                  truth.find("truth.z_m")->value.front(),
              0.02); // it got up
    for (int wheel = 0; wheel < 6; wheel++) {
        double lifted = 0, ticks = 0;
        for (const double load : truth.find("truth.wheel" + std::to_string(wheel) + ".normal_N")->value) lifted += load <= 0, ticks++;
        EXPECT_LT(lifted, 0.01 * ticks) << wheel; // off an edge it may drop, for a few hundredths of a second
        EXPECT_NEAR(mean(truth, "truth.wheel" + std::to_string(wheel) + ".normal_N", 0, 2), 4.32 * 9.81 / 6, 0.2 * 4.32 * 9.81 / 6)
            << wheel;
    }
}

TEST(Wheels, a_steering_or_a_suspension_that_cannot_work_is_refused_by_its_key) {
    const auto told = [](const std::string &rover, const std::string &top = "") {
        const std::string text = top + "duration_s = 1.0\n[rover]\n" + rover + "\n[[drive]]\nfor_s = 1.0\nmode = \"stop\"\n";
        return message_of([&] { (void)sim::parse_scenario(text, "test.toml"); });
    };
    const auto has = [](const std::string &message, const char *what) { return message.find(what) != std::string::npos; };
    EXPECT_EQ(told("[rover.steering]\nfront = 1"), "accepted");
    EXPECT_EQ(told("[rover.steering]\nfront = 1\nrear = 1\n[rover.layout]\nwheels = 6"), "accepted");
    EXPECT_TRUE(has(told("[rover.steering]\nfront = 1\n[rover.layout]\nwheels = 6"), "steering.front"));
    EXPECT_TRUE(has(told("[rover.steering]\nfront = 1\n[rover.layout]\nwheels = 1"), "steering.front"));
    EXPECT_TRUE(has(told("[rover.steering]\nfront = 1\n[rover.layout]\ndrives = [0, 1]"), "chain"));
    EXPECT_TRUE(has(told("[rover.steering]\nackermann = 0.5"), "no axle steers"));
    EXPECT_TRUE(has(told("[rover.steering]\nfront = 0.5"), "steering.front"));
    EXPECT_TRUE(has(told("[rover.steering]\nfront = 1", "bus = \"can\"\n"), "bus = can"));
    const std::string links =
        "[rover.layout]\nwheels = 6\nrocker = 1\nrocker_height_m = 0.1\nrocker_kg = 0.3\nbogie_height_m = 0.08\nbogie_kg = 0.4\n";
    EXPECT_EQ(told(links + "bogie_m = -0.04"), "accepted");
    EXPECT_EQ(told(links + "bogie_front = 1\nbogie_m = 0.04"), "accepted");
    EXPECT_EQ(told("[rover.layout]\nrocker = 1\nrocker_height_m = 0.1\nrocker_kg = 0.3"), "accepted");
    EXPECT_TRUE(has(told(links), "layout.bogie_m"));
    EXPECT_TRUE(has(told(links + "bogie_m = 0.04"), "not between the bogie's wheels"));
    EXPECT_TRUE(has(told(links + "bogie_m = -0.04\nrocker_m = 0.2"), "layout.rocker_m"));
    EXPECT_TRUE(has(told(links + "bogie_m = -0.04\nrigid = 1"), "layout.rigid"));
    EXPECT_TRUE(has(told("[rover.layout]\nbogie_m = 0.1"), "layout.bogie_m"));
    EXPECT_TRUE(has(told("[rover.layout]\nrocker = 1\nrocker_height_m = 0.1\nrocker_kg = 1.4"), "layout.rocker_kg"));
}

TEST(Wheels, a_layout_that_cannot_work_is_refused_by_its_key) {
    const std::string start = "duration_s = 1.0\n[rover]\n[rover.layout]\n", end = "\n[[drive]]\nfor_s = 1.0\nmode = \"stop\"\n";
    const auto told = [&](const std::string &layout, const std::string &more = "") {
        return message_of([&] { (void)sim::parse_scenario(start + layout + more + end, "test.toml"); });
    };
    EXPECT_NE(told("wheels = 3").find("test.toml:4: layout.wheels = 3.0: no such rover"), std::string::npos) << told("wheels = 3");
    EXPECT_NE(told("wheels = 2").find("layout.axle_m"), std::string::npos);
    EXPECT_NE(told("wheels = 2\naxle_m = 0.1\ncaster_m = 0.05").find("tips over"), std::string::npos);
    EXPECT_NE(told("wheels = 6\nmiddle_m = 0.09").find("layout.middle_m"), std::string::npos); // half a wheelbase is 0.083
    EXPECT_NE(told("wheels = 6\ndrawbar_N = 1").find("layout.drawbar_N"), std::string::npos);
    EXPECT_NE(told("middle_m = 0.01").find("means nothing for a rover of 4 wheels"), std::string::npos);
    EXPECT_NE(told("rigid = 0.5").find("layout.rigid"), std::string::npos);
    EXPECT_EQ(told("wheels = 6\nmiddle_m = -0.02\nrigid = 1"), "accepted");
    EXPECT_EQ(told("drives = [1, 0]"), "accepted");
    EXPECT_EQ(told("wheels = 6\ndrives = [2, 3]"), "accepted");
    EXPECT_NE(told("drives = [0, 2]").find("test.toml:4: rover.layout.drives"), std::string::npos) << told("drives = [0, 2]");
    EXPECT_NE(told("drives = [0, 2]").find("two motors on one side"), std::string::npos) << told("drives = [0, 2]");
    EXPECT_NE(told("drives = [0]").find("not a list of two wheels"), std::string::npos) << told("drives = [0]");
    EXPECT_NE(told("drives = [0, 5]").find("no wheel of 0 to 3"), std::string::npos) << told("drives = [0, 5]");
    EXPECT_NE(told("wheels = 1\ndrives = [0, 1]").find("means nothing for a rover of 1 wheel"), std::string::npos);
    const std::string wire = "\n[[fault]]\nwhat = \"motor_open\"\nwheel = 2\nfrom_s = 0.1\nto_s = 0.2\n";
    EXPECT_NE(told("drives = [0, 1]", wire).find("this wheel has no motor: it turns with wheel 0"), std::string::npos)
        << told("drives = [0, 1]", wire);
    const std::string friction = "\n[[effect]]\nname = \"coulomb_friction\"\nwheel = 3\ntorque_Nm = 0.05\n";
    EXPECT_NE(told("drives = [0, 1]", friction).find("it turns with wheel 1"), std::string::npos) << told("drives = [0, 1]", friction);
    EXPECT_EQ(told("drives = [0, 1]", "\n[[effect]]\nname = \"wheel_radius\"\nwheel = 3\nchange = 0.01\n"), "accepted");
    const std::string fault = "\n[[fault]]\nwhat = \"wheel_blocked\"\nwheel = 2\nfrom_s = 0.1\nto_s = 0.2\n";
    EXPECT_NE(told("wheels = 1", fault).find("the rover has no such wheel"), std::string::npos) << told("wheels = 1", fault);
    EXPECT_EQ(told("wheels = 6", fault), "accepted");
    const std::string can = message_of([&] { (void)sim::parse_scenario("bus = \"can\"\n" + start + "wheels = 6" + end, "test.toml"); });
    EXPECT_NE(can.find("bus = can"), std::string::npos) << can;
    // not in the file alone: on the command line, too
    SimulateOptions more;
    more.effects = {sim::parse_effect("wheel_radius:change=0.01,wheel=3")};
    EXPECT_NE(message_of([&] { (void)simulate(scenario_of("two_wheels"), more); }).find("the rover has no such wheel"), std::string::npos);
    SimulateOptions hide;
    hide.hide = sim::HiddenDraw{};
    EXPECT_NE(message_of([&] { (void)simulate(scenario_of("two_wheels"), hide); }).find("four wheels alone"), std::string::npos);
    EXPECT_THROW((void)model_text(scenario_of("six_wheels").rover, "sand"), std::invalid_argument); // the lab has four
}

} // namespace
