#include "frames.h"

#include <bit>
#include <cinttypes>
#include <cstdio>

namespace traction {

FrameWriter::FrameWriter(const std::string &path, const std::string &config) : file_(path) {
    file_.write("# frames of traction simulate, firmware configuration " + config + "; tests/replay/replay.c reads them\n");
}

void FrameWriter::keep() { file_.keep(); }

void FrameWriter::integer(long value) { line_.append(line_.empty() ? "" : " ").append(std::to_string(value)); }

void FrameWriter::hexadecimal(std::uint32_t value, int digits) {
    char text[16];
    std::snprintf(text, sizeof text, " %0*" PRIx32, digits, value);
    line_ += text;
}

void FrameWriter::real(float value) { hexadecimal(std::bit_cast<std::uint32_t>(value), 8); }

void FrameWriter::add(const sensor_frame_t &frame, const command_t &command) {
    line_.clear();
    integer(frame.tick);
    hexadecimal(frame.present, 1);
    for (const auto value : frame.encoder_count) integer(value);
    for (const auto value : frame.current_count) integer(value);
    integer(frame.battery_count);
    integer(frame.accel_x_count);
    integer(frame.gyro_z_count);
    integer(frame.emergency_stop ? 1 : 0);
    integer(frame.radar_samples);
    for (int i = 0; i < frame.radar_samples; i++) integer(frame.radar_count[i]);
    integer(command.mode);
    real(command.platform_speed_m_s);
    real(command.yaw_rate_rad_s);
    for (const float value : command.wheel_speed_rad_s) real(value);
    for (const float value : command.duty) real(value);
    real(command.slip_ref);
    integer(command.slip_wheels);
    integer(command.age_ticks);
    line_ += '\n';
    file_.write(line_);
}

} // namespace traction
