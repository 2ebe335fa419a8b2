#include "steering.h"

#include "sim/physics/math.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace traction::sim {

double steering_pivot_m(const LayoutParameters &layout, double half_wheelbase_m) {
    if (layout.steer_front != layout.steer_rear) return layout.steer_front ? -half_wheelbase_m : half_wheelbase_m;
    return layout.kind == Layout::six ? layout.middle_m : 0;
}

bool steers(const LayoutParameters &layout, int slot) {
    if (slot >= 4 || (layout.kind != Layout::four && layout.kind != Layout::six)) return false;
    return slot >= 2 ? layout.steer_front : layout.steer_rear;
}

double steering_angle_rad(const LayoutParameters &layout, double half_wheelbase_m, double half_track_m, int slot, double curvature_1_m) {
    if (!steers(layout, slot)) return 0;
    const WheelPlace at = wheel_place(layout, half_wheelbase_m, half_track_m, slot);
    const double rise = (at.ahead_m - steering_pivot_m(layout, half_wheelbase_m)) * curvature_1_m;
    const double parallel = math::atan2(rise, 1), own = math::atan2(rise, 1 - at.left_m * curvature_1_m);
    return layout.ackermann * own + (1 - layout.ackermann) * parallel;
}

double steering_limit_1_m(const LayoutParameters &layout, double half_wheelbase_m, double half_track_m) {
    if (!layout.steer_front && !layout.steer_rear) return 0;
    double low = 0, high = 0.999 / half_track_m; // beyond, the centre lies between the wheels
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        double most_rad = 0;
        for (int slot = 0; slot < 4; ++slot)
            most_rad = std::max(most_rad, std::fabs(steering_angle_rad(layout, half_wheelbase_m, half_track_m, slot, middle)));
        (most_rad < layout.steer_max_rad ? low : high) = middle;
    }
    return low;
}

Steering::Steering(const LayoutParameters &layout, double half_wheelbase_m, double half_track_m)
    : layout_(layout), half_wheelbase_m_(half_wheelbase_m), half_track_m_(half_track_m), there_(layout.steer_front || layout.steer_rear),
      limit_1_m_(steering_limit_1_m(layout, half_wheelbase_m, half_track_m)) {
    const double pivot_m = steering_pivot_m(layout, half_wheelbase_m);
    for (int slot = 0; slot < 4; ++slot)
        if (steers(layout, slot))
            arm_m_ = std::max(arm_m_, std::fabs(wheel_place(layout, half_wheelbase_m, half_track_m, slot).ahead_m - pivot_m));
}

void Steering::order(double curvature_1_m) {
    if (!there_) return;
    const double held = std::isnan(curvature_1_m) ? 0 : std::clamp(curvature_1_m, -limit_1_m_, limit_1_m_);
    order_rad_ = math::atan2(arm_m_ * held, 1);
}

void Steering::step(double dt_s) {
    if (!there_ || servo_rad_ == order_rad_) return;
    const double most = layout_.steer_rate_rad_s * dt_s;
    const double left = order_rad_ - servo_rad_;
    servo_rad_ = std::fabs(left) <= most ? order_rad_ : servo_rad_ + std::copysign(most, left);
    const double curvature_1_m = math::tan(servo_rad_) / arm_m_;
    for (int slot = 0; slot < 4; ++slot) {
        if (!steers(layout_, slot)) continue;
        const double angle = steering_angle_rad(layout_, half_wheelbase_m_, half_track_m_, slot, curvature_1_m);
        wheel_[static_cast<std::size_t>(slot)] = {angle, math::cos(angle), math::sin(angle)};
    }
}

} // namespace traction::sim
