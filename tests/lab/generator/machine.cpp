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

namespace {

// The two larger rovers: lengths, motors and gears as machines of that weight have them (assumed): stall torque two to three times what the
// ground can hold, no-load speed two to four times the driven one, friction of the gear a tenth of the torque that the ground can hold.
void resize(Machine &m, Size size) {
    if (size == Size::medium) {
        m.mass = 12, m.yaw_inertia = 0.42, m.radius = 0.10, m.half_base = 0.17, m.half_track = 0.21;
        m.KG = m.ke = 1.2, m.Ra = 4.0, m.J = 0.04, m.viscous = 8e-3, m.coulomb = 0.18, m.battery_V = 24, m.battery_ohm = 0.08;
        m.current_noise_A = 0.04, m.current_step_A = 0.006;
    }
    if (size == Size::large) {
        m.mass = 60, m.yaw_inertia = 6.2, m.radius = 0.18, m.half_base = 0.32, m.half_track = 0.36;
        m.KG = m.ke = 3.5, m.Ra = 3.0, m.J = 0.3, m.viscous = 0.09, m.coulomb = 1.5, m.battery_V = 48, m.battery_ohm = 0.05;
        m.current_noise_A = 0.1, m.current_step_A = 0.015;
    }
    const double heavier = m.J / 5e-3;
    m.tooth_stiffness *= heavier;
    m.tooth_damping *= heavier;
}

} // namespace

Machine nominal(Soil soil, Size size) {
    struct Ground { // mu, shear slip, rolling resistance, rms of the grip's field
        double mu, sc, rolling, noise;
    };
    const auto ground = [&]() -> Ground {
        switch (soil) {
        case Soil::sand:
            return {5.1 / 7.0, 0.27, 0.05, 0.06}; // table III: Fm at the load of 7 N for which the paper states it
        case Soil::gravel:
            return {6.8 / 7.0, 0.088, 0.03, 0.06}; // table III
        case Soil::concrete:
            return {0.8, 0.05, 0.01, 0.02}; // (21); shear slip assumed
        case Soil::loam:
            return {0.6, 0.16, 0.08, 0.05}; // assumed, as the next
        case Soil::snow:
            break;
        }
        return {0.35, 0.1, 0.06, 0.05};
    }(); // rolling resistance and ground noise: assumed
    Machine m;
    resize(m, size);
    m.soil = soil;
    m.mu = ground.mu;
    m.sc = ground.sc;
    m.rolling = ground.rolling;
    m.grip_noise = ground.noise;
    return m;
}

double scale_of(std::string_view name, Size size) {
    if (size == Size::small) return 1;
    const Machine one = nominal(Soil::sand), m = nominal(Soil::sand, size);
    const double mass = m.mass / one.mass, length = m.radius / one.radius, speed = std::sqrt(length), turning = speed / length;
    const double torque = mass * length, current = torque / (m.KG / one.KG);
    const auto ends = [&](std::string_view unit) { return name.size() >= unit.size() && name.substr(name.size() - unit.size()) == unit; };
    if (ends("_Nms2")) return torque / (turning * turning);
    if (ends("_Nms")) return torque / turning;
    if (ends("_Nm")) return torque;
    if (ends("_per_rad_s")) return 1 / turning;
    if (ends("_rad_s")) return turning;
    if (ends("_ohm") || name == "ohm") return m.Ra / one.Ra;
    if (ends("_V")) return m.battery_V / one.battery_V;
    if (ends("_A")) return current;
    if (ends("_K_W")) return 1 / (m.Ra / one.Ra * current * current); // as many degrees at that machine's current
    if (ends("_Ns2_m2")) return mass / (speed * speed);
    if (ends("_N_m")) return mass / length;
    if (ends("_s2_m2")) return 1 / (speed * speed);
    if (ends("_s2_m")) return 1; // per acceleration, which is the same
    if (ends("_s_m")) return 1 / speed;
    if (ends("_per_m")) return 1 / length;
    if (ends("_m") && !ends("_rad_s2_m")) return length;
    if (ends("_N")) return mass;
    if (name == "coefficient_s") return 1 / turning;
    return 1; // shares, angles, times, accelerations
}

