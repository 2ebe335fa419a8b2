#include "bends.h"

#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/ladder.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/fit/screen.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

constexpr const char *curve_key = "shear_curve";
constexpr double deviation = 0.3;                     // of the curve: tanh is 0.39 from (20) and 0.17 from (21), lab_wheel_step_test
constexpr double asks_from = 0.015, large_fall = 0.1; // of the squares; assumed, as what follows (bends.h)
constexpr double certain = 2.5, sure_of_much = 1;     // half widths of the 95 % interval
constexpr double part_of_the_shape = 0.5;             // of what a shape over slip gains: assumed

bool states_it(const WheelSpec &wheel) {
    const auto stated = wheel.soil.find(curve_key);
    return stated != wheel.soil.end() && (stated->second.given || !(stated->second.prior == 0));
}

Problem problem_of(const Model &model, const Dataset &data) {
    const Physics physics = make_physics(model);
    return {data, physics, free_parameters(model, physics)};
}

// Of the curve, in half widths of its 95 % interval.
double certainty(const Problem &problem) {
    const std::vector<ParameterError> errors = Screen(problem).parameter_errors();
    for (std::size_t i = 0; i < problem.parameters.size(); ++i)
        if (problem.parameters[i].owner == "soil" && problem.parameters[i].key == curve_key && errors[i].half_width > 0)
            return std::fabs(problem.theta[static_cast<Eigen::Index>(i)]) / errors[i].half_width;
    return 0;
}

} // namespace

bool bends_otherwise(const Model &model, const Dataset &data, double shape_over_slip) {
    const bool moves = model.motion == BodyMotion::longitudinal || model.motion == BodyMotion::planar;
    if (!moves || data.wheel.size() != model.wheel.size() || data.balance.empty() || data.count < 3) return false;
    if (std::any_of(model.wheel.begin(), model.wheel.end(), states_it)) return false;
    Model bent = model;
    ask_for_curve(bent);
    Problem law = problem_of(model, data), other = problem_of(bent, data), afresh = other;
    law.fit({});
    other.start_near(law);
    other.within_bounds();
    other.fit({});
    afresh.fit({}); // the law's place may be a valley of its own
    if (overall_error(afresh) < overall_error(other)) other = std::move(afresh);
    const Eigen::VectorXd weight = noise_weight(law);
    const double least = shape_over_slip > 0 ? part_of_the_shape * shape_over_slip : asks_from;
    const auto fall_of = [&](const HeldOut &before, const HeldOut &after) { // share of the squares, where it is sure
        const Fall fall = fall_between(before, after, weight);
        return fall.sure() ? fall.sum / before.residual.cwiseAbs2().dot(weight) : 0;
    };
    if (!(fall_of(as_fitted(law), as_fitted(other)) > least)) return false;
    const double fall = fall_of(held_out(law), held_out(other));
    return fall > least && (shape_over_slip > 0 || certainty(other) > (fall > large_fall ? sure_of_much : certain));
}

void ask_for_curve(Model &model) {
    for (WheelSpec &wheel : model.wheel) {
        Parameter &p = wheel.soil[curve_key];
        p.value = 0, p.prior = deviation, p.fixed = false;
        p.source = "assumed: the log asks for it";
    }
}

} // namespace traction::lab
