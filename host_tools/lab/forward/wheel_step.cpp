#include "wheel_step.h"

#include <Eigen/Dense>

namespace traction::lab {

namespace {

constexpr double resist_speed_m_s = 5e-3; // rolling resistance reverses over this speed: assumed, below any sensor's resolution
constexpr double scrub_speed_m_s = 5e-3;  // and sideways scrub over this one, where the wheels' sideways speed is that of turning alone;
constexpr double drift_speed_m_s =
    15e-3; // over this one where the body drifts as well: every small swerve would meet all of it otherwise; assumed
constexpr double least_combined_m_s = 0.02; // combined slip is taken against at least this speed: assumed

double length(double a, double b) { return std::sqrt(a * a + b * b); }

} // namespace

WheelStep::WheelStep(const Dataset &data, const Physics &physics) : data_(data), p_(physics), n_(physics.wheel.size()) {
    sideways_ = p_.motion == BodyMotion::planar;
    loads();
    followers();
    const BodyPhysics &b = p_.body;
    feels_path_ = b.patch_change != 0 || b.soil_gradient != 0 || b.tether != 0;
    for (std::size_t i = 0; i < n_; ++i) {
        const WheelPhysics &w = p_.wheel[i];
        State &s = state_[i];
        s.x = w.x - (sideways_ ? b.offset_x : 0);
        s.y = w.y - (sideways_ ? b.offset_y : 0);
        s.c = std::cos(w.heading);
        s.s = std::sin(w.heading);
        s.radius = w.radius * (1 + w.radius_change);
        s.gain = 1 / (1 - std::min(0.9, w.encoder_missed));
        s.sigma = w.relaxation + b.relaxation;
        s.plain_sc = std::max(1e-4, w.sc * (1 + b.shear_change));
        play_ = play_ || w.backlash > 0;
        lags_ = lags_ || s.sigma > 0;
    }
    for (const ExtraTerm &term : p_.terms) motion_terms_ = motion_terms_ || (target_stages(term.target) & stage_motion) != 0;
    feels_path_ = feels_path_ || motion_terms_; // a user's expression may name x
    gather();
}

void WheelStep::gather() {
    bool all_grip = true, all_lag = true, none_lags = true;
    for (std::size_t i = 0; i < n_; ++i) {
        const WheelPhysics &w = p_.wheel[i];
        const State &s = state_[i];
        Four &four = four_[i / 4];
        const auto at = static_cast<Eigen::Index>(i % 4);
        four.c[at] = s.c, four.s[at] = s.s, four.x[at] = s.x, four.y[at] = s.y, four.per_sc[at] = 1 / s.plain_sc;
        four.grip[at] = w.grip, four.resistance[at] = w.crr + w.rolling, four.lateral[at] = w.lateral + p_.body.scrub;
        four.per_speed_m[at] = s.radius * s.gain, four.adhesion[at] = w.adhesion, four.mu[at] = w.mu;
        four.load_0[at] = w.load > 0 ? w.load : s.load_0, four.load_per_accel[at] = w.load > 0 ? 0 : s.load_per_accel;
        four.load_per_side[at] = w.load > 0 ? 0 : s.load_per_side;
        four.load_per_twist[at] = w.load > 0 ? 0 : s.load_per_twist;
        four.lag_1_m[at] = s.sigma > 0 ? data_.step_s / s.sigma : 0;
        all_grip = all_grip && p_.grips_sideways[i];
        all_lag = all_lag && s.sigma > 0, none_lags = none_lags && !(s.sigma > 0);
    }
    even_ = p_.body.patch_change == 0 && p_.body.soil_gradient == 0 && p_.body.multi_pass == 0;
    plain_ = (p_.motion == BodyMotion::longitudinal || sideways_) && all_grip && (all_lag || none_lags) && !motion_terms_ && !play_;
}

void WheelStep::prepare(std::size_t k, double v_before, double accel_before, double path_m, double away_m, std::size_t first,
                        std::size_t last) {
    t_ = data_.time(k);
    path_ = path_m;
    away_ = away_m;
    accel_ = accel_before;
    side_accel_ = sideways_ && !data_.yaw_rate_rad_s.empty() ? v_before * data_.yaw_rate_rad_s[k] : 0;
    yaw_ = data_.yaw_rad.empty() ? 0 : data_.yaw_rad[k];
    if (plain_ && data_.load_N.empty() && first == 0 && last >= n_) {
        for (std::size_t g = 0; 4 * g < n_; ++g) prepare_four(g, k, v_before);
        return;
    }
    for (std::size_t i = first; i < std::min(last, n_); ++i) prepare_wheel(i, k, v_before);
}

// Of the ground under wheel i, relative.
double WheelStep::strength(std::size_t i, double v_before) const {
    const BodyPhysics &b = p_.body;
    double strength = 1;
    const double place = path_ + p_.wheel[i].x; // each wheel at its own place, as the catalogue has it
    if (b.patch_change != 0 && place >= b.patch_start && place < b.patch_start + b.patch_length) strength *= 1 + b.patch_change;
    if (b.soil_gradient != 0) strength *= std::max(0.05, 1 + b.soil_gradient * path_);
    if (b.multi_pass != 0) {
        const double forward = 0.5 * (1 + soft_sign(v_before, 0.01));
        strength *= 1 + b.multi_pass * (ahead_[i] * forward + behind_[i] * (1 - forward));
    }
    return strength;
}

void WheelStep::prepare_wheel(std::size_t i, std::size_t k, double v_before) {
    const WheelPhysics &w = p_.wheel[i];
    State &s = state_[i];
    s.w = s.gain * data_.wheel[i].speed_rad_s[k];
    s.rim = s.radius * s.w;
    if (motion_terms_) {
        s.theta = s.gain * data_.wheel[i].angle_rad[k];
        s.travel = data_.wheel[i].travel_rad.empty() ? 0 : s.gain * data_.wheel[i].travel_rad[k];
    }
    s.load = data_.load_N.empty() || data_.load_N[i].empty() ? load(i) : data_.load_N[i][k];
    s.Fm = std::max(0.0, (w.adhesion + w.mu * s.load) * (even_ ? 1 : strength(i, v_before)));
    s.sc = s.plain_sc;
    const auto at = static_cast<Eigen::Index>(i % 4);
    four_[i / 4].rim[at] = s.rim, four_[i / 4].load[at] = s.load, four_[i / 4].Fm[at] = s.Fm;
}

// As prepare_wheel() has it.
void WheelStep::prepare_four(std::size_t g, std::size_t k, double v_before) {
    Four &f = four_[g];
    const std::size_t first = 4 * g, count = std::min<std::size_t>(4, n_ - first);
    const auto speed = [&](std::size_t at) { return at < count ? data_.wheel[first + at].speed_rad_s[k] : 0; };
    f.rim = f.per_speed_m * Lane(speed(0), speed(1), speed(2), speed(3));
    f.load = (f.load_0 + f.load_per_accel * accel_ + f.load_per_side * side_accel_ + f.load_per_twist * twist_).max(0.0);
    f.Fm = f.adhesion + f.mu * f.load;
    for (std::size_t i = 0; i < count && !even_; ++i) f.Fm[static_cast<Eigen::Index>(i)] *= strength(first + i, v_before);
    f.Fm = f.Fm.max(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        State &s = state_[first + i];
        s.rim = f.rim[at], s.load = f.load[at], s.Fm = f.Fm[at], s.sc = s.plain_sc;
    }
}

// As pull() has it, for wheels that grip sideways.
inline void WheelStep::contact_of(Four &f, const Lane &v, const Lane &side_v) const {
    const BodyPhysics &b = p_.body;
    f.v = v;
    f.slip = state_[0].sigma > 0 ? lagging_slip(f.slip_before, f.lag_1_m, f.rim, v) : slip_of(f.rim, v);
    Lane Fm = f.Fm;
    if (b.sliding_loss != 0) Fm *= (-(b.sliding_loss * (f.rim - v).abs()).min(20.0)).exp();
    f.side_slip = sideways_ && state_[0].sigma > 0 ? side_slip(f.side_slip_before, f.lag_1_m, f.rim, v, side_v)
                                                   : side_slip(f.rim, v, side_v, least_combined_m_s);
    const Lane across = f.grip * f.side_slip, felt = sideways_ ? f.side_slip : across;
    const Lane grip = Fm * f.per_sc * traction_slope(p_.soil_law, Lane((f.slip.square() + felt.square()).sqrt() * f.per_sc));
    f.traction = grip * f.slip;
    f.side = grip * across;
    const Lane resist = f.load * (f.resistance + b.slip_sinkage * f.slip.abs() + b.speed_resistance * v.abs());
    f.rolling = resist * soft_sign(v, resist_speed_m_s);
}

Eigen::Vector3d WheelStep::forces(const Eigen::Vector3d &q, std::array<Eigen::Vector3d, most_wheels> *each) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < n_ && !plain_; ++i) {
        const Eigen::Vector3d one = force(i, q);
        if (each != nullptr) (*each)[i] = one;
        sum += one;
    }
    if (!plain_) return sum;
    for (std::size_t g = 0; 4 * g < n_; ++g) {
        Four &f = four_[g];
        const Lane vx = q[0] - f.y * q[2], vy = q[1] + f.x * q[2];
        const Lane side_v = vy * f.c - vx * f.s;
        contact_of(f, vx * f.c + vy * f.s, side_v);
        if (sideways_) f.side -= f.lateral * f.load * soft_sign(side_v, drift_speed_m_s);
        const Lane forward = f.traction - f.rolling, fx = forward * f.c - f.side * f.s, fy = forward * f.s + f.side * f.c;
        Lane moment = f.x * fy - f.y * fx;
        if (!sideways_) moment -= f.lateral * f.load * f.x * soft_sign(Lane(f.x * q[2]), scrub_speed_m_s);
        for (std::size_t i = 4 * g; i < std::min(n_, 4 * g + 4); ++i) {
            const auto at = static_cast<Eigen::Index>(i % 4);
            State &s = state_[i];
            s.v = f.v[at], s.side_v = side_v[at], s.slip = f.slip[at], s.side_slip = f.side_slip[at], s.traction = f.traction[at],
            s.rolling = f.rolling[at];
            if (each != nullptr) (*each)[i] = {fx[at], sideways_ ? fy[at] : 0, moment[at]};
        }
        sum += Eigen::Vector3d(fx.sum(), sideways_ ? fy.sum() : 0, moment.sum());
    }
    return sum;
}

