#include "wheel_step.h"

#include <Eigen/Dense>

namespace traction::lab {

namespace {

constexpr double resist_speed_m_s = 5e-3; // rolling resistance reverses over this speed: assumed, below any sensor's resolution

double length(double a, double b) { return std::sqrt(a * a + b * b); }

} // namespace

double traction_shape(SoilLaw law, double s, double sc) {
    const double x = std::fabs(s) / sc;
    double f = 0;
    if (law == SoilLaw::burckhardt) f = 1 - std::exp(-x);
    else f = x < 1e-4 ? 0.5 * x : 1 - (1 - std::exp(-x)) / x; // series near zero, where the quotient loses digits
    return s < 0 ? -f : f;
}

WheelStep::WheelStep(const Dataset &data, const Physics &physics) : data_(data), p_(physics), n_(physics.wheel.size()) {
    loads();
    followers();
    const BodyPhysics &b = p_.body;
    feels_path_ = b.patch_change != 0 || b.soil_gradient != 0 || b.tether != 0;
    for (std::size_t i = 0; i < n_; ++i) {
        const WheelPhysics &w = p_.wheel[i];
        State &s = state_[i];
        s.c = std::cos(w.heading);
        s.s = std::sin(w.heading);
        s.radius = w.radius * (1 + w.radius_change);
        s.gain = 1 / (1 - std::min(0.9, w.encoder_missed));
        s.sigma = w.relaxation + b.relaxation;
        s.plain_sc = std::max(1e-4, w.sc * (1 + b.shear_change));
        play_ = play_ || w.backlash > 0;
    }
    for (const ExtraTerm &term : p_.terms) motion_terms_ = motion_terms_ || (target_stages(term.target) & stage_motion) != 0;
    feels_path_ = feels_path_ || motion_terms_; // a user's expression may name x
}

void WheelStep::prepare(std::size_t k, double v_before, double accel_before, double path_m, double away_m, std::size_t first, std::size_t last) {
    t_ = data_.time(k);
    path_ = path_m;
    away_ = away_m;
    accel_ = accel_before;
    yaw_ = data_.yaw_rad.empty() ? 0 : data_.yaw_rad[k];
    for (std::size_t i = first; i < std::min(last, n_); ++i) prepare_wheel(i, k, v_before);
}

void WheelStep::prepare_wheel(std::size_t i, std::size_t k, double v_before) {
    const BodyPhysics &b = p_.body;
    const WheelPhysics &w = p_.wheel[i];
    State &s = state_[i];
    s.w = s.gain * data_.wheel[i].speed_rad_s[k];
    s.rim = s.radius * s.w;
    s.theta = s.gain * data_.wheel[i].angle_rad[k];
    s.travel = data_.wheel[i].travel_rad.empty() ? 0 : s.gain * data_.wheel[i].travel_rad[k];
    s.load = data_.load_N.empty() || data_.load_N[i].empty() ? load(i, accel_) : data_.load_N[i][k];
    double strength = 1;
    const double place = path_ + w.x; // each wheel at its own place, as the catalogue has it
    if (b.patch_change != 0 && place >= b.patch_start && place < b.patch_start + b.patch_length) strength *= 1 + b.patch_change;
    if (b.soil_gradient != 0) strength *= std::max(0.05, 1 + b.soil_gradient * path_);
    if (b.multi_pass != 0) {
        const double forward = 0.5 * (1 + soft_sign(v_before, 0.01));
        strength *= 1 + b.multi_pass * (ahead_[i] * forward + behind_[i] * (1 - forward));
    }
    s.Fm = std::max(0.0, (w.adhesion + w.mu * s.load) * strength);
    s.sc = s.plain_sc;
}

Eigen::Vector3d WheelStep::force(std::size_t i, const Eigen::Vector3d &q) {
    const State &s = state_[i];
    const WheelPhysics &w = p_.wheel[i];
    yaw_rate_ = q[2];
    const double vx = q[0] - w.y * q[2], vy = q[1] + w.x * q[2];
    const double along = vx * s.c + vy * s.s, across = -vx * s.s + vy * s.c;
    const double forward = pull(i, along, q[0], across);
    const double fx = forward * s.c - s.side * s.s, fy = forward * s.s + s.side * s.c;
    double moment = w.x * fy - w.y * fx;
    if (p_.motion == BodyMotion::longitudinal) { // vy = 0: skid steer turns about its middle
        moment -= (w.lateral + p_.body.scrub) * s.load * w.x * soft_sign(w.x * q[2], 5e-3);
        return {fx, 0, moment};
    }
    if (p_.motion == BodyMotion::planar && p_.grips_sideways[i]) {
        const double scrub = -(w.lateral + p_.body.scrub) * s.load * soft_sign(across, 5e-3);
        return {fx - scrub * s.s, fy + scrub * s.c, moment + scrub * (w.x * s.c + w.y * s.s)};
    }
    return {fx, fy, moment};
}

double WheelStep::slip_at(const State &s, double v) const {
    if (!(s.sigma > 0)) return slip_of(s.rim, v);
    const double h = data_.step_s / s.sigma;
    return std::clamp((s.slip_before + h * (s.rim - v)) / (1 + h * std::max(std::fabs(s.rim), std::fabs(v))), -1.0, 1.0);
}

void WheelStep::nudge(std::size_t i, const Eigen::Vector3d &change, double traction_N) {
    State &s = state_[i];
    s.v += (change[0] - p_.wheel[i].y * change[2]) * s.c + (change[1] + p_.wheel[i].x * change[2]) * s.s;
    s.slip = slip_at(s, s.v);
    s.traction += traction_N;
}

// Force along the heading at wheel-centre speed v; side_v across it. Combined slip: the grip acts against the whole sliding
// velocity, sideways with the share lateral_grip.
double WheelStep::pull(std::size_t i, double v, double body_v, double side_v) {
    State &s = state_[i];
    const BodyPhysics &b = p_.body;
    s.v = v;
    s.slip = slip_at(s, v);
    double Fm = s.Fm, sc = s.sc, extra = 0, extra_rolling = 0;
    if (b.sliding_loss != 0) Fm *= std::exp(-std::min(20.0, b.sliding_loss * std::fabs(s.rim - v)));
    if (motion_terms_) terms(i, v, body_v, Fm, sc, extra, extra_rolling);
    s.side = 0;
    if (side_v != 0 && p_.wheel[i].grip > 0 && p_.grips_sideways[i]) {
        const double across = -p_.wheel[i].grip * side_v / std::max({std::fabs(s.rim), std::fabs(v), 0.02});
        const double whole = length(s.slip, across);
        const double grip = whole > 1e-9 ? Fm * traction_shape(p_.soil_law, whole, sc) / whole : 0;
        s.traction = grip * s.slip;
        s.side = grip * across;
    } else {
        s.traction = Fm * traction_shape(p_.soil_law, s.slip, sc);
    }
    if (p_.wheel[i].backlash > 0) s.traction *= contact(i, v);
    const double resist = s.load * (p_.wheel[i].crr + p_.wheel[i].rolling + b.slip_sinkage * std::fabs(s.slip) + b.speed_resistance * std::fabs(v)) + extra_rolling;
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
        if (term.target == TermTarget::wheel_force) extra += term.term->value(signals, term.coefficients.data());
        else if (term.target == TermTarget::rolling) rolling += term.term->value(signals, term.coefficients.data());
        else if (term.target == TermTarget::soil_strength) Fm *= std::max(0.0, 1 + term.term->value(signals, term.coefficients.data()));
        else if (term.target == TermTarget::shear_slip) sc *= std::max(0.05, 1 + term.term->value(signals, term.coefficients.data()));
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
    for (std::size_t i = 0; i < n_; ++i) state_[i].slip_before = state_[i].slip, state_[i].play_before = state_[i].play;
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
        state_[i].load_per_accel = X.dot(share * Eigen::Vector3d(0, -b.mass * (b.centre_height + b.load_height), 0));
    }
}

double WheelStep::load(std::size_t i, double accel) const {
    const WheelPhysics &w = p_.wheel[i];
    return w.load > 0 ? w.load : std::max(0.0, state_[i].load_0 + state_[i].load_per_accel * accel);
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
