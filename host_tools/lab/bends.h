// bends.h - whether the ground's pull over slip bends otherwise than the law of the model, (6) of forward/wheel_laws.h.
//
// (20) and (21) are two curves of many: sand, carpet and asphalt each go from their stiffness to their strength in a way of their own, and
// a model of the other way leaves a shape over slip where nothing is missing. Asked of the log: the curve is set free where blocks left out
// are predicted better with it, by more than the standard error of that and by one and a half per cent of the squares, and where the fit
// is two and a half half widths of its own 95 % interval from the law; one where it takes a tenth of the squares.
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/model/model.h"

#include <string>

namespace traction::lab {

// `data`: of `model`, whose body's motion follows from its forces and which does not state the curve itself. shape_over_slip: share of the
// held-out squares that a structure-free shape over slip gains, where the lab has found one; half of it is enough then, be the curve as
// uncertain as it may.
bool bends_otherwise(const Model &model, const Dataset &data, double shape_over_slip = 0);

// Sets soil.shear_curve free.
void ask_for_curve(Model &model);

inline const std::string curve_is_asked =
    "the ground's pull over slip bends otherwise than the law of the model: that is fitted too (soil.shear_curve)";

} // namespace traction::lab
