// oracle.h - a second formulation of the rover: planar, hand-written, no ODE library, Runge-Kutta of fourth order, libm.
//
// States: x, y, yaw, vx, vy (body frame), r, and per wheel w, s, sy. Loads follow from the moment balance of each half (pitch,
// the joint passes none) and of the whole (roll), by fixed-point iteration; vertical motion is left out. Wheels keep turning
// forward, so dry friction has one sign. Written from the equations of docs/sources.md and docs/physics.md, not from the plant's code.
#pragma once

#include <array>

namespace traction::oracle {

struct Ground {
    bool hard = false; // (21), else (20)
    double adhesion_N = 0, mu = 0, lateral = 0, sc = 1, rolling = 0;
    double rise_x = 0, rise_y = 0; // g*sin(slope) along world x and y [m/s^2]
};

struct Setup {
    Ground ground;
    std::array<double, 4> duty{};
    double speed_m_s = 0, centre_height_m = 0;
};

struct Pose {
    double x = 0, y = 0, yaw = 0, path = 0;
};

// Where the rover is after `seconds`.
Pose drive(const Setup &setup, double seconds);

} // namespace traction::oracle