Eigen::Vector3d WheelStep::force(std::size_t i, const Eigen::Vector3d &q) {
    const State &s = state_[i];
    const WheelPhysics &w = p_.wheel[i];
    yaw_rate_ = q[2];
    const double vx = q[0] - s.y * q[2], vy = q[1] + s.x * q[2];
    const double along = vx * s.c + vy * s.s, across = -vx * s.s + vy * s.c;
    const double forward = pull(i, along, q[0], across);
    const double fx = forward * s.c - s.side * s.s, fy = forward * s.s + s.side * s.c;
    double moment = s.x * fy - s.y * fx;
    if (p_.motion == BodyMotion::longitudinal) { // vy = 0: skid steer turns about its middle
        moment -= (w.lateral + p_.body.scrub) * s.load * s.x * soft_sign(s.x * q[2], scrub_speed_m_s);
        return {fx, 0, moment};
    }
    if (sideways_ && p_.grips_sideways[i]) {
        const double scrub = -(w.lateral + p_.body.scrub) * s.load * soft_sign(across, drift_speed_m_s);
        return {fx - scrub * s.s, fy + scrub * s.c, moment + scrub * (s.x * s.c + s.y * s.s)};
    }
    return {fx, fy, moment};
}

double WheelStep::slip_at(const State &s, double v) const {
    if (!(s.sigma > 0)) return slip_of(s.rim, v);
    return lagging_slip(s.slip_before, data_.step_s / s.sigma, s.rim, v);
}

