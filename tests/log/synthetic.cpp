#include "synthetic.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace traction::test {

double Random::uniform() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

double Random::normal() {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return sum;
}

namespace {

// docs/sources.md section 3 and its assumed electrical side.
constexpr double R = 0.057, J = 5e-3, KG = 0.265, ke = 0.265, Ra = 3.24, M = 2.88, half_track = 0.12, dt = 0.01, rolling_N = 0.25;

struct Leg {
    double until_s, speed_m_s, yaw_rate_rad_s, sweep; // sweep: extra slip, + front, - rear
};
// Out and back on one track, turns to both sides, a slip sweep; three standstills.
const Leg rich[] = {{3, 0, 0, 0},     {10, 0.25, 0, 0},    {13, 0.25, 0.6, 0},   {16, 0.25, -0.6, 0}, {20, 0.4, 0, 0}, {22, 0, 0, 0},
                    {26, -0.4, 0, 0}, {29, -0.25, 0.6, 0}, {32, -0.25, -0.6, 0}, {39, -0.25, 0, 0},   {42, 0, 0, 0},   {50, 0.3, 0, 0.35},
                    {53, 0, 0, 0},    {60, -0.3, 0, -0.2}, {62, 0, 0, 0},        {70, 0.15, 0.3, 0},  {76, 0.5, 0, 0}, {80, 0, 0, 0}};
const Leg plain[] = {{60, 0.25, 0, 0}};

} // namespace

