// inputs.h - the inputs of the forward model on one uniform grid, from a log: wheel motion, motor voltage, yaw, imposed speed.
#pragma once

#include "dataset.h"
#include "follow_motion.h"

#include <string>
#include <vector>

namespace traction::lab {

// A wheel stands below a rim speed of a centimetre a second, where slip is taken against that speed (rest_speed_m_s), and how friction
// and rolling resistance reverse is known of no machine; but at least below the first and at most below the second share of the log's own
// top speed, so that an axis of natural units and a rover that crawls are read too.
inline constexpr double stands_m_s = 0.01, standstill_share[] = {0.0125, 0.03};
inline constexpr double standstill_share_slow = 0.1; // the second, where the model knows a speed of reversal (creeps.h)

inline constexpr double bin_s = 0.05; // rows of fast signals: keeps all below 10 Hz, assumed enough for a rover's physics

double sample_period(const log::Signal &signal);                   // [s], median
double parameter(const Parameters &table, const std::string &key); // 0 where it is not given

// Fills everything of a Dataset but its balances.
struct InputBuilder {
    const Model &model;
    const log::Log &log;
    double slope_noise; // what the angles' smoothing may leave in a speed, of the speed (half_width_for)
    double widen;       // times the half width that this makes
    Dataset data;

    const log::Signal *signal(const std::string &name) const;
    const log::Signal *wheel_signal(std::size_t i, const std::string &quantity) const;
    double header(const std::string &key) const;
    // Header window.<signal>, or window.wheel.<quantity> for all wheels: a sample is the mean of the window that ends at its time.
    double window_of(const log::Signal &s) const;
    void say(const std::string &text);
    void header_of_log();
    // The signal that tells wheel i's motion best: counts, then angle, then speed.
    const log::Signal *motion_signal(std::size_t i, double &angle_scale) const;
    // The same of wheel i's own sensor; motion_signal() takes that of the motor's wheel, else that of any wheel which turns with it.
    const log::Signal *own_motion_signal(std::size_t i, double &angle_scale) const;
    bool set_grid(double step_s);
    // Steps of 20 ms, of 10 ms where the wheels swing so quickly that the integration would lose more of it than it may. False: no grid.
    bool grid_and_wheels();
    double top_speed_rad_s() const; // of the fastest wheel, 98 % quantile over tenths of a second; 0: unknown
    double
    swing_rad_s() const; // of the wheels: root mean square of jerk over that of acceleration, where that is no rounding of the encoder
    double rounding_rad_s2 = 0; // what rounding leaves in an acceleration, of the coarsest wheel
    struct Found {              // of a wheel's motion, before the wheels of a side agree
        MotionAtWidths motion;
        WheelInput sharp; // its speed and acceleration by cubics
        double noise_rad_s2 = 0;
    };
    std::vector<std::string> scattering{}; // signals whose speeds are smoothed more widely than their samples alone ask for, and the widest
    double widest_smoothing_s = 0;
    void wheel_motion(std::size_t i, Found &found);
    void wheels_motion();
    std::vector<std::vector<std::size_t>> sides() const;
    bool is_measured(std::size_t i) const;
    // A driven wheel whose speed the log has not: its motor holds it, so that it neither stands nor rolls freely. The mean of those driven
    // wheels of its side that are measured.
    void turn_with_side(std::size_t i);
    void add_jumps(const WheelInput &input, const WheelInput &sharp, double least_noise, std::vector<char> &jumps) const;
    void follow_jumps(WheelInput &input, const WheelInput &sharp, const std::vector<char> &jumps) const;
    static double rounding_of(const std::vector<double> &angle_rad);
    static double scatter_of(const std::vector<double> &angle_rad, double count_rad);
    static double rounding_noise(double count_rad, double period_s, double half_s);
    void travel(WheelInput &input) const;
    // Acceleration from the smoothed speed by a second, equal smoothing of central differences.
    void slopes_of(WheelInput &input) const;
    void mark_gaps(const std::vector<double> &distance_s, const log::Signal &s);
    void voltages();
    void yaw();
    static std::vector<double> unwrapped(std::vector<double> angle);
    void imposed_motion();
};

} // namespace traction::lab
