// outdoors_ground.h - rows of outdoors_bench that vary what both generators of echoes hold fixed: the radar's mounting, the echo's power,
// kerbs, starts, turns on the spot, speeds at both ends of the band, an accelerometer that warms up.
#pragma once

#include "tests/bench/outdoors.h"

#include <cstdint>
#include <string>
#include <vector>

namespace outdoors {

struct Row {
    std::string group;
    Case what;
    double fault_by_s = -1;  // a fault is an answer when it comes by then
    std::uint32_t right = 0; // faults that are the truth: wheels that stand or push against the way
};

inline double ramp(double t, double t0, double t1, double v0, double v1) {
    return t <= t0 ? v0 : t >= t1 ? v1 : v0 + (v1 - v0) * (t - t0) / (t1 - t0);
}

std::vector<Row> ground_rows();

} // namespace outdoors
