#include "recorder.h"

#include "sim/plant/steering.h"

#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

namespace traction {

namespace {

// Rounded to whole millionths, of which a log keeps 32 bits.
struct Tidy {
    explicit Tidy(float value) : millionths(static_cast<double>(value) * 1e6) {}
    bool large() const { return !(std::fabs(millionths) < 2e9); } // or no number
    std::int32_t whole() const {
        constexpr double round_by = 6755399441055744.0; // 1.5 * 2^52: nearbyint without a call
        return static_cast<std::int32_t>((millionths + round_by) - round_by);
    }
    double value() const { return std::nearbyint(millionths) / 1e6 + 0.0; }
    double millionths;
};

} // namespace

void Recorder::begin(const std::map<std::string, std::string> &header) {
    spool_.begin(header);
    if (radar_spool_) radar_spool_->begin(header);
}

void Recorder::put_by() {
    spool_.put_by();
    if (radar_spool_) radar_spool_->put_by();
}

void Recorder::write_radar(const std::map<std::string, std::string> &header) {
    if (radar_spool_) radar_spool_->write(header);
}

void Recorder::large(std::size_t slot, double value) { others_.push_back({slot, value}); }

inline void Recorder::tidy(std::size_t slot, float value) {
    if (const Tidy tidied(value); tidied.large()) [[unlikely]]
        large(slot, tidied.value());
    else
        tick_[slot] = tidied.whole();
}

inline void Recorder::exact(std::size_t slot, float value) { // the firmware takes what is no number as 0 too
    tick_[slot] = std::isfinite(value) ? std::bit_cast<std::int32_t>(value) : 0;
}

std::size_t Recorder::column(const std::string &name, log::Unit unit, bool absent_is_zero) {
    return spool_.add(name, absent_is_zero, name.rfind("camera", 0) == 0 ? 0 : expected_, unit);
}

Recorder::Recorder(std::uint64_t expected_ticks, double radar_rate_Hz, const std::string &path, unsigned wheels,
                   const std::string &radar_path)
    : expected_(expected_ticks), spool_(path), radar_rate_Hz_(radar_rate_Hz), wheels_(wheels) {
    using log::Unit;
    if (!radar_path.empty()) radar_spool_.emplace(radar_path);
    std::vector<std::size_t> bound;
    const auto slot = [&](const std::string &name, Unit unit, bool absent_is_zero = false) {
        bound.push_back(column(name, unit, absent_is_zero));
        return bound.size() - 1;
    };
    for (int i = 0; i < WHEEL_COUNT; i++) {
        if (!has_wheel(i)) continue;
        const std::string name = "wheel" + std::to_string(i) + '.';
        wheel_[i] = {.speed = slot(name + "speed_rad_s", Unit::millionth),
                     .encoder = slot(name + "encoder_count", Unit::count),
                     .current = slot(name + "current_A", Unit::millionth),
                     .current_count = slot(name + "current_count", Unit::count),
                     .duty = slot(name + "duty", Unit::millionth),
                     .set_speed = slot(name + "set_speed_rad_s", Unit::millionth),
                     .slip = slot(name + "slip", Unit::millionth),
                     .torque = slot(name + "motor_torque_Nm", Unit::millionth),
                     .traction = slot(name + "traction_N", Unit::millionth),
                     .slip_std = slot(name + "slip_std", Unit::millionth),
                     .slip_valid = slot(name + "slip_valid", Unit::count),
                     .saturated = slot(name + "saturated", Unit::count),
                     .refused = slot(name + "encoder_refused", Unit::count, true),
                     .bridge = slot(name + "bridge_status", Unit::count, true),
                     .command_speed = slot(name + "command_speed_rad_s", Unit::exact, true),
                     .command_duty = slot(name + "command_duty", Unit::exact, true)};
    }
    at_ = {.battery = slot("battery.voltage_V", Unit::millionth),
           .battery_count = slot("battery.voltage_count", Unit::count),
           .radar_count = (radar_spool_ ? *radar_spool_ : spool_).add("radar.adc_count", false, 0, Unit::count),
           .radar_speed = column("radar.speed_m_s", Unit::millionth),
           .accel = slot("imu.accel_x_m_s2", Unit::millionth),
           .accel_count = slot("imu.accel_x_count", Unit::count),
           .gyro = slot("imu.gyro_z_rad_s", Unit::millionth),
           .gyro_count = slot("imu.gyro_z_count", Unit::count),
           .camera_x = column("camera.x_m", Unit::millionth),
           .camera_y = column("camera.y_m", Unit::millionth),
           .camera_yaw = column("camera.yaw_rad", Unit::millionth),
           .speed = slot("estimate.speed_m_s", Unit::millionth),
           .speed_std = slot("estimate.speed_std_m_s", Unit::millionth),
           .bias = slot("estimate.accel_bias_m_s2", Unit::millionth),
           .standstill = slot("estimate.standstill", Unit::count),
           .mode = slot("control.mode", Unit::count),
           .faults = slot("control.faults", Unit::natural),
           .command_mode = slot("command.mode", Unit::count),
           .command_speed = slot("command.speed_m_s", Unit::exact, true),
           .command_yaw_rate = slot("command.yaw_rate_rad_s", Unit::exact, true),
           .command_slip = slot("command.slip", Unit::exact, true),
           .command_slip_wheels = slot("command.slip_wheels", Unit::count, true),
           .command_age = slot("command.age_ticks", Unit::natural, true),
           .present = slot("frame.present", Unit::natural),
           .samples = slot("frame.radar_samples", Unit::count),
           .emergency_stop = slot("frame.emergency_stop", Unit::count, true),
           .motor_enable = slot("actuator.motor_enable", Unit::count),
           .drive = slot("actuator.drive", Unit::count),
           .time = slot("frame.time_us", Unit::natural),
           .elapsed = column("frame.elapsed_ticks", Unit::natural),
           .sequence = slot("frame.radar_sequence", Unit::natural),
           .accel_y = slot("imu.accel_y_count", Unit::count),
           .accel_z = slot("imu.accel_z_count", Unit::count),
           .gyro_x = slot("imu.gyro_x_count", Unit::count),
           .gyro_y = slot("imu.gyro_y_count", Unit::count),
           .fault_wheels = slot("control.fault_wheels", Unit::natural, true),
           .curvature = slot("actuator.curvature_1_m", Unit::millionth, true)};
    tick_.resize(bound.size());
    bound_ = spool_.bind(bound);
}

void Recorder::add_wheel(int wheel, const sensor_frame_t &frame, const command_t &command, const wheel_trace_t &trace) {
    const Wheel &at = wheel_[wheel];
    if ((frame.present & (unsigned{FRAME_ENCODER_0} << static_cast<unsigned>(wheel))) != 0u)
        tidy(at.speed, trace.speed_rad_s), tick_[at.encoder] = frame.encoder_count[wheel];
    else
        leave_out(at.speed), leave_out(at.encoder);
    if ((frame.present & (unsigned{FRAME_CURRENT_0} << static_cast<unsigned>(wheel))) != 0u)
        tidy(at.current, trace.current_A), tick_[at.current_count] = frame.current_count[wheel];
    else
        leave_out(at.current), leave_out(at.current_count);
    tidy(at.duty, trace.duty);
    tidy(at.set_speed, trace.set_speed_rad_s);
    tidy(at.slip, trace.slip);
    tidy(at.torque, trace.torque_Nm);
    tidy(at.traction, trace.traction_N);
    tidy(at.slip_std, trace.slip_std);
    tick_[at.slip_valid] = trace.slip_valid ? 1 : 0;
    tick_[at.saturated] = trace.saturated ? 1 : 0;
    tick_[at.refused] = trace.encoder_refused ? 1 : 0;
    tick_[at.bridge] = frame.bridge_status[wheel];
    exact(at.command_speed, command.wheel_speed_rad_s[wheel]);
    exact(at.command_duty, command.duty[wheel]);
}

void Recorder::add_frame(const sensor_frame_t &frame) {
    const auto put = [&](unsigned present, std::size_t slot, std::int32_t count) {
        if ((frame.present & present) != 0u)
            tick_[slot] = count;
        else
            leave_out(slot);
    };
    put(FRAME_BATTERY, at_.battery_count, frame.battery_count);
    put(FRAME_ACCEL, at_.accel_count, frame.accel_x_count);
    put(FRAME_GYRO, at_.gyro_count, frame.gyro_z_count);
    put(FRAME_TIME, at_.time, natural(frame.time_us));
    put(FRAME_ACCEL_YZ, at_.accel_y, frame.accel_y_count);
    put(FRAME_ACCEL_YZ, at_.accel_z, frame.accel_z_count);
    put(FRAME_GYRO_XY, at_.gyro_x, frame.gyro_x_count);
    put(FRAME_GYRO_XY, at_.gyro_y, frame.gyro_y_count);
    put(FRAME_RADAR, at_.sequence, natural(frame.radar_sequence));
    tick_[at_.present] = natural(frame.present);
    tick_[at_.samples] = frame.radar_samples;
    tick_[at_.emergency_stop] = frame.emergency_stop ? 1 : 0;
}

// Samples keep the converter's own clock, n/rate; what was recorded already is not recorded again.
void Recorder::add_radar(const sensor_frame_t &frame) {
    if ((frame.present & FRAME_RADAR) == 0u) return;
    std::array<std::int32_t, RADAR_SAMPLES_PER_TICK_MAX> fresh;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < frame.radar_samples; i++)
        if (static_cast<std::int32_t>(frame.radar_sequence + i - radar_next_) >= 0) fresh[count++] = frame.radar_count[i];
    const std::uint32_t first = frame.radar_sequence + frame.radar_samples - static_cast<std::uint32_t>(count);
    (radar_spool_ ? *radar_spool_ : spool_).put_by_clock(at_.radar_count, first, radar_rate_Hz_, {fresh.data(), count});
    if (count > 0) radar_next_ = frame.radar_sequence + frame.radar_samples;
}

