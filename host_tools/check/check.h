// check.h - is a log fit to learn from? Data quality, signs and units that contradict each other, and what the drive did not excite.
//
// Nothing is fitted here but straight lines; truth.* columns are not looked at. Findings: docs/log_format.md; thresholds stand beside their
// reasons in the .cpp files.
#pragma once

#include "host_tools/log/read.h"

#include <limits>
#include <string>
#include <vector>

namespace traction::check {

enum class Severity { note, warning, error };

struct Finding {
    std::string id; // "sign", "unit", "swapped_wheels", "gap", ...; the list is in docs/log_format.md
    Severity severity = Severity::note;
    std::string signal; // the column it concerns; empty: the log
    std::string text;   // what was found, with its number
    std::string mend;
    double value = 0;                                                                                        // the number found
    double t0_s = std::numeric_limits<double>::quiet_NaN(), t1_s = std::numeric_limits<double>::quiet_NaN(); // where, if at one place
};

// What is known of the machine beforehand; NaN: unknown. With it, a unit error is told by its factor, without it by absurdity.
struct Machine {
    double wheel_radius_m = std::numeric_limits<double>::quiet_NaN();
    double back_emf_Vs = std::numeric_limits<double>::quiet_NaN(); // at the wheel
    double resistance_ohm = std::numeric_limits<double>::quiet_NaN();
    double battery_V = std::numeric_limits<double>::quiet_NaN();       // used where the log has no battery voltage
    double counts_per_turn = std::numeric_limits<double>::quiet_NaN(); // of an encoder, at the wheel
    std::vector<double> wheel_y_m = {};                                // to the left of the middle; empty: 0, 2 left and 1, 3 right
    std::vector<int> motor_of_wheel = {}; // of each, the wheel whose motor turns it; empty: every wheel has its own
    std::size_t free_wheels = 0;          // of them, those that no motor turns
    bool wheels_point_forward = true;     // false (omni): wheel speeds are not compared with the body's
    bool unsigned_current = false;        // the model knows currents as magnitudes, whatever the log's header says
    bool on_ground = true;                // false: wheels in the air
    bool rolls_freely = true;             // false: a bench imposes slip, so speed over ground says nothing of the radius
};

struct Rate {
    std::string signal;
    std::size_t samples = 0;
    double median_s = 0; // time from sample to sample
    double jitter = 0;   // half the spread of the middle 90 % of it, relative to the median
    double missing = 0;  // share of samples missing
    double largest_gap_s = 0;
};

struct WheelExcitation {
    int wheel = 0;
    double speed_min_rad_s = 0, speed_max_rad_s = 0;
    double slip_low = 0, slip_high = 0; // 2 % and 98 % quantiles; NaN without a ground speed
    double accel_rms_rad_s2 = 0;
    double current_low_A = 0, current_high_A = 0;
};

// What the drive did: the lab reads from it which effects this log cannot show. NaN: the signals for it are missing.
struct Excitation {
    double duration_s = 0;
    double speed_min_m_s = 0, speed_max_m_s = 0; // body, along x
    double reverse_s = 0;                        // time spent in reverse
    double accel_rms_m_s2 = 0;                   // of the body, over 0.5 s
    int starts = 0;                              // times the machine set off from standstill
    double standstill_s = 0;                     // longest standstill
    double moving_s = 0;
    double turning_s = 0; // time with a yaw rate above 0.1 rad/s
    double yaw_rate_max_rad_s = 0;
    double revisited = 0; // share of the path within 5 cm of a place passed more than 5 s before; NaN without a camera
    double path_m = 0;
    double wheels_apart = 0; // rms spread of wheel speeds over their rms: 0 when all turn alike
    double slip_low = 0, slip_high = 0;
    double constant_input = 0; // share of the moving time in which no wheel speed changes
    double duty_saturated = 0; // share of the time at full duty
    std::vector<WheelExcitation> wheel;
};

struct Report {
    std::vector<Finding> findings; // errors first
    Excitation excitation;
    std::vector<Rate> rates;
    bool passed() const;                                                              // no finding is an error
    const Finding *find(const std::string &id, const std::string &signal = "") const; // nullptr when there is none
};

Report check(const log::Log &log, const std::vector<log::Repair> &repairs, const Machine &machine = {});

// Reads and checks. A clock that was set back, which the reader refuses, becomes a finding; other LogErrors pass.
Report check_file(const std::string &path, const std::string &map_path = "", const Machine &machine = {});

const char *severity_name(Severity severity);

// The ids of findings that may be errors (docs/log_format.md).
const std::vector<std::string> &error_ids();

} // namespace traction::check
