// tolerance.h - the rival of every effect: a data sheet that is wrong by more than it states.
//
// A stated deviation (of a parameter that the wheels share, of what one wheel's differs from it, or all of the soil's together) is made
// three times as wide, up to nine stated deviations, and the model is fitted again without the effect and with it. Where the effect then
// predicts blocks left out no better, by two standard errors of the paired blocks or four squared deviations, the log cannot tell the two
// apart.
#pragma once

#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/problem.h"

#include <optional>
#include <string>

namespace traction::lab {

inline constexpr double two_deviations_squared = 4;
inline constexpr double opened = 3; // how many times wider a stated deviation may be: assumed

struct ToleranceRival {
    std::string name;           // "tolerance of motor.coulomb_Nm on wheel 2", "tolerance of the soil"
    double deviations = 0;      // of the stated kind that it takes
    double lead = 0, error = 0; // what the effect still explains beside it: held-out squares and priors, and its standard error
    bool explains_as_much() const;
};

// Where the rows alone do not say that an effect is needed, the stated tolerances may decide, which give way without it: rows and
// tolerances together gain more than `least` squared deviations, surely, and the error of blocks left out, in units of noise, rises by no
// more than two of its standard errors. `scaled`, `noise`: its falls on the fit's scales and in units of noise; `spared`: squared stated
// deviations that the parameters keep to.
bool tolerances_decide(const Fall &scaled, const Fall &noise, double spared, double least);

// A number of the sheet stands where the fit may go no further.
bool is_at_a_limit(const Problem &fit);

// Numbers that lie six stated deviations off, their limit, in `with` and not in `before` (an effect may fix what it stands for). A name
// that the stated tolerances alone speak for must not break one itself: from one contradiction with the sheet to another nothing is
// explained (prior-data conflict: Evans and Moshonov 2006, Bayesian Analysis 1, 893-914). Throws a logic_error for a `with` that holds
// no parameter, as one that was moved away.
std::size_t newly_at_limits(const Problem &before, const Problem &with);

// What the tolerances gain is reason enough for a name by which the error hardly falls: more than `least` squared stated deviations, and
// still four where these are widened by the error that is left, in noises (Birge 1932, the ratio of external to internal error), for a
// model that misses draws its numbers from what is stated by its misses alone; and none is broken anew.
bool tolerances_pay(double spared, double error_in_noise, std::size_t newly_at_limits, double least);

// The other way about: by the name the numbers go farther from what is stated, by more than four squared deviations widened by the error
// that it leaves (and more than `least`), and less than a tenth of its squares is explained and less than two fifths of those that are
// not noise (a model close to the noise has no tenth to give: a gyro's delay of 32 of its standard errors took 43 % of what was there). A
// law that the machine has takes the strain off the sheet's numbers; what strains them for little is what they bend around, as when the
// ground is not quite the model's.
bool strains_sheet(double spared, double error_before, double error_with, double least);

// The nearest rival of an effect. `before`: the model without it, linearised at its optimum; `with`: with it, on the same scales, its
// strengths the last parameters. Nothing where no stated deviation does a quarter of what the effect does.
std::optional<ToleranceRival> tolerance_rival(const Problem &before, const Problem &with, std::size_t strengths);

} // namespace traction::lab
