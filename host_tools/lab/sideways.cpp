#include "sideways.h"

#include "host_tools/lab/fit/heldout.h"
#include "host_tools/lab/fit/problem.h"
#include "host_tools/lab/inputs/inputs.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

constexpr double bend_m_s2 = 0.03;      // v r: less than that, and the middle drifts by less than a hundredth of what slip lets it
constexpr double share_of_bends = 0.02; // of the samples, at least
constexpr const char *grip = "lateral_scrub";
constexpr double grip_from = 0.25; // of its coefficient's search: from nothing it may end in a valley of its own

// Wheels that hold sideways, before or behind the middle: a skid steer's, or the one axle of a machine whose middle lies elsewhere.
bool may_drift(const Model &model) {
    return std::any_of(model.wheel.begin(), model.wheel.end(),
                       [](const WheelSpec &w) { return w.grips_sideways && std::fabs(parameter(w.geometry, "x_m")) > 1e-3; });
}

bool has_bends(const Model &model, const Dataset &data) {
    std::size_t bends = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        double speed = 0, turning = 0;
        for (std::size_t i = 0; i < model.wheel.size(); ++i) {
            if (data.wheel[i].rolls_freely) continue;
            speed += parameter(model.wheel[i].geometry, "radius_m") * data.wheel[i].speed_rad_s[k];
            ++turning;
        }
        if (std::fabs(speed * data.yaw_rate_rad_s[k]) > bend_m_s2 * turning) ++bends;
    }
    return static_cast<double>(bends) > share_of_bends * static_cast<double>(data.count);
}

// What the last balance, the camera's displacement to the left, says of a body that drifts beside one that has no such motion at all.
enum class Seen { nothing, drift, none };
Seen seen_by_camera(const Problem &straight, const Problem &sideways) {
    Eigen::VectorXd weight = Eigen::VectorXd::Zero(straight.residual.size());
    const auto rows = static_cast<Eigen::Index>(straight.data().balance.back().measured.size());
    weight.tail(rows) = straight.noise_rows().tail(rows).cwiseAbs2().cwiseInverse();
    const HeldOut one = as_fitted(straight), other = as_fitted(sideways);
    if (fall_between(one, other, weight).sure()) return Seen::drift;
    return fall_between(other, one, weight).sure() ? Seen::none : Seen::nothing;
}

bool has_grip(const Model &model) {
    return std::any_of(model.effects.begin(), model.effects.end(), [](const EffectUse &use) { return use.name == grip; });
}

EffectUse sideways_grip() {
    EffectUse use;
    use.name = grip;
    Parameter &p = use.parameters["coefficient"];
    p.value = grip_from, p.minimum = 0, p.given = true;
    return use;
}

} // namespace

bool drifts_sideways(const Model &model, const Dataset &data) {
    if (model.motion != BodyMotion::longitudinal || !data.yaw_free || data.yaw_rate_rad_s.size() != data.count ||
        data.wheel.size() != model.wheel.size() || !may_drift(model) || !has_bends(model, data))
        return false;
    Dataset asked = data;
    if (!data.camera_left.measured.empty()) asked.balance.push_back(data.camera_left);
    const auto fitted = [&](Model tried, BodyMotion motion) {
        tried.motion = motion;
        const Physics physics = make_physics(tried);
        Problem problem(asked, physics, free_parameters(tried, physics));
        problem.fit({.ready = false});
        return problem;
    };
    const Problem straight = fitted(model, BodyMotion::longitudinal), sideways = fitted(model, BodyMotion::planar);
    if (!fall_of_unlikelihood(straight, sideways).sure()) return false;
    const Seen seen = asked.balance.size() > data.balance.size() ? seen_by_camera(straight, sideways) : Seen::nothing;
    if (seen == Seen::none) return false;
    if (seen == Seen::drift || has_grip(model)) return true;
    Model gripping = model;
    gripping.effects.push_back(sideways_grip());
    return fall_of_unlikelihood(fitted(gripping, BodyMotion::longitudinal), sideways).sure();
}

} // namespace traction::lab
