#include "machine.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace traction::generator {

namespace {

constexpr double h_s = 1e-3;
constexpr double copper_1_K = 3.93e-3, magnet_1_K = 2e-3;         // copper at 20 C; ferrite magnets, with the motor's constants
constexpr PerWheel along = {-1, -1, 1, 1}, side = {1, -1, 1, -1}; // rear, rear, front, front; left, right, left, right
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

double soft_sign(double x, double width) { return std::tanh(x / width); }

} // namespace

Machine nominal(Soil soil) {
    Machine m;
    m.soil = soil;
    const double Fn = 7.0; // [N] the load for which the paper states Fm
    if (soil == Soil::sand) {
        m.mu = 5.1 / Fn;
        m.sc = 0.27;
        m.rolling = 0.05;
        m.grip_noise = 0.06;
    } // table III
    if (soil == Soil::gravel) {
        m.mu = 6.8 / Fn;
        m.sc = 0.088;
        m.rolling = 0.03;
        m.grip_noise = 0.06;
    } // table III
    if (soil == Soil::concrete) {
        m.mu = 0.8;
        m.sc = 0.05;
        m.rolling = 0.01;
        m.grip_noise = 0.02;
    }         // (21); sc assumed
    return m; // rolling resistance and ground noise: assumed
}

Machine draw(Soil soil, Random &random) {
    Machine m = nominal(soil);
    const auto spread = [&](double &value, double relative) { value *= 1 + relative * std::clamp(random.normal(), -2.5, 2.5); };
    spread(m.mass, 0.003); // a rover is weighed
    spread(m.yaw_inertia, 0.03);
    spread(m.radius, 0.004);
    const double KG = m.KG;
    spread(m.KG, 0.012);
    m.ke = m.KG / KG * m.ke; // the same magnets
    spread(m.Ra, 0.02);
    spread(m.J, 0.025);
    spread(m.viscous, 0.03);
    spread(m.coulomb, 0.03);
    spread(m.mu, 0.03);
    spread(m.sc, 0.05);
    m.rolling += 0.003 * std::clamp(random.normal(), -2.5, 2.5);
    m.battery_V *= random.uniform(0.98, 1.05);
    m.grip_noise *= random.uniform(0.85, 1.3); // 5 to 8 % on soil
    m.grip_length = random.uniform(0.1, 0.3);
    return m;
}

void draw_apart(Machine &machine, const WheelSpread &spread, Random &random) {
    const auto shares = [&](PerWheel &share, double relative) {
        for (double &one : share) one = 1 + relative * std::clamp(random.normal(), -2.5, 2.5);
    };
    shares(machine.KG_each, spread.KG);
    shares(machine.Ra_each, spread.Ra);
    shares(machine.coulomb_each, spread.friction);
    shares(machine.viscous_each, spread.friction);
    shares(machine.radius_each, spread.radius);
}

GroundField::GroundField(double rms, double length_m, Random &random) : amplitude_(0) {
    constexpr int count = 48;
    for (int i = 0; i < count; ++i)
        waves_.push_back({random.normal() / length_m, random.normal() / length_m, random.uniform(0, 2 * std::numbers::pi)});
    amplitude_ = rms * std::sqrt(2.0 / count);
}

double GroundField::at(double x_m, double y_m) const {
    double sum = 0;
    for (const Wave &wave : waves_) sum += std::cos(wave.kx * x_m + wave.ky * y_m + wave.phase);
    return amplitude_ * sum;
}

World::World(const Machine &machine, const Hidden &hidden, Random &random)
    : m_(machine), h_(hidden), field_(machine.grip_noise, machine.grip_length, random), relaxed_(hidden.relaxation > 0),
      backlash_(std::any_of(hidden.play.begin(), hidden.play.end(), [](double p) { return p > 0; })) {
    int size = 2 + wheels;
    if (relaxed_) {
        slip_at_ = size;
        size += wheels;
    }
    if (backlash_) {
        gear_at_ = size;
        motor_at_ = size + wheels;
        size += 2 * wheels;
    }
    state_ = Vector::Zero(size);
    battery = m_.battery_V;
    for (std::size_t i = 0; i < wheels; ++i) radius_[i] = m_.radius * m_.radius_each[i] * (1 + h_.radius_change[i]);
    delayed_.assign(static_cast<std::size_t>(std::lround(h_.actuation_delay / h_s)), PerWheel{});
    set_loads();
}

double World::shear(double s) const {
    const double k = m_.sc * (1 + h_.shear), a = std::fabs(s) / k;
    if (m_.soil == Soil::concrete) return 1 - std::exp(-a);
    return a < 1e-4 ? a / 2 : 1 - (1 - std::exp(-a)) / a;
}

