// reversal.h - what nobody knows of how a wheel's rolling resistance reverses about standstill.
//
//   Q = resist v/sqrt(v^2 + e^2), e of some millimetres a second: assumed, and of no machine known within a factor of two                (1)
// A drive that creeps at a centimetre a second has many rows within it, and takes its numbers from the assumption: on loam, of drives
// of 1 to 10 cm/s with nothing hidden, rolling resistance went six stated deviations off, and other numbers after it.
#pragma once

#include "host_tools/lab/inputs/dataset.h"

namespace traction::lab {

// Widens the noise of the torque balances' rows by what (1) changes between half of e and twice it. By the model's own numbers, before any
// fit.
void add_reversal(const Model &model, Dataset &data);

} // namespace traction::lab
