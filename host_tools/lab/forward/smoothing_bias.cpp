#include "smoothing_bias.h"

#include "forward.h"

#include <cmath>

namespace traction::lab {

namespace {

constexpr double cubics_share = 0.4; // of the parabolas' loss, what cubics of the same width lose at a kink of the speed: assumed
constexpr double largest_ratio = 8;  // of bias over noise: assumed

Eigen::VectorXd plain_prediction(const Dataset &data, const Physics &physics) {
    Dataset plain = data;
    for (WheelInput &w : plain.wheel) {
        if (w.plain_speed_rad_s.empty()) continue;
        w.speed_rad_s = w.plain_speed_rad_s;
        w.accel_rad_s2 = w.plain_accel_rad_s2;
    }
    return Forward(plain).predict(physics);
}

} // namespace

void add_smoothing_bias(const Model &model, Dataset &data) {
    if (data.independent_rows || data.count < 3 || data.balance.empty()) return;
    const Physics physics = make_physics(model);
    const Eigen::VectorXd change = Forward(data).predict(physics) - plain_prediction(data, physics);
    std::size_t left_out = 0;
    Eigen::Index row = 0;
    for (Balance &b : data.balance) {
        Balance kept = b;
        for (auto *series : {&kept.t0_s, &kept.t1_s, &kept.measured, &kept.noise_factor, &kept.smoothing_bias}) series->clear();
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            const double factor = b.noise_factor.empty() ? 1 : b.noise_factor[r], lost = cubics_share * change[row],
                         ratio = std::fabs(lost) / (b.noise * factor);
            if (b.kind == BalanceKind::current_torque && !(ratio < largest_ratio)) {
                ++left_out;
                continue;
            }
            kept.t0_s.push_back(b.t0_s[r]);
            kept.t1_s.push_back(b.t1_s[r]);
            kept.measured.push_back(b.measured[r]);
            kept.smoothing_bias.push_back(std::isfinite(lost) ? lost : 0);
            kept.noise_factor.push_back(factor * (std::isfinite(ratio) ? std::hypot(1.0, ratio) : largest_ratio));
        }
        b = std::move(kept);
    }
    if (left_out > 0)
        data.messages.push_back(
            std::to_string(left_out) +
            " samples of the motor currents were ignored: the wheel's speed changed faster than its encoder can measure");
}

} // namespace traction::lab
