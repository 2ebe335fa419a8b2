// scatter.h - how much of what a fit leaves may be the encoders' scatter.
//
// An effect that makes the model follow its wheels more slowly or more softly (a relaxation length, a softer soil) predicts better where
// they scatter, because it smooths that noise, though no machine has it. What a candidate gains in this way is no evidence: (1) of
// forward/rounding.h before and after, row by row, is taken from the fall of the squares.
#pragma once

#include "host_tools/lab/forward/rounding.h"
#include "problem.h"

namespace traction::lab {

// A shape must explain more than this part of what scatter may be, an effect that moves the body a third of it: assumed.
inline constexpr double of_scatter = 0.15;

// (1) as far as the residual of a fitted problem shows it: per balance no more than it leaves beyond the measurement noise, or beyond
// what another fit of the same rows leaves (`better`): where that is less than the noise stated, the noise is less. (Samples of a rounding
// encoder are not white: what (1) says of them is an upper estimate.)
struct Scatter {
    Eigen::VectorXd squares; // (1) at the problem's physics
    Eigen::VectorXd part;    // of (1), row by row, that counts
    double share = 0;        // of the problem's scaled squares that scatter may be
    explicit Scatter(const Problem &problem, const Problem *better = nullptr);
    // What another physics of the same data gains by smoothing, of each row's square; below nought where it roughens.
    Eigen::VectorXd smoothed_by(const Dataset &data, const Physics &other) const;
};

} // namespace traction::lab
