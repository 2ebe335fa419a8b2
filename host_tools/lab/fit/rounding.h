// rounding.h - what the encoders' scatter (rounding, a clock that jitters) does to a prediction.
//
// A stiff soil turns a wheel's speed noise into pull: on concrete a count of 1 mrad is a force of 0.1 N and more, other at each wheel. An
// effect that makes the model follow its wheels more slowly or more softly (a relaxation length, a softer soil) then predicts better,
// because it smooths that noise, though no machine has it. What a candidate gains in this way is no evidence:
//   E[(p(w + n) - p(w))^2], n the slope of the smoothing parabolas through white errors of the samples' scatter           (1)
// before and after, row by row, is taken from the fall of the squares.
#pragma once

#include "problem.h"

#include <Eigen/Dense>

namespace traction::lab {

// (1) of each row of `data` as this physics predicts it, unscaled, the mean of a few seeded draws; zeros where no encoder's scatter is
// known.
Eigen::VectorXd rounding_squares(const Dataset &data, const Physics &physics);

// One draw of p(w + n) - p(w), of each row.
Eigen::VectorXd rounding_draw(const Dataset &data, const Physics &physics, int draw);

} // namespace traction::lab
