// outdoors.h - what the first hour outdoors does to a rover's sensors: frames for the whole control_step, every 10 ms. Written for the
// tests alone: it shares no code with the simulator's radar or with the firmware's template.
//
//   echo(x, z) = Re sum_b E_b(x) exp(i 4 pi/lambda z sin th_b),  E_b the scatterers of depression th_b        (1)
//
// x: path, z: heave. Scatterers lie at random on flat ground; two-way Gaussian beam, r^-4, sigma0 ~ sin th; pitch moves the radar by
// its height, which is a path (2). Then band-pass, a converter with offset, noise, rails and an interfering line, lost samples; an
// accelerometer with bias, noise, the slope's share of gravity and vibration; wheels with slip; a body on soil for closed loops.
#pragma once

#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <complex>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace outdoors {

using clutter::Random;
inline constexpr double pi = clutter::pi;
inline constexpr double radar_Hz = 512, tick_s = 0.01, radius_m = 0.057, gravity = 9.81;

// (1) on a grid along the track; bands of depression.
class Echo {
  public:
    Echo(std::uint64_t seed, double depression_deg);
    double at(double x_m, double z_m) const;

  private:
    static constexpr int bands = 6;
    static constexpr double grid_m = 0.0015, track_m = 8;
    std::vector<std::complex<double>> band_[bands]; // mean power of the sum's real part: 1
    double sine_[bands] = {};
};

inline const Echo &echo_of(std::uint64_t seed, double depression_deg = 20) {
    static std::map<std::pair<std::uint64_t, double>, Echo> cache;
    const std::pair key(seed, depression_deg);
    const auto found = cache.find(key);
    return found != cache.end() ? found->second : cache.emplace(key, Echo(seed, depression_deg)).first->second;
}

struct Case {
    std::string name;
    double duration_s = 20;
    double settle_s = 4; // scored from here on
    std::function<double(double)> speed = [](double) { return 0.3; };
    std::function<double(double)> wheel;                              // rim speed; empty: 1.1 times the speed
    std::function<double(double)> slope = [](double) { return 0.0; }; // [rad], nose up positive
    double accel_bias = 0.05, accel_noise = 0.2;                      // [m/s^2]
    double echo_count = 75, snr_dB = 25, offset_count = 0; // rms; of white noise over the whole band; of the converter, beyond 512
    double tone_Hz = 0, tone_count = 0;                    // amplitude
    double tone_from_s = 0;                                // it begins
    std::function<double(double)> walker_m;                // way of whoever walks in the beam, with an echo as large as the ground's
    double heave_m = 0, heave_Hz = 8, pitch_rad = 0;       // amplitudes,
    double still_s = 0;                                    // from when on: what stands does not shake
    double lost_share = 0, lost_ticks_share = 0;           // radar samples lost at random; radar ticks lost whole
    std::function<bool(double)> radar_dead, radar_silent;  // noise of 0.3 counts alone; no samples at all
    double missed_share = 0;                               // ticks missed at random
    bool sequence = true;                                  // the frame numbers its samples
    bool scatterers = false;                               // the second generator's echo, accelerometer and wheels, scatterers.h
    bool gyros = false; // all three, with offset and noise; a slope then comes within 0.1 s, as far as a body can pitch
    std::function<double(double)> gyro_y_more, gyro_x_more; // what they read too much [rad/s]
    double depression_deg = 20;                             // of the radar as it is mounted; the firmware's template has 20
    std::function<double(double)> echo_share;               // amplitude of the ground's echo over echo_count: a puddle, other ground
    std::function<double(double)> lift_m;                   // of the radar: a kerb
    std::function<double(double)> accel_more;               // what the accelerometer reads too much: a blow, warmth [m/s^2]
    std::function<double(double)> waves_m;                  // way that what lies on the ground goes by itself: grass in the wind
    double accel_rail = 1e9;                                // [m/s^2] the accelerometer reads no more
    std::function<bool(double)> stalled;                    // nobody looks at the sensors
    std::function<double(double)> turn;                     // rim speed that the right wheels have more, the left ones less [m/s]
    // closed loop
    bool closed = false;
    bool coasts = false; // in mode stop
    double command_m_s = 0.3;
    double soil_max_share = 0.55, soil_slip = 0.26, rolling_N = 1.0; // most traction over load; slip at 63 % of it; resistance
};

struct Step {
    double t, speed, estimate, std, wheel;
    std::uint32_t faults;
    double gyro_y_rad_s; // what the gyro about y is said to read too much since it stood
    std::string note;    // what the filter thinks, for the eye
};

struct Run {
    std::vector<Step> steps;
};

Run drive(const Case &now, std::uint64_t seed, const control_config_t &config);

struct Score {
    double rmse = 0, nees = 0, wrong_sign_s = 0, worst = 0; // m/s; the longest spell of a wrong sign beyond 0.05 m/s
    double first_fault_s = -1;
    double last_true = 0;
    std::uint32_t faults = 0;
    std::vector<double> relative;
    double first_fix_s = -1, square = 0, nees_sum = 0;
    int n = 0;
};

Score score(const Case &now, const Run &run);

} // namespace outdoors
