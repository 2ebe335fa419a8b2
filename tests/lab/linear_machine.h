// linear_machine.h - a machine whose every prediction is linear in what is fitted, so that each answer of the fit is a textbook's: the
// body's speed is imposed, and sensors alone are read.
//
//   accel = a0 + a1 + a2 t      radar = v (1 + r0 + r1)      yaw rate = g0      t, v: the means over a row's window
#pragma once

#include "tests/lab/hand_made.h"

#include <cmath>
#include <random>

namespace traction::lab::hand_made {

struct LinearMachine {
    Dataset data;
    Physics physics;

    // Rows of half a second; white noise of `noise` times what is stated (1).
    explicit LinearMachine(std::size_t rows = 120, double noise = 1, unsigned seed = 3) : data(data_of(3, rows, 0.5)) {
        physics.motion = BodyMotion::imposed;
        const BalanceKind kinds[] = {BalanceKind::accel, BalanceKind::radar, BalanceKind::yaw_rate};
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        for (std::size_t k = 0; k < data.count; ++k) data.body_speed_m_s.push_back(2 + std::sin(0.7 * data.time(k)));
        for (std::size_t b = 0; b < 3; ++b) {
            data.balance[b].kind = kinds[b];
            for (double &y : data.balance[b].measured) y = noise * normal(random);
        }
        const Eigen::VectorXd plain = prediction({}); // v of the radar
        for (std::size_t r = 0; r < rows; ++r) data.balance[1].measured[r] += plain[static_cast<Eigen::Index>(rows + r)];
    }

    Eigen::Index rows() const { return static_cast<Eigen::Index>(3 * data.balance[0].measured.size()); }

    // What the machine reads without noise, these parameters at these increments.
    Eigen::VectorXd prediction(const std::vector<FreeParameter> &parameters, const Eigen::VectorXd &increments = {}) const {
        Physics at = physics;
        for (std::size_t i = 0; i < parameters.size(); ++i) parameters[i].add(at, increments[static_cast<Eigen::Index>(i)]);
        return Forward(data).predict(at);
    }

    // Adds to what was measured what `p` at `increment` changes.
    void hide(const FreeParameter &p, double increment) {
        const Eigen::VectorXd change = prediction({p}, Eigen::VectorXd::Constant(1, increment)) - prediction({});
        Eigen::Index row = 0;
        for (Balance &b : data.balance)
            for (double &y : b.measured) y += change[row++];
    }

    Eigen::MatrixXd columns(const std::vector<FreeParameter> &parameters) const {
        Eigen::MatrixXd J(rows(), static_cast<Eigen::Index>(parameters.size()));
        for (std::size_t i = 0; i < parameters.size(); ++i)
            J.col(static_cast<Eigen::Index>(i)) = prediction({parameters[i]}, Eigen::VectorXd::Ones(1)) - prediction({});
        return J;
    }

    Eigen::VectorXd left() const { // of what was measured, by the machine as it stands
        Eigen::VectorXd y(rows());
        Eigen::Index row = 0;
        for (const Balance &b : data.balance)
            for (const double one : b.measured) y[row++] = one;
        return y - prediction({});
    }
};

inline FreeParameter sensor(const std::string &owner, const std::string &key, double BodyPhysics::*place, double prior) {
    FreeParameter p = parameter(owner, key, 0, prior);
    Slot slot;
    slot.in_body = place;
    p.slots = {slot};
    p.step = 1e-3;
    p.touched = stage_sensors;
    return p;
}
inline FreeParameter a0(double prior = 0) { return sensor("sensors", "accel.bias_m_s2", &BodyPhysics::accel_bias0, prior); }
inline FreeParameter a1(double prior = 0) { return sensor("accel_bias", "bias_m_s2", &BodyPhysics::accel_bias_m_s2, prior); }
inline FreeParameter a2(double prior = 0) { return sensor("accel_drift", "rate_m_s3", &BodyPhysics::accel_drift_m_s3, prior); }
inline FreeParameter r0(double prior = 0) { return sensor("soil", "radar.scale", &BodyPhysics::radar_scale0, prior); }
inline FreeParameter r1(double prior = 0) { return sensor("radar_scale", "change", &BodyPhysics::radar_scale, prior); }
inline FreeParameter g0(double prior = 0) { return sensor("sensors", "gyro.bias", &BodyPhysics::gyro_bias, prior); }

// Ridge regression by its textbook form, weights and precisions as given.
inline Eigen::VectorXd ridge(const Eigen::MatrixXd &J, const Eigen::VectorXd &y, const Eigen::VectorXd &weight,
                             const Eigen::VectorXd &precision) {
    Eigen::MatrixXd normal = J.transpose() * weight.asDiagonal() * J;
    normal.diagonal() += precision;
    return normal.fullPivLu().solve(J.transpose() * weight.cwiseProduct(y));
}

} // namespace traction::lab::hand_made
