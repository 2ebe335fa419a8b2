// clutter.h - an echo for tests: random scatterers on flat ground seen by a moving Doppler radar. Written for the tests alone,
// independent of sim/sensors and of the firmware's template.
//
// The echo is a function of position: I(x) = sum_i A_i cos(4 pi r_i(x)/lambda + phase_i), A_i^2 = G^2 sin^n(theta_i)/r_i^4 with a
// two-way Gaussian beam; a drive interpolates it along the track. Then a 3-80 Hz band-pass (second order each side), white
// noise, offset and a 10-bit converter at 512 Hz.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace clutter {

struct Random { // splitmix64; the normal is a sum of 12 uniform numbers
    std::uint64_t state;
    std::uint64_t next() {
        state += 0x9e3779b97f4a7c15u;
        std::uint64_t z = state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    double normal() {
        double sum = -6;
        for (int i = 0; i < 12; ++i) {
            sum += uniform();
        }
        return sum;
    }
};

struct Ground {
    double f0_Hz = 9.9e9, height_m = 0.3, mounting_deg = 20, vertical_deg = 36, horizontal_deg = 72, exponent = 1;
    double track_m = 12, density_m2 = 400;
    std::uint64_t seed = 1;
};

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double grid_m = 0.0015; // the echo turns at most 2/lambda = 66 times a metre: 10 points a turn

// I(x) on a grid along the track, unit variance.
inline std::vector<double> echo_along_track(const Ground &ground) {
    Random random{ground.seed * 0x1000003u + 17};
    const double near = 0.12, far = 2.2, side = 1.3, rad = pi / 180;
    const double wave = 4 * pi * ground.f0_Hz / 299792458.0;
    const double c = std::cos(ground.mounting_deg * rad), s = std::sin(ground.mounting_deg * rad);
    std::vector<double> echo(static_cast<std::size_t>(ground.track_m / grid_m) + 4, 0.0);
    const double length = ground.track_m + far;
    const auto count = static_cast<int>(ground.density_m2 * length * 2 * side);
    for (int i = 0; i < count; ++i) {
        const double px = length * random.uniform(), py = side * (2 * random.uniform() - 1), phase = 2 * pi * random.uniform();
        const auto first = static_cast<std::size_t>(std::max(0.0, (px - far) / grid_m));
        const auto last = std::min(echo.size(), static_cast<std::size_t>(std::max(0.0, (px - near) / grid_m)));
        for (std::size_t k = first; k < last; ++k) {
            const double x = px - static_cast<double>(k) * grid_m;
            const double r = std::sqrt(x * x + py * py + ground.height_m * ground.height_m);
            const double along = (x * c + ground.height_m * s) / r, up = (x * s - ground.height_m * c) / r;
            // Small-angle forms of the beam's angles: up and y/along are their sines and tangents.
            const double el = std::asin(up) / rad / ground.vertical_deg, az = std::atan(py / r / along) / rad / ground.horizontal_deg;
            const double fall = el * el + az * az;
            if (fall > 1.6) {
                continue;
            }
            const double amplitude = std::exp(-4 * std::log(2.0) * fall) * std::pow(ground.height_m / r, ground.exponent / 2) / (r * r);
            echo[k] += amplitude * std::cos(wave * r + phase);
        }
    }
    double power = 0;
    for (const double value : echo) {
        power += value * value / static_cast<double>(echo.size());
    }
    for (double &value : echo) {
        value /= std::sqrt(power);
    }
    return echo;
}

struct Biquad {
    std::array<double, 3> b{};
    std::array<double, 2> a{};
    double x1 = 0, x2 = 0, y1 = 0, y2 = 0;
    double step(double x) {
        const double y = b[0] * x + b[1] * x1 + b[2] * x2 - a[0] * y1 - a[1] * y2;
        x2 = x1, x1 = x, y2 = y1, y1 = y;
        return y;
    }
};

inline Biquad butterworth(double corner_Hz, double rate_Hz, bool high_pass) {
    const double k = std::tan(pi * corner_Hz / rate_Hz), q = std::sqrt(0.5), norm = 1 / (1 + k / q + k * k);
    Biquad out;
    out.b = high_pass ? std::array<double, 3>{norm, -2 * norm, norm} : std::array<double, 3>{k * k * norm, 2 * k * k * norm, k * k * norm};
    out.a = {2 * (k * k - 1) * norm, (1 - k / q + k * k) * norm};
    return out;
}

// A drive over a track: ADC counts at 512 Hz. `position` gives metres along the track over seconds.
struct Adc {
    double signal_count = 120; // rms of the echo [count]
    double snr_dB = 20;        // in the band-pass output
    double offset_count = 512;
    double high_Hz = 80;
    std::uint64_t seed = 1;
};

inline std::vector<std::uint16_t> drive(const std::vector<double> &echo, double duration_s, const std::function<double(double)> &position,
                                        const Adc &adc) {
    Random random{adc.seed * 77 + 5};
    Biquad high = butterworth(3, 512, true), low = butterworth(adc.high_Hz, 512, false);
    const double noise = adc.signal_count * std::pow(10, -adc.snr_dB / 20);
    std::vector<std::uint16_t> out;
    for (int n = 0; n < static_cast<int>(duration_s * 512); ++n) {
        const double x = std::clamp(position(n / 512.0), 0.0, (static_cast<double>(echo.size()) - 4) * grid_m) / grid_m + 1;
        const auto i = std::min(static_cast<std::size_t>(x), echo.size() - 3);
        const double u = x - static_cast<double>(i);
        const double *e = &echo[i];
        // Catmull-Rom through four neighbours
        const double value =
            e[0] + 0.5 * u * (e[1] - e[-1] + u * (2 * e[-1] - 5 * e[0] + 4 * e[1] - e[2] + u * (3 * (e[0] - e[1]) + e[2] - e[-1])));
        const double count = adc.offset_count + low.step(high.step(adc.signal_count * value)) + noise * random.normal();
        out.push_back(static_cast<std::uint16_t>(std::clamp(std::floor(count + 0.5), 0.0, 1023.0)));
    }
    return out;
}

} // namespace clutter
