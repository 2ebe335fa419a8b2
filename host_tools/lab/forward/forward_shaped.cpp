// What shapes f(X) change beside the base, all their coefficients at once.
#include "forward.h"

#include <algorithm>

namespace traction::lab {

bool plain_currents(const Physics &physics) {
    return std::all_of(physics.wheel.begin(), physics.wheel.end(),
                       [](const WheelPhysics &w) { return !sim::needs_any(w, sim::needs_heat | sim::needs_bend); });
}

Eigen::MatrixXd Forward::shaped(const Physics &base, const UnitResponse &unit, const Term &term, std::size_t coefficients,
                                bool each_wheel) {
    const Dataset &d = *data_;
    const Motion &m = *base_motion_;
    const std::size_t wheels = base.wheel.size(), count = each_wheel ? wheels * coefficients : coefficients;
    std::vector<double> share(d.count * wheels * count, 0);
    Signals s;
    for (std::size_t k = 0; k < d.count; ++k) {
        const std::size_t j = k == 0 ? 0 : k - 1;
        s.t = d.time(k), s.X = m.path_m[j], s.a = m.rate[j][0], s.V = m.v_m_s[k], s.r = m.yaw_rate_rad_s[k];
        for (std::size_t i = 0; i < wheels; ++i) {
            const double gain = count_gain(base.wheel[i]);
            s.w = gain * d.wheel[i].speed_rad_s[k], s.v = m.wheel[i].ground_speed_m_s[k], s.s = m.wheel[i].slip[k],
            s.Fn = m.wheel[i].load_N[k];
            s.theta = gain * d.wheel[i].angle_rad[k], s.x = s.X + base.wheel[i].x;
            s.Ft = m.wheel[i].traction_N[k], s.d = d.wheel[i].travel_rad.empty() ? 0 : gain * d.wheel[i].travel_rad[k];
            term.weights(s, coefficients, &share[(k * wheels + i) * count + (each_wheel ? i * coefficients : 0)]);
        }
    }
    shaped_->resize(count);
    neighbours_shaped(d, base, m, unit, share, *shaped_);
    Eigen::MatrixXd columns(base_prediction_.size(), static_cast<Eigen::Index>(count));
    for (std::size_t j = 0; j < count; ++j) {
        Eigen::VectorXd out = base_prediction_;
        for (std::size_t i = 0; i < wheels; ++i) torque_of_traction(base, (*shaped_)[j], i, out);
        sensors(base, (*shaped_)[j], out);
        columns.col(static_cast<Eigen::Index>(j)) = out - base_prediction_;
    }
    return columns;
}

std::vector<Forward::ElectricSeries> Forward::electric_unit(const Physics &base, TermTarget target) const {
    constexpr double size = 1e-6;
    Physics moved = base;
    moved.terms.push_back({"unit", target, -1, {size}, make_piecewise(Axis::time, {0})});
    std::vector<ElectricSeries> unit(base.wheel.size());
    ElectricSeries plain;
    std::vector<double> current;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        if (!is_motor(base, i)) continue;
        electric_series(base, *base_motion_, i, current, plain);
        electric_series(moved, *base_motion_, i, current, unit[i]);
        for (std::size_t k = 0; k < data_->count; ++k) {
            unit[i].reading[k] = (unit[i].reading[k] - plain.reading[k]) / size;
            unit[i].lost[k] = (unit[i].lost[k] - plain.lost[k]) / size;
            unit[i].per_V[k] = (unit[i].per_V[k] - plain.per_V[k]) / size;
        }
    }
    return unit;
}

Eigen::MatrixXd Forward::shaped_electric(const Physics &base, const std::vector<ElectricSeries> &unit, const Term &term,
                                         std::size_t count) const {
    const Dataset &d = *data_;
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(base_prediction_.size(), static_cast<Eigen::Index>(count));
    std::vector<double> weight(d.count * count);
    std::vector<double> series(d.count);
    Eigen::VectorXd out(base_prediction_.size()), through;
    for (std::size_t i = 0; i < unit.size(); ++i) {
        if (!is_motor(base, i)) continue;
        for (std::size_t k = 0; k < d.count; ++k) {
            Signals s = signals_of(base, *base_motion_, i, k, base_current_);
            s.I = base_current_[i].empty() ? 0 : base_current_[i][k];
            term.weights(s, count, &weight[k * count]);
        }
        for (std::size_t j = 0; j < count; ++j) {
            const auto rows_of_unit = [&](std::size_t balance, const std::vector<double> &of) {
                for (std::size_t k = 0; k < d.count; ++k) series[k] = weight[k * count + j] * of[k];
                rows_of(balance, series, current_delay_s(base.body), false, out);
                return out.segment(static_cast<Eigen::Index>(first_row_[balance]),
                                   static_cast<Eigen::Index>(d.balance[balance].measured.size()));
            };
            const auto place = [&](std::size_t balance) {
                return columns.col(static_cast<Eigen::Index>(j))
                    .segment(static_cast<Eigen::Index>(first_row_[balance]), static_cast<Eigen::Index>(d.balance[balance].measured.size()));
            };
            if (const std::size_t b = balance_of(BalanceKind::current_torque, i); b < d.balance.size())
                place(b) = rows_of_unit(b, unit[i].reading);
            if (const std::size_t b = balance_of(BalanceKind::current_voltage, i); b < d.balance.size()) {
                through =
                    rows_of_unit(b, unit[i].per_V).cwiseProduct(mean_voltage(b, current_delay_s(base.body), command_delay_s(base.body)));
                place(b) = through - rows_of_unit(b, unit[i].lost);
            }
        }
    }
    return columns;
}

} // namespace traction::lab
