// scatterers.h - a second generator for the outdoors bench, so that no rule is fitted to the first: another ground, antenna, front end,
// accelerometer and other wheels. Written for the tests alone; it shares only the random numbers with the first.
//
//   echo(x, z) = sum_i A_i G_i sin(th_i)^(1/2) / r_i^2 cos(4 pi r_i/lambda + phase_i)      (1)
//
// Ground: 40 scatterers a square metre on ground that is uneven by +-1 cm, amplitudes A log-normal (a few stones outshine the rest), so
// the echo is no Gaussian speckle. Antenna: G = cos^n, of a patch, both ways, of the widths of the reference radar, with a back lobe of
// -20 dB. Front end: two RC high-passes and a fourth-order low-pass in place of the second-order ones; half of the noise comes before
// them and is pink, so the bins above the band tell only the other half; mains hum; a converter whose steps differ by 0.3 of one and whose
// clock is 300 ppm fast. Accelerometer: half of its noise lasts for 12 ms, its bias walks, its scale is 1 % off, the wheels' lugs shake it.
// Wheels: radii by 1 % apart, each with a slip of its own that wavers by 2 %, rims that run out by half a percent.
#pragma once

#include "tests/unit/clutter.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace outdoors {

class Scatterers {
  public:
    explicit Scatterers(std::uint64_t seed, double depression_deg = 20);
    // Radar at x along the track, z above its height: (1), mean square 1; at z 0 interpolated, as it is the same in every drive.
    double echo(double x_m, double z_m);

  private:
    struct Point {
        double x, y, z, amplitude, turns;
    };
    const std::vector<Point> &column(int index);
    double gain(const Point &point, double x_m) const;
    void look_at(int cell);
    double exact(double x_m, double z_m);
    const float *samples(int cell);

    std::uint64_t seed_;
    double cosine_, sine_; // of the depression
    std::map<int, std::vector<Point>> columns_;
    std::map<int, std::vector<float>> sampled_;
    int cell_ = -1000000;
    std::vector<double> x_, y2_, z_, turns_, near_, far_; // of the points in the beam; gains at both ends of the cell
    double scale_ = 1;
};

inline Scatterers &scatterers_of(std::uint64_t seed, double depression_deg = 20) {
    static std::map<std::pair<std::uint64_t, double>, Scatterers> cache;
    const std::pair key(seed, depression_deg);
    const auto found = cache.find(key);
    return found != cache.end() ? found->second : cache.emplace(key, Scatterers(seed, depression_deg)).first->second;
}

// The converter's count of an echo: front end, noise, hum, steps.
class FrontEnd {
  public:
    FrontEnd(double echo_count, double snr_dB, std::uint64_t seed);
    double filtered(double echo); // of mean square 1; hum and all noise but the converter's in it
    int convert(double count) const;

  private:
    clutter::Random noise_;
    double echo_count_, before_, after_, pink_[4] = {};
    double high_[2] = {}, high_in_[2] = {}, t_ = 0;
    clutter::Biquad low_[2];
    std::array<double, 1024> step_{};
};

class Rattle { // accelerometer and wheels
  public:
    explicit Rattle(std::uint64_t seed);
    double accel(double true_m_s2, double bias, double noise, double rim_turns_s);
    // Moves the wheels' angles on by dt; `free`: slip and run-out of their own, where no loop closes over them.
    void turn(double rad_s, double dt, bool free);
    void waver(); // every tick
    double angle(int wheel) const { return angle_[static_cast<std::size_t>(wheel)]; }

  private:
    clutter::Random random_;
    double coloured_ = 0, walk_ = 0, shake_ = 0, shake2_ = 0;
    std::array<double, 4> angle_{}, tolerance_{}, slip_{}, turned_{};
};

} // namespace outdoors
