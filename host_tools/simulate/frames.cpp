#include "frames.h"

#include "host_tools/log/log.h"

#include <bit>
#include <cerrno>
#include <cinttypes>
#include <cstring>

namespace traction {

namespace {
[[noreturn]] void fail(const std::string &path) {
    throw log::FileError(path, 0, 0, std::string("cannot be written: ") + std::strerror(errno),
                         "check that the folder exists and has room");
}
} // namespace

FrameWriter::FrameWriter(const std::string &path, const std::string &config)
    : path_(path), file_(std::fopen((path + ".part").c_str(), "wb")) {
    if (file_ == nullptr) fail(path);
    std::fprintf(file_, "# frames of traction simulate, firmware configuration %s; tests/replay/replay.c reads them\n", config.c_str());
}

FrameWriter::~FrameWriter() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove((path_ + ".part").c_str());
}

void FrameWriter::keep() {
    const bool good = std::ferror(file_) == 0;
    if (std::fclose(file_) != 0 || !good || std::rename((path_ + ".part").c_str(), path_.c_str()) != 0) {
        file_ = nullptr;
        fail(path_);
    }
    file_ = nullptr;
}

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
    std::fputs(line_.c_str(), file_);
}

} // namespace traction
