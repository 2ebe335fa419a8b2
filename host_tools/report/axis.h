// axis.h - ranges, ticks and numbers of an axis: what a plot needs to know before it draws anything.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace traction::report {

// Grows to hold every finite number it is shown; NaN and infinities are passed over.
struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void include(double value);
    bool empty() const { return !(low <= high); }
};

struct Axis {
    double low = 0;
    double high = 1; // > low, difference finite
    std::vector<double> ticks;
    std::vector<std::string> labels; // one per tick, all with the same number of digits
    bool logarithmic = false;
    double place(double value) const; // 0 at low, 1 at high
};

// An axis that holds the range with `margin` (a fraction) left free on either side and about `wanted` ticks at 1, 2 or 5 times a
// power of ten. An empty range becomes 0..1, a single value a small range around it.
Axis make_axis(Range range, double margin, int wanted);

// The same over decades; the range counts its positive part only.
Axis make_log_axis(Range range);

// Shortest text that shows `digits` significant digits, without trailing zeros: 0.0123, 4.5e-07, 12000.
std::string number(double value, int digits = 4);

// Fixed point with two decimals, for coordinates: never an exponent, never -0.00.
std::string coordinate(double px);

} // namespace traction::report
