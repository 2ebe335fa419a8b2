// steering.h - wheels that steer: Ackermann's geometry, the linkage between it and parallel wheels, and the servo that moves them.
//
// Every wheel moves along its heading when all their axles' lines meet in one point, which lies on the line of the axle that does not
// steer (its place ahead: the pivot). Of a path of curvature k (of the rover's middle, to the left positive):
//   tan delta_i = d_i k/(1 - y_i k), d_i = x_i - pivot, y_i to the left                                       (1)  Ackermann 1818
//   delta_i = A delta_i(1) + (1 - A) atan(d_i k)     A = 1: (1); A = 0: the wheels of an axle stay parallel    (2)  the linkage
//   dphi/dt = clamp((phi_order - phi)/dt, +-rate)    phi = atan(d k) of the axle with the largest |d|          (3)  one servo for all
// The kingpins pass through the contact points: the ground turns no servo, and turning on the spot costs it nothing (assumed).
// Derived here from (1).
#pragma once

#include "layout.h"

#include <array>

namespace traction::sim {

// Where the line lies on which the rover turns, ahead of the centre of mass; and which wheels steer.
double steering_pivot_m(const LayoutParameters &layout, double half_wheelbase_m);
bool steers(const LayoutParameters &layout, int slot);

// (2) for a path's curvature.
double steering_angle_rad(const LayoutParameters &layout, double half_wheelbase_m, double half_track_m, int slot, double curvature_1_m);

// The curvature at which the first wheel reaches the largest angle.
double steering_limit_1_m(const LayoutParameters &layout, double half_wheelbase_m, double half_track_m);

class Steering {
  public:
    struct Wheel {
        double angle_rad = 0, cosine = 1, sine = 0;
    };
    Steering(const LayoutParameters &layout, double half_wheelbase_m, double half_track_m);
    bool there() const { return there_; }
    void order(double curvature_1_m); // NaN counts as 0; held within the limit
    void step(double dt_s);           // (3), then (2)
    const Wheel &wheel(int slot) const { return wheel_[static_cast<std::size_t>(slot)]; }
    double servo_rad() const { return servo_rad_; }

  private:
    LayoutParameters layout_;
    double half_wheelbase_m_, half_track_m_;
    bool there_;
    double arm_m_ = 0, limit_1_m_ = 0; // arm: the largest |d|
    double order_rad_ = 0, servo_rad_ = 0;
    std::array<Wheel, wheel_most> wheel_{};
};

} // namespace traction::sim
