#include "motion.h"

#include "wheel_step.h"

#include <Eigen/Dense>
#include <array>

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace detail {

Freedom freedom_of(const Dataset &data, const Physics &physics) {
    const bool planar = physics.motion == BodyMotion::planar;
    const bool omni = // a caster beside wheels that grip leaves the body its direction
        planar && std::find(physics.grips_sideways.begin(), physics.grips_sideways.end(), true) == physics.grips_sideways.end();
    return {planar, planar || data.yaw_free, omni, planar ? data.gyro : data.yaw_free && !data.yaw_rate_rad_s.empty()};
}

void resize(Motion &m, std::size_t count, std::size_t wheels, bool keep, bool lags) {
    for (auto *series : {&m.v_m_s, &m.vy_m_s, &m.yaw_rate_rad_s, &m.accel_m_s2, &m.path_m, &m.away_m, &m.twist_N}) series->resize(count);
    m.rate.resize(count);
    m.tangent.resize(keep ? count : 0);
    m.wheel.resize(wheels);
    for (Motion::Wheel &w : m.wheel) {
        for (auto *series : {&w.traction_N, &w.rolling_N, &w.slip, &w.side_slip, &w.load_N, &w.ground_speed_m_s}) series->resize(count);
        for (auto *series : {&w.force, &w.traction_by_speed}) series->resize(keep ? count : 0);
        for (auto *series : {&w.traction_by_accel, &w.traction_by_path}) series->resize(keep ? count : 0);
        for (auto *series : {&w.force_by_slip, &w.slip_by_speed, &w.force_by_side, &w.side_by_speed})
            series->resize(keep && lags ? count : 0);
        for (auto *series : {&w.traction_by_slip, &w.slip_by_slip, &w.traction_by_side, &w.side_by_side})
            series->resize(keep && lags ? count : 0);
    }
}

} // namespace detail

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double near_end =
    1e-5; // m/s and rad/s: the Jacobian is known to a few percent, which leaves 1e-6 at most, far below any sensor's noise
constexpr double step_speed = 1e-6, step_accel = 1e-4, step_path = 3e-3,
                 step_slip = 1e-6; // of the differences: m/s (and rad/s), m/s^2, m (about a step of the path)

// Root of a function that rises on the whole, in [low, high]: secant steps kept inside the bracket.
template <typename Function> double bracketed_root(Function &&g, double low, double high, double guess) {
    double x = std::clamp(guess, low, high), gx = g(x), x_old = x + 1e-4, g_old = g(x_old);
    for (int i = 0; i < 60; ++i) {
        if (gx > 0)
            high = std::min(high, x);
        else
            low = std::max(low, x);
        const double slope = (gx - g_old) / (x - x_old);
        double next = slope > 0 ? x - gx / slope : 0.5 * (low + high);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::fabs(next - x) < 1e-9) return next;
        x_old = x, g_old = gx;
        x = next, gx = g(x);
        if (gx == 0 || high - low < 1e-10) return x;
    }
    return x;
}

// One implicit step: g(q) = q - right - share h rate(q) = 0.
class Solver {
  public:
    Solver(const Dataset &data, const Physics &physics, bool keeps)
        : data_(data), p_(physics), step_(data, physics), freedom_(detail::freedom_of(data, physics)), keeps_(keeps) {
        for (const WheelPhysics &w : p_.wheel) {
            double adhesion = w.adhesion, mu = std::fabs(w.mu);
            for (const RunPhysics &run : p_.runs)
                adhesion = std::max(adhesion, own_or(run.adhesion, 0)), mu = std::max(mu, std::fabs(own_or(run.mu, 0)));
            most_ += (adhesion + mu * 10 + 1) + p_.body.gravity * p_.body.mass * (mu + 2);
        }
        most_ /= p_.body.mass;
    }

    void prepare(std::size_t k, const Vector3d &right, double share, double v_before, double accel_before, double path, double away,
                 double pull) {
        step_.prepare(k, v_before, accel_before, path, away);
        right_ = right;
        implicit_step_ = share * data_.step_s;
        grade_ = step_.grade_accel();
        pull_ = pull;
        centre_ = v_before;
    }

    Vector3d rate(const Vector3d &q) { return with_body(step_.forces(q, keeps_ ? &force_ : nullptr), q); }

    Vector3d residual(const Vector3d &q) {
        rate_ = rate(q);
        at_ = q;
        left_ = q - right_ - implicit_step_ * rate_;
        return left_;
    }

