// counts.h - physical quantities to the raw counts of the rover's converters, rounded and held at their rails.
//
// The scales are those of the rover that it is (sim/scenario/rover.h); the firmware has those of the rover that it believes to be.
#pragma once

#include "firmware/core/signals.h"
#include "sim/scenario/rover.h"
#include "sim/sensors/sensors.h"

#include <array>
#include <cstdint>

namespace traction::hal {

struct CountScale {
    double current_A = 0.002;                                            // [A/count] 12 bit over +-4.1 A, assumed
    double battery_V = 0.004;                                            // [V/count] 12 bit over 16.4 V, assumed
    double accel_m_s2 = 0.004;                                           // [m/s^2/count] assumed, about 0.4 mg
    double gyro_rad_s = 0.0005;                                          // [rad/s/count] assumed
    std::array<int, WHEEL_COUNT> current_offset{2048, 2048, 2048, 2048}; // offset binary
    double radar_rate_Hz = 512;
    int battery_offset = 0, accel_offset = 0, gyro_offset = 0;
    int current_max = 4095, battery_max = 4095;            // 12 bit
    std::array<int, WHEEL_COUNT> encoder_sign{1, 1, 1, 1}; // -1: the count falls as the wheel drives forward
    std::uint32_t present = FRAME_ALL;                     // less what belongs to wheels that the rover does not have
};

// The converters of a rover.
CountScale count_scale(const sim::RoverDescription &rover);

// Fills every field of the frame but its times and the emergency stop; all that the rover has present. Radar samples beyond the frame's 64
// are lost, the oldest first (512 Hz makes 5 or 6 a tick).
void to_counts(const CountScale &scale, const sim::Measurements &measured, sensor_frame_t *frame);

// Nearest count, held in low..high.
int round_count(double value, int low, int high);

} // namespace traction::hal