log::Log drive(const Drive &how) {
    Random random(how.seed);
    const Leg *const legs = how.rich ? rich : plain;
    const std::size_t count = how.rich ? 8000 : 6000;
    std::vector<double> v(count), r(count), a(count), x(count), y(count), yaw(count);
    std::vector<double> w[4], force[4];
    double speed = how.rich ? 0 : 0.25, rate = 0, px = 0, py = 0, psi = 0.3;
    std::size_t leg = 0;
    double soil[4] = {};
    for (int i = 0; i < 4; ++i) w[i].resize(count), force[i].resize(count);
    for (std::size_t k = 0; k < count; ++k) {
        while (legs[leg].until_s < static_cast<double>(k) * dt) ++leg;
        const double change = (legs[leg].speed_m_s - speed) / 0.3; // lag 0.3 s
        a[k] = std::clamp(change, -1.2, 1.2);
        speed += a[k] * dt;
        if (legs[leg].speed_m_s == 0 && std::fabs(speed) < 0.01) speed = 0, a[k] = 0;
        rate += (legs[leg].yaw_rate_rad_s - rate) / 0.3 * dt;
        if (speed == 0 && std::fabs(rate) < 0.01) rate = 0;
        psi += rate * dt, px += speed * std::cos(psi) * dt, py += speed * std::sin(psi) * dt;
        v[k] = speed, r[k] = rate, x[k] = px, y[k] = py, yaw[k] = psi;
        for (int i = 0; i < 4; ++i) {
            const bool moving = speed != 0;
            soil[i] = 0.98 * soil[i] + std::sqrt(1 - 0.98 * 0.98) * how.soil_noise_N * random.normal();
            const double side = i % 2 == 0 ? -1 : 1, vi = speed + side * half_track * rate, forward = vi < 0 ? -1 : 1;
            double ft = moving ? M * a[k] / 4 + rolling_N * forward + side * 1.5 * rate + soil[i] : 0; // 1.5 N s/rad: scrub
            double s = std::clamp(forward * ft, -0.9 * how.grip_N, 0.9 * how.grip_N);
            s = s < 0 ? 0.15 * std::log(1 + s / how.grip_N) : -0.15 * std::log(1 - s / how.grip_N); // inverse of (21), sc = 0.15
            if (moving && legs[leg].sweep != 0) {
                s += (i >= 2 ? 1 : -1) * legs[leg].sweep * std::min(1.0, std::fabs(speed) / 0.2);
                ft = forward * how.grip_N * std::copysign(1 - std::exp(-std::fabs(s) / 0.15), s);
            }
            s = std::clamp(s, -0.9, 0.6);
            w[i][k] = s > 0 ? vi / (R * (1 - s)) : vi * (1 + s) / R;
            force[i][k] = ft;
        }
    }
    log::Log log;
    log.header["scenario"] = "synthetic";
    const auto add = [&](const std::string &name, std::size_t every, const std::function<double(std::size_t)> &value) {
        log::Signal signal{name, {}, {}};
        for (std::size_t k = 0; k < count; k += every) signal.t_s.push_back(static_cast<double>(k) * dt), signal.value.push_back(value(k));
        log.signals.push_back(std::move(signal));
    };
    const double n = how.noise;
    std::vector<double> battery(count, 7.2), current[4];
    for (int i = 0; i < 4; ++i) {
        current[i].resize(count);
        for (std::size_t k = 0; k < count; ++k) {
            const double acceleration = k == 0 ? 0 : (w[i][k] - w[i][k - 1]) / dt, turn = w[i][k] == 0 ? 0 : std::copysign(1.0, w[i][k]);
            current[i][k] = (1.6e-3 * w[i][k] + 0.03 * turn + J * acceleration + R * force[i][k]) / KG;
            battery[k] -= 0.1 * std::fabs(current[i][k]); // 0.1 ohm, assumed
        }
    }
    for (int i = 0; i < 4; ++i) {
        const std::string wheel = "wheel" + std::to_string(i);
        std::vector<double> angle(count);
        for (std::size_t k = 1; k < count; ++k) angle[k] = angle[k - 1] + w[i][k] * dt;
        add(wheel + ".speed_rad_s", 1, [&](std::size_t k) { return w[i][k] == 0 ? 0.0 : w[i][k] + 0.03 * n * random.normal(); });
        add(wheel + ".encoder_count", 1, [&](std::size_t k) { return std::floor(angle[k] * 6000 / 6.283185307179586); });
        add(wheel + ".current_A", 1,
            [&](std::size_t k) { return 0.0024 * std::round((current[i][k] + 0.015 * n * random.normal()) / 0.0024); });
        add(wheel + ".duty", 1, [&](std::size_t k) { return (ke * w[i][k] + Ra * current[i][k]) / battery[k]; });
    }
    add("battery.voltage_V", 1, [&](std::size_t k) { return 0.005 * std::round((battery[k] + 0.01 * n * random.normal()) / 0.005); });
    add("imu.accel_x_m_s2", 1, [&](std::size_t k) { return a[k] + 0.08 + 0.06 * n * random.normal(); });
    add("imu.gyro_z_rad_s", 1, [&](std::size_t k) { return r[k] + 0.01 * n * random.normal(); });
    add("radar.speed_m_s", 50,
        [&](std::size_t k) { return std::fabs(v[k]) < 0.03 ? 0.0 : std::fabs(v[k] * (1 + 0.06 * n * random.normal())); });
    add("camera.x_m", 14, [&](std::size_t k) { return x[k] + 0.001 * n * random.normal(); });
    add("camera.y_m", 14, [&](std::size_t k) { return y[k] + 0.001 * n * random.normal(); });
    add("camera.yaw_rad", 14, [&](std::size_t k) { return std::remainder(yaw[k] + 0.005 * n * random.normal(), 6.283185307179586); });
    return log;
}

log::Signal &at(log::Log &log, std::string_view name) {
    for (log::Signal &signal : log.signals) {
        if (signal.name == name) return signal;
    }
    throw std::out_of_range(std::string(name));
}

void scale(log::Log &log, const std::string &name, double factor) {
    for (double &value : at(log, name).value) value *= factor;
}

void exchange(log::Log &log, const std::string &a, const std::string &b) {
    std::swap(at(log, a).t_s, at(log, b).t_s);
    std::swap(at(log, a).value, at(log, b).value);
}

} // namespace traction::test
