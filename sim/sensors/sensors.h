// sensors.h - every sensor of the rover together: the truth of each plant step in, the measurements of a 10 ms tick out.
//
// SI units; raw counts are made in hal/sim. Effects of the catalogue that act on a sensor are configuration here; their laws are
// sim/physics/effects/laws.h.
#pragma once

#include "analog.h"
#include "camera.h"
#include "encoder.h"
#include "radar.h"

#include "sim/physics/effects/acting.h"
#include "sim/plant/truth.h"

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace traction::sim {

struct SensorConfig {
    RadarConfig radar;
    std::array<AnalogConfig, wheel_count> current;
    AnalogConfig battery;
    AnalogConfig accel;
    double accel_vibration_1_s = sim::accel_vibration_1_s;
    AnalogConfig gyro;
    double heave_m = 0, heave_Hz = 0;                       // amplitude and rate of a body that hops while it drives faster than 0.1 m/s
    double pitch_vibration_rad = 0, pitch_vibration_Hz = 0; // the same of its nodding, nose down positive
    CameraConfig camera;
    double encoder_counts_per_turn = sim::encoder_counts_per_turn; // of a wheel
    RoverEffects effects;         // those that act on every reading anew; the others are in gain, offset, drift, scale and delay
    double radar_delay_s = 0;     // age of what the beam sees [s]
    double radar_mount_pitch = 1; // how much of the body's pitch turns the beam (1: rigid mount)
    double ground_slope_rad = 0;  // pitch is counted from the ground: rise along ground_direction_rad
    double ground_direction_rad = 0;
    bool on_terrain = false; // the body moves up and down in its own frame: the beam feels it (radar_mount_pitch of it)
};

// The sensors as built, with the stated noise of each.
SensorConfig default_sensors();

// Adds what the sensor effects among `effects` do, several of one kind together; effects that act elsewhere are left to the plant. To
// be called once per configuration.
void apply_sensor_effects(std::span<const ActiveEffect> effects, SensorConfig &config);

// All measurements of one tick.
struct Measurements {
    std::array<std::int32_t, wheel_count> encoder_count{};
    std::array<double, wheel_count> current_A{};
    double battery_V = 0;
    std::array<double, 3> accel_m_s2{};     // specific force along body x, y, z
    std::array<double, 3> gyro_rad_s{};     // about body x, y, z
    std::uint32_t radar_first = 0;          // number of radar_count[0] among all samples; sample n is taken at n/rate
    std::vector<std::uint16_t> radar_count; // since the last tick, oldest first
    std::vector<Pose> camera;               // since the last tick
};

class Sensors {
  public:
    // `start` is the truth before the first step.
    Sensors(const SensorConfig &config, std::uint64_t seed, const Truth &start);

    void step(const Truth &truth);   // once per plant step
    void measure(Measurements &out); // ends the tick

  private:
    struct Vibration {
        double heave_m = 0, lift_m_s2 = 0, pitch_rad = 0, pitch_rate_rad_s = 0;
    };
    Vibration vibration(const Truth &truth) const;
    void step_radar(const Truth &truth, double accel_m_s2, const Vibration &shake);
    SensorConfig config_;
    Radar radar_;
    Camera camera_;
    std::vector<AnalogSensor> current_;
    AnalogSensor battery_, accel_, gyro_; // of the last two: x and z, which the effects of the catalogue act on
    AnalogSensor accel_y_, accel_z_, gyro_x_, gyro_y_;
    Measurements pending_;
    struct Last { // of the truth, what the next step and the tick's end ask for
        double t_s, path_m, ahead_m_s, up_m_s, yaw_rate_rad_s;
        std::array<double, wheel_count> motor_angle_rad;
    };
    static Last last_of(const Truth &truth) {
        return {truth.t_s,
                truth.path_m,
                truth.v_body_m_s[0],
                truth.v_body_m_s[2],
                truth.rate_body_rad_s[2],
                {truth.wheel[0].motor_angle_rad, truth.wheel[1].motor_angle_rad, truth.wheel[2].motor_angle_rad,
                 truth.wheel[3].motor_angle_rad}};
    }
    Last last_;
    double tan_depression_;
    std::deque<double> radar_waiting_; // steps of the path that the beam has yet to see
    double radar_path_m_ = 0, heave_m_ = 0;
    std::int64_t radar_samples_ = 1; // the sample at t = 0 belongs to no tick
    double accel_m_s2_ = 0;          // along x, smoothed over 10 ms
    double lagged_m_s2_ = 0;         // the same as the suspension follows it
    double yaw_accel_rad_s2_ = 0;    // smoothed over 10 ms
};

} // namespace traction::sim
