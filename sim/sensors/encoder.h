// encoder.h - incremental encoder on the motor shaft: 120 pulses per motor turn, gear 50:1 (docs/sources.md section 3), cumulative count.
//
// Error: rounding to whole pulses (1.05 mrad of the wheel) and, when `missed` is set, that share of the pulses lost.
#pragma once

#include "sim/physics/effects/laws.h"

#include <cmath>
#include <cstdint>

namespace traction::sim {

inline constexpr double encoder_counts_per_turn = 120.0 * 50.0;
inline constexpr double encoder_rad_per_count = 6.283185307179586 / encoder_counts_per_turn;

class Encoder {
  public:
    explicit Encoder(double missed = 0) : keep_(law::encoder_missed(missed)) {}

    // motor_angle_rad: motor side, divided by the gear ratio.
    std::int32_t count(double motor_angle_rad) const {
        const double pulses = std::floor(motor_angle_rad * keep_ / encoder_rad_per_count);
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(pulses)));
    }

  private:
    double keep_;
};

} // namespace traction::sim
