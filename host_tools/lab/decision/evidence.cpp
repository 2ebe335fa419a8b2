#include "evidence.h"

#include "gyro_by_camera.h"
#include "host_tools/lab/fit/scatter.h"
#include "lag.h"
#include "rounds.h"
#include "turned_by_wheels.h"
#include "uneven_grip.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

Evidence falls_of(const Problem &before, const HeldOut &left_before, const HeldOut &left_with) {
    return {fall_between(left_before, left_with, before.row_scale.cwiseAbs2()), fall_between(left_before, left_with, noise_weight(before))};
}

bool reads_at_one_time(const Candidate &candidate, const Problem &with) {
    return candidate.effect == "accel_scale" &&
           std::fabs(with.physics().body.accel_scale) < 1.2 * sawtooth_share(with.data(), with.physics());
}

bool gyro_is_denied(const Candidate &candidate, const Problem &with) {
    if (candidate.effect != "gyro_scale") return false;
    if (!turned_by_wheels(with.data(), with.physics())) return true;
    const std::optional<ScaleByPeer> seen = gyro_by_camera(with.data());
    return seen && seen->denies(with.physics().body.gyro_scale);
}

} // namespace

double sawtooth_share(const Dataset &data, const Physics &physics) {
    double share = 0, driven = 0;
    for (const bool one : physics.driven) driven += one ? 1 : 0;
    for (std::size_t i = 0; i < physics.wheel.size() && i < data.wheel.size(); ++i) {
        const WheelPhysics &w = physics.wheel[i];
        const std::vector<double> &t = data.wheel[i].voltage_t_s;
        if (!physics.driven[i] || t.size() < 3 || !(w.KG * w.ke > 0)) continue;
        const double tick_s = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
        const double tau_s = (w.J + physics.body.mass * w.radius * w.radius / driven) * w.Ra / (w.KG * w.ke);
        share = std::max(share, 0.5 * tick_s / tau_s);
    }
    return share;
}

Evidence evidence_of(const Candidate &candidate, const Problem &before, const HeldOut &left_before, const Problem &with,
                     const HeldOut &left_with) {
    Evidence out = falls_of(before, left_before, left_with);
    out.smooths = reads_at_one_time(candidate, with) || gyro_is_denied(candidate, with);
    if ((candidate.touched & stage_motion) == 0) return out;
    const Scatter scatter(before, &with);
    const Eigen::VectorXd weight = before.row_scale.cwiseAbs2();
    const double least = of_scatter / 3 * scatter.share * before.residual.cwiseAbs2().dot(weight);
    const auto take_off = [&](const Problem &fit) {
        const Eigen::VectorXd smoothed = scatter.smoothed_by(before.data(), fit.physics());
        out.scaled.sum -= smoothed.dot(weight);
        out.noise.sum -= smoothed.dot(noise_weight(before));
    };
    take_off(with);
    if (!(out.scaled.sum > least)) {
        const Problem on_ground = held_ground(with, before);
        out = falls_of(before, left_before, held_out(on_ground));
        take_off(on_ground);
    }
    out.smooths = !(out.scaled.sum > least) ||
                  (!takes_most(left_before, left_with) && only_averages(before, left_before, with, left_with)) ||
                  !holds_in_common(candidate, before, left_before, left_with);
    return out;
}

double spared_by(const Problem &before, const Problem &with) {
    return before.theta.cwiseAbs2().dot(before.stated_precision()) - with.theta.cwiseAbs2().dot(with.stated_precision());
}

Support support_of(const Evidence &evidence, const std::optional<ToleranceRival> &rival, double spared, double least) {
    if (evidence.smooths) return {};
    const bool by_sheet = rival && tolerances_decide(evidence.scaled, evidence.noise, spared, least);
    return {evidence.falls() || by_sheet, rival && (rival->explains_as_much() || !evidence.falls())};
}

std::optional<Problem> fitted_from(const Trial &refitted, const Problem &problem) {
    Problem moved = problem;
    const double before = moved.cost();
    moved.theta = refitted.baseline;
    moved.within_bounds();
    moved.jacobian.resize(0, 0);
    moved.gauss_newton(3, false);
    if (moved.cost() > before - least_reduction) return std::nullopt;
    moved.fit({});
    return moved;
}

} // namespace traction::lab