double World::friction(int wheel_index, double w) const {
    const std::size_t i = at(wheel_index);
    const double theta = wheel[i].angle, size = std::fabs(w);
    double g =
        m_.coulomb * m_.coulomb_each[i] + h_.coulomb[i] + h_.friction_drift * t / 120 + (t > h_.friction_step_time ? h_.friction_step : 0);
    g += (m_.viscous * m_.viscous_each[i] + h_.viscous[i]) * size + h_.friction_squared * size * size;
    g += h_.stribeck[i] * std::exp(-(w * w) / (h_.stribeck_speed[i] * h_.stribeck_speed[i]));
    g += h_.ripple_cos[i] * std::cos(h_.ripple_order[i] * theta) + h_.ripple_sin[i] * std::sin(h_.ripple_order[i] * theta);
    if (w < 0) g += h_.reverse_friction;
    if (h_.resonance > 0) g += h_.resonance * std::exp(-std::pow((size - h_.resonance_speed) / 0.7, 2));
    return g * soft_sign(w, 0.03) + h_.hysteresis * wheel[i].bristle;
}

double World::current(int wheel_index, double w) const {
    const std::size_t i = at(wheel_index);
    const double u = voltage_[i] - h_.coupling * current_now_[i ^ 1U]; // the other motor of the same axle shares a lead
    const double e = u - ke_[i] * w, open = std::fabs(e) - h_.dead_voltage[i];
    return open > 0 ? std::copysign(open, e) / (Ra_[i] + h_.wiring[i]) : 0;
}

void World::rate(const Vector &s, Vector &d) {
    const double v = s[0], r = s[1];
    double force = 0, moment = 0;
    for (int k = 0; k < wheels; ++k) {
        const std::size_t i = at(k);
        WheelState &state = wheel[i];
        const double w = s[2 + k], vw = v - side[i] * m_.half_track * r, Rw = radius_[i] * w;
        const double creep = Rw - vw, steady = creep / std::max({std::fabs(Rw), std::fabs(vw), 0.01});
        double slip = steady;
        if (relaxed_) {
            slip = s[slip_at_ + k];
            d[slip_at_ + k] = std::max({std::fabs(Rw), std::fabs(vw), 0.02}) / h_.relaxation * (steady - slip);
        }
        const double Fm = m_.mu * state.load * state.grip * std::exp(-h_.sliding_loss * std::fabs(creep)) *
                          std::max(0.1, 1 - h_.grip_speed * std::fabs(vw));
        state.force = Fm * shear(slip) * (slip < 0 ? -1 : 1);
        const double Q = (m_.rolling + h_.rolling[i] + h_.sinkage * std::min(1.0, std::fabs(slip)) + h_.speed_resistance * std::fabs(vw) +
                          h_.turn_resistance * std::fabs(r)) *
                         state.load;
        const double net = state.force - Q * soft_sign(vw, 0.008);
        force += net;
        moment -= side[i] * m_.half_track * net;
        const double lateral = along[i] * m_.half_base * r;
        moment -= h_.scrub * state.load * along[i] * m_.half_base * soft_sign(lateral, 0.006);
        const double wm = backlash_ ? s[motor_at_ + k] : w;
        state.current = current(k, wm);
        double torque = KG_[i] * state.current;
        if (h_.torque_limit > 0) torque = h_.torque_limit * std::tanh(torque / h_.torque_limit);
        const double drag = friction(k, wm) + h_.mesh * std::fabs(radius_[i] * state.force) * soft_sign(wm, 0.03);
        if (!backlash_) {
            d[2 + k] = (torque - drag - radius_[i] * state.force) / m_.J;
        } else { // teeth as a stiff spring behind the play (assumed 80 N m/rad, damping 0.05 N m s)
            const double gap = s[gear_at_ + k], half = h_.play[i] / 2;
            const double bite = gap > half ? gap - half : gap < -half ? gap + half : 0;
            const double teeth = bite == 0 ? 0 : 80 * bite + 0.05 * (wm - w);
            d[motor_at_ + k] = (torque - drag - teeth) / (m_.motor_share * m_.J);
            d[2 + k] = (teeth - radius_[i] * state.force) / ((1 - m_.motor_share) * m_.J);
            d[gear_at_ + k] = wm - w;
        }
    }
    const double uphill = std::sin(h_.slope) * std::cos(yaw - h_.slope_direction) * m_.gravity;
    const double away = std::hypot(x, y);
    const double rope = away > 1e-6 ? h_.tether * (x * std::cos(yaw) + y * std::sin(yaw)) : 0; // along the heading
    force -= rope + (h_.drag + h_.water * v * v) * soft_sign(v, 0.008);
    specific_force = force / m_.mass;
    d[0] = specific_force - uphill;
    d[1] = moment / m_.yaw_inertia;
}

