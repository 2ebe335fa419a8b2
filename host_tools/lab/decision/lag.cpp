#include "lag.h"

#include "host_tools/lab/inputs/smooth.h"
#include "sim/physics/effects/laws.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace traction::lab {

namespace {

constexpr double of_its_time = 0.5;                // (lag.h); over all of it starts and stops blur away too
constexpr double sure = 3, of_the_fall = 1.0 / 6;  // on four rovers whose slip does not lag at most 0.12 was left, of eleven that do 0.25
constexpr double longest_half_s = 2;

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

Dataset with_smoothed_wheels(const Dataset &data, double half_s) {
    Dataset out = data;
    std::vector<double> t;
    for (std::size_t k = 0; k < data.count; ++k) t.push_back(data.time(k));
    for (WheelInput &w : out.wheel) {
        if (w.speed_rad_s.size() != data.count) continue;
        const Smooth even = smooth_at(t, w.speed_rad_s, data.start_s, data.step_s, data.count, half_s, 2);
        for (std::size_t k = 0; k < data.count; ++k)
            if (std::fabs(w.speed_rad_s[k]) > data.standstill_rad_s) w.speed_rad_s[k] = even.value[k];
    }
    return out;
}

bool only_averages(const Problem &before, const Problem &with, double fall) {
    const Dataset &data = before.data();
    const double length = longest_lag_m(with.physics());
    if (data.independent_rows || !(length > longest_lag_m(before.physics()))) return false;
    const double speed = rim_speed_m_s(data, with.physics()), half = std::min(longest_half_s, of_its_time * length / speed);
    double has = 0;
    for (const WheelInput &w : data.wheel) has = std::max(has, w.half_s);
    if (!(speed > 0) || !(half > has)) return false;
    const Dataset even = with_smoothed_wheels(data, half);
    const auto refitted = [&](const Problem &problem) {
        Problem out(even, problem.physics_at(Eigen::VectorXd::Zero(problem.theta.size())), problem.parameters);
        out.theta = problem.theta;
        out.keep_scales(before);
        out.gauss_newton(6);
        return held_out(out);
    };
    const Fall left = fall_between(refitted(before), refitted(with), before.row_scale.cwiseAbs2());
    return !(left.sum > sure * left.error && left.sum > of_the_fall * fall);
}

} // namespace traction::lab
