// odd_wheel.h - one wheel that the model misses by far more than the others: something is wrong with it, be there a law for it or not.
//
//   e_w / median(e of the other wheels) > 1.25 by voltage, 2 by torque,                                                    (1)
//   e^2 = mean((residual / noise)^2) of the wheel's currents, but for the largest hundredth
//
// Ground and smoothing leave wheels alike: of 355 clean logs the largest ratio, by all rows, was 1.06 by voltage, 1.84 by torque
// (docs/lab_method.md). A fault that shows in few rows (a dead band, a loose hub) is no shape that all rows bear, and is seen here.
#pragma once

#include "diagnose.h"

#include <optional>
#include <string>
#include <vector>

namespace traction::lab {

struct OddWheel {
    int wheel = 0;
    bool electric = false;        // by its voltage; else by its torque
    double error = 0, others = 0; // of (1), in noises: its own, and the others' median
    double excess() const { return error * error - others * others; }
};

// Of a fitted problem, the wheel whose ratio is farthest beyond (1); nothing where none is, or where a wheel has none beside it.
std::optional<OddWheel> odd_wheel(const Problem &fitted);

// What is left of such a wheel in another fit, by the same currents.
double excess_of(const OddWheel &wheel, const Problem &fitted);

// An effect on that wheel that leaves most of it is not its cause.
bool explains_wheel(double excess_without, double excess_with);

// The shape over which most of what is left on that wheel lies, of those on it alone that act as it shows; and a word where none gains.
UnknownShape what_acts_on(const OddWheel &wheel, const Problem &fitted);

std::string odd_wheel_words(const OddWheel &wheel);

} // namespace traction::lab
