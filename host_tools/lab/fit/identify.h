// identify.h - what a log says of a fitted model's parameters, and what it does not.
//
//   A = J'J + P (P: of the priors), in units in which A has a diagonal of ones; C = A^-1                                         (1)
// dead: moving the parameter by its prior's deviation (by its own size, or one unit, where it has none) changes all rows together by less
// than a tenth of a standard deviation. prior alone: its variance is more than 0.9 of the prior's. flat: no prior, and an error larger than
// the value. What wheels share and differ in counts by its mean over the wheels. correlated: |C_ij| / sqrt(C_ii C_jj) > 0.95. condition:
// largest over least eigenvalue of (1).
#pragma once

#include "problem.h"

#include <string>
#include <vector>

namespace traction::lab {

struct Limit {
    std::string parameter, unit;
    double value = 0;
    bool own = false;      // a wheel's own, and `value` its difference from what the wheels share
    bool of_prior = false; // six of its prior's deviations from the model's value; else the parameter's own minimum or maximum
};

struct Resonance {
    std::string balance;
    double frequency_Hz = 0, times = 0; // of the residual's spectrum, over its surroundings
};

struct Identifiability {
    std::vector<std::string> dead, flat, prior_alone;
    struct Pair {
        std::string a, b;
        double correlation = 0;
    };
    std::vector<Pair> correlated;
    double condition = 1;
};

// Parameters that stand at a limit of the fit. What a wheel's own differs is told by that wheel.
std::vector<Limit> limits_of(const Problem &problem);
std::string limit_text(const Limit &limit);
// Parameters but the sensors' (of what wheels share and differ in, the mean) that stand at no limit and yet more than three of their
// priors' deviations from the model's value, a sentence each.
struct Moved {
    std::string parameter, text;
};
std::vector<Moved> moved_far(const Problem &problem);
// Of the same, those at a limit with them: the most of its prior's deviations that one stands from the model's value.
double furthest_of_sheet(const Problem &problem);

// The problem must be linearised at its optimum.
Identifiability identifiability(const Problem &problem);

// Does nothing that the log holds depend on this parameter?
bool is_dead(const Problem &problem, std::size_t parameter);

// Peaks of the residual's spectrum above 0.5 Hz that stand out from their surroundings at p < 1e-4 (all frequencies of a balance together):
// Welch's method, Hann windows of at most 512 rows, half overlapping; surroundings: median of 20 frequencies on either side.
std::vector<Resonance> resonances(const Problem &problem);

} // namespace traction::lab