    // From a near start: chord iteration with an inverse that each step mends (Broyden's good update). A last change smaller than
    // `near_end` is taken without another evaluation where `exact` is not asked for. False: not found.
    bool approach(Vector3d &q, const Motion &guess, std::size_t k, bool exact) {
        Matrix3d inverse = guess.tangent[k].inverse;
        Vector3d f = residual(q);
        double last = 1e300;
        for (int i = 0; i < 8; ++i) {
            if (converged(f)) return true;
            if (!(f.squaredNorm() < last)) return false;
            last = f.squaredNorm();
            const Vector3d change = -(inverse * f), f_before = f;
            q += change;
            if (!exact && change.cwiseAbs().maxCoeff() < near_end) {
                rate_ = (q - right_) / implicit_step_;
                for (std::size_t w = 0; w < step_.wheels(); ++w) step_.nudge(w, change, guess.wheel[w].traction_by_speed[k].dot(change));
                return true;
            }
            f = residual(q);
            const Vector3d seen = inverse * (f - f_before);
            const double along = change.dot(seen);
            if (along > 1e-3 * change.squaredNorm()) inverse += (change - seen) * (change.transpose() * inverse) / along;
        }
        return converged(f);
    }

    // Newton with halving, and for the speed alone a bracketed search.
    Vector3d solve(Vector3d q) {
        Vector3d f;
        if (freedom_.yaw || freedom_.vy) {
            q = newton(q);
            f = q == at_ ? left_ : residual(q); // most often the search ended where it looked last
            if (std::fabs(f[0]) < 1e-6 || freedom_.vy) return q;
        }
        const double half_range = implicit_step_ * most_ + std::fabs(right_[0] - centre_);
        q[0] = bracketed_root([&](double v) { return residual({v, q[1], q[2]})[0]; }, right_[0] - half_range, right_[0] + half_range, q[0]);
        if (q != at_) residual(q);
        return q;
    }

    const Vector3d &rate_found() const { return rate_; }
    double grade() const { return grade_[0]; }
    WheelStep &step() { return step_; }
    detail::Freedom freedom() const { return freedom_; }

    // Derivatives at q, the state prepared for; leaves the wheels at q.
    void differentiate(std::size_t k, const Vector3d &q, double v_before, double accel_before, double path, double away, Motion &m) {
        StepTangent &t = m.tangent[k];
        const Vector3d at = rate_; // the search ended here
        for (std::size_t i = 0; i < step_.wheels(); ++i) {
            found_[i] = step_.state(i);
            m.wheel[i].force[k] = force_[i];
        }
        for (std::size_t i = 0; i < step_.wheels(); ++i)
            if (step_.lags(i)) by_slip(i, k, q, m.wheel[i]);
        const bool free[3] = {true, freedom_.vy, freedom_.yaw};
        Matrix3d J = Matrix3d::Identity();
        for (int c = 0; c < 3; ++c) {
            Vector3d moved = q;
            moved[c] += step_speed;
            if (free[c]) J.col(c) -= implicit_step_ * (rate(moved) - at) / step_speed;
            for (std::size_t i = 0; i < step_.wheels(); ++i) {
                m.wheel[i].traction_by_speed[k][c] = free[c] ? (step_.state(i).traction - found_[i].traction) / step_speed : 0;
                if (!step_.lags(i)) continue;
                m.wheel[i].slip_by_speed[k][c] = free[c] ? (step_.state(i).slip - found_[i].slip) / step_speed : 0;
                m.wheel[i].side_by_speed[k][c] = free[c] ? (step_.state(i).side_slip - found_[i].side_slip) / step_speed : 0;
            }
        }
        t.inverse = J.inverse();
        if (!t.inverse.allFinite()) t.inverse.setIdentity();
        t.rate_by_accel = Vector3d::Zero();
        t.rate_by_path = Vector3d::Zero();
        step_.prepare(k, v_before, accel_before + step_accel, path, away);
        t.rate_by_accel = (rate(q) - at) / step_accel;
        for (std::size_t i = 0; i < step_.wheels(); ++i)
            m.wheel[i].traction_by_accel[k] = (step_.state(i).traction - found_[i].traction) / step_accel;
        if (step_.feels_path()) {
            step_.prepare(k, v_before, accel_before, path + step_path, away + step_path);
            t.rate_by_path = (rate(q) - at) / step_path;
        }
        for (std::size_t i = 0; i < step_.wheels(); ++i)
            m.wheel[i].traction_by_path[k] = step_.feels_path() ? (step_.state(i).traction - found_[i].traction) / step_path : 0;
        if (!step_.has_terms()) {
            for (std::size_t i = 0; i < step_.wheels(); ++i) step_.restore(i, found_[i]);
            return;
        }
        step_.prepare(k, v_before, accel_before, path, away); // a term may look at the traction as it was
        rate(q);
    }

