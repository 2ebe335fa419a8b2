// Neighbours of a known motion, (3) of motion.h.
#include "motion.h"

#include "wheel_step.h"

#include <Eigen/Dense>
#include <array>

#include <cmath>

namespace traction::lab {

namespace {

using Eigen::Vector3d;

// What the moved parameters alone change at a step of the known motion: the body's rate, the traction of wheels first to last - 1.
class Moved {
  public:
    Moved(const Dataset &data, const Physics &moved, const Motion &known, std::size_t first, std::size_t last)
        : step_(data, moved), p_(moved), gyro_(data.yaw_rate_rad_s), known_(known), freedom_(detail::freedom_of(data, moved)),
          first_(first), last_(last) {}

    Vector3d rate_change(std::size_t k, const Vector3d &q, double v_before, double accel_before, double path) {
        step_.remember_twist(k == 0 ? 0 : known_.twist_N[k - 1]);
        step_.prepare(k, v_before, accel_before, path, k == 0 ? 0 : known_.away_m[k - 1], first_, last_);
        for (std::size_t i = first_; i < last_; ++i)
            step_.remember(i, k == 0 ? 0 : known_.wheel[i].slip[k - 1], k == 0 ? 0 : known_.wheel[i].side_slip[k - 1]);
        Vector3d force = Vector3d::Zero();
        if (first_ == 0 && last_ == p_.wheel.size())
            force = step_.forces(q, nullptr);
        else
            for (std::size_t i = 0; i < p_.wheel.size(); ++i)
                force += i >= first_ && i < last_ ? step_.force(i, q) : known_.wheel[i].force[k];
        const double speed = freedom_.omni ? std::hypot(q[0], q[1]) : q[0], along = step_.body_force(speed);
        if (!freedom_.omni)
            force[0] += along;
        else if (speed > 1e-6)
            force[0] += along * q[0] / speed, force[1] += along * q[1] / speed;
        return detail::rate_of(force, q, step_.grade_accel(), gyro_.empty() ? 0 : gyro_[k], p_, freedom_) - known_.rate[k];
    }
    double traction_change(std::size_t i, std::size_t k) const {
        return i >= first_ && i < last_ ? step_.state(i).traction - known_.wheel[i].traction_N[k] : 0;
    }
    double slip_change(std::size_t i, std::size_t k) const {
        return i >= first_ && i < last_ ? step_.state(i).slip - known_.wheel[i].slip[k] : 0;
    }
    double side_change(std::size_t i, std::size_t k) const {
        return i >= first_ && i < last_ ? step_.state(i).side_slip - known_.wheel[i].side_slip[k] : 0;
    }
    double grade_accel(std::size_t) const { return step_.grade_accel()[0]; }
    const WheelStep &step() const { return step_; }