Machine draw(Soil soil, Random &random, Size size) {
    Machine m = nominal(soil, size);
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
    if (h_.gusts > 0)
        for (int k = 1; k <= 40; ++k)
            weather_.push_back({2 * std::numbers::pi * 0.01 * k * random.uniform(0.9, 1.1), random.uniform(0, 2 * std::numbers::pi)});
    delayed_.assign(static_cast<std::size_t>(std::lround(h_.actuation_delay / h_s)), PerWheel{});
    set_loads();
}

double World::shear(double s) const {
    const double k = m_.sc * (1 + h_.shear), a = std::fabs(s) / k;
    const double rise = m_.soil == Soil::concrete ? a : a / 2; // as steep as the stated law is
    switch (m_.knee) {
    case Knee::tanh:
        return std::tanh(rise);
    case Knee::hyperbola:
        return rise / (1 + rise);
    case Knee::magic:
        return std::sin(1.25 * std::atan(rise / 1.25));
    case Knee::stated:
        break;
    }
    if (m_.soil == Soil::concrete) return 1 - std::exp(-a);
    return a < 1e-4 ? a / 2 : 1 - (1 - std::exp(-a)) / a;
}

double World::friction(int wheel_index, double w) const {
    const std::size_t i = at(wheel_index);
    const double theta = wheel[i].angle, size = std::fabs(w);
    double g = m_.coulomb * m_.coulomb_each[i] + h_.coulomb[i] + h_.friction_drift[i] * t / 120 +
               (t > h_.friction_step_time[i] ? h_.friction_step[i] : 0);
    g += (m_.viscous * m_.viscous_each[i] + h_.viscous[i]) * size + h_.friction_squared[i] * size * size;
    g += h_.stribeck[i] * std::exp(-(w * w) / (h_.stribeck_speed[i] * h_.stribeck_speed[i]));
    g += h_.ripple_cos[i] * std::cos(h_.ripple_order[i] * theta) + h_.ripple_sin[i] * std::sin(h_.ripple_order[i] * theta);
    if (w < 0) g += h_.reverse_friction[i];
    if (h_.resonance[i] > 0) g += h_.resonance[i] * std::exp(-std::pow((size - h_.resonance_speed[i]) / 0.7, 2));
    if (h_.wear_in[i] > 0) g += h_.wear_in[i] * std::exp(-t / h_.wear_in_time[i]);
    if (h_.tooth[i] > 0) g += h_.tooth[i] * std::exp(8 * (std::cos(theta) - 1)); // once a turn, over some 40 degrees
    return g * soft_sign(w, 0.03) + h_.hysteresis[i] * wheel[i].bristle;
}

double World::current(int wheel_index, double w) const {
    const std::size_t i = at(wheel_index);
    const double u = voltage_[i] - h_.coupling * current_now_[i ^ 1U]; // the other motor of the same axle shares a lead
    const double e = u - ke_[i] * w, open = std::fabs(e) - h_.dead_voltage[i];
    return open > 0 ? std::copysign(open, e) / (Ra_[i] + h_.wiring[i]) : 0;
}

// Rolling resistance of a soft place on the travelled path, each wheel at its own.
double World::muddy(std::size_t i) const {
    const double place = path + along[i] * m_.half_base;
    return h_.mud != 0 && place >= h_.mud_start && place < h_.mud_start + h_.mud_length ? h_.mud : 0;
}

// What pushes the body along its heading, but for the ground [N].
double World::pushed() const {
    double gust = 0; // standard deviation 1
    for (const GustWave &wave : weather_)
        gust += std::sqrt(2.0 / static_cast<double>(weather_.size())) * std::cos(wave.rate * t + wave.phase);
    return h_.swing * std::sin(2 * std::numbers::pi * h_.swing_Hz * t) + h_.gusts * gust;
}