void Recorder::add_command(const command_t &command) {
    tick_[at_.command_mode] = command.mode;
    exact(at_.command_speed, command.platform_speed_m_s);
    exact(at_.command_yaw_rate, command.yaw_rate_rad_s);
    exact(at_.command_slip, command.slip_ref);
    tick_[at_.command_slip_wheels] = command.slip_wheels;
    tick_[at_.command_age] = natural(command.age_ticks);
}

void Recorder::add_estimates(const trace_t &trace) {
    const auto put = [&](unsigned present, std::size_t slot, float value) {
        if ((trace.present & present) != 0u)
            tidy(slot, value);
        else
            leave_out(slot);
    };
    put(FRAME_BATTERY, at_.battery, trace.battery_voltage_V);
    put(FRAME_ACCEL, at_.accel, trace.accel_x_m_s2);
    put(FRAME_GYRO, at_.gyro, trace.gyro_z_rad_s);
    tidy(at_.speed, trace.speed_m_s);
    tidy(at_.speed_std, trace.speed_std_m_s);
    tidy(at_.bias, trace.accel_bias_m_s2);
    tick_[at_.standstill] = trace.standstill ? 1 : 0;
    tick_[at_.mode] = trace.mode;
    tick_[at_.faults] = natural(trace.faults);
    tick_[at_.fault_wheels] = natural(trace.fault_wheels);
    tidy(at_.curvature, trace.actuator.curvature_1_m);
    tick_[at_.drive] = trace.actuator.drive;
    tick_[at_.motor_enable] = trace.actuator.drive == DRIVE_ON || trace.actuator.drive == DRIVE_BRAKE ? 1 : 0;
}

