// The plant on soft ground against a second formulation: straight ahead, no ODE, no sinkage state (each wheel stands where it carries its
// load), Runge-Kutta of fourth order, libm, 100 nodes for the arc. Written from equations (1)-(6) of docs/physics.md, not from the plant's
// code.
#include "sim/plant/plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

using namespace traction::sim;

namespace {

// Table I and (17)-(19), the rest as assumed in the plant (docs/sources.md).
constexpr double M = 2.88, g = 9.81, R = 0.057, ww = 0.042, J = 5e-3, KG = 0.265, Ra = 3.24, viscous = 1.6e-3, dry = 0.03, V0 = 7.2,
                 Rb = 0.06;
constexpr double sigma = 0.005, hysteresis = 0.005;

struct Pull {
    double load = 0, traction = 0, resistance = 0, torque = 0;
};

double reload(const Bekker &b, double rut) { return std::max(b.reload_N_m4 * rut, 2 * (b.kc / ww + b.kphi) * std::pow(rut, b.n - 1)); }

double surface_of(const Bekker &b, double rut) { return rut > 0 ? rut - (b.kc / ww + b.kphi) * std::pow(rut, b.n) / reload(b, rut) : 0; }

double bulldozing(const Bekker &b, double z, double rut) {
    const double fresh = std::max(0.0, z - rut), t = std::tan(std::acos(-1.0) / 4 + b.phi_rad / 2);
    return ww * b.weight_N_m3 * fresh * fresh / 2 * t * t;
}

Pull closed_form(const Bekker &b, double z, double slip, double rut) {
    const double n = b.n * (1 + b.slip_sinkage * std::fabs(slip)), surface = surface_of(b, rut);
    if (z <= surface) return {};
    double length = std::sqrt(2 * R * z - z * z);
    const double k = b.kc / std::min(ww, length) + b.kphi;
    const auto load = [&](double depth) { return ww * k * std::sqrt(2 * R) * std::pow(depth, n + 0.5) * (3 - std::min(n, 1.3)) / 3; };
    Pull out;
    out.load = z >= rut ? load(z) : load(rut) * std::pow((z - surface) / (rut - surface), 1.5);
    double compaction = ww * k * std::pow(z, n + 1) / (n + 1);
    if (rut > 0) {
        length = std::min(length, 2 * std::sqrt(2 * R * (z - surface)));
        compaction -= ww * k * std::pow(std::min(z, rut), n + 1) / (n + 1);
    }
    const double sc = b.K_m / length, q = std::fabs(slip) / sc, most = length * ww * b.c_Pa + out.load * std::tan(b.phi_rad);
    out.traction = q < 1e-9 ? 0 : std::copysign(most * (1 - (1 - std::exp(-q)) / q), slip);
    out.resistance = compaction + bulldozing(b, z, rut) + hysteresis * out.load;
    out.torque = R * out.traction;
    return out;
}

Pull arc_integral(const Bekker &b, double z, double slip, double rut) {
    const double n = b.n * (1 + b.slip_sinkage * std::fabs(slip)), surface = surface_of(b, rut), deep = z - surface;
    if (deep <= 0) return {};
    const double entry = std::acos(1 - deep / R), summit = std::min(0.95, b.c1 + b.c2 * std::fabs(slip)) * entry;
    const double k = b.kc / std::min(ww, R * std::sin(entry)) + b.kphi, K = b.K_m, ratio = slip >= 0 ? 1 - slip : 1 / (1 + slip);
    constexpr int nodes = 100;
    Pull out;
    for (int i = 0; i < nodes; ++i) {
        const double theta = (i + 0.5) * entry / nodes;
        const double as_in_front = theta > summit ? theta : entry - theta * (entry - summit) / summit;
        const double depth = z - R * (1 - std::cos(as_in_front));
        double p = k * std::pow(depth, n);
        if (rut > 0 && depth < rut) {
            const double again = reload(b, rut) * (depth - surface) * k * std::pow(rut, n) / ((b.kc / ww + b.kphi) * std::pow(rut, b.n));
            p = std::min(p, std::max(0.0, again));
        }
        const double j = R * ((entry - theta) - ratio * (std::sin(entry) - std::sin(theta)));
        const double tau = std::copysign((b.c_Pa + p * std::tan(b.phi_rad)) * (1 - std::exp(-std::fabs(j) / K)), j),
                     area = R * ww * entry / nodes;
        out.load += area * (p * std::cos(theta) + tau * std::sin(theta));
        out.traction += area * tau * std::cos(theta);
        out.resistance += area * p * std::sin(theta);
        out.torque += R * area * tau;
    }
    out.resistance += bulldozing(b, z, rut) + hysteresis * out.load;
    return out;
}

// Where a wheel stands that carries a quarter of the rover: secant steps from the last answer `z`; the load grows with the depth.
Pull standing(const std::function<Pull(double)> &law, double &z) {
    constexpr double want = M * g / 4;
    Pull at = law(z);
    double before = z * 1.001 + 1e-7, missed_before = law(before).load - want;
    for (int i = 0; i < 50 && std::fabs(at.load - want) > 1e-6; ++i) {
        const double missed = at.load - want, step = missed * (z - before) / (missed - missed_before);
        before = z, missed_before = missed;
        z = std::clamp(z - step, 0.5 * z, 2 * z + 1e-5);
        at = law(z);
    }
    EXPECT_NEAR(at.load, want, 1e-5);
    return at;
}

using State = std::array<double, 6>; // x, v, front w, s, rear w, s

State slope(const Bekker &b, ContactLaw contact, double duty, const State &x, double &front_m, double &rear_m) {
    const double supply = (V0 + Rb * 2 * duty * KG * (x[2] + x[4]) / Ra) / (1 + Rb * 4 * duty * duty / Ra);
    const auto law = [&](double z, double slip, double rut) {
        return contact == ContactLaw::arc ? arc_integral(b, z, slip, rut) : closed_form(b, z, slip, rut);
    };
    const Pull front = standing([&](double z) { return law(z, x[3], 0); }, front_m);
    // 166 mm behind, in fresh soil until they reach the front wheels' track; a strip of the wheel's width mixes the two
    const double reached = std::clamp((x[0] - 0.166 + ww) / ww, 0.0, 1.0);
    const Pull rear = standing([&](double z) { return law(z, x[5], reached * front_m); }, rear_m);
    const auto spin = [&](double w, const Pull &p) { return (KG * (duty * supply - KG * w) / Ra - viscous * w - dry - p.torque) / J; };
    const auto slipping = [&](double w, double s) { return (R * w - x[1] - std::max(std::fabs(R * w), std::fabs(x[1])) * s) / sigma; };
    return {x[1],
            2 * (front.traction - front.resistance + rear.traction - rear.resistance) / M,
            spin(x[2], front),
            slipping(x[2], x[3]),
            spin(x[4], rear),
            slipping(x[4], x[5])};
}

TEST(second_formulation, agrees_on_soft_ground_in_path_and_sinkage_after_six_seconds) {
    double worst = 0;
    for (const ContactLaw contact : {ContactLaw::bekker, ContactLaw::arc})
        for (const char *soil : {"gravel", "sand", "dry_sand_literature", "loam", "snow", "lunar_simulant"}) {
            PlantConfig config;
            config.ground.soil = *find_soil(soil);
            config.ground.contact = contact;
            config.speed_m_s = 0.3;
            Plant plant(config);
            for (int i = 0; i < wheel_count; ++i) plant.set_duty(i, 0.5);
            for (int k = 0; k < 6000; ++k) plant.step();

            State x = {0, 0.3, 0.3 / R, 0, 0.3 / R, 0};
            double front_m = 0.005, rear_m = 0.005;
            constexpr double h = 0.004; // of the slip's 5 mm/0.3 m/s = 17 ms: fourth order leaves 1e-4 of it
            for (int k = 0; k < 1500; ++k) {
                const auto at = [&](const State &d, double by) {
                    State y = x;
                    for (std::size_t i = 0; i < y.size(); ++i) y[i] += by * d[i];
                    return slope(*config.ground.soil.bekker, contact, 0.5, y, front_m, rear_m);
                };
                const State a = at({}, 0), b = at(a, h / 2), c = at(b, h / 2), d = at(c, h);
                for (std::size_t i = 0; i < x.size(); ++i) x[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
            }
            const std::string what = std::string(soil) + ", contact " + std::to_string(static_cast<int>(contact));
            // 16 nodes stand for 100 within 1 % of the load, which is what moves the arc's path; the closed form has no such excuse
            const double within = contact == ContactLaw::arc ? 0.02 : 0.005, path = std::fabs(plant.truth().position_m[0] / x[0] - 1);
            EXPECT_LT(path, within) << what;
            EXPECT_NEAR(plant.truth().wheel[2].sinkage_m, front_m, 0.02 * front_m) << what;
            EXPECT_NEAR(plant.truth().wheel[0].sinkage_m, rear_m, 0.02 * rear_m) << what;
            worst = std::max(worst, path);
        }
    std::printf("worst difference of the path after 6 s: %.3f %%\n", 100 * worst);
}

} // namespace
