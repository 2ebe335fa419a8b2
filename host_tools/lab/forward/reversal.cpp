#include "reversal.h"

#include "motion.h"
#include "wheel_laws.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

// Of what (1) is where the wheel rolls, half of the difference between the ends of e.
double unknown_share(double v_m_s) {
    const double v = std::fabs(v_m_s);
    return 0.5 * (soft_sign(v, resist_speed_m_s / 2) - soft_sign(v, resist_speed_m_s * 2));
}

} // namespace

void add_reversal(const Model &model, Dataset &data) {
    if (data.independent_rows || data.count < 3 || data.balance.empty()) return;
    const Physics physics = make_physics(model);
    Motion motion;
    integrate(data, physics, motion, nullptr, true); // with all that is known of each step
    for (Balance &b : data.balance) {
        if (b.kind != BalanceKind::current_torque || b.measured.empty()) continue;
        const WheelPhysics &p = physics.wheel[static_cast<std::size_t>(b.wheel)];
        const Motion::Wheel &m = motion.wheel[static_cast<std::size_t>(b.wheel)];
        if (!(p.KG > 0) || m.rolling_N.size() < data.count || m.ground_speed_m_s.size() < data.count) continue;
        if (b.noise_factor.empty()) b.noise_factor.assign(b.measured.size(), 1);
        for (std::size_t r = 0; r < b.measured.size(); ++r) {
            const auto at = [&](double t_s) {
                return static_cast<std::size_t>(std::clamp((t_s - data.start_s) / data.step_s, 0.0, static_cast<double>(data.count - 1)));
            };
            double sum_N = 0;
            const std::size_t first = at(b.t0_s[r]), last = at(b.t1_s[r]);
            for (std::size_t k = first; k <= last; ++k) {
                const double v = m.ground_speed_m_s[k], part = std::fabs(soft_sign(v, resist_speed_m_s));
                if (part > 0) sum_N += std::fabs(m.rolling_N[k]) / part * unknown_share(v);
            }
            const double off_A = rolling_radius(p) / p.KG * sum_N / static_cast<double>(last - first + 1);
            if (std::isfinite(off_A)) b.noise_factor[r] = std::hypot(b.noise_factor[r], off_A / b.noise);
        }
    }
}

} // namespace traction::lab
