// replay.h - a drive as the page plays it again: where the rover was, how its wheels turned, slipped and pushed, and what its radar heard.
//
// The pose is the truth's where there is one (truth.x_m, truth.y_m, truth.yaw_rad; on terrain truth.z_m, roll_rad, pitch_rad, joint_rad),
// else the camera's. Every quantity is put on one clock of equal rows and into whole numbers of 16 bits, so that a log of 120 s takes half
// a megabyte of a page; the radar's samples are kept as they are, so that the page can take a spectrum at any time.
#pragma once

#include "host_tools/log/log.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace traction::report {

// What is drawn. Body frame: x forward, y left; lengths in m, all of them > 0.
struct RoverShape {
    struct Wheel {
        double x_m, y_m; // of the wheel's middle
        double radius_m, width_m;
        int number = -1; // in the log: "wheel<number>."; -1: its place in the list
    };
    std::string name;
    double mass_kg, length_m, width_m, height_m;
    bool halves = true; // left and right half on a hinge across
    std::vector<Wheel> wheel;
    double Hz_per_m_s = 0; // of the radar over level ground, 2 f0 cos(a) / c; 0: not known
};

struct ReplayLimits {
    double row_s = 0.04;                  // between two rows, where that makes no more than:
    std::size_t rows = 6000;              //   else they lie farther apart
    std::size_t radar_samples = 1u << 18; // of a longer log only windows of 256 samples are kept, evenly spread
};

// The page's key "replay" (host_tools/report/README.md); null when the log has no pose. `truth`: what really happened, where it is known,
// in a file of its own; nullptr: not known, or in the log itself.
nlohmann::json replay_of(const log::Log &log, const log::Log *truth, const RoverShape &rover, const ReplayLimits &limits = {});

} // namespace traction::report
