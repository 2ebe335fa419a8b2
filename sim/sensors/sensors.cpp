#include "sensors.h"

#include "sim/physics/math.h"

#include <algorithm>
#include <cmath>

namespace traction::sim {

namespace {
constexpr double gravity_m_s2 = 9.81;      // the plant's (RoverParameters), or what tilts would weigh other than what stands
constexpr double accel_smoothing_s = 0.01; // [s] assumed: what the beam and the springs of the body follow
} // namespace

SensorConfig default_sensors() {
    SensorConfig config;
    for (AnalogConfig &current : config.current) current.noise = current_noise_A;
    config.battery.noise = battery_noise_V;
    config.accel.noise = accel_noise_m_s2;
    config.gyro.noise = gyro_noise_rad_s;
    return config;
}

void apply_sensor_effects(std::span<const ActiveEffect> effects, SensorConfig &config) {
    const RoverEffects all = config.effects = act_together(effects);
    const BodyEffects &b = all.body;
    config.accel.gain *= law::accel_scale(1, b.accel_scale);
    config.accel.offset = law::accel_bias(config.accel.offset, b.accel_bias_m_s2);
    config.accel.drift_s = law::accel_drift(config.accel.drift_s, b.accel_drift_m_s3, 1); // per second
    config.accel.delay_s = law::accel_delay_s(config.accel.delay_s, b.accel_delay_s);
    config.accel.lag_s = law::accel_lag_s(config.accel.lag_s, b.accel_lag_s);
    config.gyro.gain *= law::gyro_scale(1, b.gyro_scale);
    config.gyro.delay_s = law::gyro_delay_s(config.gyro.delay_s, b.gyro_delay_s);
    config.radar_delay_s = law::radar_delay_s(config.radar_delay_s, b.radar_delay_s);
    config.battery.gain *= law::voltage_gain(1, b.voltage_gain);
    config.camera.delay_s = law::camera_delay_s(config.camera.delay_s, b.camera_delay_s);
    config.camera.scale *= law::camera_scale(1, b.camera_scale);
    for (std::size_t i = 0; i < wheel_count; i++) {
        config.current[i].gain *= law::current_gain(1, all.wheel[i].current_gain);
        config.current[i].delay_s = law::current_delay_s(config.current[i].delay_s, b.current_delay_s);
        config.current[i].offset = law::current_offset(config.current[i].offset, all.wheel[i].current_offset_A);
    }
}

namespace {

constexpr double tan_20_deg = 0.36397023426620234;

double tangent_of(double angle_deg) {
    const double angle = angle_deg * math::pi / 180;
    return angle_deg == 20 ? tan_20_deg : math::sin(angle) / math::cos(angle);
}

} // namespace

Sensors::Sensors(const SensorConfig &config, std::uint64_t seed, const Truth &start)
    : config_(config), radar_(config.radar, mix64(seed + 1)), camera_(config.camera, mix64(seed + 2)),
      battery_(config.battery, seed, "battery"), accel_(config.accel, seed, "imu.accel"), gyro_(config.gyro, seed, "imu.gyro"),
      accel_y_({.noise = config.accel.noise}, seed, "imu.accel_y"), accel_z_({.noise = config.accel.noise}, seed, "imu.accel_z"),
      gyro_x_({.noise = config.gyro.noise}, seed, "imu.gyro_x"), gyro_y_({.noise = config.gyro.noise}, seed, "imu.gyro_y"),
      last_(last_of(start)), tan_depression_(tangent_of(config.radar.depression_deg)) {
    constexpr std::array<std::string_view, wheel_count> name{"wheel0.current", "wheel1.current", "wheel2.current", "wheel3.current"};
    for (std::size_t i = 0; i < wheel_count; i++) current_.emplace_back(config.current[i], seed, name[i]);
    if (const auto pose = camera_.step({start.t_s, start.position_m[0], start.position_m[1], start.yaw_rad}))
        pending_.camera.push_back(*pose);
}

// Two harmonic motions, grown with the speed up to 0.1 m/s: a standing rover does not shake.
Sensors::Vibration Sensors::vibration(const Truth &truth) const {
    Vibration shake;
    const double share = std::min(1.0, std::fabs(truth.v_body_m_s[0]) / 0.1);
    if (config_.heave_m > 0) {
        const double rate = 2 * math::pi * config_.heave_Hz, phase = rate * truth.t_s;
        shake.heave_m = share * config_.heave_m * math::sin(phase);
        shake.lift_m_s2 = -rate * rate * shake.heave_m;
    }
    if (config_.pitch_vibration_rad > 0) {
        const double rate = 2 * math::pi * config_.pitch_vibration_Hz, phase = rate * truth.t_s;
        shake.pitch_rad = share * config_.pitch_vibration_rad * math::sin(phase);
        shake.pitch_rate_rad_s = share * config_.pitch_vibration_rad * rate * math::cos(phase);
    }
    return shake;
}

// The path that the beam sees: the body's, stretched by scale errors and by the pitch that tips the beam.
void Sensors::step_radar(const Truth &truth, double accel_m_s2, const Vibration &shake) {
    // nose down by p: cos(theta_d + p)/cos(theta_d) = cos p - tan(theta_d) sin p; up a rise the ground itself pitches the nose up
    const BodyEffects &b = config_.effects.body;
    double stretch = law::radar_scale(1, b.radar_scale) * law::radar_pitch(b.radar_pitch_s2_m, accel_m_s2);
    double lifted_m = 0;
    if (config_
            .on_terrain) { // along the line of sight (cos theta_d, 0, -sin theta_d) over cos theta_d; a level drive gives the same as below
        lifted_m = config_.radar_mount_pitch * 0.5 * (truth.v_body_m_s[2] + last_.up_m_s) * (truth.t_s - last_.t_s);
    } else if (config_.radar_mount_pitch != 0) {
        double ground_rad = 0;
        if (config_.ground_slope_rad != 0) ground_rad = -config_.ground_slope_rad * math::cos(truth.yaw_rad - config_.ground_direction_rad);
        const double pitch = config_.radar_mount_pitch * (truth.pitch_rad - ground_rad);
        stretch *= 1 - tan_depression_ * pitch - 0.5 * pitch * pitch;
    }
    stretch *= 1 - tan_depression_ * shake.pitch_rad;
    // a hop lengthens the beam by sin(theta_d) of it, which looks like a path of tan(theta_d) of it, backwards
    const double hop_m = -tan_depression_ * (shake.heave_m - heave_m_ + lifted_m);
    heave_m_ = shake.heave_m;
    double step_m = (truth.path_m - last_.path_m) * stretch + hop_m;
    const double step_s = truth.t_s - last_.t_s;
    if (config_.radar_delay_s > 0 && step_s > 0) { // the beam sees what it saw then
        radar_waiting_.push_back(step_m);
        const bool full = static_cast<double>(radar_waiting_.size()) > config_.radar_delay_s / step_s;
        step_m = full ? radar_waiting_.front() : 0;
        if (full) radar_waiting_.pop_front();
    }
    for (;;) {
        const double due_s = static_cast<double>(radar_samples_) / config_.radar.rate_Hz;
        if (due_s > truth.t_s + 1e-9) break; // 1 ns: both clocks are sums
        const double u = step_s > 0 ? (due_s - last_.t_s) / step_s : 1;
        pending_.radar_count.push_back(radar_.sample(radar_path_m_ + u * step_m));
        radar_samples_++;
    }
    radar_path_m_ += step_m;
}

void Sensors::step(const Truth &truth) {
    const double step_s = truth.t_s - last_.t_s;
    if (step_s > 0) {
        const double rate = (truth.v_body_m_s[0] - last_.ahead_m_s) / step_s;
        accel_m_s2_ += (rate - accel_m_s2_) * std::min(1.0, step_s / accel_smoothing_s);
        yaw_accel_rad_s2_ +=
            ((truth.rate_body_rad_s[2] - last_.yaw_rate_rad_s) / step_s - yaw_accel_rad_s2_) * std::min(1.0, step_s / accel_smoothing_s);
        lagged_m_s2_ += (accel_m_s2_ - lagged_m_s2_) * std::min(1.0, step_s / law::accel_tilt_lag_s);
    }
    const Vibration shake = vibration(truth);
    step_radar(truth, accel_m_s2_, shake);
    for (std::size_t i = 0; i < wheel_count; i++) current_[i].add(truth.wheel[i].current_A, step_s);
    battery_.add(truth.battery_voltage_V);
    // a nose that nods down by p turns -g p into the axis
    const BodyEffects &b = config_.effects.body;
    const double felt =
        law::accel_place(truth.specific_force_m_s2[0], b.accel_ahead_m, b.accel_left_m, truth.rate_body_rad_s[2], yaw_accel_rad_s2_);
    accel_.add(law::accel_tilt(felt, gravity_m_s2, b.accel_tilt_rad_s2_m, lagged_m_s2_) - gravity_m_s2 * shake.pitch_rad, step_s);
    accel_y_.add(truth.specific_force_m_s2[1]);
    accel_z_.add(truth.specific_force_m_s2[2] + shake.lift_m_s2);
    gyro_x_.add(truth.rate_body_rad_s[0]);
    gyro_y_.add(truth.rate_body_rad_s[1] - truth.rise_rate_rad_s + shake.pitch_rate_rad_s);
    gyro_.add(truth.rate_body_rad_s[2], step_s);
    if (const auto pose = camera_.step({truth.t_s, truth.position_m[0], truth.position_m[1], truth.yaw_rad}))
        pending_.camera.push_back(*pose);
    last_ = last_of(truth);
}

void Sensors::measure(Measurements &out) {
    out = pending_;
    out.radar_first = static_cast<std::uint32_t>(radar_samples_ - static_cast<std::int64_t>(out.radar_count.size()));
    pending_.radar_count.clear();
    pending_.camera.clear();
    for (std::size_t i = 0; i < wheel_count; i++) {
        out.encoder_count[i] =
            Encoder(config_.effects.wheel[i].encoder_missed, config_.encoder_counts_per_turn).count(last_.motor_angle_rad[i]);
        out.current_A[i] = current_[i].measure(last_.t_s);
    }
    out.battery_V = battery_.measure(last_.t_s);
    const double vibration = config_.accel_vibration_1_s * std::fabs(last_.ahead_m_s);
    out.accel_m_s2 = {accel_.measure(last_.t_s, vibration), accel_y_.measure(last_.t_s, vibration), accel_z_.measure(last_.t_s, vibration)};
    out.gyro_rad_s = {gyro_x_.measure(last_.t_s), gyro_y_.measure(last_.t_s), gyro_.measure(last_.t_s)};
}

} // namespace traction::sim
