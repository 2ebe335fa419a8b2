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

// A shape must explain more than this part of what scatter may be, an effect that moves the body a third of it: assumed.
inline constexpr double of_scatter = 0.15;

// The same as far as the residual of a fitted problem shows it: per balance no more than it leaves beyond the measurement noise. (Samples
// of a rounding encoder are not white: what (1) says of them is an upper estimate.)
struct Scatter {
    Eigen::VectorXd part; // of (1), row by row, that counts
    double share = 0;     // of the problem's scaled squares that scatter may be
    explicit Scatter(const Problem &problem);
};

} // namespace traction::lab
