// make_dataset.h - a log made ready for a fit: inputs and measured rows (inputs/dataset.h), the bias of their smoothing (smoothing_bias.h),
// and the noise that a repeat run shows.
#pragma once

#include "host_tools/lab/inputs/dataset.h"

namespace traction::lab {

// Never throws for a poor log: what cannot be used is left out with a message. `repeat`: a second run of the same drive, whose
// difference gives the noise; nullptr when there is none. Bounds on the smoothing's bias are taken with the noise that the log itself
// tells.
Dataset make_dataset(const Model &model, const log::Log &log, const log::Log *repeat = nullptr);

} // namespace traction::lab
