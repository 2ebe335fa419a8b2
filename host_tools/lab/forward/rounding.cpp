#include "rounding.h"

#include "forward.h"

#include "host_tools/lab/inputs/smooth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace traction::lab {

namespace {

// Uniform in -0.5 .. 0.5, of a draw, wheel and sample (splitmix64, Steele, Lea, Flood 2014).
double uniform(std::uint64_t draw, std::uint64_t wheel, std::uint64_t sample) {
    std::uint64_t z = (draw * 64 + wheel) * 0x100000000ULL + sample + 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    z ^= z >> 31U;
    return static_cast<double>(z >> 11U) * 0x1p-53 - 0.5;
}

// A wheel that stands keeps its count, and its rounding error with it.
void add_rounding(Dataset &data, std::uint64_t draw) {
    for (std::size_t i = 0; i < data.wheel.size(); ++i) {
        WheelInput &in = data.wheel[i];
        if (in.turns_with >= 0 || !(in.scatter_rad > 0) || !(in.sample_s > 0)) continue;
        std::vector<double> t, error;
        const double last = data.time(data.count - 1) + in.half_s;
        for (std::uint64_t j = 0; data.start_s - in.half_s + static_cast<double>(j) * in.sample_s < last; ++j) {
            t.push_back(data.start_s - in.half_s + static_cast<double>(j) * in.sample_s);
            error.push_back(std::sqrt(12.0) * in.scatter_rad * uniform(draw, i, j));
        }
        const std::vector<double> slope =
            slopes_at(t, error, data.start_s, data.step_s, in.width_s.empty() ? std::vector<double>(data.count, in.half_s) : in.width_s);
        for (std::size_t k = 0; k < data.count; ++k)
            if (std::fabs(in.speed_rad_s[k]) > data.standstill_rad_s) in.speed_rad_s[k] += slope[k];
    }
    for (WheelInput &in : data.wheel) // one encoder a motor
        if (in.turns_with >= 0) in.speed_rad_s = data.wheel[static_cast<std::size_t>(in.turns_with)].speed_rad_s;
}

} // namespace

Eigen::VectorXd rounding_squares(const Dataset &data, const Physics &physics, int draws) {
    const Eigen::VectorXd plain = Forward(data).predict(physics);
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(plain.size());
    if (data.independent_rows || data.count < 3) return squares;
    for (int draw = 0; draw < draws; ++draw) {
        Dataset noisy = data;
        add_rounding(noisy, static_cast<std::uint64_t>(draw));
        squares += (Forward(noisy).predict(physics) - plain).cwiseAbs2() / draws;
    }
    return squares;
}

} // namespace traction::lab
