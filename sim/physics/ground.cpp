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

void GripCell::go_to(double i_now, double j_now, std::uint64_t seed) {
    const auto a = static_cast<std::int64_t>(i_now), b = static_cast<std::int64_t>(j_now);
    *this = {i_now, j_now, {lattice(a, b, seed), lattice(a + 1, b, seed), lattice(a, b + 1, seed), lattice(a + 1, b + 1, seed)}};
}

double Ground::grip_change(double x_m, double y_m, GripCell &last) const {
    double trend = 0;
    if (gradient_1_m != 0) trend = gradient_1_m * (x_m * math::cos(gradient_direction_rad) + y_m * math::sin(gradient_direction_rad));
    if (grip_noise <= 0) return trend > -0.95 ? trend : -0.95; // some grip is left everywhere
    const double u = x_m / grip_length_m, v = y_m / grip_length_m;
    const double i = detail::floor(u), j = detail::floor(v);
    if (!(i == last.i && j == last.j)) last.go_to(i, j, seed);
    return detail::grip_between(u - i, v - j, last.corner[0], last.corner[1], last.corner[2], last.corner[3], trend, grip_noise);
}

} // namespace traction::sim
