// remainder.h - what a fitted model leaves, split into parts by what each part follows: sensors, ground, encoders.
//
//   E^2 = mean over balances of mean (residual / noise)^2 = sum of the parts' squares                                   (1)
//
// A balance's mean square is split as the scales of its rows are (problem.h): a non-negative sum of a constant, of what grows with
// traction (ground that differs from place to place scales the pull by as much everywhere), with a wheel's acceleration (the encoders'
// smoothing), where the soil's curve is steep, with speed (vibration), and with the range of the speed inside one reading. Of the constant,
// one square of noise is the sensors'. A part is what the residual follows, not a proof of its cause: an effect that is missing lands in
// these parts too. So they are told as a cause only after a diagnosis has found nothing more.
#pragma once

#include "problem.h"

#include <array>
#include <vector>

namespace traction::lab {

enum class LeftBy { sensors, ground, encoders, steep_soil, vibration, mixed_speed, everywhere, outliers };
constexpr std::size_t left_by_count = 8;

struct Remainder {
    double error = 0;                         // E of (1), in units of noise: overall_error() of ladder.h
    std::array<double, left_by_count> part{}; // roots of the parts' squares, by LeftBy, in units of noise
    double of(LeftBy cause) const { return part[static_cast<std::size_t>(cause)]; }
};

// "how the ground varies from place to place": for "..., of which 4.1 is ".
const char *words_of(LeftBy cause);

// Of a problem at its optimum. All zero without balances.
Remainder remainder_of(const Problem &problem);

} // namespace traction::lab
