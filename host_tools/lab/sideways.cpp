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

// Two axles or more, and wheels that all hold sideways.
bool may_drift(const Model &model) {
    double front = -1e9, rear = 1e9;
    for (const WheelSpec &w : model.wheel) {
        if (!w.grips_sideways) return false;
        front = std::max(front, parameter(w.geometry, "x_m")), rear = std::min(rear, parameter(w.geometry, "x_m"));
    }
    return front - rear > 1e-3;
}

bool has_bends(const Model &model, const Dataset &data) {
    std::size_t bends = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        double speed = 0;
        for (std::size_t i = 0; i < model.wheel.size(); ++i)
            speed +=
                parameter(model.wheel[i].geometry, "radius_m") * data.wheel[i].speed_rad_s[k] / static_cast<double>(model.wheel.size());
        if (std::fabs(speed * data.yaw_rate_rad_s[k]) > bend_m_s2) ++bends;
    }
    return static_cast<double>(bends) > share_of_bends * static_cast<double>(data.count);
}

} // namespace

bool drifts_sideways(const Model &model, const Dataset &data) {
    if (model.motion != BodyMotion::longitudinal || !data.yaw_free || !data.gyro || data.yaw_rate_rad_s.size() != data.count ||
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
    return fall_between(as_fitted(straight), as_fitted(sideways), straight.row_scale.cwiseAbs2()).sure();
}

} // namespace traction::lab
