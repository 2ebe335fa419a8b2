// smoothing_bias.h - what the smoothing of the wheels' speeds may cost the predictions where the speeds jump.
//
// Near a kink of the speed no smoothing follows: parabolas lose a part of the acceleration, cubics a share of that part. The forward
// model is asked with both: a row's bias is bounded by that share of the difference between the two predictions.
#pragma once

#include "host_tools/lab/inputs/dataset.h"

namespace traction::lab {

// Widens the noise of the balances' rows by that bias; leaves rows of the torque balances out where it exceeds eight times their noise,
// with a message. By the model's own numbers, before any fit.
void add_smoothing_bias(const Model &model, Dataset &data);

} // namespace traction::lab
