// analog.h - the small sensors: current shunt, battery divider, accelerometer, gyro. Truth in, measurement in SI out.
//
// Each passes the truth through its own low pass and delay, averages it over a tick (its anti-alias filter), then adds its own error. Noise
// figures are one standard deviation of one 10 ms value. Rounding to counts happens in the HAL.
#pragma once

#include "random.h"

#include <cstdint>
#include <deque>
#include <string_view>

namespace traction::sim {

// gain * mean + offset + drift * t + noise
struct AnalogConfig {
    double gain = 1;    // [1]
    double offset = 0;  // [unit of the sensor]
    double drift_s = 0; // [unit/s]
    double noise = 0;   // [unit] standard deviation of one value
    double lag_s = 0;   // [s] time constant of a first-order low pass of its own
    double delay_s = 0; // [s] age of what it measures
};

// Wheel current: 0.01 A (assumed: 5 counts of the 12-bit converter, what a shunt of 50 mohm behind a bridge leaves).
inline constexpr double current_noise_A = 0.01;
// Battery voltage: 0.01 V (assumed: 2.5 counts).
inline constexpr double battery_noise_V = 0.01;
// Accelerometer: 0.02 m/s^2 (250 ug/sqrt(Hz) over 50 Hz, as the MEMS parts of the paper's years state; the part is assumed).
inline constexpr double accel_noise_m_s2 = 0.02;
// Vibration felt by it while driving: 0.05 m/s^2 rms per m/s (assumed; smooth ground).
inline constexpr double accel_vibration_1_s = 0.05;
// Gyro: 0.005 rad/s (0.05 deg/s/sqrt(Hz) over 50 Hz; the part is assumed, the paper has none).
inline constexpr double gyro_noise_rad_s = 0.005;

class AnalogSensor {
  public:
    AnalogSensor(const AnalogConfig &config, std::uint64_t seed, std::string_view name)
        : config_(config), random_(seed, name), late_(config.lag_s > 0 || config.delay_s > 0) {}

    void add(double truth, double step_s = 0) { // once per plant step, step_s after the one before
        if (!late_) {
            sum_ += truth;
            count_++;
            return;
        }
        if (config_.lag_s > 0) {
            filtered_ = started_ ? filtered_ + step_s / (config_.lag_s + step_s) * (truth - filtered_) : truth;
            truth = filtered_;
        }
        started_ = true;
        if (config_.delay_s > 0 && step_s > 0) {
            waiting_.push_back(truth);
            const auto most = static_cast<std::size_t>(config_.delay_s / step_s + 0.5);
            while (waiting_.size() > most + 1) waiting_.pop_front();
            truth = waiting_.front();
        }
        sum_ += truth;
        count_++;
    }
    // The value of the tick that ends now. extra_noise: more of it, same unit, for this value.
    double measure(double t_s, double extra_noise = 0) {
        const double mean = count_ > 0 ? sum_ / count_ : 0;
        sum_ = 0;
        count_ = 0;
        const double own = config_.noise * random_.normal(), extra = extra_noise * random_.normal();
        return config_.gain * mean + config_.offset + config_.drift_s * t_s + own + extra;
    }

  private:
    AnalogConfig config_;
    Random random_;
    std::deque<double> waiting_;
    double sum_ = 0, filtered_ = 0;
    int count_ = 0;
    bool late_, started_ = false;
};

} // namespace traction::sim
