// heldout.h - the held-out error of a fitted model: each part of the log is predicted by a refit to the others, within the bounds.
//
// Blocks of 5 s (a log shorter than ten is cut finer; rows of a table of trials are blocks each) are dealt out to at most ten parts in
// turn. A refit begins at the optimum of all rows and steps by Gauss-Newton with an active set, on scales that stay; a step that does not
// lower the squares of the rows and priors that it may see is halved, so a step to beyond a bound, or one that the law's curve does not
// follow, counts as what it truly does. Screening's linear held-out error (screen.h) is for ranking alone.
#pragma once

#include "problem.h"

#include <Eigen/Dense>

#include <vector>

namespace traction::lab {

struct HeldOut {
    Eigen::VectorXd residual;       // of every row, predicted without its block; unscaled
    std::vector<std::size_t> block; // of every row
    std::size_t blocks = 0;
    double error = 0; // root of the mean over balances of its mean square, in units of each row's measurement noise
};

// The problem must be linearised at its optimum; it is left as it was. Costs about twenty predictions.
HeldOut held_out(const Problem &problem);

// The same without refits: every row as the fit to all of them leaves it. For two models with the same parameters.
HeldOut as_fitted(const Problem &problem);

// Fall of the held-out squares from one model to another on the same data, and its standard error over blocks.
struct Fall {
    double sum = 0, error = 0;
    Eigen::VectorXd of_block;
    bool sure() const { return sum > error; }
};
Fall fall_between(const HeldOut &before, const HeldOut &after, const Eigen::VectorXd &row_weight);

// Per row: -2 log likelihood by the problem's own scales, but for what is the same for all.
Eigen::VectorXd unlikelihood(const Problem &problem);

// The same of the rows' likelihood, of two models as fitted, each by its own scales. Squares by one model's scales do not compare two
// models where the first has weighed down what it misses.
Fall fall_of_unlikelihood(const Problem &before, const Problem &after);

// The weights by which the squares add up to the square of `error`.
Eigen::VectorXd noise_weight(const Problem &problem);

} // namespace traction::lab
