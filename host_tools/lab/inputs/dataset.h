// dataset.h - a log as the forward model wants it: inputs on one uniform grid, and the measured rows of every balance.
//
// Inputs (encoder angle, speed and acceleration by zero-phase local polynomials, motor voltage, yaw rate) are resampled.
// Measurements keep their own times: a row is the mean of a balance over [t0, t1] (of a camera: its change from t0 to t1), its prediction
// that of the same window.
// A signal that the log lacks removes its balance and leaves a message.
#pragma once

#include "host_tools/lab/model/model.h"

#include "host_tools/log/log.h"

#include <string>
#include <vector>

namespace traction::lab {

// What is compared. Per-wheel kinds come once per wheel.
enum class BalanceKind {
    current_torque,  // wheel current from the torque balance (17)
    current_voltage, // wheel current from the voltage balance
    accel,           // longitudinal specific force
    radar,           // ground speed by radar, averaged over its window
    camera_x,        // camera displacement per interval, along the body's x
    camera_y,        // the same along body y (planar machines)
    camera_yaw,      // camera heading change per interval (planar machines)
    yaw_rate,        // by the gyro
    force,           // drawbar pull of one wheel on a bench
    torque,          // measured wheel torque on a bench
};

struct Balance {
    BalanceKind kind;
    int wheel = -1;
    std::string name;  // "wheel0.current_A"
    std::string title; // for people
    std::string unit;
    double noise = 0; // standard deviation of one row, measurement noise alone
    std::string noise_source;
    std::vector<double> t0_s, t1_s, measured; // one entry per row
    std::vector<double> noise_factor;         // of a row's noise, relative to `noise`; empty: all 1
    std::vector<double> smoothing_bias;       // what the smoothing may cost a row's prediction, with its sign [unit]; empty: nothing
};

struct WheelInput {
    std::vector<double> angle_rad, speed_rad_s, accel_rad_s2; // on the grid, smoothed
    std::vector<double> travel_rad;                           // since the wheel last reversed
    std::vector<double> plain_speed_rad_s,
        plain_accel_rad_s2; // by parabolas throughout: speed_rad_s differs where the wheel jumps, accel_rad_s2 is by cubics; empty: it
                            // never turns
    double scatter_rad = 0, sample_s = 0, half_s = 0;     // of its encoder's samples (rounding, a clock that jitters), their period, its
                                                          // parabolas' half width; 0: none known
    std::vector<double> width_s;                          // the half width in use on the grid (follow_motion.h); empty: half_s
    std::vector<double> voltage_V;                        // at the motor; empty when unknown
    std::vector<double> voltage_t_s, voltage_integral_Vs; // its integral at the log's own times: a row's mean is exact
    std::vector<double> duty;                             // held from those times on; empty where the voltage itself is logged
    bool swings = false;                                  // with its own angle, quicker than its half width shows (follow_motion.h)
    bool rolls_freely = false; // without a motor, its speed not in the log: it turns as fast as it moves over the ground
    int turns_with = -1;       // the wheel whose motor turns this one: its motion is that wheel's; -1: its own
};

struct Dataset {
    double start_s = 0, step_s = 0.01; // grid: time[k] = start_s + k * step_s
    std::size_t count = 0;
    double standstill_rad_s = 0.15; // below it friction is indeterminate: the torque balance says nothing (inputs.h)
    bool independent_rows = false;  // a table of steady states, not a time series
    std::vector<WheelInput> wheel;
    std::vector<double> yaw_rate_rad_s;       // empty when unknown
    std::vector<double> yaw_rad;              // empty when unknown: integral of the rate, or the camera's
    bool camera_heading = false;              // yaw_rad is the camera's
    std::vector<double> body_speed_m_s;       // imposed speed; empty otherwise
    std::vector<std::vector<double>> load_N;  // measured load per wheel; empty when not logged
    std::vector<double> supply_t_s, supply_V; // battery, or one constant
    bool yaw_free = false;                    // the yaw rate follows from the model's forces, drawn to the measured one where there is one
    bool gyro = false;                        // the yaw rate is a gyro's
    std::size_t yaw_late = 1;                 // steps by which what draws the model's yaw rate is late: else a row would meet its own noise
    std::vector<char> gap;                    // 1 where a wheel's speed is not known
    std::vector<Balance> balance;
    Balance camera_left; // of a machine that is not followed sideways: what it might be asked of that (sideways.h); often no rows
    std::vector<std::string> messages; // what is missing and what that removes
    double smoothing_half_s = 0;       // half width of the encoder's parabolas, of the last wheel and before half_width_for() widens them
    double accel_bias_prior_m_s2 = 0;  // header bias.imu.accel_x_m_s2: the sensor's own word on its offset; 0: none
    std::vector<double> run_start_s;   // where each run begins, of a data set of several (join_runs.h); empty: one run
    std::vector<std::string> despite;  // errors of the check that were overridden when the log was opened
    std::string log_file, scenario, date;
    double duration_s = 0;

    // Share of a wheel's acceleration at omega [rad/s] that the smoothing and the grid lose.
    double acceleration_loss(double omega_rad_s) const;
    // Integral of a wheel's voltage at voltage_t_s + lag_s, where the command acts lag_s late on the supply of its own time.
    std::vector<double> voltage_integral(const WheelInput &input, double lag_s) const;
    std::size_t motor_of(std::size_t i) const { return wheel[i].turns_with < 0 ? i : static_cast<std::size_t>(wheel[i].turns_with); }
    double time(std::size_t k) const { return start_s + static_cast<double>(k) * step_s; }
};

// Inputs and balances of a log, without what its smoothing may cost where speeds jump (forward/make_dataset.h adds that). Never throws
// for a poor log: what cannot be used is left out with a message. `slope_noise`: what the smoothing of angles may leave in a wheel's
// speed, as a share of the speed. `widen`: times the half width that this makes.
Dataset measured_data(const Model &model, const log::Log &log, double slope_noise = 0.01, double widen = 1);

// Two runs of one drive: where at least 20 rows of a balance lie within 20 ms of the other run's, the standard deviation of their
// difference over sqrt(2) becomes the balance's noise.
void noise_from_repeat(Dataset &data, const Dataset &other);

} // namespace traction::lab
