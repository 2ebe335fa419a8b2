// The table of reactions of docs/can.md, row by row: a rover on a CAN bus drives at 0.3 m/s on concrete, and from 4 s on the bus fails.
#include "host_tools/simulate/simulate.h"

#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace traction;

namespace {

constexpr double from_s = 4.0;
constexpr std::uint32_t wheel_lost = FAULT_ENCODER_LOST | FAULT_CURRENT_LOST | FAULT_BRIDGE;
constexpr std::uint32_t sensors_lost = FAULT_BATTERY_LOST | FAULT_ACCEL_LOST | FAULT_GYRO_LOST | FAULT_RADAR_LOST | FAULT_EMERGENCY_STOP;

SimulationResult drive(const std::string &top, const std::string &fault, const std::string &soil = "concrete", std::uint64_t seed = 9) {
    SimulateOptions options;
    options.truth = true;
    options.seed = seed;
    return simulate(
        sim::parse_scenario(top + "duration_s = 6\n[ground]\nsoil = \"" + soil +
                                "\"\n[[drive]]\nfor_s = 1.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = 0.0\n[[drive]]\nfor_s = "
                                "60.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = 5.26\n" +
                                fault,
                            "row.toml"),
        options);
}

std::string can(const std::string &how, const std::string &node, const std::string &more = "") {
    return "[[fault]]\nwhat = \"can\"\nhow = \"" + how + "\"\nnode = \"" + node + "\"\nfrom_s = 4.0\n" + more;
}

// Largest current of a wheel's winding from t_s on.
double current_A(const SimulationResult &result, int wheel, double t_s) {
    const log::Signal &current = *result.truth.find("truth.wheel" + std::to_string(wheel) + ".current_A");
    double largest = 0;
    for (std::size_t k = 0; k < current.value.size(); k++)
        if (current.t_s[k] > t_s + 1e-6) largest = std::max(largest, std::fabs(current.value[k]));
    return largest;
}

// When one of `bits` was latched first, after from_s; 1e9 never.
double named_s(const SimulationResult &result, std::uint32_t bits) {
    const log::Signal &faults = *result.log.find("control.faults");
    for (std::size_t k = 0; k < faults.value.size(); k++)
        if ((static_cast<std::uint32_t>(faults.value[k]) & bits) == bits) return faults.t_s[k] - from_s;
    return 1e9;
}

double last_drive(const SimulationResult &result) { return result.log.find("actuator.drive")->value.back(); }
double last_speed(const SimulationResult &result) { return result.truth.find("truth.speed_m_s")->value.back(); }

const std::string on_can = "bus = \"can\"\n";

} // namespace

TEST(can_rover, without_a_fault_drives_bit_for_bit_as_a_rover_that_is_wired_directly) {
    for (const char *soil : {"concrete", "gravel", "sand"})
        for (const std::uint64_t seed : {1u, 2u}) {
            for (const std::string effect : {"", "[[effect]]\nname = \"actuation_delay\"\ndelay_s = 0.027\n"}) {
                const auto direct = drive("", effect, soil, seed), bus = drive(on_can, effect, soil, seed);
                EXPECT_EQ(direct.trace_hash, bus.trace_hash) << soil << ' ' << seed << effect;
                EXPECT_EQ(direct.truth.find("truth.x_m")->value, bus.truth.find("truth.x_m")->value);
                EXPECT_EQ(direct.ticks, 600u);
            }
        }
}

TEST(can_rover, what_comes_twice_changes_nothing) {
    const auto healthy = drive(on_can, ""), doubled = drive(on_can, can("duplicated", "all", "share = 1.0\n"));
    EXPECT_EQ(healthy.trace_hash, doubled.trace_hash);
    EXPECT_EQ(healthy.faults, 0u);
}

TEST(can_rover, a_bus_that_loses_spoils_or_delays_a_tenth_of_its_frames_is_driven_on) {
    for (const char *how : {"lost", "corrupted", "late"}) {
        const auto result = drive(on_can, can(how, "all", "share = 0.1\n"));
        EXPECT_EQ(result.faults, 0u) << how;
        EXPECT_EQ(result.ended_by, HAL_END) << how;
        EXPECT_NEAR(last_speed(result), 0.3, 0.03) << how; // as without a fault, and a tenth of it
    }
}

TEST(can_rover, a_burst_shorter_than_the_patience_is_driven_through_and_a_longer_one_stops) {
    for (const char *to : {"to_s = 4.03\n", "to_s = 4.055\n"}) { // six ticks: beyond the bridges' release
        const auto result = drive(on_can, can("lost", "all", std::string("share = 1.0\n") + to));
        EXPECT_EQ(result.faults, 0u) << to;
        EXPECT_NEAR(last_speed(result), 0.3, 0.03) << to;
    }
    const auto result = drive(on_can, can("lost", "all", "share = 1.0\nto_s = 4.1\n"));
    EXPECT_LE(named_s(result, wheel_lost | sensors_lost), 0.08 + 1e-6);
    EXPECT_EQ(last_drive(result), 2.0); // brake, and the nodes hear it again
    EXPECT_NEAR(last_speed(result), 0, 0.02);
}

