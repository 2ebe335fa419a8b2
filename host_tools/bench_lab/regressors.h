// regressors.h - the lab's question as one linear regression, for programs that regress: what the fitted model leaves, and what
// every candidate of the catalogue would change in it.
//
// File: one line of JSON, then float32 little-endian columns of `rows` numbers each: time_s, block of the balance (index), residual,
// then the listed columns. All are on the lab's own scales: one is a standard deviation of the row, as the fitted model weighs it.
#pragma once

#include "host_tools/lab/inputs/dataset.h"

#include <string>

namespace traction::bench_lab {

// Fits the model to the data, then writes the residual, the sensitivities of the model's own parameters (with the standard deviation
// of their priors) and those of each candidate: effect x wheel x shape. Reads nothing but its arguments.
void write_regressors(const lab::Model &model, const lab::Dataset &data, const std::string &file);

} // namespace traction::bench_lab
