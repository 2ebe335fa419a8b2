// Neighbours of a known motion, (3) of motion.h.
#include "motion.h"

#include "wheel_step.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace traction::lab {

namespace {

using Eigen::Vector3d;

// s' of (2) of wheel_laws.h at step k of a known series of slips.
double memory_at(const std::vector<double> &slip, std::size_t k, double order) {
    return k == 0 ? 0 : remembered(k, order, slip[k - 1], k < 2 ? 0 : slip[k - 2]);
}

// What the moved parameters alone change at a step of the known motion: the body's rate, the traction of wheels first to last - 1.
class Moved {
  public:
    Moved(const Dataset &data, const Physics &moved, const Motion &known, std::size_t first, std::size_t last)
        : step_(data, moved), p_(moved), known_(known), freedom_(detail::freedom_of(data, moved)), first_(first), last_(last) {}

    Vector3d rate_change(std::size_t k, const Vector3d &q, double v_before, double accel_before, double path, double pull) {
        step_.remember_twist(k == 0 ? 0 : known_.twist_N[k - 1]);
        step_.prepare(k, v_before, accel_before, path, k == 0 ? 0 : known_.away_m[k - 1], first_, last_);
        for (std::size_t i = first_; i < last_; ++i) // who does not lag has no use for it
            if (step_.lags(i))
                step_.remember(i, memory_at(known_.wheel[i].slip, k, step_.order(i)),
                               memory_at(known_.wheel[i].side_slip, k, step_.order(i)));
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
        return detail::rate_of(force, q, step_.grade_accel(), pull, p_, freedom_) - known_.rate[k];
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
    const Motion &known_;
    detail::Freedom freedom_;
    std::size_t first_, last_;
};

// (3): the motion beside the known one, step by step.
class Follower {
  public:
    Follower(const Dataset &data, const Physics &moved, const Motion &known, std::size_t first, std::size_t last, Motion &motion)
        : data_(data), moved_(moved), known_(known), change_(data, moved, known, first, last), freedom_(detail::freedom_of(data, moved)),
          m_(motion) {
        detail::resize(m_, data.count, moved.wheel.size(), false, false);
    }

    void steps(std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) step(k);
    }

    // What a plain prediction does not read.
    void rest() {
        const WheelStep &step = change_.step();
        for (std::size_t i = 0; i < moved_.wheel.size(); ++i) {
            for (std::size_t k = 0; k < data_.count; ++k) {
                const auto &s = step.state(i);
                const double along = (m_.v_m_s[k] - s.y * m_.yaw_rate_rad_s[k]) * s.c + (m_.vy_m_s[k] + s.x * m_.yaw_rate_rad_s[k]) * s.s;
                m_.wheel[i].ground_speed_m_s[k] = along;
                m_.wheel[i].side_slip[k] = known_.wheel[i].side_slip[k];
                m_.wheel[i].slip[k] =
                    step.lags(i) ? known_.wheel[i].slip[k] : slip_of(s.radius * s.gain * data_.wheel[i].speed_rad_s[k], along);
                m_.wheel[i].load_N[k] = known_.wheel[i].load_N[k];
            }
        }
    }

