#include "recorder.h"

#include "sim/plant/steering.h"

#include <charconv>
#include <cmath>
#include <string>
#include <utility>

namespace traction {

// Rounded to whole millionths.
void Recorder::put_tidy(std::size_t column, double t_s, float value) {
    const double millionths = static_cast<double>(value) * 1e6;
    if (std::fabs(millionths) < 2e9) {
        constexpr double round_by = 6755399441055744.0; // 1.5 * 2^52: nearbyint without a call
        spool_.put_millionths(column, t_s, static_cast<std::int32_t>((millionths + round_by) - round_by));
    } else {
        put_large(column, t_s, millionths);
    }
}

void Recorder::put_large(std::size_t column, double t_s, double millionths) { put(column, t_s, std::nearbyint(millionths) / 1e6 + 0.0); }

std::size_t Recorder::column(const std::string &name, bool absent_is_zero) {
    return spool_.add(name, absent_is_zero, name.rfind("camera", 0) == 0 ? 0 : expected_);
}

Recorder::Recorder(std::uint64_t expected_ticks, double radar_rate_Hz, const std::string &path, unsigned wheels)
    : expected_(expected_ticks), spool_(path), radar_rate_Hz_(radar_rate_Hz), wheels_(wheels) {
    for (int i = 0; i < WHEEL_COUNT; i++) {
        if (!has_wheel(i)) continue;
        const std::string name = "wheel" + std::to_string(i) + '.';
        wheel_[i] = {.speed = column(name + "speed_rad_s"),
                     .encoder = column(name + "encoder_count"),
                     .current = column(name + "current_A"),
                     .current_count = column(name + "current_count"),
                     .duty = column(name + "duty"),
                     .set_speed = column(name + "set_speed_rad_s"),
                     .slip = column(name + "slip"),
                     .torque = column(name + "motor_torque_Nm"),
                     .traction = column(name + "traction_N"),
                     .slip_std = column(name + "slip_std"),
                     .slip_valid = column(name + "slip_valid"),
                     .saturated = column(name + "saturated"),
                     .refused = column(name + "encoder_refused", true),
                     .bridge = column(name + "bridge_status", true),
                     .command_speed = column(name + "command_speed_rad_s", true),
                     .command_duty = column(name + "command_duty", true)};
    }
    at_ = {.battery = column("battery.voltage_V"),
           .battery_count = column("battery.voltage_count"),
           .radar_count = column("radar.adc_count"),
           .radar_speed = column("radar.speed_m_s"),
           .accel = column("imu.accel_x_m_s2"),
           .accel_count = column("imu.accel_x_count"),
           .gyro = column("imu.gyro_z_rad_s"),
           .gyro_count = column("imu.gyro_z_count"),
           .camera_x = column("camera.x_m"),
           .camera_y = column("camera.y_m"),
           .camera_yaw = column("camera.yaw_rad"),
           .speed = column("estimate.speed_m_s"),
           .speed_std = column("estimate.speed_std_m_s"),
           .bias = column("estimate.accel_bias_m_s2"),
           .standstill = column("estimate.standstill"),
           .mode = column("control.mode"),
           .faults = column("control.faults"),
           .command_mode = column("command.mode"),
           .command_speed = column("command.speed_m_s", true),
           .command_yaw_rate = column("command.yaw_rate_rad_s", true),
           .command_slip = column("command.slip", true),
           .command_slip_wheels = column("command.slip_wheels", true),
           .command_age = column("command.age_ticks", true),
           .present = column("frame.present"),
           .samples = column("frame.radar_samples"),
           .emergency_stop = column("frame.emergency_stop", true),
           .motor_enable = column("actuator.motor_enable"),
           .drive = column("actuator.drive"),
           .time = column("frame.time_us"),
           .elapsed = column("frame.elapsed_ticks"),
           .sequence = column("frame.radar_sequence"),
           .accel_y = column("imu.accel_y_count"),
           .accel_z = column("imu.accel_z_count"),
           .gyro_x = column("imu.gyro_x_count"),
           .gyro_y = column("imu.gyro_y_count"),
           .fault_wheels = column("control.fault_wheels", true),
           .curvature = column("actuator.curvature_1_m", true)};
}

// A double whose shortest text reads back to this very float.
double Recorder::exact(float value) {
    if (value == last_float_) return last_exact_;
    if (!std::isfinite(value)) return 0; // the firmware takes it as 0 too
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    double result = 0;
    std::from_chars(text, end, result);
    last_float_ = value;
    last_exact_ = result;
    return result;
}

void Recorder::add_wheel(int wheel, double t_s, const sensor_frame_t &frame, const command_t &command, const wheel_trace_t &trace) {
    const Wheel &at = wheel_[wheel];
    if ((frame.present & (unsigned{FRAME_ENCODER_0} << static_cast<unsigned>(wheel))) != 0u) {
        put_tidy(at.speed, t_s, trace.speed_rad_s);
        put(at.encoder, t_s, frame.encoder_count[wheel]);
    }
    if ((frame.present & (unsigned{FRAME_CURRENT_0} << static_cast<unsigned>(wheel))) != 0u) {
        put_tidy(at.current, t_s, trace.current_A);
        put(at.current_count, t_s, frame.current_count[wheel]);
    }
    put_tidy(at.duty, t_s, trace.duty);
    put_tidy(at.set_speed, t_s, trace.set_speed_rad_s);
    put_tidy(at.slip, t_s, trace.slip);
    put_tidy(at.torque, t_s, trace.torque_Nm);
    put_tidy(at.traction, t_s, trace.traction_N);
    put_tidy(at.slip_std, t_s, trace.slip_std);
    put(at.slip_valid, t_s, trace.slip_valid ? 1 : 0);
    put(at.saturated, t_s, trace.saturated ? 1 : 0);
    put(at.refused, t_s, trace.encoder_refused ? 1 : 0);
    put(at.bridge, t_s, frame.bridge_status[wheel]);
    put(at.command_speed, t_s, exact(command.wheel_speed_rad_s[wheel]));
    put(at.command_duty, t_s, exact(command.duty[wheel]));
}

void Recorder::add_frame(double t_s, const sensor_frame_t &frame) {
    if ((frame.present & FRAME_BATTERY) != 0u) put(at_.battery_count, t_s, frame.battery_count);
    if ((frame.present & FRAME_ACCEL) != 0u) put(at_.accel_count, t_s, frame.accel_x_count);
    if ((frame.present & FRAME_GYRO) != 0u) put(at_.gyro_count, t_s, frame.gyro_z_count);
    put(at_.present, t_s, frame.present);
    put(at_.samples, t_s, frame.radar_samples);
    put(at_.emergency_stop, t_s, frame.emergency_stop ? 1 : 0);
    if ((frame.present & FRAME_TIME) != 0u) put(at_.time, t_s, frame.time_us);
    if (frame.elapsed_ticks != 1) put(at_.elapsed, t_s, frame.elapsed_ticks);
    if ((frame.present & FRAME_ACCEL_YZ) != 0u) {
        put(at_.accel_y, t_s, frame.accel_y_count);
        put(at_.accel_z, t_s, frame.accel_z_count);
    }
    if ((frame.present & FRAME_GYRO_XY) != 0u) {
        put(at_.gyro_x, t_s, frame.gyro_x_count);
        put(at_.gyro_y, t_s, frame.gyro_y_count);
    }
    // samples keep the converter's own clock, n/rate; what was recorded already is not recorded again
    if ((frame.present & FRAME_RADAR) == 0u) return;
    put(at_.sequence, t_s, frame.radar_sequence);
    for (std::uint32_t i = 0; i < frame.radar_samples; i++) {
        const std::uint32_t n = frame.radar_sequence + i;
        if (static_cast<std::int32_t>(n - radar_next_) < 0) continue;
        put(at_.radar_count, static_cast<double>(n) / radar_rate_Hz_, frame.radar_count[i]);
        radar_next_ = n + 1;
    }
}

void Recorder::add_command(double t_s, const command_t &command) {
    put(at_.command_mode, t_s, command.mode);
    put(at_.command_speed, t_s, exact(command.platform_speed_m_s));
    put(at_.command_yaw_rate, t_s, exact(command.yaw_rate_rad_s));
    put(at_.command_slip, t_s, exact(command.slip_ref));
    put(at_.command_slip_wheels, t_s, command.slip_wheels);
    put(at_.command_age, t_s, command.age_ticks);
}

void Recorder::add_estimates(double t_s, const trace_t &trace) {
    if ((trace.present & FRAME_BATTERY) != 0u) put_tidy(at_.battery, t_s, trace.battery_voltage_V);
    if ((trace.present & FRAME_ACCEL) != 0u) put_tidy(at_.accel, t_s, trace.accel_x_m_s2);
    if ((trace.present & FRAME_GYRO) != 0u) put_tidy(at_.gyro, t_s, trace.gyro_z_rad_s);
    if (trace.radar_fresh) put_tidy(at_.radar_speed, t_s, trace.radar_speed_m_s);
    put_tidy(at_.speed, t_s, trace.speed_m_s);
    put_tidy(at_.speed_std, t_s, trace.speed_std_m_s);
    put_tidy(at_.bias, t_s, trace.accel_bias_m_s2);
    put(at_.standstill, t_s, trace.standstill ? 1 : 0);
    put(at_.mode, t_s, trace.mode);
    put(at_.faults, t_s, trace.faults);
    put(at_.fault_wheels, t_s, trace.fault_wheels);
    put_tidy(at_.curvature, t_s, trace.actuator.curvature_1_m);
    put(at_.drive, t_s, trace.actuator.drive);
    put(at_.motor_enable, t_s, trace.actuator.drive == DRIVE_ON || trace.actuator.drive == DRIVE_BRAKE ? 1 : 0);
}

void Recorder::add(const sensor_frame_t &frame, const command_t &command, const trace_t &trace) {
    const double t_s = (frame.tick + 1.0) / 100; // a tick ends its 10 ms
    for (int wheel = 0; wheel < WHEEL_COUNT; wheel++)
        if (has_wheel(wheel)) add_wheel(wheel, t_s, frame, command, trace.wheel[wheel]);
    add_frame(t_s, frame);
    add_command(t_s, command);
    add_estimates(t_s, trace);
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
