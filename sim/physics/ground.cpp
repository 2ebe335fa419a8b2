#include "ground.h"

#include "math.h"

#include <cmath>

namespace traction::sim {

namespace {

// A number of -1..1 that belongs to a lattice point.
double lattice(std::int64_t i, std::int64_t j, std::uint64_t seed) {
    std::uint64_t h =
        seed ^ (static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ull) ^ (static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4Full);
    h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ull; // splitmix64's finaliser
    h = (h ^ (h >> 27)) * 0x94D049BB133111EBull;
    h ^= h >> 31;
    return static_cast<double>(h >> 11) * (2.0 / 9007199254740992.0) - 1.0;
}

// Without SSE4.1 std::floor is a call. |x| < 2^63.
double floor(double x) {
    const auto below = static_cast<double>(static_cast<std::int64_t>(x));
    return below > x ? below - 1 : below;
}

double smooth(double u) { return u * u * u * (u * (u * 6 - 15) + 10); }

} // namespace

const Soil &Ground::at(double x_m, double y_m) const {
    for (auto patch = patches.rbegin(); patch != patches.rend(); ++patch)
        if (x_m >= patch->x_min_m && x_m < patch->x_max_m && y_m >= patch->y_min_m && y_m < patch->y_max_m) return patch->soil;
    return soil;
}

double Ground::slope_here_rad(double path_m) const {
    double rise = slope_rad;
    for (const SlopeStep &step : slope_steps) {
        if (path_m >= step.path_m)
            rise = step.slope_rad;
        else if (path_m > step.path_m - slope_blend_m)
            rise += (step.slope_rad - rise) * (path_m - step.path_m + slope_blend_m) / slope_blend_m;
    }
    return rise;
}

double Ground::grip_change(double x_m, double y_m, GripCell &last) const {
    double trend = 0;
    if (gradient_1_m != 0) trend = gradient_1_m * (x_m * math::cos(gradient_direction_rad) + y_m * math::sin(gradient_direction_rad));
    if (grip_noise <= 0) return trend > -0.95 ? trend : -0.95; // some grip is left everywhere
    const double u = x_m / grip_length_m, v = y_m / grip_length_m;
    const double iu = floor(u), iv = floor(v);
    if (!(iu == last.i && iv == last.j)) {
        const auto i = static_cast<std::int64_t>(iu), j = static_cast<std::int64_t>(iv);
        last = {iu, iv, {lattice(i, j, seed), lattice(i + 1, j, seed), lattice(i, j + 1, seed), lattice(i + 1, j + 1, seed)}};
    }
    const double a = smooth(u - iu), b = smooth(v - iv);
    const double low = last.corner[0] * (1 - a) + last.corner[1] * a;
    const double high = last.corner[2] * (1 - a) + last.corner[3] * a;
    // Uniform -1..1 has variance 1/3; the quintic weights keep 0.78355 of it per dimension (the mean of (1-a)^2 + a^2).
    constexpr double scale = 1.7320508075688772 / 0.78355; // makes the rms 1
    const double change = trend + grip_noise * scale * (low * (1 - b) + high * b);
    return change > -0.95 ? change : -0.95;
}

} // namespace traction::sim
