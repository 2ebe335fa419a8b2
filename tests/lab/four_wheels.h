// four_wheels.h - a rover of four wheels on soft ground that turn unlike, for a minute: currents by torque and by voltage, radar and
// accelerometer in rows of half a second, every noise known. What it holds beside its model a test says itself.
#pragma once

#include "tests/lab/hand_made.h"

#include <cmath>
#include <random>
#include <string>

namespace traction::lab::hand_made {

struct FourWheels {
    Model model;
    Dataset data;
    // cruise: at one speed but for the first seconds, a little to and fro about it.
    explicit FourWheels(const std::string &more = "", bool cruise = false) : data(data_of(10, 120, 0.5)) {
        model = parse_model("[rover]\nmass_kg = 6\n[wheels]\nradius_m = 0.05\n[motor]\ntorque_constant_Nm_A = 0.3\n"
                            "back_emf_Vs_rad = 0.3\nresistance_ohm = 3\ncoulomb_Nm = 0.05\nviscous_Nms = 0.002\ninertia_kg_m2 = 0.002\n"
                            "[soil]\nmu = 0.7\nshear_slip = 0.2\nrolling_coefficient = 0.05\n[[wheel]]\nx_m = 0.1\ny_m = 0.1\n"
                            "[[wheel]]\nx_m = 0.1\ny_m = -0.1\n[[wheel]]\nx_m = -0.1\ny_m = 0.1\n[[wheel]]\nx_m = -0.1\ny_m = -0.1\n" +
                                more,
                            "four wheels");
        const auto hold = [](Parameters &table) {
            for (auto &[key, p] : table) p.prior = p.each_wheel = 0;
        };
        hold(model.rover), hold(model.sensors);
        for (WheelSpec &w : model.wheel) {
            hold(w.geometry), hold(w.motor), hold(w.soil);
            w.soil.at("mu").prior = 0.1;
        }
        for (int i = 0; i < 4; ++i) {
            WheelInput w;
            double angle = 0, integral = 0;
            for (std::size_t k = 0; k < data.count; ++k) {
                const double t = data.time(k), begun = std::exp(-0.5 * t),
                             speed = cruise ? 8 * (1 - begun) + 0.3 * std::sin(1.7 * t + i)
                                            : 6 + 4 * std::sin(0.5 * t + 0.1 * i) + (1.5 + 0.2 * i) * std::sin(1.7 * t),
                             u = 0.35 * speed + 0.5 + 0.3 * std::sin(0.9 * t + i);
                w.speed_rad_s.push_back(speed);
                w.accel_rad_s2.push_back(cruise ? 4 * begun + 0.51 * std::cos(1.7 * t + i)
                                                : 2 * std::cos(0.5 * t + 0.1 * i) + (1.5 + 0.2 * i) * 1.7 * std::cos(1.7 * t));
                w.angle_rad.push_back(angle), w.travel_rad.push_back(angle);
                w.voltage_V.push_back(u), w.voltage_t_s.push_back(t), w.voltage_integral_Vs.push_back(integral);
                angle += 0.1 * speed, integral += 0.1 * u;
            }
            w.scatter_rad = 0.002, w.sample_s = 0.1, w.half_s = 0.3;
            data.wheel.push_back(w);
        }
        data.yaw_rate_rad_s.assign(data.count, 0), data.yaw_rad.assign(data.count, 0);
        for (std::size_t b = 0; b < 10; ++b) {
            Balance &balance = data.balance[b];
            balance.kind = b < 4   ? BalanceKind::current_torque
                           : b < 8 ? BalanceKind::current_voltage
                           : b < 9 ? BalanceKind::radar
                                   : BalanceKind::accel;
            balance.wheel = b < 8 ? static_cast<int>(b % 4) : -1;
            balance.noise = b < 8 ? 0.01 : b < 9 ? 0.004 : 0.03;
        }
        measure(make_physics(model));
    }
    // Reads this machine, with noise.
    void measure(const Physics &truth) {
        const Eigen::VectorXd y = Forward(data).predict(truth);
        std::mt19937 random(5);
        std::normal_distribution<double> normal;
        Eigen::Index row = 0;
        for (Balance &b : data.balance)
            for (double &one : b.measured) one = y[row++] + b.noise * normal(random);
    }
    void hide(const std::vector<EffectUse> &effects) {
        Model truth = model;
        truth.effects = effects;
        measure(make_physics(truth));
    }
};

} // namespace traction::lab::hand_made
