#include "frames.h"

#include "host_tools/log/log.h"

#include <bit>
#include <cerrno>
#include <cinttypes>
#include <cstring>

namespace traction {

namespace {
[[noreturn]] void fail(const std::string &path) {
    throw log::FileError(path, 0, 0, std::string("cannot be written: ") + std::strerror(errno), "check that the folder exists and has room");
}
} // namespace

FrameWriter::FrameWriter(const std::string &path, const std::string &config) : path_(path), file_(std::fopen((path + ".part").c_str(), "wb")) {
    if (file_ == nullptr) fail(path);
    std::fprintf(file_, "# traction-frames 1 %s\n", config.c_str());
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

void FrameWriter::real(float value) {
    char text[16];
    std::snprintf(text, sizeof text, " %08" PRIx32, std::bit_cast<std::uint32_t>(value));
    line_ += text;
}

void FrameWriter::add(const sensor_frame_t &frame, const command_t &command, const trace_t &trace) {
    line_.clear();
    integer(frame.tick);
    integer(frame.present);
    for (const auto value : frame.encoder_count) integer(value);
    for (const auto value : frame.current_count) integer(value);
    integer(frame.battery_count);
    integer(frame.accel_x_count);
    integer(frame.gyro_z_count);
    integer(frame.emergency_stop ? 1 : 0);
    integer(frame.radar_samples);
    for (const auto value : frame.radar_count) integer(value);

    integer(command.mode);
    real(command.platform_speed_m_s);
    real(command.yaw_rate_rad_s);
    for (const float value : command.wheel_speed_rad_s) real(value);
    for (const float value : command.duty) real(value);
    real(command.slip_ref);
    integer(command.slip_wheels);
    integer(command.age_ticks);

    integer(trace.mode);
    integer(trace.faults);
    for (const wheel_trace_t &wheel : trace.wheel) {
        for (const float value : {wheel.speed_rad_s, wheel.accel_rad_s2, wheel.set_speed_rad_s, wheel.current_A, wheel.torque_Nm,
                                  wheel.traction_N, wheel.slip, wheel.duty})
            real(value);
        integer(wheel.slip_valid ? 1 : 0);
        integer(wheel.saturated ? 1 : 0);
    }
    for (const float value : {trace.battery_voltage_V, trace.accel_x_m_s2, trace.gyro_z_rad_s, trace.radar_speed_m_s}) real(value);
    integer(trace.radar_fresh ? 1 : 0);
    for (const float value : {trace.speed_m_s, trace.speed_std_m_s, trace.accel_bias_m_s2}) real(value);
    integer(trace.standstill ? 1 : 0);
    for (const auto value : trace.actuator.duty_q15) integer(value);
    integer(trace.actuator.motor_enable ? 1 : 0);
    line_ += '\n';
    std::fputs(line_.c_str(), file_);
}

} // namespace traction
