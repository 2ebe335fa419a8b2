// speed.h - ground speed with its uncertainty from a recorded radar, by the rover's own firmware (firmware/core: doppler, ground_speed).
//
// Every 10 ms of the recording are one tick: its samples go through doppler_missing, doppler_gap and doppler_step, their values with the
// tick's acceleration through ground_speed_step, one tick later, as control.c does it. What a rover knows and a recording does not:
//   no accelerometer   its place takes a constant 0, whose bias b = -dv/dt walks: Qb = agility^2 T/1 s per tick   (1)
//   no wheels          the sign is not known: the recording is taken to begin forward, and standing is what is not heard
//
// Judged where there is a reference, at every tick from the first speed on:
//   e = |v| - |reference| (with wheels: v - reference),  NEES = mean(e^2 / std^2), coverage = share of |e| < 1 or 2 std   (2)
#pragma once

#include "recording.h"

#include "firmware/template/radar_template.h"
#include "host_tools/log/log.h"

#include <limits>
#include <string>
#include <vector>

namespace traction::speed {

struct Settings {
    radar_geometry_t radar = radar_geometry_reference(); // rate_Hz is replaced by that of the counts
    double scale = 1;                                    // calibrated over geometric speed
    int offset_count = 512, max_count = 1023;
    double quiet_count2 = 2; // variance below which there is no echo
    bool paper = false;      // the paper's estimator
    double agility_m_s2 = 0; // of (1), change of the acceleration within a second; 0: 0.5 of ground, 3 of a point target
    double wheel_radius_m = 0.057;
};

// What else the log knows, by column; empty: not there.
struct Helpers {
    log::Signal accel_m_s2, rim_m_s;
};
// accel: the column's name, "none", or "" for imu.accel_x_m_s2 where the log has it. Wheels: the mean of wheel<i>.speed_rad_s where all are
// there and `wheels` says so. Throws log::LogError for a column that is named and not there.
Helpers helpers_of(const log::Log &log, const std::string &accel, bool wheels, double wheel_radius_m);

struct Judgement {
    std::string reference;
    std::size_t ticks = 0;
    double rmse_m_s = 0, bias_m_s = 0, worst_m_s = 0, nees = 0, within_1 = 0, within_2 = 0;
};

struct Result {
    double rate_Hz = 0;
    bool used_accel = false, used_wheels = false;
    std::vector<double> t_s, speed_m_s, std_m_s; // every tick
    log::Signal doppler;                         // values of the Doppler stage that were used
    std::size_t values = 0, quiet = 0, spoilt = 0, beyond = 0;
    double first_s = std::numeric_limits<double>::quiet_NaN(); // of the first value that was used, from the start
    double lowest_m_s = 0, highest_m_s = 0;                    // that the radar hears at this rate
    double mean_m_s = 0, mean_std_m_s = 0;                     // from the first value on
};

// Throws log::LogError where the geometry cannot be (radar_geometry_check), with the option that mends it.
Result measure(const Counts &counts, const Helpers &helpers, const Settings &settings, const std::string &source);

// (2). Ticks farther than 0.25 s from a reference sample are left out. Throws log::LogError where nothing overlaps.
Judgement judge(const Result &result, const log::Signal &reference, const std::string &source);

// The result as a log: estimate.speed_m_s, estimate.speed_std_m_s, radar.speed_m_s.
log::Log to_log(const Result &result, const Settings &settings, const std::string &source);

} // namespace traction::speed
