#include "turned_by_wheels.h"

#include <cmath>
#include <cstddef>

namespace traction::lab {

namespace {

constexpr double of_measured = 0.8;

} // namespace

bool turned_by_wheels(const Dataset &data, const Physics &physics) {
    if (data.yaw_rate_rad_s.size() != data.count || data.count < 2) return true;
    double middle_m = 0, wheels = 0;
    for (std::size_t i = 0; i < physics.wheel.size(); ++i) {
        if (data.wheel[i].rolls_freely) continue;
        if (!physics.grips_sideways[i] || physics.wheel[i].heading != 0) return true;
        middle_m += physics.body.track_scale * physics.wheel[i].y, ++wheels;
    }
    if (!(wheels > 0)) return true;
    middle_m /= wheels;
    double arms = 0;
    std::vector<double> rate(data.count, 0);
    for (std::size_t i = 0; i < physics.wheel.size(); ++i) {
        if (data.wheel[i].rolls_freely) continue;
        const double arm = physics.body.track_scale * physics.wheel[i].y - middle_m, per_speed = arm * physics.wheel[i].radius;
        arms += arm * arm;
        for (std::size_t k = 0; k < data.count; ++k) rate[k] -= per_speed * data.wheel[i].speed_rad_s[k];
    }
    if (!(arms > 0)) return true;
    const auto n = static_cast<double>(data.count);
    double mean = 0, measured = 0;
    for (std::size_t k = 0; k < data.count; ++k) mean += rate[k] / n, measured += data.yaw_rate_rad_s[k] / n;
    double both = 0, squares = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        const double b = data.yaw_rate_rad_s[k] - measured;
        both += (rate[k] - mean) * b, squares += b * b;
    }
    return both / arms >= of_measured * squares;
}

} // namespace traction::lab
