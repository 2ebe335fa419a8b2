// soft_sign.h - the sign of a speed without a jump.
#pragma once

#include <algorithm>

namespace traction::sim {

inline constexpr double reversal_m_s =
    0.005; // what rolling does to torque and load turns over this speed: assumed, below any sensor's resolution

// -1..1, the sign of a speed made continuous over `width`.
inline double soft_sign(double speed, double width) { return std::clamp(speed / width, -1.0, 1.0); }

} // namespace traction::sim
