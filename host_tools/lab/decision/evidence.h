// evidence.h - what a name is believed by, once the whole model is fitted with it and without it.
//
//   fall = sum of (held-out residual without)^2 - (with)^2 - what the name gains by smoothing the encoders' scatter, row by row     (1)
//
// in units of noise and on the scales of the model without it. Beyond smoothing a name must gain a twentieth of what scatter may be of the
// squares; where a softer ground beside it is all that smooths, (1) is asked with the ground as it was. A law that lags must gain where
// speeds change (lag.h), a grip that falls with slip in what the wheels have in common (uneven_grip.h). An accelerometer's scale must be
// more than what reading it once a tick makes:
//
//   tick / (2 tau),   tau = (J + M R^2 / n) Ra / (KG ke)                                                                            (2)
//
// A duty holds for a tick, in which the body's acceleration falls by tick / tau as its n motors gain speed; a sensor that is read at always
// the same time of it reads up to half of that more or less than the mean.
#pragma once

#include "host_tools/lab/fit/heldout.h"
#include "tolerance.h"
#include "trial.h"

#include <optional>

namespace traction::lab {

// (1), on the scales of the model without the name and in units of noise.
struct Evidence {
    Fall scaled, noise;
    bool smooths = false; // that is all it does, or its like (lag.h, uneven_grip.h, gyro_by_camera.h, turned_by_wheels.h, (2)): none
    bool falls() const { return !smooths && scaled.sure() && noise.sure(); }
};

// before: fitted without the candidate; with: the whole model with it, on the scales of `before`; their held-out errors.
Evidence evidence_of(const Candidate &candidate, const Problem &before, const HeldOut &left_before, const Problem &with,
                     const HeldOut &left_with);

// (2), of the wheel where it is most; 0 where no voltage is known.
double sawtooth_share(const Dataset &data, const Physics &physics);

// Squared stated deviations that are spared by it.
double spared_by(const Problem &before, const Problem &with);

// Whether a candidate is told at all, and how, before it is asked whether the sheet's numbers pay for it: where the rows alone say nothing
// because the stated tolerances give way, those decide, and are told beside it.
struct Support {
    bool enough = false, tolerance_as_much = false; // of all; a tolerance explains as much: told in a class with it
};
Support support_of(const Evidence &evidence, const std::optional<ToleranceRival> &rival, double spared, double least);

// The problem fitted anew from where a refit has left it (Trial::baseline), where that is a better place; nothing where it is none.
std::optional<Problem> fitted_from(const Trial &refitted, const Problem &problem);

} // namespace traction::lab
