#include "lag.h"

#include "host_tools/lab/inputs/smooth.h"
#include "sim/physics/effects/laws.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace traction::lab {

namespace {

constexpr double at_changes = 2;        // (1): of four logs whose slip does not lag at most 1.7, of eight whose does at least 2.1
constexpr double a_change = 0.1;        // of the largest speed
constexpr double enough_rows = 50;      // of either kind
constexpr double within_the_blur = 0.3; // (2)

double rim_speed_m_s(const Dataset &data, const Physics &physics) {
    std::vector<double> moving;
    for (std::size_t i = 0; i < data.wheel.size(); ++i)
        for (const double w : data.wheel[i].speed_rad_s)
            if (std::fabs(w) > data.standstill_rad_s) moving.push_back(std::fabs(w) * physics.wheel[i].radius);
    return median(std::move(moving));
}

} // namespace

double longest_lag_m(const Physics &physics) {
    double longest = 0;
    for (const WheelPhysics &w : physics.wheel)
        longest = std::max(longest, sim::law::relaxation_length_m(w.relaxation, physics.body.relaxation_m));
    return longest;
}

std::vector<char> changing_steps(const Dataset &data, std::size_t back) {
    std::vector<char> changing(data.count, 0);
    double largest = 0;
    for (const WheelInput &w : data.wheel)
        for (const double speed : w.speed_rad_s) largest = std::max(largest, std::fabs(speed));
    back = std::max<std::size_t>(1, back);
    for (const WheelInput &w : data.wheel)
        for (std::size_t k = back; k < w.speed_rad_s.size(); ++k)
            if (std::fabs(w.speed_rad_s[k] - w.speed_rad_s[k - back]) > a_change * largest) changing[k] = 1;
    return changing;
}

bool only_averages(const Problem &before, const HeldOut &left_before, const Problem &with, const HeldOut &left_with) {
    const Dataset &data = before.data();
    const double length = longest_lag_m(with.physics()), speed = rim_speed_m_s(data, with.physics());
    if (data.independent_rows || data.count < 3 || !(speed > 0) || !(length > longest_lag_m(before.physics()))) return false;
    double blurred_s = 0;
    for (const WheelInput &w : data.wheel) blurred_s = std::max(blurred_s, w.half_s);
    const bool by_a_name = with.physics().body.relaxation_m > before.physics().body.relaxation_m; // not the sheet's own, in a fit beside
    if (by_a_name && length / speed < within_the_blur * blurred_s) return true;
    const std::vector<char> changing = changing_steps(data, static_cast<std::size_t>(length / speed / data.step_s));
    const Eigen::VectorXd fall =
        (left_before.residual.cwiseAbs2() - left_with.residual.cwiseAbs2()).cwiseProduct(before.row_scale.cwiseAbs2());
    double there = 0, elsewhere = 0, rows_there = 0, rows_elsewhere = 0;
    Eigen::Index row = 0;
    for (const Balance &b : data.balance)
        for (std::size_t r = 0; r < b.measured.size(); ++r, ++row) {
            if (b.kind != BalanceKind::current_torque) continue;
            const double at = std::clamp((b.t0_s[r] - data.start_s) / data.step_s, 0.0, static_cast<double>(data.count - 1));
            if (changing[static_cast<std::size_t>(at)] != 0)
                there += fall[row], ++rows_there;
            else
                elsewhere += fall[row], ++rows_elsewhere;
        }
    if (rows_there < enough_rows || rows_elsewhere < enough_rows) return false;
    return !(there / rows_there > at_changes * elsewhere / rows_elsewhere);
}

} // namespace traction::lab
