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

} // namespace

bool drifts_sideways(const Model &model, const Dataset &data) {
    if (model.motion != BodyMotion::longitudinal || !data.yaw_free || data.yaw_rate_rad_s.size() != data.count ||
        data.wheel.size() != model.wheel.size() || !may_drift(model) || !has_bends(model, data))
        return false;
    const auto fitted = [&](BodyMotion motion) {
        Model tried = model;
        tried.motion = motion;
        const Physics physics = make_physics(tried);
        Problem problem(data, physics, free_parameters(tried, physics));
        problem.fit({.ready = false});
        return problem;
    };
    const Problem straight = fitted(BodyMotion::longitudinal), sideways = fitted(BodyMotion::planar);
    return fall_of_unlikelihood(straight, sideways).sure();
}

} // namespace traction::lab
