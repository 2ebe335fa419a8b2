// lag.h - whether a law by which the wheels' slip lags does more than average.
//
// Such a law averages over its own length whatever is false in the wheels' speed (counts that beat slowly with it, a count that a servo
// holds), and so predicts better where they run evenly, in which no lag shows. A real one tells where speeds change:
//   fall per row where a wheel's speed has changed by a tenth of the log's largest within length / median rim speed
//       > 2 x fall per row elsewhere                                                                                                (1)
// of the torque balances' held-out squares. And it takes longer than three tenths of the half width by which the wheels' speeds are
// smoothed (2): of 21 logs with such a name those that were true took half of it and more, six false ones 0.04 to 0.23, all at 0.4 m/s.
#pragma once

#include "host_tools/lab/fit/heldout.h"

namespace traction::lab {

// Longest relaxation length of a wheel [m]; 0: none lags.
double longest_lag_m(const Physics &physics);

// Steps of the grid at which a wheel's speed has changed by a tenth of the largest of all within the last `back` steps (at least one).
std::vector<char> changing_steps(const Dataset &data, std::size_t back);

// Whether the fall is not (1), of a model with a longer lag than the one before it; false of any other, and where all rows, or none, are at
// changes. Both held out on the same data.
bool only_averages(const Problem &before, const HeldOut &left_before, const Problem &with, const HeldOut &left_with);

} // namespace traction::lab
