#include "model_keys.h"

namespace traction::lab {

namespace {

// Priors are assumed: a brushed gear motor's data sheet holds within 2 to 3 % for its constant and winding, 10 % for friction; a soil is
// known to 20 %; a tyre's radius under load to 0.5 %. Between the wheels of one machine: motors of one lot differ by 1.5 % in their magnets
// and 3 % in windings and brushes, wheels with their rotors by 3 % in inertia, bearings and gears by 15 % in what they lose, tyres of one
// mould by 0.2 %. Without the inertia's share 3 % between four wheels were named as encoders that miss counts. An accelerometer's own low
// pass: MEMS data sheets offer 5 to 260 Hz, so up to some 30 ms and mostly 10; as much again until it is read.
constexpr ModelKey rover[] = {
    {"mass_kg", "kg", 0, 0, 1e5, 0, 0},          {"yaw_inertia_kg_m2", "kg m^2", 0, 0, 1e5, 0.05, 0},
    {"centre_height_m", "m", 0, 0, 10, 0, 0},    {"gravity_m_s2", "m/s^2", 9.81, 0, 30, 0, 0},
    {"battery_voltage_V", "V", 0, 0, 1e3, 0, 0}, {"track_scale", "1", 1, 0.2, 5, 0, 0},
};
constexpr ModelKey wheel[] = {
    {"x_m", "m", 0, -50, 50, 0, 0},         {"y_m", "m", 0, -50, 50, 0, 0},
    {"heading_rad", "rad", 0, -7, 7, 0, 0}, {"radius_m", "m", 0, 1e-4, 5, 0.005, 0, 0.002},
    {"width_m", "m", 0, 0, 5, 0, 0},        {"load_N", "N", 0, 0, 1e6, 0, 0},
};
constexpr ModelKey motor[] = {
    {"torque_constant_Nm_A", "N m/A", 0, 0, 1e4, 0.02, 0, 0.015},
    {"back_emf_Vs_rad", "V s/rad", 0, 0, 1e4, 0.02, 0, 0.015},
    {"resistance_ohm", "ohm", 0, 0, 1e4, 0.05, 0, 0.03}, // limits of 10 % are two deviations; copper gains 5 % in 13 K
    {"inertia_kg_m2", "kg m^2", 0, 0, 1e4, 0.05, 0, 0.03},
    {"viscous_Nms", "N m s", 0, 0, 1e4, 0.1, 0, 0.15},
    {"coulomb_Nm", "N m", 0, 0, 1e4, 0.1, 0, 0.15},
    {"current_offset_A", "A", 0, -10, 10, 0, 0},
};
constexpr ModelKey soil[] = {
    {"mu", "1", 0, 0, 5, 0.2, 0},
    {"adhesion_N", "N", 0, 0, 1e5, 0, 0},
    {"shear_slip", "1", 0.1, 1e-4, 10, 0.15, 0},
    {"shear_curve", "1", 0, -0.6, 0.6, 0, 0},
    {"rolling_coefficient", "1", 0, -0.2, 2, 0, 0.005},
    {"lateral_coefficient", "1", 0, 0, 3, 0.3, 0},
    {"lateral_grip", "1", 0.5, 0, 1.5, 0, 0.5},
    {"relaxation_length_m", "m", 0, 0, 2, 0, 0},
    {"reversal_speed_m_s", "m/s", 0, 0, 0.05, 0, 0},
};
constexpr ModelKey sensors[] = {
    {"encoder.counts_per_turn", "1", 6000, 1, 1e9, 0, 0},
    {"duty.delay_s", "s", 0, -5, 5, 0, 0.004},
    {"current.noise_A", "A", 0, 0, 1e3, 0, 0},
    {"current.delay_s", "s", 0, -5, 5, 0, 0.003},
    {"accel.noise_m_s2", "m/s^2", 0, 0, 1e3, 0, 0},
    {"accel.bias_m_s2", "m/s^2", 0, -5, 5, 0, 0.05},
    {"accel.delay_s", "s", 0, -5, 5, 0, 0.01},
    {"accel.lag_s", "s", 0, -1, 1, 0, 0.01},
    {"accel.ahead_m", "m", 0, -50, 50, 0, 0.005},
    {"accel.left_m", "m", 0, -50, 50, 0, 0.005},
    {"gyro.noise_rad_s", "rad/s", 0, 0, 1e2, 0, 0},
    {"gyro.bias_rad_s", "rad/s", 0, -1, 1, 0, 0.003},
    {"gyro.scale", "1", 0, -0.9, 5, 0, 0},
    {"radar.noise_m_s", "m/s", 0, 0, 1e2, 0, 0},
    {"radar.window_s", "s", 0.5, 0, 10, 0, 0},
    {"radar.delay_s", "s", 0, -5, 5, 0, 0.02},
    {"radar.scale", "1", 0, -0.9, 5, 0, 0.004},
    {"radar.lead", "1", 0, -1, 1, 0, 0.1},
    {"radar.minimum_m_s", "m/s", 0.1, 0, 10, 0, 0},
    {"camera.noise_m", "m", 0, 0, 10, 0, 0},
    {"camera.delay_s", "s", 0, -5, 5, 0, 0.004},
    {"camera.scale", "1", 0, -0.9, 5, 0, 0.002},
    {"camera.x_m", "m", 0, -10, 10, 0, 0},
    {"camera.y_m", "m", 0, -10, 10, 0, 0},
    {"camera.yaw_rad", "rad", 0, -7, 7, 0, 0},
    {"force.noise_N", "N", 0, 0, 1e4, 0, 0},
    {"torque.noise_Nm", "N m", 0, 0, 1e4, 0, 0},
};

} // namespace

std::span<const ModelKey> rover_keys() { return rover; }
std::span<const ModelKey> wheel_keys() { return wheel; }
std::span<const ModelKey> motor_keys() { return motor; }
std::span<const ModelKey> soil_keys() { return soil; }
std::span<const ModelKey> sensor_keys() { return sensors; }

double default_each_wheel(std::string_view key) {
    for (const std::span<const ModelKey> table : {wheel_keys(), motor_keys()})
        for (const ModelKey &k : table)
            if (k.key == key) return k.each_wheel;
    return 0;
}

} // namespace traction::lab