  private:
    void step(std::size_t k) {
        const Vector3d at(known_.v_m_s[k], known_.vy_m_s[k], known_.yaw_rate_rad_s[k]);
        const std::size_t j = k == 0 ? 0 : k - 1, wheels = moved_.wheel.size();
        const Vector3d moved_rate =
            change_.rate_change(k, at, k == 0 ? at[0] : known_.v_m_s[j], k == 0 ? 0 : known_.rate[j][0], k == 0 ? 0 : known_.path_m[j],
                                detail::pull_of(data_, m_.yaw_rate_rad_s, k, freedom_));
        const StepTangent &t = known_.tangent[k];
        const double implicit_step = (k < 2 ? 1.0 : 2.0 / 3) * data_.step_s;
        Vector3d right = k < 2 ? q_ : Vector3d((4 * q_ - before_) / 3);
        if (!freedom_.yaw) right[2] = 0;
        Vector3d by_slip = Vector3d::Zero();
        std::array<double, most_wheels> slip{}, side{}; // of the memory
        for (std::size_t i = 0; i < wheels; ++i) {
            if (!change_.step().lags(i)) continue;
            const double order = change_.step().order(i);
            slip[i] = remembered(k, order, slip_[i], slip_before_[i]), side[i] = remembered(k, order, side_[i], side_before_[i]);
            by_slip += known_.wheel[i].force_by_slip[k] * slip[i] + known_.wheel[i].force_by_side[k] * side[i];
        }
        by_slip = by_slip.cwiseProduct(
            Vector3d(1 / moved_.body.mass, freedom_.vy ? 1 / moved_.body.mass : 0, freedom_.yaw ? 1 / moved_.body.yaw_inertia : 0));
        const Vector3d next =
            t.inverse * (right + implicit_step * (moved_rate + t.rate_by_accel * accel_ + t.rate_by_path * path_ + by_slip));
        for (std::size_t i = 0; i < wheels; ++i) {
            const Motion::Wheel &w = known_.wheel[i];
            m_.wheel[i].traction_N[k] = w.traction_N[k] + change_.traction_change(i, k) + w.traction_by_speed[k].dot(next) +
                                        w.traction_by_accel[k] * accel_ + w.traction_by_path[k] * path_;
            if (!change_.step().lags(i)) continue;
            m_.wheel[i].traction_N[k] += w.traction_by_slip[k] * slip[i] + w.traction_by_side[k] * side[i];
            slip_before_[i] = slip_[i], side_before_[i] = side_[i];
            slip_[i] = change_.slip_change(i, k) + w.slip_by_speed[k].dot(next) + w.slip_by_slip[k] * slip[i];
            side_[i] = change_.side_change(i, k) + w.side_by_speed[k].dot(next) + w.side_by_side[k] * side[i];
        }
        before_ = q_;
        q_ = next;
        accel_ = (q_[0] - right[0]) / implicit_step;
        const Vector3d now = at + q_;
        path_ += data_.step_s * (freedom_.omni ? std::hypot(now[0], now[1]) - std::hypot(at[0], at[1]) : q_[0]);
        m_.v_m_s[k] = now[0];
        m_.vy_m_s[k] = now[1];
        m_.yaw_rate_rad_s[k] = now[2];
        m_.path_m[k] = known_.path_m[k] + path_;
        m_.accel_m_s2[k] = known_.rate[k][0] + accel_ - change_.grade_accel(k) - (freedom_.vy ? now[2] * now[1] : 0);
    }

    const Dataset &data_;
    const Physics &moved_;
    const Motion &known_;
    Moved change_;
    detail::Freedom freedom_;
    Motion &m_;
    Vector3d q_ = Vector3d::Zero(), before_ = q_; // of the change, as are the next
    double accel_ = 0, path_ = 0;
    std::array<double, most_wheels> slip_{}, side_{}, slip_before_{}, side_before_{};
};

constexpr std::size_t steps_at_once = 64; // of the known motion: some 40 kB, which stay near while every follower goes through them

} // namespace

bool has_neighbours(const Physics &base, const Physics &moved) {
    if (moved.motion != BodyMotion::longitudinal && moved.motion != BodyMotion::planar) return false;
    if (moved.wheel.size() > most_wheels) return false;
    const auto lags = [](const Physics &p, std::size_t i) {
        return sim::law::relaxation_length_m(p.wheel[i].relaxation, p.body.relaxation_m) > 0;
    };
    for (std::size_t i = 0; i < moved.wheel.size(); ++i)
        if (lags(base, i) != lags(moved, i) || base.wheel[i].play_rad > 0 || moved.wheel[i].play_rad > 0) return false;
    return true;
}

void neighbours(const Dataset &data, const Motion &known, const std::vector<Beside> &list) {
    std::vector<std::unique_ptr<Follower>> followers;
    for (const Beside &one : list) {
        const std::size_t first = one.wheel < 0 ? 0 : static_cast<std::size_t>(one.wheel),
                          last = one.wheel < 0 ? one.moved->wheel.size() : first + 1;
        followers.push_back(std::make_unique<Follower>(data, *one.moved, known, first, last, *one.motion));
    }
    for (std::size_t k = 0; k < data.count; k += steps_at_once)
        for (const auto &follower : followers) follower->steps(k, std::min(data.count, k + steps_at_once));
    for (std::size_t i = 0; i < list.size(); ++i)
        if (list[i].whole) followers[i]->rest();
}

void neighbour(const Dataset &data, const Physics &moved, const Motion &known, int wheel, bool whole, Motion &m) {
    neighbours(data, known, {{&moved, wheel, whole, &m}});
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
            step.remember(i, memory_at(known.wheel[i].slip, k, step.order(i)), memory_at(known.wheel[i].side_slip, k, step.order(i)));
            unit.force[i].push_back((step.force(i, {known.v_m_s[k], known.vy_m_s[k], known.yaw_rate_rad_s[k]}) - known.wheel[i].force[k]) /
                                    size);
            unit.traction[i].push_back((step.state(i).traction - known.wheel[i].traction_N[k]) / size);
        }
    }
    return unit;
}

} // namespace traction::lab
