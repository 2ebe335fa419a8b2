// lag.h - whether a law by which the wheels' slip lags does more than smooth what scatters.
//
// Such a law averages the wheels' speed over its own length, and so whatever is false in it: rounding that beats slowly with the speed, a
// ground that was softened to bear it. A real lag is still there when the wheels are averaged before they come to the model, evenly to both
// sides, so that nothing lags: both models are fitted anew to wheels smoothed over half the law's own time, length / median rim speed.
#pragma once

#include "host_tools/lab/fit/heldout.h"

namespace traction::lab {

// Longest relaxation length of a wheel [m]; 0: none lags.
double longest_lag_m(const Physics &physics);

// The same data with each wheel's speed, where it turns, by parabolas over +-half_s.
Dataset with_smoothed_wheels(const Dataset &data, double half_s);

// Whether on such wheels the fall of the held-out squares (on the scales of `before`) is not surely, by three standard errors, a sixth of
// `fall`, that on the wheels as they are. False where the law's time is within the smoothing that the wheels have.
bool only_averages(const Problem &before, const Problem &with, double fall);

} // namespace traction::lab
