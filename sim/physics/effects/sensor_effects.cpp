#include "parts.h"

namespace traction::sim {

std::vector<Effect> sensor_effects() {
    using enum ActsOn;
    constexpr bool per_wheel = true;
    return {
        {"accel_bias", "Accelerometer off by a constant", sensor, false, "a_meas += b", "zero-g offset of MEMS data sheets",
         "A constant residual, also at rest.", "Stand still. A grade gives the same at rest but changes with heading.",
         {strength("bias_m_s2", "m/s^2", "constant error", -0.5, 0.5, 0.15, 0.02)}},
        {"accel_drift", "Accelerometer that drifts", sensor, false, "a_meas += r*t", "offset against temperature, as a ramp; derived here",
         "A residual that grows with time, whatever the motion.", "Stand still at the beginning and at the end. A bias alone is the same at both.",
         {strength("rate_m_s3", "m/s^3", "drift per time", -0.01, 0.01, 0.003, 3e-4)}},
        {"accel_scale", "Accelerometer with a wrong scale", sensor, false, "a_meas *= 1 + c", "sensitivity tolerance of MEMS data sheets",
         "Residual proportional to acceleration.", "Hard starts and stops with camera or radar. A rocking body adds a late copy instead.",
         {strength("change", "1", "relative change", -0.3, 0.3, 0.1, 0.02)}},
        {"accel_tilt", "Body that rocks back when it accelerates", sensor, false, "pitch = kappa*a, lagged 0.1 s; a_meas += g*pitch",
         "compliance of the suspension of the sensor; derived here",
         "A late copy of the acceleration on top of it.", "Steps of acceleration: the lag tells it from a wrong scale.",
         {strength("compliance_rad_s2_m", "rad s^2/m", "pitch per acceleration", 0, 0.05, 0.012, 0.002)}},
        {"radar_scale", "Radar with a wrong scale", sensor, false, "v_radar *= 1 + c",
         "error of the mounting angle in (11) Lhomme-Desages: df = 2 v cos(theta_d) f0/c",
         "Radar speed wrong in proportion to speed.", "Cruise at several speeds with a camera in view. Without one, wheel radius looks alike.",
         {strength("change", "1", "relative change", -0.3, 0.3, 0.08, 0.01)}},
        {"radar_pitch", "Radar beam that nods when the rover accelerates", sensor, false, "v_radar *= 1 + k*a",
         "pitch under acceleration changes theta_d in (11) Lhomme-Desages; derived here",
         "Radar speed wrong while accelerating only.", "Fast starts and stops; weak, since the radar is slow. Constant speed shows radar scale instead.",
         {strength("coefficient_s2_m", "s^2/m", "relative change per acceleration", -0.3, 0.3, 0.1, 0.02)}},
        {"current_gain", "Current sensor with a wrong gain", sensor, per_wheel, "I_meas *= 1 + c", "shunt and amplifier tolerance",
         "Measured current wrong in proportion to itself; speeds and voltages agree.", "Any load. Both balances of that motor are wrong alike.",
         {strength("change", "1", "relative change", -0.4, 0.4, 0.12, 0.02)}},
        {"current_offset", "Current sensor with an offset", sensor, per_wheel, "I_meas += o", "amplifier offset",
         "A constant current, also when the motor is off.", "Stand with the motors off. While turning one way only, dry friction looks alike.",
         {strength("offset_A", "A", "constant error", -0.3, 0.3, 0.08, 0.01)}},
        {"voltage_gain", "Battery voltage read with a wrong gain", sensor, false, "V_meas *= 1 + c", "divider tolerance",
         "All voltage balances wrong in proportion to duty.", "Hold several duties, light load. A motor constant changes the torque balance as well.",
         {strength("change", "1", "relative change", -0.3, 0.3, 0.06, 0.01)}},
        {"encoder_missed", "Encoder that misses counts", sensor, per_wheel, "w_meas = w*(1-p)", "weak edge or slow counter; mean effect, derived here",
         "That wheel seems slower than it is: false slip, a false radius.", "Straight cruise, compare the wheels with each other and the ground.",
         {strength("fraction", "1", "share of the counts lost", 0, 0.3, 0.06, 0.005)}},
        {"camera_delay", "Camera that sees the past", sensor, false, "pose_meas(t) = pose(t - delay)", "exposure, transfer and image processing",
         "Camera position trails in proportion to speed, and jumps with acceleration.", "Speed steps; compare with radar and wheels.",
         {strength("delay_s", "s", "delay", 0, 0.4, 0.12, 0.01)}},
        {"camera_scale", "Camera with a wrong scale", sensor, false, "distances times (1 + c)", "calibration of focal length or height",
         "Camera distances wrong in proportion, wheels and radar agree.", "Long straight drives. Without radar, wheel radius looks alike.",
         {strength("change", "1", "relative change", -0.2, 0.2, 0.05, 0.005)}},
        {"actuation_delay", "Commands that take effect late", motor_voltage, false, "u(t) = duty(t - delay)*V", "bus and timer latency",
         "After each change of duty the current answers late.", "Many steps of duty at known battery voltage. Backlash answers late after reversals only.",
         {strength("delay_s", "s", "delay", 0, 0.2, 0.05, 0.01)}},
    };
}

} // namespace traction::sim
