// ladder.h - the ladder of models, each a step richer than the one before: the error of each on what it was fitted to and on blocks left
// out, beside the noise floor.
#pragma once

#include "problem.h"

#include <optional>
#include <string>

namespace traction::lab {

struct LadderStep {
    std::string label;                        // "baseline", "+ slip_sinkage"
    double train = 0, heldout = 0, floor = 1; // in units of noise
};

// Root of the mean over balances of the mean square of the residual, in units of each row's measurement noise, on the rows that were
// fitted; that of blocks left out: heldout.h. 0 without balances.
double overall_error(const Problem &problem);

// The model's problem at its optimum, linearised there. A strength whose slope at zero says little (what remembers: play, relaxation) is
// started from several places over its range as well; the least squares on the first start's scales are kept.
Problem fitted_problem(const Model &model, const Dataset &data);

// The same problem with a parameter that remembers at 5, 15 and 40 % of its range, all others where they stand, each searched for from
// there: the one of the least cost, on the same scales; nothing where none lies below `least`.
std::optional<Problem> from_afar(const Problem &problem, std::size_t parameter, double least);

// Half of the 95 % interval of an effect's size, time or speed. No law of the catalogue is a machine's own: the same law written by another
// hand differs from it by a few hundredths, in every block alike, so that no scatter over blocks tells. `of_data`: by the rows alone.
double with_the_laws_own(double of_data, double value);

// The optimum of fitted_problem(); writes the values with their 95 % intervals into it.
LadderStep fit_model(Model &model, const Dataset &data, const std::string &label);
LadderStep store_fit(Model &model, const Problem &fitted, const std::string &label); // the same of a problem at its optimum

} // namespace traction::lab
