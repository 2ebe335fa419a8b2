#include "motion.h"

#include <Eigen/Dense>

#include <array>

namespace traction::lab {

namespace {

constexpr double resist_speed_m_s = 5e-3; // rolling resistance reverses over this speed: assumed, below any sensor's resolution
constexpr std::size_t most_wheels = 32;

// The wheels of one time step: everything that does not depend on the unknown speed.
class Step {
  public:
    Step(const Dataset &data, const Physics &physics) : data_(data), p_(physics), n_(physics.wheel.size()) {
        loads_from_geometry();
        followers();
        for (std::size_t i = 0; i < n_; ++i) {
            const WheelPhysics &w = p_.wheel[i];
            state_[i].c = std::cos(w.heading);
            state_[i].s = std::sin(w.heading);
            state_[i].radius = w.radius * (1 + w.radius_change);
            state_[i].gain = 1 / (1 - std::min(0.9, w.encoder_missed));
            state_[i].sigma = w.relaxation + p_.body.relaxation;
            state_[i].plain_sc = std::max(1e-4, w.sc * (1 + p_.body.shear_change));
        }
        for (const ExtraTerm &term : p_.terms) motion_terms_ = motion_terms_ || (target_stages(term.target) & stage_motion) != 0;
    }

    // Prepares time index k from the state at the step before.
    void prepare(std::size_t k, double v_before, double accel_before, double path) {
        const BodyPhysics &b = p_.body;
        for (std::size_t i = 0; i < n_; ++i) {
            const WheelPhysics &w = p_.wheel[i];
            State &s = state_[i];
            s.rim = s.radius * s.gain * data_.wheel[i].speed_rad_s[k];
            s.w = s.gain * data_.wheel[i].speed_rad_s[k];
            s.theta = s.gain * data_.wheel[i].angle_rad[k];
            s.load = data_.load_N.empty() || data_.load_N[i].empty() ? load(i, accel_before) : data_.load_N[i][k];
            double strength = 1;
            const double place = path + w.x; // each wheel at its own place, as the catalogue has it
            if (b.patch_change != 0 && place >= b.patch_start && place < b.patch_start + b.patch_length) strength *= 1 + b.patch_change;
            if (b.soil_gradient != 0) strength *= std::max(0.05, 1 + b.soil_gradient * path);
            if (b.multi_pass != 0) strength *= 1 + b.multi_pass * follows(i, v_before);
            s.Fm = std::max(0.0, (w.adhesion + w.mu * s.load) * strength);
            s.sc = s.plain_sc;
        }
        t_ = data_.time(k);
        path_ = path;
        accel_ = accel_before;
        yaw_ = data_.yaw_rad.empty() ? 0 : data_.yaw_rad[k];
    }

    // Force of wheel i on the body along its heading at wheel-centre speed v; `side_v` across it. Combined slip: the grip acts
    // against the whole sliding velocity, sideways with the share `lateral_grip`.
    double wheel_force(std::size_t i, double v, double body_v, double side_v) {
        State &s = state_[i];
        const BodyPhysics &b = p_.body;
        s.v = v;
        if (s.sigma > 0) {
            const double h = data_.step_s / s.sigma;
            s.slip = (s.slip_before + h * (s.rim - v)) / (1 + h * std::max(std::fabs(s.rim), std::fabs(v)));
            s.slip = std::clamp(s.slip, -1.0, 1.0);
        } else {
            s.slip = slip_of(s.rim, v);
        }
        double Fm = s.Fm, sc = s.sc, extra = 0, extra_rolling = 0;
        if (b.sliding_loss != 0) Fm *= std::exp(-std::min(20.0, b.sliding_loss * std::fabs(s.rim - v)));
        if (motion_terms_) terms(i, v, body_v, Fm, sc, extra, extra_rolling);
        s.side = 0;
        if (side_v != 0 && p_.wheel[i].grip > 0 && p_.grips_sideways[i]) {
            const double across = -p_.wheel[i].grip * side_v / std::max({std::fabs(s.rim), std::fabs(v), 0.02});
            const double whole = std::sqrt(s.slip * s.slip + across * across);
            const double pull = whole > 1e-9 ? Fm * traction_shape(p_.soil_law, whole, sc) / whole : 0;
            s.traction = pull * s.slip;
            s.side = pull * across;
        } else {
            s.traction = Fm * traction_shape(p_.soil_law, s.slip, sc);
        }
        if (p_.wheel[i].backlash > 0) s.traction *= contact(i, v);
        const double resist = s.load * (p_.wheel[i].crr + p_.wheel[i].rolling + b.slip_sinkage * std::fabs(s.slip) + b.speed_resistance * std::fabs(v)) + extra_rolling;
        // rollers roll sideways too: the resistance opposes the whole velocity of the wheel's centre
        const double speed = p_.grips_sideways[i] ? std::fabs(v) : std::hypot(v, side_v);
        s.rolling = resist * v / std::hypot(speed, resist_speed_m_s);
        if (!p_.grips_sideways[i]) s.side = -resist * side_v / std::hypot(speed, resist_speed_m_s);
        return s.pull = s.traction - s.rolling + extra;
    }

