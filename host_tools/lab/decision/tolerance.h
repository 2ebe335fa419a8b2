// tolerance.h - the rival of every effect: a data sheet that is wrong by more than it states.
//
// One stated deviation after the other (a parameter that the wheels share, what one wheel's differs from it, or all of the soil's) is made
// three times as wide, and the model without the effect is fitted again. Where that predicts blocks left out as well as the effect does,
// within two standard errors of the paired blocks or four squared deviations, the log cannot tell the two apart.
#pragma once

#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/problem.h"

#include <optional>
#include <string>

namespace traction::lab {

inline constexpr double opened = 3; // how many times wider a stated deviation may be: assumed

struct ToleranceRival {
    std::string name;           // "tolerance of motor.coulomb_Nm on wheel 2", "tolerance of the soil"
    double deviations = 0;      // of the stated kind that it takes
    double lead = 0, error = 0; // what the effect explains more than it: held-out squares and priors, and its standard error
    bool explains_as_much() const;
    bool explains_more() const { return lead < -2 * error; }
};

// The best rival of an effect. `before`: the model without it, linearised at its optimum; `with`: with it, on the same scales, and its
// held-out error. Nothing where no parameter has a prior.
std::optional<ToleranceRival> tolerance_rival(const Problem &before, const Problem &with, const HeldOut &with_heldout);

} // namespace traction::lab
