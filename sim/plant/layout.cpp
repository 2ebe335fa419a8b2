#include "layout.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace traction::sim {

std::span<const int> wheels_of(Layout layout) {
    static constexpr int six[] = {0, 1, 2, 3, 4, 5}, caster[] = {0, 1, 4};
    switch (layout) {
    case Layout::six:
        return six;
    case Layout::caster:
        return caster;
    case Layout::carriage:
        return std::span(six).first(1);
    case Layout::four:
        break;
    }
    return std::span(six).first(4);
}

bool has_wheel(Layout layout, int slot) {
    const auto all = wheels_of(layout);
    return std::find(all.begin(), all.end(), slot) != all.end();
}

bool is_caster(Layout layout, int slot) { return layout == Layout::caster && slot == 4; }

int motor_of(const LayoutParameters &layout, int slot) {
    return layout.drives[0] < 0 ? slot : layout.drives[static_cast<std::size_t>(slot % 2)];
}

std::string steered_axles(const LayoutParameters &layout) {
    return layout.steer_front ? layout.steer_rear ? "front rear" : "front" : layout.steer_rear ? "rear" : "";
}

bool is_plain(const LayoutParameters &layout) {
    return layout.kind == Layout::four && layout.drives[0] < 0 && !layout.rocker && steered_axles(layout).empty();
}

unsigned firmware_wheels(const LayoutParameters &layout) {
    unsigned mask = 0;
    for (const int slot : wheels_of(layout.kind))
        if (slot < 4 && motor_of(layout, slot) == slot) mask |= 1u << static_cast<unsigned>(slot);
    return mask;
}

WheelPlace wheel_place(const LayoutParameters &layout, double half_wheelbase_m, double half_track_m, int slot) {
    const double side_m = slot % 2 == 0 ? half_track_m : -half_track_m;
    switch (layout.kind) {
    case Layout::carriage:
        return {0, 0};
    case Layout::caster:
        return slot == 4 ? WheelPlace{layout.caster_m, 0} : WheelPlace{layout.axle_m, side_m};
    case Layout::four:
    case Layout::six:
        break;
    }
    return {slot >= 4 ? layout.middle_m : slot >= 2 ? half_wheelbase_m : -half_wheelbase_m, side_m};
}

Stance stand_on(std::span<const double> ahead_m, const std::function<double(std::size_t, double)> &load_N, double weight_N,
                double start_m) {
    double span_m = 0;
    for (const double x : ahead_m) span_m = std::max(span_m, std::fabs(x));
    Stance at{.depth_m = start_m};
    // what is left of (1), the moment by the longest arm
    const auto residual = [&](const Stance &s) {
        std::array<double, 2> sum{-weight_N, 0};
        for (std::size_t k = 0; k < ahead_m.size(); ++k) {
            const double N = load_N(k, s.depth_m + s.pitch_rad * ahead_m[k]);
            sum[0] += N;
            if (span_m > 0) sum[1] += N * ahead_m[k] / span_m;
        }
        return sum;
    };
    const auto size = [](const std::array<double, 2> &sum) { return std::fabs(sum[0]) + std::fabs(sum[1]); };
    constexpr double probe_m = 1e-7; // of the differences below: the laws are smooth over far more
    auto left = residual(at);
    for (int turn = 0; turn < 60 && size(left) > 1e-10 * weight_N; ++turn) {
        const auto deeper = residual({at.depth_m + probe_m, at.pitch_rad});
        const double a = (deeper[0] - left[0]) / probe_m, c = (deeper[1] - left[1]) / probe_m;
        double step_m = a > 0 ? -left[0] / a : start_m, lean_rad = 0;
        if (span_m > 0) {
            const auto leant = residual({at.depth_m, at.pitch_rad + probe_m / span_m});
            const double b = (leant[0] - left[0]) / probe_m * span_m, d = (leant[1] - left[1]) / probe_m * span_m, det = a * d - b * c;
            if (det > 0) step_m = (-left[0] * d + left[1] * b) / det, lean_rad = (-left[1] * a + left[0] * c) / det;
        }
        double share = 1; // less where a whole step overshoots
        Stance next = at;
        auto after = left;
        for (int halving = 0; halving < 30; ++halving) {
            next = {at.depth_m + share * step_m, at.pitch_rad + share * lean_rad};
            after = residual(next);
            if (size(after) < size(left)) break;
            share *= 0.5;
        }
        if (size(after) >= size(left)) break;
        at = next, left = after;
    }
    return at;
}

} // namespace traction::sim