  private:
    void by_slip(std::size_t i, std::size_t k, const Vector3d &q, Motion::Wheel &w) {
        const WheelStep::State before = step_.state(i);
        const Vector3d force = force_[i];
        step_.remember(i, before.slip_before + step_slip, before.side_slip_before);
        w.force_by_slip[k] = (step_.force(i, q) - force) / step_slip;
        w.traction_by_slip[k] = (step_.state(i).traction - before.traction) / step_slip;
        w.slip_by_slip[k] = (step_.state(i).slip - before.slip) / step_slip;
        step_.remember(i, before.slip_before, before.side_slip_before + step_slip);
        w.force_by_side[k] = (step_.force(i, q) - force) / step_slip;
        w.traction_by_side[k] = (step_.state(i).traction - before.traction) / step_slip;
        w.side_by_side[k] = (step_.state(i).side_slip - before.side_slip) / step_slip;
        step_.remember(i, before.slip_before, before.side_slip_before);
    }

    Vector3d with_body(Vector3d force, const Vector3d &q) const {
        if (!freedom_.omni) {
            force[0] += step_.body_force(q[0]);
        } else if (const double speed = std::hypot(q[0], q[1]); speed > 1e-6) {
            const double along = step_.body_force(speed);
            force[0] += along * q[0] / speed, force[1] += along * q[1] / speed;
        }
        return detail::rate_of(force, q, grade_, pull_, p_, freedom_);
    }

    static bool converged(const Vector3d &f) { return std::fabs(f[0]) < 1e-9 && std::fabs(f[1]) < 1e-9 && std::fabs(f[2]) < 1e-8; }

    // Newton with a Broyden-updated Jacobian and halving.
    Vector3d newton(Vector3d x) {
        Vector3d f = residual(x);
        Matrix3d J;
        const auto jacobian = [&] {
            J.setIdentity();
            const bool free[3] = {true, freedom_.vy, freedom_.yaw};
            for (int c = 0; c < 3; ++c) {
                if (!free[c]) continue;
                Vector3d moved = x;
                moved[c] += 1e-5;
                J.col(c) = (residual(moved) - f) / 1e-5;
            }
        };
        jacobian();
        const double scale = 0.0144; // (m/s)^2 per (rad/s)^2: half a track squared
        const auto size = [&](const Vector3d &v) { return v[0] * v[0] + v[1] * v[1] + scale * v[2] * v[2]; };
        for (int i = 0; i < 40; ++i) {
            const Vector3d change = -J.partialPivLu().solve(f);
            if (!change.allFinite()) break;
            double share = 1;
            Vector3d next = x + change, g_next = residual(next);
            while (share > 0.01 && !(size(g_next) < size(f))) share *= 0.5, next = x + share * change, g_next = residual(next);
            const Vector3d moved = next - x;
            const double small = std::max({std::fabs(moved[0]), std::fabs(moved[1]), 0.1 * std::fabs(moved[2])});
            const bool slow = share < 1 || size(g_next) > 0.05 * size(f);
            const Vector3d change_f = g_next - f;
            const Vector3d f_old = f;
            if (size(g_next) <= size(f))
                x = next, f = g_next;
            else if (share <= 0.01)
                break;
            if (small < 1e-9 || size(f) < 1e-18) break;
            if (slow || f == f_old)
                jacobian();
            else
                J += (change_f - J * moved) * moved.transpose() / moved.squaredNorm();
        }
        return x;
    }

    const Dataset &data_;
    const Physics &p_;
    WheelStep step_;
    detail::Freedom freedom_;
    bool keeps_; // the tangents will be asked for
    Vector3d right_ = Vector3d::Zero(), rate_ = Vector3d::Zero();
    Vector3d at_ = Vector3d::Zero(), left_ = Vector3d::Zero(); // where the residual was taken last, and what it is there
    std::array<Vector3d, most_wheels> force_{};
    std::array<WheelStep::State, most_wheels> found_; // at the step's end, while its derivatives are taken
    Eigen::Vector2d grade_ = Eigen::Vector2d::Zero();
    double implicit_step_ = 0, pull_ = 0, most_ = 0, centre_ = 0;
};

// whole: not the tractions alone, which are all that a plain prediction reads.
void record(const WheelStep &step, std::size_t k, bool whole, Motion &m) {
    m.twist_N[k] = step.twist();
    for (std::size_t i = 0; i < step.wheels(); ++i) {
        const auto &s = step.state(i);
        m.wheel[i].traction_N[k] = s.traction;
        if (!whole) continue;
        m.wheel[i].rolling_N[k] = s.rolling;
        m.wheel[i].slip[k] = s.slip;
        m.wheel[i].side_slip[k] = s.side_slip;
        m.wheel[i].load_N[k] = s.load;
        m.wheel[i].ground_speed_m_s[k] = s.v;
    }
}

