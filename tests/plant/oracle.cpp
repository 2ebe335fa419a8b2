#include "oracle.h"

#include <algorithm>
#include <cmath>

namespace traction::oracle {

namespace {

// Table I and (17)-(19), the rest as assumed in the plant.
constexpr double M = 2.88, a = 0.083, b = 0.12, R = 0.057, J = 5e-3, m_wheel = 0.15, KG = 0.265, Ra = 3.24, visc = 1.6e-3, dry = 0.03;
constexpr double V0 = 7.2, Rb = 0.06, g = 9.81, sigma = 0.005;
constexpr double Iz = M * (0.30 * 0.30 + 0.27 * 0.27) / 12; // box

constexpr std::size_t states = 7 + 12;
using State = std::array<double, states>; // x y yaw vx vy r path | w s sy per wheel

double share(const Ground &soil, double S) {
    const double q = S / soil.sc;
    if (soil.hard) return 1 - std::exp(-q);
    return q < 1e-6 ? q / 2 : 1 - (1 - std::exp(-q)) / q;
}

struct WheelForce {
    double along, across, rolling;
};

WheelForce wheel_force(const Ground &soil, double Fn, double rim, double v, double vy, double s, double sy, double ds, double dsy) {
    const double Fm = soil.adhesion_N + soil.mu * Fn, S = std::hypot(s, sy);
    double along = 0, across = 0;
    if (S > 0) along = Fm * share(soil, S) * s / S, across = Fm * share(soil, S) * sy / S;
    const double near = std::max(0.0, 1 - std::max(std::fabs(rim), std::fabs(v)) / 0.2);
    const double c = 0.6 * std::sqrt(Fm / soil.sc * (soil.hard ? 1 : 0.5) / sigma * M / 4) * near * near;
    along += c * sigma * ds, across += c * sigma * dsy;
    const double size = std::hypot(along, across);
    if (size > Fm) along *= Fm / size, across *= Fm / size;
    (void)vy;
    return {along, across * soil.lateral * Fn / Fm, soil.rolling * Fn};
}

State derivative(const Setup &setup, const State &x) {
    State d{};
    const double yaw = x[2], vx = x[3], vy = x[4], r = x[5];
    const double up = setup.ground.rise_x * std::cos(yaw) + setup.ground.rise_y * std::sin(yaw);
    const double left = -setup.ground.rise_x * std::sin(yaw) + setup.ground.rise_y * std::cos(yaw);
    const double weight = std::sqrt(g * g - setup.ground.rise_x * setup.ground.rise_x - setup.ground.rise_y * setup.ground.rise_y);
    // battery: V (1 + Rb sum d^2/Ra) = V0 + Rb sum d KG w/Ra
    double dd = 0, dw = 0;
    for (std::size_t i = 0; i < 4; ++i) dd += setup.duty[i] * setup.duty[i], dw += setup.duty[i] * KG * x[7 + 3 * i];
    const double supply = (V0 + Rb * dw / Ra) / (1 + Rb * dd / Ra);

    std::array<double, 4> Fn;
    Fn.fill(M * weight / 4);
    std::array<WheelForce, 4> f{};
    std::array<double, 4> spin{};
    for (int pass = 0; pass < 6; ++pass) { // loads depend on forces and forces on loads: contraction by h/a < 1
        for (std::size_t i = 0; i < 4; ++i) {
            const double px = i < 2 ? -a : a, py = i % 2 == 0 ? b : -b;
            const double w = x[7 + 3 * i], s = x[8 + 3 * i], sy = x[9 + 3 * i], v = vx - py * r, side = vy + px * r;
            const double U = std::max(std::fabs(R * w), std::fabs(v));
            d[8 + 3 * i] = (R * w - v - U * s) / sigma;
            d[9 + 3 * i] = (-side - U * sy) / sigma;
            f[i] = wheel_force(setup.ground, Fn[i], R * w, v, side, s, sy, d[8 + 3 * i], d[9 + 3 * i]);
            f[i].rolling *= std::clamp(v / 0.005, -1.0, 1.0);
            const double current = (setup.duty[i] * supply - KG * w) / Ra;
            spin[i] = (KG * current - visc * w - dry - R * f[i].along) / J;
            d[7 + 3 * i] = spin[i];
        }
        double sideways = 0;
        for (const WheelForce &force : f) sideways += force.across;
        const double h = setup.centre_height_m, roll = sideways * h / (4 * b); // right wheels gain when pushed left
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t mate = (i + 2) % 4; // the other wheel of the half
            double pitch = (f[i].along + f[mate].along - f[i].rolling - f[mate].rolling) * h;
            if (h > 0) pitch += 0.5 * m_wheel * R * R * (spin[i] + spin[mate]);
            Fn[i] = M * weight / 4 + (i < 2 ? 1 : -1) * pitch / (2 * a) + (i % 2 == 0 ? -1 : 1) * roll;
        }
    }
    double Fx = 0, Fy = 0, Mz = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double px = i < 2 ? -a : a, py = i % 2 == 0 ? b : -b, pull = f[i].along - f[i].rolling;
        Fx += pull, Fy += f[i].across, Mz += px * f[i].across - py * pull;
    }
    d[0] = vx * std::cos(yaw) - vy * std::sin(yaw);
    d[1] = vx * std::sin(yaw) + vy * std::cos(yaw);
    d[2] = r;
    d[3] = Fx / M - up + r * vy;
    d[4] = Fy / M - left - r * vx;
    d[5] = Mz / Iz;
    d[6] = vx;
    return d;
}

State shifted(const State &x, const State &d, double h) {
    State out;
    for (std::size_t i = 0; i < states; ++i) out[i] = x[i] + h * d[i];
    return out;
}

} // namespace

Pose drive(const Setup &setup, double seconds) {
    State x{};
    x[3] = setup.speed_m_s;
    for (std::size_t i = 0; i < 4; ++i) x[7 + 3 * i] = setup.speed_m_s / R;
    const double h = 5e-4; // stiffest rate: slip spring on concrete, 300 rad/s: (0.15)^4/120 of an error per radian
    const long steps = std::lround(seconds / h);
    for (long k = 0; k < steps; ++k) {
        const State k1 = derivative(setup, x), k2 = derivative(setup, shifted(x, k1, h / 2));
        const State k3 = derivative(setup, shifted(x, k2, h / 2)), k4 = derivative(setup, shifted(x, k3, h));
        for (std::size_t i = 0; i < states; ++i) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    return {x[0], x[1], x[2], x[6]};
}

} // namespace traction::oracle
