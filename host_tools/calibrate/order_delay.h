// order_delay.h - how late an order acts, from currents: the delay with which the ordered duty explains them best.
//
//   I[k] = g V[k] d[k - D/T] + h w[k]                                               (1)  one g and h a wheel, least squares
//
// The order in force is a staircase, so its mean over a tick that is D late is (1 - f) d[k-n] + f d[k-n-1], D = (n + f) T. The
// D of the least sum of squares over all wheels is taken from a grid of 1 ms. (derived here)
#pragma once

#include "firmware/core/signals.h"

#include <array>
#include <cstddef>
#include <span>

namespace traction {

struct Sample { // one tick
    double battery_V = 0;
    struct Wheel {
        double speed_rad_s = 0, current_A = 0; // mean over the tick
        double ordered = 0;                    // duty that is in force in it when no order is late, -1..1
    };
    std::array<Wheel, WHEEL_COUNT> wheel{};
};

// Duty in force over tick k when orders act order_delay_s late; 0 before the first.
double duty_in_force(std::span<const Sample> samples, std::size_t k, std::size_t wheel, double order_delay_s);

// [s], 0 to 0.25 in steps of 1 ms. Samples without a step of duty tell nothing: 0.
double order_delay_s(std::span<const Sample> samples);

} // namespace traction
