#include "counts.h"

#include <algorithm>
#include <cmath>

namespace traction::hal {

namespace {
int whole(double value) { return static_cast<int>(std::floor(value + 0.5)); }
} // namespace

CountScale count_scale(const sim::RoverDescription &rover) {
    CountScale scale;
    scale.current_A = rover.at("current", "A_per_count");
    scale.battery_V = rover.at("battery", "V_per_count");
    scale.accel_m_s2 = rover.at("accel", "m_s2_per_count");
    scale.gyro_rad_s = rover.at("gyro", "rad_s_per_count");
    scale.battery_offset = whole(rover.at("battery", "offset_count"));
    scale.accel_offset = whole(rover.at("accel", "offset_count"));
    scale.gyro_offset = whole(rover.at("gyro", "offset_count"));
    scale.radar_rate_Hz = rover.at("radar", "rate_Hz");
    scale.current_max = whole(rover.at("current", "max_count"));
    scale.battery_max = whole(rover.at("battery", "max_count"));
    const unsigned absent = ~sim::firmware_wheels(rover.layout()) & 0xfu;
    scale.present &= ~(absent * FRAME_ENCODER_0 | absent * FRAME_CURRENT_0 | absent * FRAME_BRIDGE_0);
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
        scale.current_offset[i] = whole(rover.current_offset_count(i));
        scale.encoder_sign[i] = rover.wheel[i].encoder_sign < 0 ? -1 : 1;
    }
    return scale;
}

int round_count(double value, int low, int high) {
    if (!(value > low)) return low; // NaN too
    if (value > high) return high;
    return static_cast<int>(std::floor(value + 0.5));
}

void to_counts(const CountScale &scale, const sim::Measurements &measured, sensor_frame_t *frame) {
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
        frame->encoder_count[i] = static_cast<std::int32_t>(static_cast<std::uint32_t>(measured.encoder_count[i]) *
                                                            static_cast<std::uint32_t>(scale.encoder_sign[i])); // wraps
        const double current = measured.current_A[i] / scale.current_A + scale.current_offset[i];
        frame->current_count[i] = static_cast<std::uint16_t>(round_count(current, 0, scale.current_max));
    }
    frame->battery_count =
        static_cast<std::uint16_t>(round_count(measured.battery_V / scale.battery_V + scale.battery_offset, 0, scale.battery_max));
    const auto signed_count = [](double value, double unit, int offset) {
        return static_cast<std::int16_t>(round_count(value / unit + offset, INT16_MIN, INT16_MAX));
    };
    frame->accel_x_count = signed_count(measured.accel_m_s2[0], scale.accel_m_s2, scale.accel_offset);
    frame->accel_y_count = signed_count(measured.accel_m_s2[1], scale.accel_m_s2, 0);
    frame->accel_z_count = signed_count(measured.accel_m_s2[2], scale.accel_m_s2, 0);
    frame->gyro_x_count = signed_count(measured.gyro_rad_s[0], scale.gyro_rad_s, 0);
    frame->gyro_y_count = signed_count(measured.gyro_rad_s[1], scale.gyro_rad_s, 0);
    frame->gyro_z_count = signed_count(measured.gyro_rad_s[2], scale.gyro_rad_s, scale.gyro_offset);
    const std::size_t taken = measured.radar_count.size();
    const std::size_t samples = std::min<std::size_t>(taken, RADAR_SAMPLES_PER_TICK_MAX);
    std::copy_n(measured.radar_count.end() - static_cast<std::ptrdiff_t>(samples), samples, frame->radar_count);
    std::fill(frame->radar_count + samples, frame->radar_count + RADAR_SAMPLES_PER_TICK_MAX, std::uint16_t{0});
    frame->radar_samples = static_cast<std::uint8_t>(samples);
    frame->radar_sequence = measured.radar_first + static_cast<std::uint32_t>(taken - samples);
    frame->present = scale.present;
}

} // namespace traction::hal