double WheelStep::side_slip_at(const State &s, double v, double side_v) const {
    if (!(sideways_ && s.sigma > 0)) return side_slip(s.rim, v, side_v, least_combined_m_s); // a presumed sideways speed has no memory
    return side_slip(s.side_slip_before, data_.step_s / s.sigma, s.rim, v, side_v);
}

void WheelStep::nudge(std::size_t i, const Eigen::Vector3d &change, double traction_N) {
    State &s = state_[i];
    const double vx = change[0] - s.y * change[2], vy = change[1] + s.x * change[2];
    s.v += vx * s.c + vy * s.s;
    s.side_v += vy * s.c - vx * s.s;
    s.slip = slip_at(s, s.v);
    s.side_slip = side_slip_at(s, s.v, s.side_v);
    s.traction += traction_N;
}

// Force along the heading at wheel-centre speed v; side_v across it. Combined slip S = |(s, sy)|, (Ft, Fy) = f(S)/S (Fm s, Fym sy) inside
// the friction ellipse, Fym = lateral_grip Fm (Pacejka's similarity). Where the body is not followed sideways its sideways speed is only
// presumed, and lateral_grip is the share of it that slides: S = |(s, lateral_grip sy)|.
double WheelStep::pull(std::size_t i, double v, double body_v, double side_v) {
    State &s = state_[i];
    const BodyPhysics &b = p_.body;
    s.v = v;
    s.side_v = side_v;
    s.slip = slip_at(s, v);
    s.side_slip = p_.grips_sideways[i] ? side_slip_at(s, v, side_v) : 0;
    double Fm = s.Fm, sc = s.sc, extra = 0, extra_rolling = 0;
    if (b.sliding_loss != 0) Fm *= std::exp(-std::min(20.0, b.sliding_loss * std::fabs(s.rim - v)));
    if (motion_terms_) terms(i, v, body_v, Fm, sc, extra, extra_rolling);
    s.side = 0;
    if (s.side_slip != 0 && p_.wheel[i].grip > 0) {
        const double across = p_.wheel[i].grip * s.side_slip;
        const double grip = Fm / sc * traction_slope(p_.soil_law, length(s.slip, sideways_ ? s.side_slip : across) / sc);
        s.traction = grip * s.slip;
        s.side = grip * across;
    } else {
        s.traction = Fm / sc * traction_slope(p_.soil_law, std::fabs(s.slip) / sc) * s.slip;
    }
    if (p_.wheel[i].backlash > 0) s.traction *= contact(i, v);
    const double resist =
        s.load * (p_.wheel[i].crr + p_.wheel[i].rolling + b.slip_sinkage * std::fabs(s.slip) + b.speed_resistance * std::fabs(v)) +
        extra_rolling;
    // rollers roll sideways too: the resistance opposes the whole velocity of the wheel's centre
    const double speed = p_.grips_sideways[i] ? std::fabs(v) : length(v, side_v), share = resist / length(speed, resist_speed_m_s);
    s.rolling = share * v;
    if (!p_.grips_sideways[i]) s.side = -share * side_v;
    return s.traction - s.rolling + extra;
}

