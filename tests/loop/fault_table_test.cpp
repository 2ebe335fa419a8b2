// The fault table of docs/firmware.md, row by row: each fault is injected into a rover that drives at 0.3 m/s, on level ground and up 5 and
// 10 degrees; it must be named within half a second (or the time its row states), by its own name and wheel, and answered as the row says.
#include "host_tools/simulate/simulate.h"

#include <algorithm>
#include <cstdint>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

using namespace traction;

namespace {

constexpr double from_s = 4.0; // the fault begins; the drive has been steady for two seconds
constexpr double degree = 3.14159265358979323846 / 180;

// which asks no estimate, and which does
const std::string by_wheels = "mode = \"wheel_speed\"\nwheel_speed_rad_s = 5.26\n",
                  by_ground = "mode = \"platform_speed\"\nspeed_m_s = 0.3\n";

enum class Answer { brake, drive_on };

struct Row {
    const char *name;
    std::string fault;
    std::uint32_t bits;   // what must be among the latched faults
    std::uint32_t wheels; // and whose they are; 0: the rover's
    double within_s = 0.5;
    Answer answer = Answer::brake;
    std::uint32_t also = 0; // what may come with it, later or in the same tick
};

std::string sensor(const std::string &what, const std::string &how, const std::string &more = "") {
    return "[[fault]]\nwhat = \"sensor\"\nsensor = \"" + what + "\"\nhow = \"" + how + "\"\nfrom_s = 4.0\n" + more;
}

std::vector<Row> table() {
    const std::string at = "\nfrom_s = 4.0\n";
    return {
        {"emergency stop", "[[fault]]\nwhat = \"emergency_stop\"" + at, FAULT_EMERGENCY_STOP, 0, 0.02},
        {"emergency stop unread", sensor("emergency_stop", "dropped"), FAULT_EMERGENCY_STOP, 0, 0.09},
        {"command lost", "[[fault]]\nwhat = \"command_lost\"" + at, FAULT_COMMAND_TIMEOUT, 0, 0.1},
        {"encoder silent", sensor("encoder", "dropped", "wheel = 2\n"), FAULT_ENCODER_LOST, 4, 0.1},
        {"encoder frozen", sensor("encoder", "stuck", "wheel = 1\n"), FAULT_ENCODER_CIRCUIT, 2},
        {"encoder slips by half", sensor("encoder", "slipping", "wheel = 0\nshare = 0.5\n"), FAULT_ENCODER_CIRCUIT, 1, 0.6},
        {"encoder absurd", sensor("encoder", "noisy", "wheel = 3\nnoise = 10000\n"), FAULT_ABSURD_SENSOR, 8, 0.5, Answer::brake,
         FAULT_ENCODER_LOST | FAULT_ENCODER_CIRCUIT},
        {"current silent", sensor("current", "timeout", "wheel = 3\n"), FAULT_CURRENT_LOST, 8, 0.1},
        {"current at its rail", sensor("current", "offset", "wheel = 1\noffset = 10\n"), FAULT_ABSURD_SENSOR, 2, 0.1, Answer::brake,
         FAULT_CURRENT_LOST | FAULT_OVER_CURRENT},
        {"motor open", "[[fault]]\nwhat = \"motor_open\"\nwheel = 2" + at, FAULT_MOTOR_OPEN, 4, 0.5, Answer::drive_on},
        {"bridge silent", sensor("bridge", "dropped", "wheel = 0\n"), FAULT_BRIDGE, 1, 0.1, Answer::brake},
        {"battery silent", sensor("battery", "dropped"), FAULT_BATTERY_LOST, 0, 0.1},
        {"battery low", "[[fault]]\nwhat = \"brown_out\"\nsag_V = 2.0" + at, FAULT_LOW_BATTERY, 0, 0.52},
        {"brown-out", "[[fault]]\nwhat = \"brown_out\"\nsag_V = 4.0" + at, FAULT_BROWN_OUT, 0, 0.05, Answer::brake, FAULT_LOW_BATTERY},
        {"accelerometer silent", sensor("accel", "dropped"), FAULT_ACCEL_LOST, 0, 0.1},
        {"gyro silent", sensor("gyro", "dropped"), FAULT_GYRO_LOST, 0, 0.1},
        {"radar silent", sensor("radar", "dropped"), FAULT_RADAR_LOST, 0, 0.1},
        {"radar stuck", sensor("radar", "stuck"), FAULT_RADAR_LOST, 0},
        {"radar front dead", sensor("radar", "dead", "noise = 0.5\n"), FAULT_RADAR_LOST, 0},
        {"ten ticks missed", "[[fault]]\nwhat = \"missed_ticks\"\nticks = 10" + at, FAULT_MISSED_TICKS, 0, 0.13},
    };
}

SimulationResult drive(const std::string &fault, double slope_deg, const std::string &mode, double duration_s = 7) {
    SimulateOptions options;
    options.truth = true;
    const std::string text = "duration_s = " + std::to_string(duration_s) +
                             "\nseed = 9\n[ground]\nsoil = \"concrete\"\nslope_rad = " + std::to_string(slope_deg * degree) +
                             "\n[[drive]]\nfor_s = 1.0\nmode = \"wheel_speed\"\nwheel_speed_rad_s = 0.0\n"
                             "[[drive]]\nfor_s = 60.0\n" +
                             mode;
    return simulate(sim::parse_scenario(text + fault, "row.toml"), options);
}

std::vector<std::pair<double, std::string>> drives() {
    std::vector<std::pair<double, std::string>> all;
    for (const double slope_deg : {0.0, 5.0, 10.0})
        for (const std::string &mode : {by_wheels, by_ground}) all.emplace_back(slope_deg, mode);
    return all;
}

} // namespace