    // Share of the drive that is engaged: the wheel rolls freely while the play is being crossed.
    double contact(std::size_t i, double v) {
        State &s = state_[i];
        const double half = 0.5 * p_.wheel[i].backlash;
        const double next = s.play_before + data_.step_s * (s.w - v / s.radius);
        s.play = std::clamp(next, -half, half);
        const double soft = 0.02 * half + 1e-6; // rad beyond the end of the play over which the teeth take the load
        const double over = std::fabs(next) - half;
        // engaged only if the slip pushes on the side that touches
        if (over <= 0 || next * (s.rim - v) <= 0) return 0;
        return std::min(1.0, over / soft);
    }

    double body_force(double v) const {
        const BodyPhysics &b = p_.body;
        double force = -b.tether * std::max(0.0, std::fabs(path_)) * soft_sign(path_, 1e-3) - b.drag * soft_sign(v, resist_speed_m_s);
        if (motion_terms_) {
            Signals signals;
            signals.t = t_, signals.v = v, signals.V = v, signals.x = path_, signals.a = accel_;
            for (const ExtraTerm &term : p_.terms)
                if (term.target == TermTarget::body_force) force += term.term->value(signals, term.coefficients.data());
        }
        return force;
    }

    double grade_force() const {
        const BodyPhysics &b = p_.body;
        return b.grade == 0 ? 0 : -b.mass * b.gravity * std::sin(b.grade) * std::cos(yaw_ - b.grade_direction);
    }

    void commit() {
        for (std::size_t i = 0; i < n_; ++i) state_[i].slip_before = state_[i].slip, state_[i].play_before = state_[i].play;
    }

    struct State {
        double c = 1, s = 0, radius = 0, gain = 1, sigma = 0, plain_sc = 0.1;
        double rim = 0, w = 0, theta = 0, load = 0, Fm = 0, sc = 0.1;
        double slip_before = 0, play_before = 0;
        double v = 0, slip = 0, play = 0, traction = 0, rolling = 0, pull = 0, side = 0;
    };
    const State &state(std::size_t i) const { return state_[i]; }
    std::size_t wheels() const { return n_; }

  private:
    void terms(std::size_t i, double v, double body_v, double &Fm, double &sc, double &extra, double &rolling) const {
        const State &s = state_[i];
        Signals signals;
        signals.t = t_, signals.w = s.w, signals.v = v, signals.s = s.slip, signals.Fn = s.load, signals.theta = s.theta;
        signals.x = path_ + p_.wheel[i].x, signals.a = accel_, signals.V = body_v, signals.Ft = s.traction;
        for (const ExtraTerm &term : p_.terms) {
            if (term.wheel >= 0 && static_cast<std::size_t>(term.wheel) != i) continue;
            if (term.target == TermTarget::wheel_force) extra += term.term->value(signals, term.coefficients.data());
            else if (term.target == TermTarget::rolling) rolling += term.term->value(signals, term.coefficients.data());
            else if (term.target == TermTarget::soil_strength) Fm *= std::max(0.0, 1 + term.term->value(signals, term.coefficients.data()));
            else if (term.target == TermTarget::shear_slip) sc *= std::max(0.05, 1 + term.term->value(signals, term.coefficients.data()));
        }
    }