void Recorder::add(const sensor_frame_t &frame, const command_t &command, const trace_t &trace) {
    const double t_s = (frame.tick + 1.0) / 100; // a tick ends its 10 ms
    absent_ = {};
    others_.clear();
    for (int wheel = 0; wheel < WHEEL_COUNT; wheel++)
        if (has_wheel(wheel)) add_wheel(wheel, frame, command, trace.wheel[wheel]);
    add_frame(frame);
    add_command(command);
    add_estimates(trace);
    spool_.put_together(bound_, t_s, tick_.data(), absent_, others_);
    add_radar(frame);
    if (frame.elapsed_ticks != 1) spool_.put_whole(at_.elapsed, t_s, natural(frame.elapsed_ticks));
    if (!trace.radar_fresh) return;
    if (const Tidy speed(trace.radar_speed_m_s); speed.large())
        put(at_.radar_speed, t_s, speed.value());
    else
        spool_.put_whole(at_.radar_speed, t_s, speed.whole());
}

void Recorder::add_camera(std::span<const sim::Pose> poses) {
    for (const sim::Pose &pose : poses) {
        put(at_.camera_x, pose.t_s, std::nearbyint(pose.x_m * 1e4) / 1e4 + 0.0);
        put(at_.camera_y, pose.t_s, std::nearbyint(pose.y_m * 1e4) / 1e4 + 0.0);
        put(at_.camera_yaw, pose.t_s, std::nearbyint(pose.yaw_rad * 1e5) / 1e5 + 0.0);
    }
}