TEST(can_rover, a_dead_bus_releases_every_bridge_in_fifty_milliseconds_and_is_named_in_eighty) {
    for (const std::string &fault :
         {can("lost", "all", "share = 1.0\n"), can("corrupted", "all", "share = 1.0\n"), can("silent", "computer")}) {
        const auto result = drive(on_can, fault);
        EXPECT_LE(named_s(result, wheel_lost | sensors_lost), 0.08 + 1e-6) << fault;
        for (int wheel = 0; wheel < 4; wheel++) {
            EXPECT_GT(current_A(result, wheel, 3.9), 0.05) << fault;                 // it was driven
            EXPECT_EQ(current_A(result, wheel, from_s + 0.05 + 0.01), 0.0) << fault; // the last order may be a tick old
        }
        EXPECT_EQ(result.ended_by, HAL_END);
    }
}

TEST(can_rover, answers_that_are_always_late_are_no_answers_and_the_rover_brakes) {
    const auto result = drive(on_can, can("late", "wheel1", "share = 1.0\n"));
    EXPECT_LE(named_s(result, wheel_lost), 0.08 + 1e-6);
    EXPECT_EQ(result.log.find("control.fault_wheels")->value.back(), 2);
    EXPECT_EQ(last_drive(result), 2.0);
    EXPECT_NEAR(last_speed(result), 0, 0.02);
    EXPECT_GT(current_A(result, 1, from_s + 0.1), 0.01); // it hears its orders, and brakes too
}

TEST(can_rover, a_silent_wheel_node_lets_its_own_wheel_go_and_the_others_brake) {
    for (int wheel = 0; wheel < 4; wheel++)
        for (const char *how : {"silent", "bus_off"}) {
            const auto result = drive(on_can, can(how, "wheel" + std::to_string(wheel)));
            EXPECT_LE(named_s(result, wheel_lost), 0.08 + 1e-6) << wheel;
            EXPECT_EQ(result.faults & ~wheel_lost, 0u) << wheel;
            EXPECT_EQ(result.log.find("control.fault_wheels")->value.back(), 1 << wheel);
            EXPECT_EQ(current_A(result, wheel, from_s + 0.05 + 0.01), 0.0) << wheel; // let go, for good
            EXPECT_EQ(last_drive(result), 2.0);
            EXPECT_GT(current_A(result, (wheel + 1) % 4, from_s + 0.1), 0.01) << wheel; // a shorted winding that still turned
            EXPECT_NEAR(last_speed(result), 0, 0.02) << wheel;
        }
}

TEST(can_rover, a_silent_sensor_node_is_every_one_of_its_sensors_lost_and_the_stop_line_pressed) {
    const auto result = drive(on_can, can("silent", "sensors"));
    EXPECT_LE(named_s(result, sensors_lost), 0.08 + 1e-6);
    EXPECT_EQ(result.faults, sensors_lost);
    EXPECT_EQ(last_drive(result), 2.0);
    EXPECT_NEAR(last_speed(result), 0, 0.02);
}

TEST(can_rover, a_computer_off_the_bus_for_three_ticks_drives_on_and_for_five_ends_the_run_with_the_motors_off) {
    const auto brief = drive(on_can, can("bus_off", "computer", "to_s = 4.03\n"));
    EXPECT_EQ(brief.faults, 0u);
    EXPECT_EQ(brief.ended_by, HAL_END);
    EXPECT_NEAR(last_speed(brief), 0.3, 0.03);
    const auto lost = drive(on_can, can("bus_off", "computer"));
    EXPECT_EQ(lost.ended_by, HAL_ERR_TIMEOUT);
    EXPECT_LE(static_cast<double>(lost.ticks), 400 + 5);
}

TEST(can_rover, every_fault_of_the_bus_repeats_with_its_seed) {
    const std::string fault = can("corrupted", "all", "share = 0.3\n");
    EXPECT_EQ(drive(on_can, fault).trace_hash, drive(on_can, fault).trace_hash);
    EXPECT_NE(drive(on_can, fault).trace_hash, drive(on_can, fault, "concrete", 10).trace_hash);
}

TEST(can_rover, a_fault_of_a_bus_that_is_not_there_is_refused_with_file_and_line) {
    try {
        drive("", can("lost", "all", "share = 1.0\n"));
        FAIL();
    } catch (const sim::ScenarioError &error) {
        EXPECT_GT(error.line, 0u);
        EXPECT_NE(std::string(error.what()).find("write bus = \"can\" at the top"), std::string::npos) << error.what();
    }
    EXPECT_THROW(drive("bus = \"flexray\"\n", ""), sim::ScenarioError);
    EXPECT_THROW(drive(on_can, can("lost", "all")), sim::ScenarioError); // without its share
    EXPECT_THROW(drive(on_can, can("lost", "wheel4", "share = 1.0\n")), sim::ScenarioError);
}