    // Loads as the least-norm solution of the three balances: sum Fn = W, sum Fn x = W ox - M a h, sum Fn y = W oy.
    void loads_from_geometry() {
        Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
        for (std::size_t i = 0; i < n_; ++i) {
            const Eigen::Vector3d X(1, p_.wheel[i].x, p_.wheel[i].y);
            S += X * X.transpose();
        }
        share_ = S.completeOrthogonalDecomposition().pseudoInverse();
    }
    double load(std::size_t i, double accel) const {
        const WheelPhysics &w = p_.wheel[i];
        if (w.load > 0) return w.load;
        const BodyPhysics &b = p_.body;
        const double W = b.mass * b.gravity;
        const Eigen::Vector3d balance(W, W * b.offset_x - b.mass * accel * (b.centre_height + b.load_height), W * b.offset_y);
        return std::max(0.0, Eigen::Vector3d(1, w.x, w.y).dot(share_ * balance));
    }

    void followers() {
        for (std::size_t i = 0; i < n_; ++i)
            for (std::size_t j = 0; j < n_; ++j) {
                if (std::fabs(p_.wheel[i].y - p_.wheel[j].y) > 0.02 || i == j) continue;
                if (p_.wheel[j].x > p_.wheel[i].x + 1e-3) ahead_[i] = 1;
                if (p_.wheel[j].x < p_.wheel[i].x - 1e-3) behind_[i] = 1;
            }
    }
    double follows(std::size_t i, double v) const {
        const double forward = 0.5 * (1 + soft_sign(v, 0.01));
        return ahead_[i] * forward + behind_[i] * (1 - forward);
    }