void integrate_free(const Dataset &data, const Physics &p, Motion &m, const Motion *guess, bool keep) {
    Solver solver(data, p, keep);
    const detail::Freedom freedom = solver.freedom();
    Vector3d q = Vector3d::Zero(), before = q, shift = q, shift_before = q; // shift: from the guess
    if (!freedom.omni)
        for (std::size_t i = 0; i < p.wheel.size(); ++i)
            q[0] += p.wheel[i].radius * data.wheel[i].speed_rad_s[0] / static_cast<double>(p.wheel.size());
    double accel = 0, path = 0, away = 0, x = 0, y = 0, heading = 0; // place and heading from the start
    const bool chord = guess != nullptr && guess->tangent.size() == data.count, exact = keep || solver.step().has_play();
    const bool whole = keep || !p.terms.empty() ||
                       std::any_of(data.balance.begin(), data.balance.end(), [](const Balance &b) { return b.kind == BalanceKind::force; });
    const bool far = keep || p.body.tether_N_m != 0; // who else asks how far away it is?
    for (std::size_t k = 0; k < data.count; ++k) {
        const double given = data.yaw_rate_rad_s.empty() ? 0 : data.yaw_rate_rad_s[k];
        Vector3d right = k < 2 ? q : Vector3d((4 * q - before) / 3);
        if (!freedom.yaw) right[2] = given;
        const double v_before = q[0], accel_before = accel, path_before = path, away_before = away;
        solver.prepare(k, right, k < 2 ? 1.0 : 2.0 / 3, v_before, accel_before, path_before, away_before,
                       detail::pull_of(data, m.yaw_rate_rad_s, k, freedom));
        const Vector3d guessed = guess != nullptr ? Vector3d(guess->v_m_s[k], guess->vy_m_s[k], guess->yaw_rate_rad_s[k]) : q;
        Vector3d found =
            guess != nullptr ? Vector3d(guessed + 2 * shift - shift_before) : Vector3d(q + data.step_s * Vector3d(accel, 0, 0));
        if (!freedom.yaw) found[2] = given;
        if (!chord || !solver.approach(found, *guess, k, exact)) found = solver.solve(found);
        if (!found.allFinite()) found = q;
        shift_before = shift;
        shift = found - guessed;
        const Vector3d rate = solver.rate_found();
        if (keep) solver.differentiate(k, found, v_before, accel_before, path_before, away_before, m);
        solver.step().commit();
        before = q;
        q = found;
        accel = rate[0];
        path += (freedom.omni ? std::hypot(q[0], q[1]) : q[0]) * data.step_s;
        if (far && !freedom.omni) {
            heading = data.yaw_rad.empty() ? heading + q[2] * data.step_s : data.yaw_rad[k];
            const double c = std::cos(heading), s = std::sin(heading);
            x += (q[0] * c - q[1] * s) * data.step_s;
            y += (q[0] * s + q[1] * c) * data.step_s;
            away = x * c + y * s;
        } else {
            away = path;
        }
        m.v_m_s[k] = q[0];
        m.vy_m_s[k] = q[1];
        m.yaw_rate_rad_s[k] = q[2];
        m.path_m[k] = path;
        m.away_m[k] = away;
        m.rate[k] = rate;
        m.accel_m_s2[k] = rate[0] - solver.grade() - (freedom.vy ? q[2] * q[1] : 0);
        record(solver.step(), k, whole, m);
    }
}

void integrate_imposed(const Dataset &data, const Physics &p, Motion &m) {
    WheelStep step(data, p);
    double path = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        const double v = data.body_speed_m_s.empty() ? 0 : data.body_speed_m_s[k];
        step.prepare(k, v, 0, path, path);
        if (p.motion != BodyMotion::none)
            for (std::size_t i = 0; i < step.wheels(); ++i) step.force(i, {v, 0, 0});
        step.commit();
        path += v * data.step_s;
        m.v_m_s[k] = v;
        m.vy_m_s[k] = m.yaw_rate_rad_s[k] = m.accel_m_s2[k] = 0;
        m.path_m[k] = m.away_m[k] = path;
        record(step, k, true, m);
    }
}

} // namespace

void integrate(const Dataset &data, const Physics &physics, Motion &motion, const Motion *guess, bool keep) {
    const bool free = physics.motion == BodyMotion::longitudinal || physics.motion == BodyMotion::planar;
    const bool lags = std::any_of(physics.wheel.begin(), physics.wheel.end(), [&](const WheelPhysics &w) {
        return sim::law::relaxation_length_m(w.relaxation, physics.body.relaxation_m) > 0;
    });
    detail::resize(motion, data.count, physics.wheel.size(), keep && free, lags);
    if (physics.wheel.size() > most_wheels) return;
    if (free)
        integrate_free(data, physics, motion, guess, keep);
    else
        integrate_imposed(data, physics, motion);
}

} // namespace traction::lab
