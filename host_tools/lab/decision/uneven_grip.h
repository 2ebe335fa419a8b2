// uneven_grip.h - whether a law by which grip falls as the wheel slips more does more than a ground that grips unevenly.
//
// Where the ground holds less the wheel slips more, wheel by wheel: that alone looks like a grip that falls with slip. It is each wheel's
// own; the law is all wheels', and tells in seconds. So of the torque balances' held-out squares, each row the mean over a second,
//   share taken of the wheels' > 1/2, or > 0.3 and share taken of the mean of all wheels > 1/2 of that                              (1)
#pragma once

#include "host_tools/lab/fit/heldout.h"
#include "trial.h"

namespace traction::lab {

// Shares of the held-out squares, means over a second, that a model takes off another's on the same data; negative: it adds.
struct SharesTaken {
    int wheels = 0; // that have such rows
    double of_wheels = 0, of_all_together = 0;
};
SharesTaken shares_taken(const Problem &before, const HeldOut &left_before, const HeldOut &left_with);

// (1); true of a law that is not of this kind or of one wheel, and where fewer than two wheels' currents are measured.
bool holds_in_common(const Candidate &law, const Problem &before, const HeldOut &left_before, const HeldOut &left_with);

} // namespace traction::lab