    const Dataset &data_;
    const Physics &p_;
    std::size_t n_;
    std::array<State, most_wheels> state_{};
    std::array<double, most_wheels> ahead_{}, behind_{};
    Eigen::Matrix3d share_;
    double t_ = 0, path_ = 0, accel_ = 0, yaw_ = 0;
    bool motion_terms_ = false;
};

void resize(Motion &m, std::size_t count, std::size_t wheels) {
    for (auto *series : {&m.v_m_s, &m.vy_m_s, &m.yaw_rate_rad_s, &m.accel_m_s2, &m.path_m, &m.body_force_N}) series->assign(count, 0);
    m.wheel.resize(wheels);
    for (Motion::Wheel &w : m.wheel)
        for (auto *series : {&w.traction_N, &w.rolling_N, &w.slip, &w.load_N, &w.ground_speed_m_s}) series->resize(count);
}

// Root of a function that rises on the whole, in [low, high]: secant steps kept inside the bracket.
template <typename Function> double bracketed_root(Function &&g, double low, double high, double guess) {
    double x = std::clamp(guess, low, high), gx = g(x), x_old = x + 1e-4, g_old = g(x_old);
    for (int i = 0; i < 60; ++i) {
        if (gx > 0) high = std::min(high, x);
        else low = std::max(low, x);
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

double total_force(Step &step, double v, double yaw_rate, const Physics &p) {
    double force = 0;
    for (std::size_t i = 0; i < step.wheels(); ++i) {
        const auto &s = step.state(i);
        const double along = (v - p.wheel[i].y * yaw_rate) * s.c + p.wheel[i].x * yaw_rate * s.s;
        const double across = p.wheel[i].x * yaw_rate * s.c - (v - p.wheel[i].y * yaw_rate) * s.s;
        const double pull = step.wheel_force(i, along, v, across);
        force += pull * s.c - s.side * s.s;
    }
    return force;
}

void record(const Step &step, std::size_t k, Motion &m) {
    for (std::size_t i = 0; i < step.wheels(); ++i) {
        const auto &s = step.state(i);
        m.wheel[i].traction_N[k] = s.traction;
        m.wheel[i].rolling_N[k] = s.rolling;
        m.wheel[i].slip[k] = s.slip;
        m.wheel[i].load_N[k] = s.load;
        m.wheel[i].ground_speed_m_s[k] = s.v;
    }
}

double yaw_accel(const Step &step, double yaw_rate, const Physics &p) {
    double moment = 0;
    for (std::size_t i = 0; i < step.wheels(); ++i) {
        const auto &s = step.state(i);
        const WheelPhysics &w = p.wheel[i];
        moment += s.pull * (w.x * s.s - w.y * s.c) + s.side * (w.x * s.c + w.y * s.s);
        const double side_speed = w.x * yaw_rate; // vy = 0: skid steer turns about its middle
        moment -= (w.lateral + p.body.scrub) * s.load * w.x * soft_sign(side_speed, 5e-3);
    }
    return p.body.yaw_inertia > 0 ? moment / p.body.yaw_inertia : 0;
}

// (v, r) of one implicit step by Newton with a Broyden-updated Jacobian and halving; `x` starts the search.
template <typename Function> Eigen::Vector2d root_of_two(Function &&g, Eigen::Vector2d x) {
    Eigen::Vector2d f = g(x);
    Eigen::Matrix2d J;
    const auto jacobian = [&] {
        for (int c = 0; c < 2; ++c) {
            Eigen::Vector2d moved = x;
            moved[c] += 1e-5;
            J.col(c) = (g(moved) - f) / 1e-5;
        }
    };
    jacobian();
    const double scale = 0.0144; // (m/s)^2 per (rad/s)^2: half a track squared
    const auto size = [&](const Eigen::Vector2d &v) { return v[0] * v[0] + scale * v[1] * v[1]; };
    for (int i = 0; i < 40; ++i) {
        const double det = J.determinant();
        if (!(std::fabs(det) > 1e-12)) break;
        const Eigen::Vector2d change = -(J.inverse() * f);
        double share = 1;
        Eigen::Vector2d next = x + change, g_next = g(next);
        while (share > 0.01 && !(size(g_next) < size(f))) share *= 0.5, next = x + share * change, g_next = g(next);
        const Eigen::Vector2d moved = next - x;
        const double small = std::max(std::fabs(moved[0]), 0.1 * std::fabs(moved[1]));
        const bool slow = share < 1 || size(g_next) > 0.05 * size(f);
        const Eigen::Vector2d change_f = g_next - f;
        if (size(g_next) <= size(f)) x = next;
        else if (share <= 0.01) break;
        const Eigen::Vector2d f_old = f;
        f = size(g_next) <= size(f_old) ? g_next : f;
        if (small < 1e-9 || size(f) < 1e-18) break;
        if (slow) jacobian();
        else J += (change_f - J * moved) * moved.transpose() / moved.squaredNorm();
    }
    return x;
}

void integrate_longitudinal(const Dataset &data, const Physics &p, Motion &m, const Motion *guess, bool keep) {
    Step step(data, p);
    double v = 0, r = 0, accel = 0, path = 0;
    for (std::size_t i = 0; i < p.wheel.size(); ++i) v += p.wheel[i].radius * data.wheel[i].speed_rad_s[0] / static_cast<double>(p.wheel.size());
    const double h = data.step_s / p.body.mass;
    double most = 0; // bound of the total force
    for (const WheelPhysics &w : p.wheel) most += (w.adhesion + std::fabs(w.mu) * 10 + 1) + p.body.gravity * p.body.mass * (std::fabs(w.mu) + 2);
    const bool chord = guess != nullptr && guess->inverse.size() == data.count;
    if (keep) m.inverse.resize(data.count);
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
    double felt = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        step.prepare(k, v, accel, path);
        const double before = v, before_r = r, other = step.grade_force();
        if (!data.yaw_free) r = data.yaw_rate_rad_s.empty() ? 0 : data.yaw_rate_rad_s[k];
        const auto g = [&](const Eigen::Vector2d &x) -> Eigen::Vector2d {
            felt = total_force(step, x[0], x[1], p) + step.body_force(x[0]);
            return {x[0] - before - h * (felt + other), data.yaw_free ? x[1] - before_r - data.step_s * yaw_accel(step, x[1], p) : x[1] - r};
        };
        const auto converged = [](const Eigen::Vector2d &f) { return std::fabs(f[0]) < 1e-9 && std::fabs(f[1]) < 1e-8; };
        Eigen::Vector2d x(before + data.step_s * accel, r), f;
        bool done = false;
        if (guess != nullptr) x = Eigen::Vector2d(guess->v_m_s[k], data.yaw_free ? guess->yaw_rate_rad_s[k] : r) + shift;
        if (chord) {
            double last = 1e300;
            f = g(x);
            for (int i = 0; i < 8; ++i) {
                if ((done = converged(f)) || !(f.squaredNorm() < last)) break;
                last = f.squaredNorm();
                x -= guess->inverse[k] * f;
                f = g(x);
            }
        }
        if (!done) {
            if (data.yaw_free) x = root_of_two(g, x);
            f = g(x);
            if (!data.yaw_free || !(std::fabs(f[0]) < 1e-6)) {
                x[0] = bracketed_root([&](double speed) { return g({speed, x[1]})[0]; }, before - h * most, before + h * most, x[0]);
                f = g(x);
            }
        }
        if (keep) {
            Eigen::Matrix2d J = Eigen::Matrix2d::Identity();
            const double kept = felt;
            for (int c = 0; c < (data.yaw_free ? 2 : 1); ++c) {
                Eigen::Vector2d moved = x;
                moved[c] += 1e-6;
                J.col(c) = (g(moved) - f) / 1e-6;
            }
            m.inverse[k] = J.inverse();
            if (!m.inverse[k].allFinite()) m.inverse[k].setIdentity();
            g(x);
            felt = kept;
        }
        v = x[0];
        r = x[1];
        if (guess != nullptr) shift = x - Eigen::Vector2d(guess->v_m_s[k], data.yaw_free ? guess->yaw_rate_rad_s[k] : r);
        accel = (v - before) / data.step_s;
        step.commit();
        path += v * data.step_s;
        m.v_m_s[k] = v;
        m.path_m[k] = path;
        m.accel_m_s2[k] = felt / p.body.mass;
        m.yaw_rate_rad_s[k] = r;
        m.body_force_N[k] = felt;
        record(step, k, m);
    }
}

void integrate_imposed(const Dataset &data, const Physics &p, Motion &m) {
    Step step(data, p);
    double path = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        const double v = data.body_speed_m_s.empty() ? 0 : data.body_speed_m_s[k];
        step.prepare(k, v, 0, path);
        m.body_force_N[k] = p.motion == BodyMotion::none ? 0 : total_force(step, v, 0, p);
        step.commit();
        path += v * data.step_s;
        m.v_m_s[k] = v;
        m.path_m[k] = path;
        if (p.motion != BodyMotion::none) record(step, k, m);
    }
}

// Forces on (vx, vy, yaw rate) at that body velocity.
Eigen::Vector3d planar_force(Step &step, const Eigen::Vector3d &q, const Physics &p) {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < step.wheels(); ++i) {
        const auto &s = step.state(i);
        const WheelPhysics &w = p.wheel[i];
        const double vx = q[0] - w.y * q[2], vy = q[1] + w.x * q[2];
        const double along = vx * s.c + vy * s.s, side = -vx * s.s + vy * s.c;
        const double pull = step.wheel_force(i, along, q[0], side);
        const double grip = s.side + (p.grips_sideways[i] ? -(w.lateral + p.body.scrub) * s.load * soft_sign(side, 5e-3) : 0);
        const double fx = pull * s.c - grip * s.s, fy = pull * s.s + grip * s.c;
        force += Eigen::Vector3d(fx, fy, w.x * fy - w.y * fx);
    }
    const double speed = std::hypot(q[0], q[1]), along = step.body_force(speed);
    if (speed > 1e-6) force += Eigen::Vector3d(along * q[0] / speed, along * q[1] / speed, 0);
    return force;
}

void integrate_planar(const Dataset &data, const Physics &p, Motion &m, const Motion *guess) {
    Step step(data, p);
    const double inertia = p.body.yaw_inertia > 0 ? p.body.yaw_inertia : p.body.mass * 0.02;
    const Eigen::Vector3d mass(p.body.mass, p.body.mass, inertia);
    Eigen::Vector3d q = Eigen::Vector3d::Zero();
    double path = 0, accel = 0;
    for (std::size_t k = 0; k < data.count; ++k) {
        step.prepare(k, q[0], accel, path);
        const Eigen::Vector3d before = q;
        const double h = data.step_s;
        const auto residual = [&](const Eigen::Vector3d &x) -> Eigen::Vector3d {
            return (x - before).cwiseProduct(mass) - h * planar_force(step, x, p);
        };
        const auto size = [&](const Eigen::Vector3d &g) { return g.cwiseProduct(g).cwiseQuotient(mass).sum(); };
        Eigen::Vector3d x = guess != nullptr ? Eigen::Vector3d(guess->v_m_s[k], guess->vy_m_s[k], guess->yaw_rate_rad_s[k]) : before;
        Eigen::Vector3d g = residual(x);
        for (int iteration = 0; iteration < 25; ++iteration) {
            Eigen::Matrix3d J;
            for (int c = 0; c < 3; ++c) {
                Eigen::Vector3d moved = x;
                moved[c] += 1e-5;
                J.col(c) = (residual(moved) - g) / 1e-5;
            }
            Eigen::Vector3d change = J.partialPivLu().solve(-g);
            if (!change.allFinite()) break;
            double share = 1;
            Eigen::Vector3d next = x + change, g_next = residual(next);
            while (share > 0.02 && !(size(g_next) <= size(g))) share *= 0.5, next = x + share * change, g_next = residual(next);
            const double moved = (next - x).cwiseAbs().maxCoeff();
            x = next, g = g_next;
            if (moved < 1e-8) break;
        }
        q = x.allFinite() ? x : before;
        const Eigen::Vector3d force = planar_force(step, q, p);
        step.commit();
        accel = force[0] / p.body.mass;
        path += std::hypot(q[0], q[1]) * h;
        m.v_m_s[k] = q[0];
        m.vy_m_s[k] = q[1];
        m.yaw_rate_rad_s[k] = q[2];
        m.accel_m_s2[k] = accel - q[2] * q[1];
        m.path_m[k] = path;
        record(step, k, m);
    }
}

} // namespace

double traction_shape(SoilLaw law, double s, double sc) {
    const double x = std::fabs(s) / sc;
    double f = 0;
    if (law == SoilLaw::burckhardt) f = 1 - std::exp(-x);
    else f = x < 1e-4 ? 0.5 * x : 1 - (1 - std::exp(-x)) / x; // series near zero, where the quotient loses digits
    return s < 0 ? -f : f;
}

void integrate(const Dataset &data, const Physics &physics, Motion &motion, const Motion *guess, bool keep) {
    resize(motion, data.count, physics.wheel.size());
    if (physics.wheel.size() > most_wheels) return;
    switch (physics.motion) {
    case BodyMotion::longitudinal: return integrate_longitudinal(data, physics, motion, guess, keep);
    case BodyMotion::planar: return integrate_planar(data, physics, motion, guess);
    case BodyMotion::imposed:
    case BodyMotion::none: return integrate_imposed(data, physics, motion);
    }
}

} // namespace traction::lab
