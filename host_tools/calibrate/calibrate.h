// calibrate.h - the radar's scale and mounting angle from a log that also knows the true speed.
//
//   scale = sum_i reference_i / sum_i radar_i                                     (1)  over steady windows; its spread by leaving out a
//   tenth angle: where (2) of radar_model.h, drawn at this log's speeds, gives this scale                                 (2)
//
// Truth: the camera where the log has one, else the mean rim speed on firm ground. (1) is a ratio of sums, because a ratio of
// single values would be biased by the radar's noise. (2) is what the angle is if nothing else causes the scale: one number cannot tell an
// angle from a ground whose echo falls otherwise with depression, so the angle is given for three grounds and its uncertainty covers them.
#pragma once

#include "host_tools/log/log.h"

#include <array>
#include <string>

namespace traction {

enum class CalibrationTruth { automatic, camera, wheels };

struct Calibration {
    std::string truth; // "camera" or "wheels"
    int windows = 0;   // steady windows used
    double scale = 1, scale_std = 0;
    double angle_deg = 20, angle_std_deg = 0;      // on ground of exponent 1; the uncertainty covers 0 to 2
    double angle_known_ground_std_deg = 0;         // were the exponent known
    std::array<double, 3> angle_by_exponent_deg{}; // for sigma0 ~ sin^n, n = 0, 1, 2
};

// Throws log::LogError when the log has no radar samples, no truth, or fewer than 20 steady windows.
Calibration calibrate(const log::Log &log, CalibrationTruth truth, double wheel_radius_m);

// Sets `key = value # comment` in the firmware's parameter file at `path`, which is made when absent; every other line is kept.
void put_parameter(const std::string &path, const std::string &key, double value, const std::string &comment);

} // namespace traction
