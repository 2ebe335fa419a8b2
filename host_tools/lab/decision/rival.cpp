#include "rival.h"

#include "shape_refit.h"
#include "shape_scores.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <vector>

namespace traction::lab {

namespace {

constexpr int most_refits = 4;
constexpr double half_of_it = 0.5;   // of the name's fall, that a shape explains by its linear step at least
constexpr double notably_more = 1.1; // as the name, that a shape must explain to take its place
constexpr double errors_ahead = 2;   // standard errors over blocks
constexpr double same_cosine = 0.98; // assumed
constexpr double least_beside = 0.1; // of the name's fall, that it must still explain beside the shape to be needed there: assumed

const std::map<std::string_view, std::vector<Axis>> &own_axes() {
    static const std::vector<Axis> speeds = {Axis::wheel_speed, Axis::abs_wheel_speed, Axis::speed, Axis::abs_speed, Axis::direction},
                                   along = {Axis::path, Axis::place}, of_slip = {Axis::slip},
                                   of_current = {Axis::current, Axis::load, Axis::slip};
    static const std::map<std::string_view, std::vector<Axis>> table = {
        {"coulomb_friction", {Axis::direction, Axis::wheel_speed, Axis::abs_wheel_speed}},
        {"viscous_friction", speeds},
        {"stribeck_friction", speeds},
        {"churning_friction", speeds},
        {"reverse_friction", speeds},
        {"gear_speed_loss",
         {Axis::wheel_speed, Axis::abs_wheel_speed, Axis::speed, Axis::abs_speed, Axis::current, Axis::load, Axis::slip}},
        {"mesh_loss", of_current},
        {"torque_constant", of_current},
        {"current_gain", of_current},
        {"wear_in", {Axis::time}},
        {"winding_heating", {Axis::time, Axis::current}},
        {"accel_drift", {Axis::time}},
        {"torque_ripple", {Axis::angle, Axis::turn}},
        {"backlash", {Axis::reversal, Axis::angle}},
        {"wiring_resistance", {Axis::current}},
        {"bridge_dead_time", {Axis::current, Axis::voltage}},
        {"shared_lead", {Axis::other_current, Axis::axle_current, Axis::side_current, Axis::current}},
        {"slip_sinkage", of_slip},
        {"shear_peak", of_slip},
        {"shear_stiffness", of_slip},
        {"relaxation_length", of_slip},
        {"sliding_speed_loss", {Axis::slip, Axis::speed, Axis::abs_speed, Axis::wheel_speed, Axis::abs_wheel_speed}},
        {"speed_resistance", speeds},
        {"squared_resistance", speeds},
        {"fluid_drag", speeds},
        {"radar_scale", speeds},
        {"encoder_missed", {Axis::wheel_speed, Axis::abs_wheel_speed, Axis::speed, Axis::abs_speed, Axis::slip}},
        {"wheel_radius", {Axis::wheel_speed, Axis::abs_wheel_speed, Axis::speed, Axis::abs_speed, Axis::slip}},
        {"soil_patch", along},
        {"soil_gradient", along},
        {"resistance_patch", along},
        {"multi_pass", along},
        {"tether_drag", along},
        {"lateral_scrub", {Axis::yaw_rate}},
        {"load_transfer", {Axis::accel, Axis::load}},
        {"accel_scale", {Axis::accel}},
        {"accel_tilt", {Axis::accel}},
        {"radar_pitch", {Axis::accel}},
    };
    return table;
}

// Squares of blocks left out, with what is gained by smoothing the encoders' scatter put back.
HeldOut sharp(const Problem &with, const Problem &less, unsigned touched, const Scatter &scatter) {
    HeldOut held = held_out(with);
    if ((touched & stage_motion) == 0) return held;
    held.residual = (held.residual.cwiseAbs2() + scatter.smoothed_by(less.data(), with.physics())).cwiseMax(0.0).cwiseSqrt();
    return held;
}

bool is_sure_fall(const Fall &fall) { return fall.sum > errors_ahead * fall.error; }

// Over slip and in waves along the path the ground of any log gives a shape something to explain (shape_rules.h).
bool absorbs_all(const Candidate &c) { return c.axis == Axis::slip || (c.order > 0 && c.target == TermTarget::soil_strength); }

// What both change in the log, beside all that the model may retune: the same, so one is how the other looks.
bool is_same_change(const Eigen::VectorXd &law, const Eigen::VectorXd &shape) {
    const double norm = law.norm() * shape.norm();
    return norm > 0 && std::fabs(law.dot(shape)) > same_cosine * norm;
}

Problem on_scales_of(const Problem &less, const Problem &last) {
    Problem with = last;
    with.keep_scales(less);
    with.jacobian.resize(0, 0);
    with.gauss_newton(2);
    return with;
}

} // namespace

bool is_own_axis(const std::string &effect, Axis axis) {
    const auto found = own_axes().find(effect);
    return found != own_axes().end() && std::find(found->second.begin(), found->second.end(), axis) != found->second.end();
}

bool is_constant_of(const std::string &effect, TermTarget target) {
    static const std::map<std::string_view, TermTarget> table = {
        {"rolling_resistance", TermTarget::rolling}, {"coulomb_friction", TermTarget::wheel_friction},
        {"radar_scale", TermTarget::radar},          {"torque_constant", TermTarget::motor_constant},
        {"current_gain", TermTarget::current},       {"wiring_resistance", TermTarget::resistance},
        {"camera_scale", TermTarget::camera},        {"accel_bias", TermTarget::accel},
        {"shear_stiffness", TermTarget::shear_slip},
    };
    const auto found = table.find(effect);
    return found != table.end() && found->second == target;
}

std::vector<std::string> laws_with_axes() {
    std::vector<std::string> list;
    for (const auto &[effect, axes] : own_axes()) list.emplace_back(effect);
    return list;
}

std::optional<Rival> rival_of(const Candidate &named, const std::vector<std::string> &alternatives, const Problem &last, Problem less,
                              const DiagnoseOptions &options) {
    const Scatter scatter(less);
    const Eigen::VectorXd weight = less.row_scale.cwiseAbs2(), noise = noise_weight(less);
    const HeldOut left = held_out(less);
    const Problem with = on_scales_of(less, last);
    const HeldOut by_name = sharp(with, less, named.touched, scatter);
    const Fall own = fall_between(left, by_name, weight);
    if (!own.sure()) return std::nullopt; // precise rows speak for it, which these squares hardly see
    Eigen::MatrixXd of_name;
    const Problem without = without_effect(with, named, of_name);
    const Screen screen(less);
    const Eigen::VectorXd law = screen.projected((with.residual - without.residual).cwiseProduct(less.row_scale));
    std::optional<Rival> best;
    double most = 0;
    int refits = 0;
    std::set<std::tuple<TermTarget, Axis, bool>> seen;
    for (ShapeScore &s : all_shapes(less, screen, true)) {
        const Candidate &c = s.candidate;
        if (!(s.p_value < options.shape_p_limit) || !(s.assessment.gain > half_of_it * own.sum)) continue;
        const auto is_look_of = [&](const std::string &effect) { return is_own_axis(effect, c.axis) || is_constant_of(effect, c.target); };
        if (absorbs_all(c) || is_look_of(named.effect) || std::any_of(alternatives.begin(), alternatives.end(), is_look_of)) continue;
        if (refits >= most_refits) break;
        if (!seen.insert({c.target, c.axis, is_straight(c)}).second) continue;
        ++refits;
        const Problem shaped = with_shape(less, s);
        const HeldOut by_shape = sharp(shaped, less, c.touched, scatter);
        const Fall fall = fall_between(left, by_shape, weight), lead = fall_between(by_name, by_shape, weight),
                   noise_lead = fall_between(by_name, by_shape, noise);
        const bool better = is_sure_fall(lead) && fall.sum > notably_more * own.sum;
        const bool as_well = is_sure_fall(fall) && lead.sum > -lead.error && -noise_lead.sum < errors_ahead * noise_lead.error;
        if (!better && !as_well) continue;
        if (!better && is_same_change(law, screen.projected(s.columns.whole() * shaped.theta.tail(s.columns.cols())))) continue;
        ShapeScore fitted = as_fitted(s, shaped);
        if (!is_possible(fitted)) continue;
        const Problem both = with_shape(with, s);
        const Fall beside = fall_between(by_shape, sharp(both, less, named.touched | c.touched, scatter), weight);
        const bool needed = is_sure_fall(beside) && beside.sum > (better ? half_of_it : least_beside) * own.sum;
        if (needed || (best && (best->better > better || !(fall.sum > most)))) continue;
        best = Rival{std::move(fitted), better, screen.heldout_error()};
        most = fall.sum;
    }
    return best;
}

bool outdoes(const Candidate &named, const Problem &last, const Problem &less, const ShapeScore &shape) {
    const Scatter scatter(less);
    const HeldOut by_name = sharp(on_scales_of(less, last), less, named.touched, scatter),
                  by_shape = sharp(with_shape(less, shape), less, shape.candidate.touched, scatter);
    return is_sure_fall(fall_between(by_shape, by_name, less.row_scale.cwiseAbs2()));
}

constexpr double names_ahead = 0.6; // of the held-out error with a shape in their place: assumed

bool predicts_surely_better(const Problem &last, const Problem &less, const ShapeScore &shape) {
    return held_out(last).error < names_ahead * held_out(with_shape(less, shape)).error;
}

} // namespace traction::lab