// Rise of an uneven floor along the travelled path [rad].
double World::waves() const { return h_.waves * std::sin(2 * std::numbers::pi * path / h_.wave_length); }

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
        state.force = Fm * shear(slip) * (slip < 0 ? -1 : 1) * (1 - h_.shear_peak * std::max(0.0, std::fabs(slip) - 2 * m_.sc));
        const double Q = (m_.rolling + h_.rolling[i] + h_.sinkage * std::min(1.0, std::fabs(slip)) + h_.speed_resistance * std::fabs(vw) +
                          h_.turn_resistance * std::fabs(r) + h_.rolling_squared * vw * vw + muddy(i)) *
                         state.load;
        const double net = state.force - Q * soft_sign(vw, 0.008);
        force += net;
        moment -= (side[i] * m_.half_track - h_.offset_y) * net; // about the centre of mass, though it be off the middle
        const double lateral = along[i] * m_.half_base * r;
        moment -= h_.scrub * state.load * along[i] * m_.half_base * soft_sign(lateral, 0.006);
        const double wm = backlash_ ? s[motor_at_ + k] : w;
        state.current = current(k, wm);
        double torque = KG_[i] * state.current;
        if (h_.torque_limit[i] > 0) torque = h_.torque_limit[i] * std::tanh(torque / h_.torque_limit[i]);
        torque *= std::max(0.2, 1 - h_.speed_loss[i] * std::fabs(wm)); // a gear that loses more the faster it turns
        const double drag = friction(k, wm) + h_.mesh * std::fabs(radius_[i] * state.force) * soft_sign(wm, 0.03);
        if (!backlash_) {
            d[2 + k] = (torque - drag - radius_[i] * state.force) / m_.J;
        } else { // teeth as a stiff spring behind the play
            const double gap = s[gear_at_ + k], half = h_.play[i] / 2;
            const double bite = gap > half ? gap - half : gap < -half ? gap + half : 0;
            const double teeth = bite == 0 ? 0 : m_.tooth_stiffness * bite + m_.tooth_damping * (wm - w);
            d[motor_at_ + k] = (torque - drag - teeth) / (m_.motor_share * m_.J);
            d[2 + k] = (teeth - radius_[i] * state.force) / ((1 - m_.motor_share) * m_.J);
            d[gear_at_ + k] = wm - w;
        }
    }
    const double uphill = (std::sin(h_.slope) * std::cos(yaw - h_.slope_direction) + std::sin(waves())) * m_.gravity;
    const double away = std::hypot(x, y);
    const double rope = away > 1e-6 ? h_.tether * (x * std::cos(yaw) + y * std::sin(yaw)) : 0; // along the heading
    force += pushed() - rope - (h_.drag + h_.water * v * v) * soft_sign(v, 0.008);
    specific_force = force / mass();
    d[0] = specific_force - uphill;
    d[1] = moment / m_.yaw_inertia;
}

void World::set_loads() {
    const double each = mass() * m_.gravity / 4, base = 2 * m_.half_base, track = 2 * m_.half_track;
    for (std::size_t i = 0; i < wheels; ++i) {
        double load = each - along[i] * mass() * accel * h_.height / (2 * base);
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
        if (std::fabs(duty[i]) < h_.dead_band[i]) duty[i] = 0;
        if (h_.tyre_loss[i] > 0) radius_[i] = m_.radius * m_.radius_each[i] * (1 - h_.tyre_loss[i] * t / 120);
        drawn += std::fabs(duty[i] * wheel[i].current);
        current_now_[i] = wheel[i].current;
        const double hot = wheel[i].heat, constant = (1 + h_.constant_change[i]) * (1 - magnet_1_K * hot);
        KG_[i] = m_.KG * m_.KG_each[i] * constant;
        ke_[i] = m_.ke * m_.KG_each[i] * constant; // the same magnets
        Ra_[i] = m_.Ra * m_.Ra_each[i] * (1 + copper_1_K * hot);
    }
    battery = m_.battery_V * (1 - m_.battery_sag_1_s * t) - m_.battery_ohm * drawn;
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
