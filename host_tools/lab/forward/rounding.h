// rounding.h - what the encoders' scatter (rounding, a clock that jitters) does to a prediction.
//
// A stiff soil turns a wheel's speed noise into pull: on concrete a count of 1 mrad is a force of 0.1 N and more, other at each wheel:
//   E[(p(w + n) - p(w))^2], n the slope of the smoothing parabolas through white errors of the samples' scatter           (1)
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "physics.h"

#include <Eigen/Dense>

namespace traction::lab {

// (1) of each row of `data` as this physics predicts it, unscaled, the mean of `draws` seeded draws (each has thousands of independent
// rows); zeros where no encoder's scatter is known.
Eigen::VectorXd rounding_squares(const Dataset &data, const Physics &physics, int draws = 2);

} // namespace traction::lab