// Share of the drive that is engaged: the wheel rolls freely while the play is being crossed.
double WheelStep::contact(std::size_t i, double v) {
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

void WheelStep::terms(std::size_t i, double v, double body_v, double &Fm, double &sc, double &extra, double &rolling) const {
    const State &s = state_[i];
    Signals signals;
    signals.t = t_, signals.w = s.w, signals.v = v, signals.s = s.slip, signals.Fn = s.load, signals.theta = s.theta;
    signals.x = path_ + p_.wheel[i].x, signals.a = accel_, signals.V = body_v, signals.Ft = s.traction;
    signals.r = yaw_rate_, signals.X = path_, signals.d = s.travel;
    for (const ExtraTerm &term : p_.terms) {
        if (term.wheel >= 0 && static_cast<std::size_t>(term.wheel) != i) continue;
        if (term.target == TermTarget::wheel_force)
            extra += term.term->value(signals, term.coefficients.data());
        else if (term.target == TermTarget::rolling)
            rolling += term.term->value(signals, term.coefficients.data());
        else if (term.target == TermTarget::soil_strength)
            Fm *= std::max(0.0, 1 + term.term->value(signals, term.coefficients.data()));
        else if (term.target == TermTarget::shear_slip)
            sc *= std::max(0.05, 1 + term.term->value(signals, term.coefficients.data()));
    }
}

double WheelStep::body_force(double v) const {
    const BodyPhysics &b = p_.body;
    double force = -b.tether * away_ - b.drag * soft_sign(v, resist_speed_m_s);
    if (motion_terms_) {
        Signals signals;
        signals.t = t_, signals.v = v, signals.V = v, signals.x = signals.X = path_, signals.a = accel_, signals.r = yaw_rate_;
        for (const ExtraTerm &term : p_.terms)
            if (term.target == TermTarget::body_force) force += term.term->value(signals, term.coefficients.data());
    }
    return force;
}

Eigen::Vector2d WheelStep::grade_accel() const {
    const BodyPhysics &b = p_.body;
    if (b.grade == 0) return {0, 0};
    const double steep = b.gravity * std::sin(b.grade), turned = yaw_ - b.grade_direction;
    return {-steep * std::cos(turned), steep * std::sin(turned)};
}

void WheelStep::commit() {
    if (play_ || lags_)
        for (std::size_t i = 0; i < n_; ++i) remember(i, state_[i].slip, state_[i].side_slip), state_[i].play_before = state_[i].play;
    if (!p_.halves) return;
    twist_ = 0;
    for (std::size_t i = 0; i < n_; ++i) twist_ += 0.5 * soft_sign(p_.wheel[i].y, 1e-6) * (state_[i].traction - state_[i].rolling);
}

void WheelStep::loads() {
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < n_; ++i) {
        const Eigen::Vector3d X(1, p_.wheel[i].x, p_.wheel[i].y);
        S += X * X.transpose();
    }
    const Eigen::Matrix3d share = S.completeOrthogonalDecomposition().pseudoInverse();
    const BodyPhysics &b = p_.body;
    const double W = b.mass * b.gravity;
    for (std::size_t i = 0; i < n_; ++i) {
        const Eigen::Vector3d X(1, p_.wheel[i].x, p_.wheel[i].y);
        state_[i].load_0 = X.dot(share * Eigen::Vector3d(W, W * b.offset_x, W * b.offset_y));
        const double M_h = b.mass * (b.centre_height + b.load_height);
        if (p_.halves) {
            double reach = 0; // of this half
            for (const WheelPhysics &w : p_.wheel) reach += same_side(w, p_.wheel[i]) ? w.x * w.x : 0;
            state_[i].load_per_twist =
                reach > 0 ? -(b.centre_height + b.load_height) * soft_sign(p_.wheel[i].y, 1e-6) * p_.wheel[i].x / reach : 0;
        }
        state_[i].load_per_side = X.dot(share * Eigen::Vector3d(0, 0, -M_h));
        state_[i].load_per_accel = X.dot(share * Eigen::Vector3d(0, -M_h, 0));
    }
}

double WheelStep::load(std::size_t i) const {
    const WheelPhysics &w = p_.wheel[i];
    return w.load > 0 ? w.load
                      : std::max(0.0, state_[i].load_0 + state_[i].load_per_accel * accel_ + state_[i].load_per_side * side_accel_ +
                                          state_[i].load_per_twist * twist_);
}

void WheelStep::followers() {
    for (std::size_t i = 0; i < n_; ++i)
        for (std::size_t j = 0; j < n_; ++j) {
            if (std::fabs(p_.wheel[i].y - p_.wheel[j].y) > 0.02 || i == j) continue;
            if (p_.wheel[j].x > p_.wheel[i].x + 1e-3) ahead_[i] = 1;
            if (p_.wheel[j].x < p_.wheel[i].x - 1e-3) behind_[i] = 1;
        }
}

} // namespace traction::lab
