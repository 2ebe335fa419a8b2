#include "stretch.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

namespace {

template <typename T> void keep(std::vector<T> &series, std::size_t whole, std::size_t first, std::size_t count) {
    if (series.size() != whole) return; // not known
    series =
        std::vector<T>(series.begin() + static_cast<std::ptrdiff_t>(first), series.begin() + static_cast<std::ptrdiff_t>(first + count));
}

void keep_rows(Balance &b, double from_s, double to_s) {
    Balance out = b;
    for (auto *series : {&out.t0_s, &out.t1_s, &out.measured, &out.noise_factor, &out.smoothing_bias}) series->clear();
    for (std::size_t r = 0; r < b.measured.size(); ++r) {
        if (b.t0_s[r] < from_s || b.t1_s[r] > to_s) continue;
        out.t0_s.push_back(b.t0_s[r]), out.t1_s.push_back(b.t1_s[r]), out.measured.push_back(b.measured[r]);
        if (!b.noise_factor.empty()) out.noise_factor.push_back(b.noise_factor[r]);
        if (!b.smoothing_bias.empty()) out.smoothing_bias.push_back(b.smoothing_bias[r]);
    }
    b = std::move(out);
}

} // namespace

Dataset stretch(const Dataset &data, double from_s, double to_s) {
    if (data.independent_rows || data.count < 3) return data;
    const double last = static_cast<double>(data.count - 1);
    const auto first = static_cast<std::size_t>(std::clamp(std::ceil((from_s - data.start_s) / data.step_s - 1e-6), 0.0, last));
    const auto end = static_cast<std::size_t>(std::clamp(std::floor((to_s - data.start_s) / data.step_s + 1e-6), 0.0, last));
    const std::size_t count = end >= first ? end - first + 1 : 0;
    Dataset out = data;
    for (WheelInput &w : out.wheel)
        for (auto *series : {&w.angle_rad, &w.speed_rad_s, &w.accel_rad_s2, &w.travel_rad, &w.plain_speed_rad_s, &w.plain_accel_rad_s2,
                             &w.width_s, &w.voltage_V})
            keep(*series, data.count, first, count);
    for (auto *series : {&out.yaw_rate_rad_s, &out.yaw_rad, &out.body_speed_m_s}) keep(*series, data.count, first, count);
    for (std::vector<double> &load : out.load_N) keep(load, data.count, first, count);
    keep(out.gap, data.count, first, count);
    out.start_s = data.time(first), out.count = count;
    out.duration_s = static_cast<double>(count) * data.step_s;
    for (Balance &b : out.balance) keep_rows(b, out.start_s, data.time(end));
    keep_rows(out.camera_left, out.start_s, data.time(end));
    std::erase_if(out.balance, [](const Balance &b) { return b.measured.empty(); });
    std::erase_if(out.run_start_s, [&](double t) { return t > data.time(end); });
    return out;
}

} // namespace traction::lab