void World::set_loads() {
    const double each = m_.mass * m_.gravity / 4, base = 2 * m_.half_base, track = 2 * m_.half_track;
    for (std::size_t i = 0; i < wheels; ++i) {
        double load = each - along[i] * m_.mass * accel * h_.height / (2 * base);
        load += 2 * each * along[i] * h_.offset_x / base + 2 * each * side[i] * h_.offset_y / track;
        wheel[i].load = std::max(0.0, load);
    }
}

void World::set_grip() {
    for (std::size_t i = 0; i < wheels; ++i) {
        const double forward = along[i] * m_.half_base, left = side[i] * m_.half_track;
        const double px = x + forward * std::cos(yaw) - left * std::sin(yaw), py = y + forward * std::sin(yaw) + left * std::cos(yaw);
        double grip = 1 + field_.at(px, py);
        const double place = path + forward; // along the travelled path, each wheel at its own
        if (h_.patch != 0 && place >= h_.patch_start && place < h_.patch_start + h_.patch_length) grip *= 1 + h_.patch;
        grip *= std::max(0.1, 1 + h_.gradient * place);
        if (along[i] * v() < 0) grip *= 1 + h_.multi_pass; // it follows in the other's track
        grip *= 1 + h_.place_wave * std::sin(2 * std::numbers::pi * path / h_.place_length);
        grip *= 1 + h_.grip_drift * t / 120;
        wheel[i].grip = std::max(0.05, grip);
    }
}

void World::step(const PerWheel &wanted) {
    PerWheel duty = wanted;
    if (!delayed_.empty()) {
        delayed_.push_back(wanted);
        duty = delayed_.front();
        delayed_.pop_front();
    }
    double drawn = 0;
    for (std::size_t i = 0; i < wheels; ++i) {
        if (std::fabs(duty[i]) < h_.dead_band) duty[i] = 0;
        drawn += std::fabs(duty[i] * wheel[i].current);
        current_now_[i] = wheel[i].current;
        const double hot = wheel[i].heat, constant = (1 + h_.constant_change[i]) * (1 - magnet_1_K * hot);
        KG_[i] = m_.KG * m_.KG_each[i] * constant;
        ke_[i] = m_.ke * m_.KG_each[i] * constant; // the same magnets
        Ra_[i] = m_.Ra * m_.Ra_each[i] * (1 + copper_1_K * hot);
    }
    battery = m_.battery_V * (1 - 0.012 * t / 120) - m_.battery_ohm * drawn; // discharges 1.2 % in two minutes (assumed)
    for (std::size_t i = 0; i < wheels; ++i) voltage_[i] = duty[i] * battery;
    set_loads();
    set_grip();

    const auto size = state_.size();
    Vector f0(size), f1(size), moved(size);
    rate(state_, f0);
    const double specific_before = specific_force;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 18, 18> system(size, size);
    constexpr double gamma = 1 - 1 / std::numbers::sqrt2;
    for (Eigen::Index j = 0; j < size; ++j) {
        const double delta = 1e-7 * std::max(1.0, std::fabs(state_[j]));
        moved = state_;
        moved[j] += delta;
        rate(moved, f1);
        system.col(j) = -(gamma * h_s / delta) * (f1 - f0);
        system(j, j) += 1;
    }
    const Eigen::PartialPivLU<decltype(system)> lu(system);
    const Vector k1 = lu.solve(f0);
    moved = state_ + h_s * k1;
    rate(moved, f1);
    const Vector k2 = lu.solve(f1 - 2 * k1);
    const Vector before = state_;
    state_ += h_s * (1.5 * k1 + 0.5 * k2);
    const double gravity_part = specific_before - f0[0];
    accel = (state_[0] - before[0]) / h_s;
    integrate_slow((before[0] + state_[0]) / 2, (before[1] + state_[1]) / 2);
    rate(state_, f1); // forces and currents at the new state
    specific_force = accel + gravity_part;
    t += h_s;
}

void World::integrate_slow(double v_mid, double r_mid) {
    const double heading = yaw + 0.5 * h_s * r_mid;
    x += h_s * v_mid * std::cos(heading);
    y += h_s * v_mid * std::sin(heading);
    yaw += h_s * r_mid;
    path += h_s * v_mid;
    for (int k = 0; k < wheels; ++k) {
        WheelState &state = wheel[at(k)];
        const double w = wheel_speed(k), wm = motor_speed(k);
        state.angle += h_s * w;
        state.motor_angle += h_s * wm;
        state.bristle += h_s * (wm - std::fabs(wm) * state.bristle) / h_.hysteresis_angle; // Dahl (1968), first order
        if (h_.heating > 0)                                                                // thermal capacity = time constant / resistance
            state.heat += h_s * (state.current * state.current * m_.Ra - state.heat / h_.heating) * h_.heating / h_.heating_time;
    }
}

} // namespace traction::generator
