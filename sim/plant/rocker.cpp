#include "rocker.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace traction::sim {

namespace {
double place_m(const LayoutParameters &layout, double half_wheelbase_m, int slot) {
    return wheel_place(layout, half_wheelbase_m, 0, slot).ahead_m;
}
} // namespace

RockerSide rocker_side(const LayoutParameters &layout, int side) {
    if (layout.kind == Layout::four) return {2 + side, {side}};
    if (layout.bogie_front) return {side, {4 + side, 2 + side}};
    return {2 + side, {side, 4 + side}};
}

LinkPlace rocker_place(const LayoutParameters &layout, double half_wheelbase_m, double wheel_radius_m) {
    const RockerSide side = rocker_side(layout, 0);
    const bool four = layout.kind == Layout::four;
    const double a = place_m(layout, half_wheelbase_m, side.rocker_wheel),
                 b = four ? place_m(layout, half_wheelbase_m, side.others.front()) : layout.bogie_m;
    const double low = wheel_radius_m, high = four ? wheel_radius_m : layout.bogie_height_m;
    return {0.5 * (a + b), four ? 0.5 * (wheel_radius_m + layout.rocker_height_m) : 0.5 * (low + high), std::fabs(a - b)};
}

LinkPlace bogie_place(const LayoutParameters &layout, double half_wheelbase_m, double wheel_radius_m) {
    const RockerSide side = rocker_side(layout, 0);
    const double a = place_m(layout, half_wheelbase_m, side.others.front()), b = place_m(layout, half_wheelbase_m, side.others.back());
    return {0.5 * (a + b), 0.5 * (wheel_radius_m + layout.bogie_height_m), std::fabs(a - b)};
}

std::array<double, wheel_most> rocker_loads(const LayoutParameters &layout, double mass_kg, double half_wheelbase_m,
                                            double wheel_radius_m) {
    std::array<double, wheel_most> out{};
    const bool six = layout.kind == Layout::six;
    const double rocker = layout.rocker_kg / mass_kg, bogie = six ? layout.bogie_kg / mass_kg : 0;
    const double body = 0.5 - rocker - bogie; // on one side, at x = 0: the differential hands the body's moment to both rockers alike
    const double at_rocker = rocker_place(layout, half_wheelbase_m, wheel_radius_m).ahead_m;
    for (int side = 0; side < 2; ++side) {
        const RockerSide chain = rocker_side(layout, side);
        const double a = place_m(layout, half_wheelbase_m, chain.rocker_wheel);
        const double b = six ? layout.bogie_m : place_m(layout, half_wheelbase_m, chain.others.front());
        const double first = (body * (0 - b) + rocker * (at_rocker - b)) / (a - b); // moments about the other end
        const double rest = body + rocker - first;
        out[static_cast<std::size_t>(chain.rocker_wheel)] = first;
        if (!six) {
            out[static_cast<std::size_t>(chain.others.front())] = rest;
            continue;
        }
        const double c = place_m(layout, half_wheelbase_m, chain.others.front()),
                     d = place_m(layout, half_wheelbase_m, chain.others.back());
        const double at_bogie = bogie_place(layout, half_wheelbase_m, wheel_radius_m).ahead_m;
        const double last = (rest * (b - c) + bogie * (at_bogie - c)) / (d - c);
        out[static_cast<std::size_t>(chain.others.back())] = last;
        out[static_cast<std::size_t>(chain.others.front())] = rest + bogie - last;
    }
    return out;
}

} // namespace traction::sim