  private:
    WheelStep step_;
    const Physics &p_;
    const std::vector<double> &gyro_;
    const Motion &known_;
    detail::Freedom freedom_;
    std::size_t first_, last_;
};

// (3): the motion beside the known one, from what `change` says of each step.
template <typename Change> void follow(const Dataset &data, const Physics &moved, const Motion &known, Change &change, Motion &m) {
    const std::size_t wheels = moved.wheel.size();
    const detail::Freedom freedom = detail::freedom_of(data, moved);
    Vector3d q = Vector3d::Zero(), before = q; // of the change, as are the next
    double accel = 0, path = 0;
    std::array<double, most_wheels> slip{}, side{};
    for (std::size_t k = 0; k < data.count; ++k) {
        const Vector3d at(known.v_m_s[k], known.vy_m_s[k], known.yaw_rate_rad_s[k]);
        const std::size_t j = k == 0 ? 0 : k - 1;
        const Vector3d moved_rate =
            change.rate_change(k, at, k == 0 ? at[0] : known.v_m_s[j], k == 0 ? 0 : known.rate[j][0], k == 0 ? 0 : known.path_m[j]);
        const StepTangent &t = known.tangent[k];
        const double implicit_step = (k < 2 ? 1.0 : 2.0 / 3) * data.step_s;
        Vector3d right = k < 2 ? q : Vector3d((4 * q - before) / 3);
        if (!freedom.yaw) right[2] = 0;
        Vector3d by_slip = Vector3d::Zero();
        for (std::size_t i = 0; i < wheels; ++i)
            if (change.step().lags(i)) by_slip += known.wheel[i].force_by_slip[k] * slip[i] + known.wheel[i].force_by_side[k] * side[i];
        by_slip = by_slip.cwiseProduct(
            Vector3d(1 / moved.body.mass, freedom.vy ? 1 / moved.body.mass : 0, freedom.yaw ? 1 / moved.body.yaw_inertia : 0));
        const Vector3d next =
            t.inverse * (right + implicit_step * (moved_rate + t.rate_by_accel * accel + t.rate_by_path * path + by_slip));
        for (std::size_t i = 0; i < wheels; ++i) {
            const Motion::Wheel &w = known.wheel[i];
            m.wheel[i].traction_N[k] = w.traction_N[k] + change.traction_change(i, k) + w.traction_by_speed[k].dot(next) +
                                       w.traction_by_accel[k] * accel + w.traction_by_path[k] * path;
            if (!change.step().lags(i)) continue;
            m.wheel[i].traction_N[k] += w.traction_by_slip[k] * slip[i] + w.traction_by_side[k] * side[i];
            slip[i] = change.slip_change(i, k) + w.slip_by_speed[k].dot(next) + w.slip_by_slip[k] * slip[i];
            side[i] = change.side_change(i, k) + w.side_by_speed[k].dot(next) + w.side_by_side[k] * side[i];
        }
        before = q;
        q = next;
        accel = (q[0] - right[0]) / implicit_step;
        const Vector3d now = at + q;
        path += data.step_s * (freedom.omni ? std::hypot(now[0], now[1]) - std::hypot(at[0], at[1]) : q[0]);
        m.v_m_s[k] = now[0];
        m.vy_m_s[k] = now[1];
        m.yaw_rate_rad_s[k] = now[2];
        m.path_m[k] = known.path_m[k] + path;
        m.accel_m_s2[k] = known.rate[k][0] + accel - change.grade_accel(k) - (freedom.vy ? now[2] * now[1] : 0);
    }
}

} // namespace

bool has_neighbours(const Dataset &data, const Physics &base, const Physics &moved) {
    if (moved.motion != BodyMotion::longitudinal && moved.motion != BodyMotion::planar) return false;
    if (moved.wheel.size() > most_wheels) return false;
    const WheelStep a(data, base), b(data, moved);
    for (std::size_t i = 0; i < moved.wheel.size(); ++i)
        if (a.lags(i) != b.lags(i)) return false;
    return !a.has_play() && !b.has_play();
}

void neighbour(const Dataset &data, const Physics &moved, const Motion &known, int wheel, bool whole, Motion &m) {
    const std::size_t wheels = moved.wheel.size(), first = wheel < 0 ? 0 : static_cast<std::size_t>(wheel),
                      last = wheel < 0 ? wheels : first + 1;
    detail::resize(m, data.count, wheels, false, false);
    Moved change(data, moved, known, first, last);
    follow(data, moved, known, change, m);
    if (!whole) return;
    const WheelStep &step = change.step();
    for (std::size_t i = 0; i < wheels; ++i) {
        for (std::size_t k = 0; k < data.count; ++k) {
            const auto &s = step.state(i);
            const double along = (m.v_m_s[k] - s.y * m.yaw_rate_rad_s[k]) * s.c + (m.vy_m_s[k] + s.x * m.yaw_rate_rad_s[k]) * s.s;
            m.wheel[i].ground_speed_m_s[k] = along;
            m.wheel[i].side_slip[k] = known.wheel[i].side_slip[k];
            m.wheel[i].slip[k] = step.lags(i) ? known.wheel[i].slip[k] : slip_of(s.radius * s.gain * data.wheel[i].speed_rad_s[k], along);
            m.wheel[i].load_N[k] = known.wheel[i].load_N[k];
        }
    }
}

UnitResponse unit_response(const Dataset &data, const Physics &base, const Motion &known, TermTarget target) {
    constexpr double size = 1e-6;
    Physics moved = base;
    moved.terms.push_back({"unit", target, -1, {size}, make_piecewise(Axis::time, {0})});
    WheelStep step(data, moved);
    UnitResponse unit;
    unit.force.resize(base.wheel.size());
    unit.traction.resize(base.wheel.size());
    for (std::size_t k = 0; k < data.count; ++k) {
        const std::size_t j = k == 0 ? 0 : k - 1;
        step.remember_twist(k == 0 ? 0 : known.twist_N[j]);
        step.prepare(k, known.v_m_s[j], k == 0 ? 0 : known.rate[j][0], k == 0 ? 0 : known.path_m[j], k == 0 ? 0 : known.away_m[j]);
        for (std::size_t i = 0; i < base.wheel.size(); ++i) {
            step.remember(i, k == 0 ? 0 : known.wheel[i].slip[j], k == 0 ? 0 : known.wheel[i].side_slip[j]);
            unit.force[i].push_back((step.force(i, {known.v_m_s[k], known.vy_m_s[k], known.yaw_rate_rad_s[k]}) - known.wheel[i].force[k]) /
                                    size);
            unit.traction[i].push_back((step.state(i).traction - known.wheel[i].traction_N[k]) / size);
        }
    }
    return unit;
}

} // namespace traction::lab
