#include "wheel_step.h"

#include "sim/physics/terramechanics.h"

#include <Eigen/Dense>

namespace traction::lab {

namespace {

constexpr double resist_speed_m_s = 5e-3;   // rolling resistance reverses over this speed: assumed, below any sensor's resolution
constexpr double least_reversal_m_s = 1e-4; // below it the step is a jump to the integration
constexpr double scrub_speed_m_s = 5e-3;    // and sideways scrub over this one, where the wheels' sideways speed is that of turning alone;
constexpr double drift_speed_m_s =
    15e-3; // over this one where the body drifts as well: every small swerve would meet all of it otherwise; assumed
constexpr double least_combined_m_s = 0.02; // combined slip is taken against at least this speed: assumed

double length(double a, double b) { return std::sqrt(a * a + b * b); }
double fourth(double x) { return x * x * x * x; }

// Fourth power of the speed over which a wheel's resistance reverses; of a wheel that knows none beside some that do, the assumed.
double reversal_4(const WheelPhysics &w) { return fourth(w.reversal > 0 ? std::max(w.reversal, least_reversal_m_s) : resist_speed_m_s); }

// Slips, and resistance over load, of a wheel or of four side by side. lag_1_m: the step over the relaxation length, where it lags.
template <typename T> T slip_now(bool lags, const T &before, const T &lag_1_m, const T &rim, const T &v) {
    return lags ? lagging_slip(before, lag_1_m, rim, v) : slip_of(rim, v);
}
template <typename T> T side_slip_now(bool lags, const T &before, const T &lag_1_m, const T &rim, const T &v, const T &side_v) {
    return lags ? side_slip(before, lag_1_m, rim, v, side_v) : side_slip(rim, v, side_v, least_combined_m_s);
}
template <typename T>
T resistance(const T &known, const sim::WheelEffectsOf<T> &wheel, const sim::BodyEffects &body, const T &slip, const T &v) {
    T sum = known;
    sim::each_resistance(wheel, body, slip, v, [&](const T &per_load) { sum += per_load; });
    return sum;
}

} // namespace

WheelStep::WheelStep(const Dataset &data, const Physics &physics) : data_(data), p_(physics), n_(physics.wheel.size()) {
    sideways_ = p_.motion == BodyMotion::planar;
    widen(true);
    loads();
    followers();
    const BodyPhysics &b = p_.body;
    feels_path_ = sim::needs_any(b, sim::needs_path);
    for (std::size_t i = 0; i < n_; ++i) {
        const WheelPhysics &w = p_.wheel[i];
        State &s = state_[i];
        feels_path_ = feels_path_ || sim::needs_any(w, sim::needs_path);
        s.x = sideways_ ? sim::law::mass_offset_m(w.x, b.offset_x_m) : w.x;
        s.y = sideways_ ? sim::law::mass_offset_m(b.track_scale * w.y, b.offset_y_m) : b.track_scale * w.y;
        s.arm_m = sim::law::mass_offset_m(b.track_scale * w.y, b.offset_y_m);
        s.c = std::cos(w.heading);
        s.s = std::sin(w.heading);
        s.radius = rolling_radius(w);
        s.gain = count_gain(w);
        s.sigma = sim::law::relaxation_length_m(w.relaxation, b.relaxation_m);
        s.lag_1_m = s.sigma > 0 ? data_.step_s / s.sigma : 0;
        const double sc = std::max(1e-4, sim::law::shear_stiffness(w.sc, b.shear_change));
        const double k_m_s2 = b.gravity * std::fabs(w.mu) / sc * (p_.soil_law == SoilLaw::burckhardt ? 1 : 0.5);
        s.order = s.sigma > 0 ? second_order(k_m_s2, data_.step_s, s.sigma) : 0;
        s.free = data_.wheel[i].rolls_freely;
        play_ = play_ || w.play_rad > 0;
        lags_ = lags_ || s.sigma > 0;
        reverses_ = reverses_ || w.reversal > 0;
    }
    for (const ExtraTerm &term : p_.terms) motion_terms_ = motion_terms_ || (target_stages(term.target) & stage_motion) != 0;
    feels_path_ = feels_path_ || motion_terms_; // a user's expression may name x
    grounds_ = std::any_of(p_.runs.begin(), p_.runs.end(), [](const RunPhysics &run) { return run.has_ground(); });
    stand_on(grounds_ ? &p_.runs.front() : nullptr);
    gather();
}

void WheelStep::stand_on(const RunPhysics *run) {
    static constexpr RunPhysics nothing;
    const RunPhysics &own = run != nullptr ? *run : nothing;
    run_ = run;
    for (std::size_t i = 0; i < n_; ++i) {
        const WheelPhysics &w = p_.wheel[i];
        State &s = state_[i];
        s.mu = own_or(own.mu, w.mu), s.adhesion = own_or(own.adhesion, w.adhesion);
        s.rolling_coefficient = own_or(own.crr, w.crr), s.lateral = own_or(own.lateral, w.lateral) + p_.body.scrub;
        s.plain_sc = std::max(1e-4, sim::law::shear_stiffness(own_or(own.sc, w.sc), p_.body.shear_change));
        Four &four = four_[i / 4];
        const std::size_t at = i % 4;
        four.per_sc.set(at, 1 / s.plain_sc), four.adhesion.set(at, s.adhesion), four.mu.set(at, s.mu);
        four.resistance.set(at, s.rolling_coefficient), four.lateral.set(at, s.lateral);
    }
}

bool WheelStep::widen(bool wide) {
    static const bool has_wide = sim::has(sim::Vectors::avx2);
    return wide_ = wide && has_wide;
}

void WheelStep::gather() {
    bool all_grip = true, all_lag = true, none_lags = true, none_free = true;
    for (std::size_t i = 0; i < n_; ++i) {
        const WheelPhysics &w = p_.wheel[i];
        const State &s = state_[i];
        Four &four = four_[i / 4];
        const std::size_t at = i % 4;
        four.c.set(at, s.c), four.s.set(at, s.s), four.x.set(at, s.x), four.y.set(at, s.y), four.arm_m.set(at, s.arm_m);
        four.grip.set(at, w.grip), four.curve.set(at, w.curve);
        for (std::size_t field = 0; field < sim::WheelEffects::all().size(); ++field)
            (four.effects.*sim::WheelEffectsOf<Lane>::all()[field]).set(at, w.*sim::WheelEffects::all()[field]);
        four.per_speed_m.set(at, s.radius * s.gain);
        four.load_0.set(at, w.load > 0 ? w.load : s.load_0), four.load_per_accel.set(at, w.load > 0 ? 0 : s.load_per_accel);
        four.load_per_side.set(at, w.load > 0 ? 0 : s.load_per_side);
        four.load_per_twist.set(at, w.load > 0 ? 0 : s.load_per_twist);
        four.lag_1_m.set(at, s.lag_1_m), four.reversal.set(at, reversal_4(w));
        all_grip = all_grip && p_.grips_sideways[i];
        none_free = none_free && !s.free;
        all_lag = all_lag && s.sigma > 0, none_lags = none_lags && !(s.sigma > 0);
    }
    even_ = sim::even_strength(p_.body);
    plain_ =
        (p_.motion == BodyMotion::longitudinal || sideways_) && all_grip && (all_lag || none_lags) && none_free && !motion_terms_ && !play_;
}

void WheelStep::prepare(std::size_t k, double v_before, double accel_before, double path_m, double away_m, std::size_t first,
                        std::size_t last) {
    t_ = data_.time(k), k_ = k;
    if (lags_ && lag_step_ != std::min<std::size_t>(k, 2)) lag_at(std::min<std::size_t>(k, 2));
    if (grounds_)
        if (const RunPhysics *run = run_at(p_, t_); run != run_) stand_on(run);
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

void WheelStep::lag_at(std::size_t k) {
    lag_step_ = k;
    for (std::size_t i = 0; i < n_; ++i) {
        State &s = state_[i];
        s.lag_1_m = s.sigma > 0 ? implicit_share(k, s.order) * data_.step_s / s.sigma : 0;
        four_[i / 4].lag_1_m.set(i % 4, s.lag_1_m);
    }
}

// Of the ground under wheel i, relative.
double WheelStep::strength(std::size_t i, double v_before) const {
    const double forward = 0.5 * (1 + soft_sign(v_before, 0.01));
    const double follows = ahead_[i] * forward + behind_[i] * (1 - forward);
    return sim::strength_here(1, p_.body, path_ + p_.wheel[i].x, path_, follows); // each wheel at its own place, as the catalogue has it
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
    s.Fm = std::max(0.0, (s.adhesion + s.mu * s.load) * (even_ ? 1 : strength(i, v_before)));
    s.sc = s.plain_sc;
    if (p_.body.heavy_resistance != 0) s.resistance_here = sim::resistance_here(p_.body, path_ + w.x);
    Four &four = four_[i / 4];
    four.resistance_here.set(i % 4, s.resistance_here);
    four.rim.set(i % 4, s.rim), four.load.set(i % 4, s.load), four.Fm.set(i % 4, s.Fm);
}

// As prepare_wheel() has it.
void WheelStep::prepare_four(std::size_t g, std::size_t k, double v_before) {
    Four &f = four_[g];
    const std::size_t first = 4 * g, count = std::min<std::size_t>(4, n_ - first);
    const auto speed = [&](std::size_t at) { return at < count ? data_.wheel[first + at].speed_rad_s[k] : 0; };
    f.rim = f.per_speed_m * Lane(speed(0), speed(1), speed(2), speed(3));
    f.load = larger_of(f.load_0 + f.load_per_accel * accel_ + f.load_per_side * side_accel_ + f.load_per_twist * twist_, Lane(0.0));
    f.Fm = f.adhesion + f.mu * f.load;
    for (std::size_t i = 0; i < count && !even_; ++i) f.Fm.set(i, f.Fm[i] * strength(first + i, v_before));
    f.Fm = larger_of(f.Fm, Lane(0.0));
    for (std::size_t i = 0; i < count; ++i) {
        State &s = state_[first + i];
        s.rim = f.rim[i], s.load = f.load[i], s.Fm = f.Fm[i], s.sc = s.plain_sc;
        if (p_.body.heavy_resistance == 0) continue;
        s.resistance_here = sim::resistance_here(p_.body, path_ + p_.wheel[first + i].x);
        f.resistance_here.set(i, s.resistance_here);
    }
}

// As pull() has it, for wheels that grip sideways and feel no terms and no play.
void WheelStep::contact_of(Four &f, const Lane &v, const Lane &side_v) const {
    const BodyPhysics &b = p_.body;
    f.v = v;
    const bool lags = state_[0].sigma > 0;
    f.slip = slip_now(lags, f.slip_before, f.lag_1_m, f.rim, v);
    f.side_slip = side_slip_now(sideways_ && lags, f.side_slip_before, f.lag_1_m, f.rim, v, side_v);
    Lane Fm = f.Fm;
    if (b.sliding_loss_s_m != 0) Fm = sim::strength_sliding<law::Library>(Fm, b, Lane(f.rim - v));
    if (b.shear_peak != 0) Fm = sim::strength_slipping<Lane>(Fm, b, f.slip, Lane(1 / f.per_sc)); // else four divisions for nothing
    const auto [traction, side] = grip_of(p_.soil_law, Fm, f.per_sc, f.curve, f.slip, f.side_slip, f.grip, sideways_);
    f.traction = traction, f.side = side;
    const Lane resist = f.load * resistance(Lane(f.resistance + f.resistance_here), f.effects, b, f.slip, v);
    f.rolling = resist * (reverses_ ? reversing(v, f.reversal) : soft_sign(v, resist_speed_m_s));
}

Eigen::Vector3d WheelStep::plain_forces(const Eigen::Vector3d &q, Each *each) {
    double sum_x = 0, sum_y = 0, sum_moment = 0;
    for (std::size_t g = 0; 4 * g < n_; ++g) {
        Four &f = four_[g];
        const Lane vx = q[0] - f.y * q[2], vy = q[1] + f.x * q[2];
        const Lane side_v = vy * f.c - vx * f.s;
        contact_of(f, vx * f.c + vy * f.s, side_v);
        const Lane scrub = sim::law::lateral_scrub_N(f.lateral, f.load);
        if (sideways_) f.side -= scrub * soft_sign(side_v, drift_speed_m_s);
        const Lane forward = f.traction - f.rolling, fx = forward * f.c - f.side * f.s, fy = forward * f.s + f.side * f.c;
        Lane moment = f.x * fy - f.arm_m * fx;
        if (!sideways_) moment -= scrub * f.x * soft_sign(Lane(f.x * q[2]), scrub_speed_m_s);
        for (std::size_t i = 4 * g; i < std::min(n_, 4 * g + 4); ++i) {
            const std::size_t at = i % 4;
            State &s = state_[i];
            s.v = f.v[at], s.side_v = side_v[at], s.slip = f.slip[at], s.side_slip = f.side_slip[at], s.traction = f.traction[at],
            s.rolling = f.rolling[at];
            if (each != nullptr) (*each)[i] = {fx[at], sideways_ ? fy[at] : 0, moment[at]};
        }
        sum_x += fx.sum(), sum_y += sideways_ ? fy.sum() : 0, sum_moment += moment.sum();
    }
    return {sum_x, sum_y, sum_moment};
}

// The same operations, none contracted: the same bits.
[[gnu::flatten]] Eigen::Vector3d WheelStep::narrow_forces(const Eigen::Vector3d &q, Each *each) { return plain_forces(q, each); }
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
[[gnu::target("avx2"), gnu::flatten]] Eigen::Vector3d WheelStep::wide_forces(const Eigen::Vector3d &q, Each *each) {
    return plain_forces(q, each);
}
#else
Eigen::Vector3d WheelStep::wide_forces(const Eigen::Vector3d &q, Each *each) { return narrow_forces(q, each); }
#endif

Eigen::Vector3d WheelStep::forces(const Eigen::Vector3d &q, std::array<Eigen::Vector3d, most_wheels> *each) {
    if (plain_) return wide_ ? wide_forces(q, each) : narrow_forces(q, each);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < n_; ++i) {
        const Eigen::Vector3d one = force(i, q);
        if (each != nullptr) (*each)[i] = one;
        sum += one;
    }
    return sum;
}

Eigen::Vector3d WheelStep::force(std::size_t i, const Eigen::Vector3d &q) {
    const State &s = state_[i];
    yaw_rate_ = q[2];
    const double vx = q[0] - s.y * q[2], vy = q[1] + s.x * q[2];
    const double along = vx * s.c + vy * s.s, across = -vx * s.s + vy * s.c;
    const double forward = pull(i, along, q[0], across);
    const double fx = forward * s.c - s.side * s.s, fy = forward * s.s + s.side * s.c;
    double moment = s.x * fy - s.arm_m * fx;
    const double most_scrub = sim::law::lateral_scrub_N(s.lateral, s.load);
    if (p_.motion == BodyMotion::longitudinal) { // vy = 0: skid steer turns about its middle
        moment -= most_scrub * s.x * soft_sign(s.x * q[2], scrub_speed_m_s);
        return {fx, 0, moment};
    }
    if (sideways_ && p_.grips_sideways[i]) {
        const double scrub = -most_scrub * soft_sign(across, drift_speed_m_s);
        return {fx - scrub * s.s, fy + scrub * s.c, moment + scrub * (s.x * s.c + s.arm_m * s.s)};
    }
    return {fx, fy, moment};
}

double WheelStep::slip_at(const State &s, double v) const { return slip_now(s.sigma > 0, s.slip_before, s.lag_1_m, s.rim, v); }

double WheelStep::side_slip_at(const State &s, double v, double side_v) const {
    // a presumed sideways speed has no memory
    return side_slip_now(sideways_ && s.sigma > 0, s.side_slip_before, s.lag_1_m, s.rim, v, side_v);
}

void WheelStep::nudge(std::size_t i, const Eigen::Vector3d &change, double traction_N) {
    State &s = state_[i];
    const double vx = change[0] - s.y * change[2], vy = change[1] + s.x * change[2];
    s.v += vx * s.c + vy * s.s;
    s.side_v += vy * s.c - vx * s.s;
    if (s.free) s.rim = s.v;
    s.slip = slip_at(s, s.v);
    s.side_slip = side_slip_at(s, s.v, s.side_v);
    s.traction += traction_N;
}

// Force along the heading at wheel-centre speed v; side_v across it.
double WheelStep::pull(std::size_t i, double v, double body_v, double side_v) {
    State &s = state_[i];
    const BodyPhysics &b = p_.body;
    s.v = v;
    s.side_v = side_v;
    if (s.free) s.rim = v;
    s.slip = slip_at(s, v);
    s.side_slip = p_.grips_sideways[i] ? side_slip_at(s, v, side_v) : 0;
    double Fm = sim::strength_sliding<law::Library>(s.Fm, b, s.rim - v), sc = s.sc, extra = 0, extra_rolling = 0;
    if (motion_terms_) terms(i, v, body_v, Fm, sc, extra, extra_rolling);
    Fm = sim::strength_slipping<double>(Fm, b, s.slip, sc);
    const auto [traction, side] = grip_of(p_.soil_law, Fm, sc, p_.wheel[i].curve, s.slip, s.side_slip, p_.wheel[i].grip, sideways_);
    s.traction = traction, s.side = side;
    if (p_.wheel[i].play_rad > 0) s.traction *= contact(i, v);
    const double resist = s.load * resistance<double>(s.rolling_coefficient + s.resistance_here, p_.wheel[i], b, s.slip, v) + extra_rolling;
    // rollers roll sideways too: the resistance opposes the whole velocity of the wheel's centre
    const double speed = p_.grips_sideways[i] ? std::fabs(v) : length(v, side_v);
    const double share =
        resist / (reverses_ ? std::sqrt(std::sqrt(fourth(speed) + reversal_4(p_.wheel[i]))) : length(speed, resist_speed_m_s));
    s.rolling = share * v;
    if (!p_.grips_sideways[i]) s.side = -share * side_v;
    return s.traction - s.rolling + extra;
}

// Share of the drive that is engaged: the wheel rolls freely while the play is being crossed.
double WheelStep::contact(std::size_t i, double v) {
    State &s = state_[i];
    const double half = 0.5 * p_.wheel[i].play_rad;
    const double next = s.play_before + data_.step_s * (s.w - v / s.radius);
    s.play = std::clamp(next, -half, half);
    const double soft = 0.02 * half + 1e-6; // rad beyond the end of the play over which the teeth take the load
    const double over = sim::law::backlash_rad(p_.wheel[i].play_rad, next);
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
    const double way = reverses_ ? reversing(v, reversal_4(p_.wheel[0])) : soft_sign(v, resist_speed_m_s);
    double force = sim::law::tether_drag_N(b.tether_N_m, away_) + sim::dragged_N(b, v, way);
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
    if (b.slope_rad == 0) return {0, 0};
    const auto slope = sim::law::grade_m_s2<law::Library>(b.gravity, b.slope_rad, yaw_ - b.slope_direction_rad);
    return {slope.along_m_s2, slope.across_m_s2};
}

void WheelStep::commit() {
    if (play_ || lags_)
        for (std::size_t i = 0; i < n_; ++i) {
            State &s = state_[i];
            remember(i, remembered(k_ + 1, s.order, s.slip, s.last_slip), remembered(k_ + 1, s.order, s.side_slip, s.last_side_slip));
            s.last_slip = s.slip, s.last_side_slip = s.side_slip, s.play_before = s.play;
        }
    if (!p_.halves) return;
    twist_ = 0;
    for (std::size_t i = 0; i < n_; ++i) twist_ += 0.5 * soft_sign(p_.wheel[i].y, 1e-6) * (state_[i].traction - state_[i].rolling);
}

void WheelStep::loads() {
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < n_; ++i) {
        const Eigen::Vector3d X(1, p_.wheel[i].x, p_.body.track_scale * p_.wheel[i].y);
        S += X * X.transpose();
    }
    const Eigen::Matrix3d share = S.completeOrthogonalDecomposition().pseudoInverse();
    const BodyPhysics &b = p_.body;
    const double W = b.mass * b.gravity, height = sim::law::load_transfer_m(b.centre_height, b.raised_m);
    const Eigen::Vector3d static_loads(W, sim::law::mass_offset_Nm(W, b.offset_x_m), sim::law::mass_offset_Nm(W, b.offset_y_m));
    for (std::size_t i = 0; i < n_; ++i) {
        const Eigen::Vector3d X(1, p_.wheel[i].x, p_.body.track_scale * p_.wheel[i].y);
        state_[i].load_0 = X.dot(share * static_loads);
        const double M_h = b.mass * height;
        if (p_.halves) {
            double sum_x2 = 0; // of this half
            for (const WheelPhysics &w : p_.wheel) sum_x2 += same_side(w, p_.wheel[i]) ? w.x * w.x : 0;
            state_[i].load_per_twist = sum_x2 > 0 ? -height * soft_sign(p_.wheel[i].y, 1e-6) * p_.wheel[i].x / sum_x2 : 0;
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
