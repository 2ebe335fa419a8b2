// recorder.h - one run as a log: what the sensors said, what was asked, what the firmware made of it (docs/log_format.md).
//
// Every raw count of every frame and every command is kept, so control_step can be replayed bit for bit from the log. Counts and
// commands are exact; everything that follows from them is rounded to 1e-6 SI.
#pragma once

#include "firmware/core/rover_config.h"
#include "host_tools/log/spool.h"
#include "sim/plant/truth.h"
#include "sim/sensors/camera.h"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace traction {

class Recorder {
  public:
    // path: of the log, for write; empty: it stays in memory, for take.
    // wheels: bit i: the rover has wheel i; of the others nothing is written.
    // radar_path: of a log of its own for the radar's samples, so that the other rows have no empty cells for them; empty: they are in it.
    Recorder(std::uint64_t expected_ticks, double radar_rate_Hz, const std::string &path = "", unsigned wheels = 0xf,
             const std::string &radar_path = "");

    void add(const sensor_frame_t &frame, const command_t &command, const trace_t &trace);
    void add_radar(const sensor_frame_t &frame); // of add, where nothing else of the tick is wanted
    void add_camera(std::span<const sim::Pose> poses);
    // Columns that never held anything but 0 are left out where 0 is what absence means.
    void begin(const std::map<std::string, std::string> &header); // log::Spool's
    void tick_is_over() {                                         // log::Spool's
        spool_.instant_is_over();
        if (radar_spool_) radar_spool_->instant_is_over();
    }
    void put_by();
    log::Log take() { return spool_.take(); }
    void write(const std::map<std::string, std::string> &header) { spool_.write(header); }
    void write_radar(const std::map<std::string, std::string> &header);    // where it has a path
    const std::string &part() const { return spool_.part(); }              // log::Spool's
    const std::string &radar_part() const { return radar_spool_->part(); } // where it has a path

  private:
    std::size_t column(const std::string &name, log::Unit unit, bool absent_is_zero = false);
    void put(std::size_t column, double t_s, double value) { spool_.put(column, t_s, value); }
    static std::int32_t natural(std::uint32_t count) { return static_cast<std::int32_t>(count); }
    void tidy(std::size_t slot, float value);
    [[gnu::noinline]] void large(std::size_t slot, double value); // 2e9 millionths, and more
    void exact(std::size_t slot, float value);
    void leave_out(std::size_t slot) { absent_[slot / 64] |= std::uint64_t{1} << (slot % 64); }
    void add_wheel(int wheel, const sensor_frame_t &frame, const command_t &command, const wheel_trace_t &trace);
    void add_frame(const sensor_frame_t &frame);
    void add_command(const command_t &command);
    void add_estimates(const trace_t &trace);
    bool has_wheel(int wheel) const { return (wheels_ >> static_cast<unsigned>(wheel) & 1u) != 0u; }

    std::uint64_t expected_;
    log::Spool spool_;
    std::optional<log::Spool> radar_spool_;
    double radar_rate_Hz_;
    unsigned wheels_;
    std::uint32_t radar_next_ = 1; // the sample at t = 0 belongs to no tick

    // what a tick holds, in slots: together one row (log::Spool::put_together)
    std::vector<std::int32_t> tick_;
    log::Absent absent_{};
    std::vector<log::Other> others_;
    std::size_t bound_ = 0;
    struct Wheel { // slots
        std::size_t speed, encoder, current, current_count, duty, set_speed, slip, torque, traction, slip_std, slip_valid, saturated,
            refused, bridge, command_speed, command_duty;
    } wheel_[WHEEL_COUNT]{};
    struct { // slots; of radar, camera and elapsed columns
        std::size_t battery, battery_count, radar_count, radar_speed, accel, accel_count, gyro, gyro_count, camera_x, camera_y, camera_yaw,
            speed, speed_std, bias, standstill, mode, faults, command_mode, command_speed, command_yaw_rate, command_slip,
            command_slip_wheels, command_age, present, samples, emergency_stop, motor_enable, drive, time, elapsed, sequence, accel_y,
            accel_z, gyro_x, gyro_y, fault_wheels, curvature;
    } at_{};
};

// The truth of one run, in columns of its own, one row per tick. Only ever written to a separate file.
class TruthRecorder {
  public:
    // path as Recorder's; on terrain height, roll and joint too; the wheels of `layout` (sim/plant/layout.h), and how those that
    // steer stand
    explicit TruthRecorder(const std::string &path = "", bool on_terrain = false, const sim::LayoutParameters &layout = {});
    void add(const sim::Truth &truth);
    void begin(const std::map<std::string, std::string> &header) { spool_.begin(header); } // log::Spool's
    void put_by() { spool_.put_by(); }
    const std::string &part() const { return spool_.part(); } // log::Spool's
    log::Log take() { return spool_.take(); }
    void write(const std::map<std::string, std::string> &header) { spool_.write(header); }

  private:
    log::Spool spool_;
    bool on_terrain_;
    sim::LayoutParameters layout_;
};

} // namespace traction
