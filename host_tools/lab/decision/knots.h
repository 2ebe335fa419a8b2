// knots.h - where the knots of a structure-free shape f(X) go, by the values of X that a log holds.
#pragma once

#include "host_tools/lab/forward/motion.h"
#include "host_tools/lab/inputs/dataset.h"

#include <vector>

namespace traction::lab {

struct AxisValues {
    std::vector<double> values;         // of all wheels
    bool varies_between_wheels = false; // X differs between the wheels more than within one: f(X) may stand for the wheels
};

// `current_A`: the model's, per wheel.
AxisValues values_on(Axis axis, const Dataset &data, const Motion &motion, const Physics &physics,
                     const std::vector<std::vector<double>> &current_A, bool of_motors = false);

// At quantiles; over even steps where most of the time is spent at one value; after a reversal where friction turns; at the ends of a
// current that drives a torque; near zero of a voltage. Fewer than three: the log has no such X.
std::vector<double> knots_on(Axis axis, const std::vector<double> &values, bool of_torque);

} // namespace traction::lab
