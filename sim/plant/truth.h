// truth.h - what really happens in the simulated world at one instant. Sensors turn it into measurements; nothing else reads it.
//
// World frame: x, y horizontal, z up, right-handed. Body frame: x forward, y left, z up, origin at the centre of mass.
#pragma once

#include "layout.h"

#include <array>
#include <cstddef>

namespace traction::sim {

inline constexpr int wheel_count = 4; // that the firmware knows

struct WheelTruth {
    double angle_rad = 0;         // wheel side of the gear, cumulative
    double speed_rad_s = 0;       // wheel side of the gear
    double motor_angle_rad = 0;   // motor side, divided by the gear ratio; differs from angle_rad by the backlash
    double motor_speed_rad_s = 0; // motor side, divided by the gear ratio
    double current_A = 0;         // winding current, signed
    double duty = 0;              // as applied by the bridge, -1..1
    double traction_N = 0;        // Ft of (2), along the wheel's heading, on the rover
    double rolling_N = 0;         // Rr of (2), >= 0
    double rolling_share = 0;     // how much of it acts: 1 rolling ahead, -1 back, between at rest, where it holds
    double lateral_N = 0;         // on the rover, along the wheel's axle, to the left
    double steer_rad = 0;         // the wheel's heading against the body's, to the left positive: steering.h
    double normal_N = 0;          // Fn, >= 0
    double slip = 0;              // slip state, (1) extended
    double sinkage_m = 0;
    double ground_speed_m_s = 0; // v of (1): speed of the wheel's centre along its heading
    double winding_temperature_C = 25;
};

struct Truth {
    double t_s = 0;
    std::array<double, 3> position_m{};                      // world
    std::array<double, 4> orientation{1, 0, 0, 0};           // body to world, unit quaternion w x y z
    std::array<double, 3> v_body_m_s{};                      // body frame
    std::array<double, 3> rate_body_rad_s{};                 // body frame
    std::array<double, 3> specific_force_m_s2{};             // body frame: acceleration minus gravity, what an ideal accelerometer feels
    double yaw_rad = 0;                                      // continuous, not wrapped
    double pitch_rad = 0;                                    // nose down positive (rotation about +y)
    double roll_rad = 0;                                     // right side down positive (rotation about +x)
    double joint_rad = 0;                                    // right half (or rocker) against the left one, nose down positive
    std::array<double, 2> rocker_rad{}, bogie_rad{};         // left and right, against the body and against the rocker, nose down positive
    double rise_rate_rad_s = 0;                              // how fast the ground's own rise changes under the rover: nose up positive
    double path_m = 0;                                       // arc length travelled by the body, signed along x
    double battery_voltage_V = 0;                            // at the terminals, under load
    std::array<WheelTruth, wheel_count> wheel;               // the firmware's; one that a rover does not have stays 0
    std::array<WheelTruth, wheel_most - wheel_count> beyond; // a middle axle's, or a caster: layout.h

    WheelTruth &slot(int i) {
        const auto n = static_cast<std::size_t>(i);
        return n < wheel.size() ? wheel[n] : beyond[n - wheel.size()];
    }
    const WheelTruth &slot(int i) const {
        const auto n = static_cast<std::size_t>(i);
        return n < wheel.size() ? wheel[n] : beyond[n - wheel.size()];
    }
};

} // namespace traction::sim
