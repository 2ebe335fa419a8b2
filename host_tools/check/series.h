// series.h - the tools of the check: quantiles, straight-line fits, and signals brought to one grid of times.
#pragma once

#include "check.h"

#include <limits>
#include <string>
#include <vector>

namespace traction::check {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr double step_s = 0.05; // [s] of the common grid: the mean of five samples at 100 Hz

// q in 0..1. Not-numbers are left out. NaN for nothing.
double quantile(std::vector<double> values, double q);

// y = a*x1 + b*x2 by least squares through the origin; b stays 0 when x2 is empty. Rows with a not-number are left out.
struct Fit {
    double a = 0, b = 0;
    double error_a = 0, error_b = 0; // standard errors, widened by `design_effect` for rows that are not independent
    double rms = 0, y_rms = 0;       // of what is left over, of y
    std::size_t rows = 0;
    bool good = false; // enough rows, and x1 and x2 tell apart
};
constexpr double design_effect =
    25; // [1] variance ratio, assumed: soil noise makes neighbouring rows alike (docs/evidence.md section 4: 20 to 100)
Fit fit(const std::vector<double> &y, const std::vector<double> &x1, const std::vector<double> &x2 = {});

double correlation(const std::vector<double> &a, const std::vector<double> &b);

// The signals of one log on one grid. NaN where a signal has no sample near.
struct Wheel {
    int index = 0;
    std::vector<double> speed, set_speed, current, duty, voltage, count_rate, angle_rate; // empty when absent; voltage = duty * battery
    std::string speed_column; // where speed comes from: the speed column, else the angle's rate, else the counts'
    bool unsigned_current = false;
    bool in_volts = true; // false: no battery voltage in the log, `voltage` is the duty
};
struct Grid {
    double start_s = 0;
    std::size_t count = 0;
    std::vector<Wheel> wheel;
    std::vector<double> battery, accel, gyro, radar, carriage;
    std::vector<double> camera_x, camera_y, camera_yaw;
    std::vector<double> camera_forward, camera_speed, camera_yaw_rate; // over +-0.25 s; forward is along the heading
    std::vector<double> mean_speed;                                    // of the wheels
    std::vector<double> ground_speed;      // camera, else radar with the wheels' sign, else carriage; empty: unknown
    std::string ground_source;             // the column it comes from
    double effective_radius_m = not_known; // ground speed over wheel speed where slip is least
    double middle_radius_m = not_known;    // the same, median
    double rad_per_count = not_known;      // of the encoders, by the machine, else by the header
    bool speed_is_guessed = false;         // counts of unknown size: wheel speeds are right but for one common factor
    std::vector<char> active;              // 1 where a wheel turns or is driven
    double time(std::size_t k) const { return start_s + static_cast<double>(k) * step_s; }
};
// One velocity from beginning to end, but for standstill (to and fro is none): nineteen of twenty moving cells within a tenth of their
// median. What moves its motor's voltage and current then is noise, the supply and the ground, each its own way, so that neither can be
// told not to belong.
bool is_steady(const Wheel &wheel);

Grid make_grid(const log::Log &log, const Machine &machine);

// Does the machine say on which side each wheel of the log is? One motor may stand for several wheels: then by the wheels' numbers.
bool knows_sides(const Grid &grid, const Machine &machine);
double left_of(const Grid &grid, const Machine &machine, std::size_t i); // y of grid.wheel[i]; meaningless unless knows_sides()

// The change of x over +-half_span samples, per second.
std::vector<double> slope(const std::vector<double> &x, std::size_t half_span);

// The same, averaged over +-half_span samples.
std::vector<double> smooth(const std::vector<double> &x, std::size_t half_span);

// The same without single wild samples: held within the middle 99 %, widened by its width on either side.
std::vector<double> tame(std::vector<double> x);

// A wheel angle that jumps back by a turn instead of going on.
bool wraps(const log::Signal &angle);

// A unit that people mistake for the SI one: the logged number is `factor` times the right one.
struct UnitSlip {
    double factor;
    const char *written; // "rpm"
};
// The slip whose factor is within 1.35 times of `factor` either way, nullptr when there is none. kind: 'w' angular speed, 'I', 'v' speed or
// length, 'a'.
const UnitSlip *unit_slip(char kind, double factor);
// What a column looks like by such a slip of the wheel's speed: an angle's unit where the speed comes from angles ("degrees").
std::string looks_like(const UnitSlip &slip, std::string_view column);

// printf into a string.
std::string say(const char *format, ...) __attribute__((format(printf, 1, 2)));

using Findings = std::vector<Finding>;
void add_error(Findings &findings, const char *id, const std::string &signal, std::string text, std::string mend, double value);
bool has_error(const Findings &findings, const std::string &start); // of a signal whose name begins so
void check_quality(const log::Log &log, const std::vector<log::Repair> &repairs, const Grid &grid, Findings &findings,
                   std::vector<Rate> &rates);
void check_clipping(const log::Signal &signal, const Grid &grid, Findings &findings); // the end of a sensor's range
void check_drives(const Grid &grid, const Machine &machine, Findings &findings);      // duty, speed, current: units, signs, swaps
void check_magnitudes(const Grid &grid, Findings &findings);                          // currents that lack their sign
void check_scales(const Grid &grid, const Machine &machine, Findings &findings);      // factors, with a known machine
void check_clock(const log::Log &log, const Grid &grid, const Machine &machine, Findings &findings);     // its rate; signals that are late
void check_misplaced(const log::Log &log, const Grid &grid, const Machine &machine, Findings &findings); // copies, other axes, sides
void check_motion(const Grid &grid, const Machine &machine, Findings &findings);                         // encoder, camera, radar, imu
Excitation measure_excitation(const Grid &grid);
void judge_excitation(const Excitation &excitation, const Grid &grid, Findings &findings);

} // namespace traction::check
