#include "order_delay.h"

#include <cmath>
#include <limits>

namespace traction {

namespace {

constexpr int tick_ms = TICK_US / 1000, longest_ms = 250;

double ordered(std::span<const Sample> samples, std::size_t k, std::size_t wheel, std::size_t ticks_ago) {
    return k >= ticks_ago ? samples[k - ticks_ago].wheel[wheel].ordered : 0;
}

// Sum of squares that (1) leaves of one wheel's current.
double left_over(std::span<const Sample> samples, std::size_t wheel, int late_ms) {
    double uu = 0, uw = 0, ww = 0, ui = 0, wi = 0, ii = 0;
    for (std::size_t k = 0; k < samples.size(); k++) {
        const Sample::Wheel &now = samples[k].wheel[wheel];
        const double u = samples[k].battery_V * duty_in_force(samples, k, wheel, late_ms * 1e-3);
        const double w = now.speed_rad_s, i = now.current_A;
        uu += u * u, uw += u * w, ww += w * w, ui += u * i, wi += w * i, ii += i * i;
    }
    const double det = uu * ww - uw * uw;
    if (!(det > 1e-9 * uu * ww)) return uu > 0 ? ii - ui * ui / uu : ii; // no wheel turned: g alone
    const double g = (ui * ww - wi * uw) / det, h = (wi * uu - ui * uw) / det;
    return ii - g * ui - h * wi;
}

} // namespace

double duty_in_force(std::span<const Sample> samples, std::size_t k, std::size_t wheel, double order_delay_s) {
    const int late_ms = static_cast<int>(std::lround(order_delay_s * 1000));
    const auto ticks = static_cast<std::size_t>(late_ms / tick_ms);
    const double part = static_cast<double>(late_ms % tick_ms) / tick_ms;
    return (1 - part) * ordered(samples, k, wheel, ticks) + part * ordered(samples, k, wheel, ticks + 1);
}

double order_delay_s(std::span<const Sample> samples) {
    int best_ms = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int late_ms = 0; late_ms <= longest_ms; late_ms++) {
        double sum = 0;
        for (std::size_t wheel = 0; wheel < WHEEL_COUNT; wheel++) sum += left_over(samples, wheel, late_ms);
        if (sum < least) least = sum, best_ms = late_ms;
    }
    return best_ms * 1e-3;
}

} // namespace traction
