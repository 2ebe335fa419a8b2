// layout.h - which wheels a rover has, where they are, and how it stands on them.
//
// The firmware knows four wheels; the plant has six slots. Slots 0 to 3 are the firmware's: 0 rear left, 1 rear right, 2 front left, 3
// front right. Slots 4 and 5 are the left and the right wheel of a middle axle, or 4 is a caster. Even slots are on the left half.
//   four      0 1 2 3        at +-half_wheelbase, +-half_track
//   six       0 1 2 3 4 5    a middle axle at middle_m; its motors get the mean duty of their side (hal/sim)
//   caster    0 1 4          one driven axle at axle_m, a ball caster in the middle at caster_m
//   carriage  0              a bench: the wheel under the centre of mass, free along a rail and in height, all else held
// A rigid rover's halves do not turn against each other; `caster` and `carriage` always are.
// Standing: with d_i = d + p x_i the depth of wheel i below the plane's surface (p nose down, x_i ahead of the centre of mass),
//   sum N(d_i) = W, sum x_i N(d_i) = 0                                                                   (1)  statics
// N is the contact's spring or the soil's law without slip. Three wheels are determinate; more share as a beam on those springs.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>

namespace traction::sim {

inline constexpr int wheel_most = 6;

enum class Layout { four, six, caster, carriage };

struct LayoutParameters {
    Layout kind = Layout::four;
    bool rigid = false;
    double middle_m = 0; // the middle axle, ahead of the centre of mass: six
    double axle_m = 0;   // the driven axle: caster
    double caster_m = 0, caster_radius_m = 0.02;
    double caster_rolling = 0; // of its bearing, over its load, beside the ground's: 0..1
    double drawbar_N = 0;      // carriage: a constant pull against the heading
    // four, six: the slots of the left and of the right motor, each of which turns all wheels of its side by a chain, one to one. -1: every
    // wheel has a motor of its own.
    std::array<int, 2> drives{-1, -1};
    bool rocker = false;      // four, six: wheels on rockers (rocker.h), of bogies with six; places ahead and over the ground
    bool bogie_front = false; // the bogie is at the front; else at the rear
    double rocker_m = 0, rocker_height_m = 0, bogie_m = 0, bogie_height_m = 0;
    double rocker_kg = 0, bogie_kg = 0;               // of one link with its wheels, out of the rover's mass
    bool steer_front = false, steer_rear = false;     // four, six: which axles steer (steering.h)
    double steer_max_rad = 0.6, steer_rate_rad_s = 1; // of a wheel; of the servo
    double ackermann = 1;                             // 0..1
    bool operator==(const LayoutParameters &) const = default;
};

// The slots that there are, in the order in which the plant steps them.
std::span<const int> wheels_of(Layout layout);
bool has_wheel(Layout layout, int slot);
bool is_caster(Layout layout, int slot);
// The slot whose motor turns this one.
int motor_of(const LayoutParameters &layout, int slot);
// Four wheels, a motor each, fixed in their heading, on two halves or one chassis.
bool is_plain(const LayoutParameters &layout);
// "front", "rear" or "front rear"; empty where no wheel steers.
std::string steered_axles(const LayoutParameters &layout);
// Bit i: the firmware has wheel i (0..3): one with a motor.
unsigned firmware_wheels(const LayoutParameters &layout);

// Where the four wheels of a rover with these half distances are, or those of another layout [m].
struct WheelPlace {
    double ahead_m = 0, left_m = 0;
};
WheelPlace wheel_place(const LayoutParameters &layout, double half_wheelbase_m, double half_track_m, int slot);

struct Stance {
    double depth_m = 0;   // d of (1)
    double pitch_rad = 0; // p, nose down
};
// (1) by Newton's method; load_N(k, depth) of wheel k must grow with its depth and be 0 above the ground. start_m: a first guess of d.
// Where all wheels are at x = 0, p = 0.
Stance stand_on(std::span<const double> ahead_m, const std::function<double(std::size_t, double)> &load_N, double weight_N, double start_m);

} // namespace traction::sim
