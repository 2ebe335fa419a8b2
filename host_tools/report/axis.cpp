#include "axis.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace traction::report {

namespace {

constexpr double largest = 1e300;  // beyond it, differences of two values would overflow
constexpr double finest = 1e-300;  // below it, ticks would be denormal
constexpr double relative = 1e-12; // a range narrower than this part of its value is one value: double has 2.2e-16

// The smallest of 1, 2, 5 x 10^k that is not below `rough`: ticks at round numbers, never more than wanted.
double nice_step(double rough) {
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    const double part = rough / power;
    if (part <= 1.0) return power;
    if (part <= 2.0) return 2 * power;
    if (part <= 5.0) return 5 * power;
    return 10 * power;
}

std::string tick_label(double value, double step, double biggest) {
    if (std::fabs(value) < step * 1e-6) return "0";
    if (biggest >= 1e5 || biggest < 1e-3) {
        const int digits = static_cast<int>(std::clamp(std::ceil(std::log10(biggest / step)) + 1, 1.0, 16.0));
        return number(value, digits);
    }
    const int decimals = static_cast<int>(std::clamp(-std::floor(std::log10(step) + 1e-9), 0.0, 15.0));
    char text[64];
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals);
    return {text, end.ptr};
}

} // namespace

void Range::include(double value) {
    if (!std::isfinite(value)) return;
    value = std::clamp(value, -largest, largest);
    low = std::min(low, value);
    high = std::max(high, value);
}

double Axis::place(double value) const {
    if (logarithmic) return (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low));
    return (std::clamp(value, -largest, largest) - low) / (high - low);
}

Axis make_axis(Range range, double margin, int wanted) {
    Axis axis;
    if (range.empty()) range = {0, 1};
    const double size = std::max(std::fabs(range.low), std::fabs(range.high));
    if (range.high - range.low <= size * relative || range.high - range.low < finest) {
        const double half = std::max(size * 0.05, size == 0.0 ? 1.0 : finest);
        range = {range.low - half, range.high + half};
        margin = 0;
    }
    const double room = (range.high - range.low) * margin;
    axis.low = range.low - room;
    axis.high = range.high + room;
    const double step = nice_step((axis.high - axis.low) / std::max(1, wanted));
    const double first = std::ceil(axis.low / step - 1e-9);
    const double last = std::floor(axis.high / step + 1e-9);
    const double biggest = std::max(std::fabs(axis.low), std::fabs(axis.high));
    for (double k = first; k <= last && axis.ticks.size() < 50; k += 1.0) {
        axis.ticks.push_back(k * step);
        axis.labels.push_back(tick_label(k * step, step, biggest));
    }
    return axis;
}

Axis make_log_axis(Range range) {
    Axis axis;
    axis.logarithmic = true;
    if (range.empty() || range.high <= 0) range = {0.1, 1};
    if (range.low <= 0) range.low = range.high * 1e-6;
    const double down = std::floor(std::log10(std::max(range.low, finest)) + 1e-9);
    const double up = std::max(down + 1, std::ceil(std::log10(std::max(range.high, finest)) - 1e-9));
    axis.low = std::pow(10.0, down);
    axis.high = std::pow(10.0, up);
    const double stride = std::max(1.0, std::ceil((up - down) / 8));
    for (double k = down; k <= up; k += stride) {
        axis.ticks.push_back(std::pow(10.0, k));
        axis.labels.push_back(number(axis.ticks.back(), 1));
    }
    return axis;
}

std::string number(double value, int digits) {
    if (std::isnan(value)) return "-";
    char text[64];
    const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::general, std::clamp(digits, 1, 17));
    std::string out(text, end.ptr);
    const double size = std::fabs(value);
    if (out.find('e') != std::string::npos && size >= 1 && size < 1e6) { // 12000 reads better than 1.2e+04
        const auto plain = std::to_chars(text, text + sizeof text, std::round(value), std::chars_format::fixed, 0);
        out.assign(text, plain.ptr);
    }
    return out;
}

std::string coordinate(double px) {
    if (!std::isfinite(px)) px = 0;
    px = std::round(std::clamp(px, -1e7, 1e7) * 100) / 100;
    char text[64];
    const auto end = std::to_chars(text, text + sizeof text, px == 0.0 ? 0.0 : px, std::chars_format::fixed, 2);
    std::string out(text, end.ptr);
    while (out.back() == '0') out.pop_back();
    if (out.back() == '.') out.pop_back();
    return out;
}

} // namespace traction::report