TruthRecorder::TruthRecorder(const std::string &path, bool on_terrain, const sim::LayoutParameters &layout)
    : spool_(path), on_terrain_(on_terrain), layout_(layout) {
    for (const char *name : {"truth.x_m", "truth.y_m", "truth.yaw_rad", "truth.pitch_rad", "truth.speed_m_s", "truth.path_m",
                             "truth.accel_x_m_s2", "truth.battery_voltage_V"})
        spool_.add(name);
    for (const int i : sim::wheels_of(layout_.kind))
        for (const char *name : {"speed_rad_s", "current_A", "duty", "slip", "traction_N", "rolling_N", "lateral_N", "normal_N",
                                 "sinkage_m", "ground_speed_m_s", "temperature_degC"})
            spool_.add("truth.wheel" + std::to_string(i) + '.' + name);
    if (on_terrain_)
        for (const char *name : {"truth.z_m", "truth.roll_rad", "truth.joint_rad"}) spool_.add(name);
    for (const int i : sim::wheels_of(layout_.kind))
        if (sim::steers(layout_, i)) spool_.add("truth.wheel" + std::to_string(i) + ".steer_rad");
    if (layout_.rocker)
        for (const char *name : {"truth.rocker0_rad", "truth.rocker1_rad", "truth.bogie0_rad", "truth.bogie1_rad"}) spool_.add(name);
}

void TruthRecorder::add(const sim::Truth &truth) {
    std::size_t next = 0;
    const double t_s = std::nearbyint(truth.t_s * 1000) / 1000;
    const auto put = [&](double value) {
        const std::size_t column = next++;
        if (std::isfinite(value)) spool_.put(column, t_s, std::nearbyint(value * 1e9) / 1e9 + 0.0);
    };
    put(truth.position_m[0]);
    put(truth.position_m[1]);
    put(truth.yaw_rad);
    put(truth.pitch_rad);
    put(truth.v_body_m_s[0]);
    put(truth.path_m);
    put(truth.specific_force_m_s2[0]);
    put(truth.battery_voltage_V);
    for (const int i : sim::wheels_of(layout_.kind)) {
        const sim::WheelTruth &wheel = truth.slot(i);
        for (const double value : {wheel.speed_rad_s, wheel.current_A, wheel.duty, wheel.slip, wheel.traction_N, wheel.rolling_N,
                                   wheel.lateral_N, wheel.normal_N, wheel.sinkage_m, wheel.ground_speed_m_s, wheel.winding_temperature_C})
            put(value);
    }
    if (on_terrain_)
        for (const double value : {truth.position_m[2], truth.roll_rad, truth.joint_rad}) put(value);
    for (const int i : sim::wheels_of(layout_.kind))
        if (sim::steers(layout_, i)) put(truth.slot(i).steer_rad);
    if (layout_.rocker)
        for (const double value : {truth.rocker_rad[0], truth.rocker_rad[1], truth.bogie_rad[0], truth.bogie_rad[1]}) put(value);
    spool_.instant_is_over();
}

} // namespace traction