TEST(FaultTable, every_row_is_named_in_its_time_and_answered_as_it_says_on_level_ground_and_on_slopes) {
    for (const auto &[slope_deg, mode] : drives()) {
        const auto healthy = drive("", slope_deg, mode);
        ASSERT_EQ(healthy.faults, 0u) << slope_deg << " deg, nothing injected";
        ASSERT_NEAR(healthy.truth.find("truth.speed_m_s")->value.back(), 0.3, 0.1) << slope_deg; // the bound of the closed loop on slopes
        for (const Row &row : table()) {
            const std::string where = std::string(row.name) + ", " + std::to_string(slope_deg) + " deg, " + mode;
            const auto result = drive(row.fault, slope_deg, mode);
            const log::Signal &faults = *result.log.find("control.faults"), &bridges = *result.log.find("actuator.drive");
            double named_s = 1e9;
            std::uint32_t first = 0;
            for (std::size_t k = 0; k < faults.value.size(); k++) {
                const auto bits = static_cast<std::uint32_t>(faults.value[k]);
                if (bits != 0 && first == 0) first = bits;
                if ((bits & row.bits) != 0 && named_s > 1e8) named_s = faults.t_s[k] - from_s;
            }
            EXPECT_GE(named_s, 0) << where;
            EXPECT_LE(named_s, row.within_s + 1e-6) << where;
            EXPECT_EQ(first & ~(row.bits | row.also), 0u) << where << ": first " << first; // its own name, and no other before it
            const log::Signal *wheels = result.log.find("control.fault_wheels");
            EXPECT_EQ(wheels == nullptr ? 0u : static_cast<std::uint32_t>(wheels->value.back()) & row.wheels, row.wheels) << where;
            EXPECT_EQ(bridges.value.back(), row.answer == Answer::brake ? 2.0 : 3.0) << where;
            const double speed_m_s = result.truth.find("truth.speed_m_s")->value.back();
            if (row.answer == Answer::brake) {
                // shorted windings hold all but m g sin - 4 t0/R: (4.9 - 2.1) N over 4 KG ke/(Ra R^2) = 26.7 N s/m at 10 deg
                EXPECT_GT(speed_m_s, -0.12) << where;
                EXPECT_LT(speed_m_s, 0.02) << where;
            } else {
                EXPECT_GT(speed_m_s, 0.2) << where;
            }
            for (int wheel = 0; wheel < 4; wheel++) { // a limit of nobody is full duty while the fault goes unnamed
                const auto &duty = result.log.find("wheel" + std::to_string(wheel) + ".duty")->value;
                for (std::size_t k = 399; k < duty.size(); k++) ASSERT_LT(std::fabs(duty[k]), 0.999) << where << " wheel " << wheel;
            }
        }
    }
}

TEST(FaultTable, an_emergency_stop_on_a_slope_brakes_instead_of_rolling_away) {
    const auto result = drive("[[fault]]\nwhat = \"emergency_stop\"\nfrom_s = 4.0\n", 6.875, by_wheels, 9); // 0.12 rad
    const auto &speed = result.truth.find("truth.speed_m_s")->value;
    double least = 1;
    for (std::size_t k = 500; k < speed.size(); k++) least = std::min(least, speed[k]);
    // (m g sin(0.12) - 4 t0/R)/(4 KG ke/(Ra R^2)) = (3.38 - 2.11) N/26.7 N s/m = 0.048 m/s; it coasted at 0.41 m/s after 2 s, and faster
    EXPECT_GT(least, -0.06);
}
