// drive_plan.h - what the rover is asked to do, over time: segments of any control mode with constant, ramped or waving references.
//
// Knows nothing of the firmware: the caller turns a Demand into the firmware's command.
#pragma once

#include "sim/plant/truth.h"

#include <array>
#include <string_view>
#include <vector>

namespace traction::sim {

// start + (end - start) u, u = 0..1 over the segment, plus amplitude sin(2 pi t/period), t from the segment's start.
struct Reference {
    double start = 0, end = 0, amplitude = 0, period_s = 1;
    double at(double t_s, double length_s) const;
};

enum class DriveMode { stop, open_loop, wheel_speed, platform_speed, slip, soil_sweep };
inline constexpr std::array<std::string_view, 6> drive_mode_names{"stop",           "open_loop", "wheel_speed",
                                                                  "platform_speed", "slip",      "soil_sweep"};

struct DriveSegment {
    double from_s = 0, to_s = 0;
    DriveMode mode = DriveMode::stop;
    Reference speed_m_s, yaw_rate_rad_s, slip;
    std::array<Reference, wheel_count> wheel_speed_rad_s, duty;
    std::array<bool, wheel_count> slip_wheel{};
};

struct Demand {
    DriveMode mode = DriveMode::stop;
    double speed_m_s = 0, yaw_rate_rad_s = 0, slip = 0;
    std::array<double, wheel_count> wheel_speed_rad_s{}, duty{};
    std::array<bool, wheel_count> slip_wheel{};
};

// What is asked at t_s: the segment that holds it, or stop where there is none.
Demand demand_at(const std::vector<DriveSegment> &plan, double t_s);

} // namespace traction::sim
