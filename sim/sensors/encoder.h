// encoder.h - incremental encoder on the motor shaft, cumulative count. The reference: 120 pulses per motor turn, gear 50:1.
//
// Error: rounding to whole pulses (1.05 mrad of the wheel with the reference) and, when `missed` is set, that share of the pulses lost.
#pragma once

#include "sim/physics/effects/laws.h"

#include <cmath>
#include <cstdint>

namespace traction::sim {

inline constexpr double encoder_counts_per_turn = 120.0 * 50.0;
inline constexpr double encoder_rad_per_count = 6.283185307179586 / encoder_counts_per_turn;

class Encoder {
  public:
    explicit Encoder(double missed = 0, double counts_per_turn = encoder_counts_per_turn)
        : keep_(law::encoder_missed(missed)), rad_per_count_(6.283185307179586 / counts_per_turn) {}

    // motor_angle_rad: motor side, divided by the gear ratio.
    std::int32_t count(double motor_angle_rad) const {
        const double pulses = std::floor(motor_angle_rad * keep_ / rad_per_count_);
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(pulses)));
    }

  private:
    double keep_, rad_per_count_;
};

} // namespace traction::sim
