// laws.h - the law of every effect of the catalogue as a pure function, one for the plant, the sensors and the lab alike.
//
// Each names its effect; with the strength at zero it returns the baseline (0, or the value it was given). Signs as in the catalogue.
#pragma once

#include "sim/physics/math.h"

#include <cmath>

namespace traction::sim::law {

inline double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

// ---- wheel torque: added to Gr of (18); dry parts are magnitudes, to be opposed to the speed
inline double coulomb_friction_Nm(double torque_Nm) { return torque_Nm; }
inline double viscous_friction_Nm(double coefficient_Nms, double speed_rad_s) { return coefficient_Nms * speed_rad_s; }
inline double stribeck_friction_Nm(double torque_Nm, double scale_rad_s, double speed_rad_s) {
    const double x = speed_rad_s / scale_rad_s;
    return torque_Nm * math::exp(-x * x);
}
inline double mesh_loss_Nm(double fraction, double transmitted_Nm) { return fraction * std::fabs(transmitted_Nm); }
inline double torque_ripple_Nm(double cos_Nm, double sin_Nm, double order, double angle_rad) {
    return cos_Nm * math::cos(order * angle_rad) + sin_Nm * math::sin(order * angle_rad);
}
// Torque through elastic teeth with play: motor angle minus wheel angle, and its rate. Teeth push, they do not pull.
inline double backlash_Nm(double play_rad, double stiffness_Nm_rad, double damping_Nms, double twist_rad, double twist_rad_s) {
    const double over = std::fabs(twist_rad) - 0.5 * play_rad;
    if (over <= 0) return 0;
    const double side = twist_rad > 0 ? 1 : -1;
    const double torque = stiffness_Nm_rad * over + damping_Nms * side * twist_rad_s;
    return torque > 0 ? side * torque : 0;
}

// ---- motor
inline constexpr double copper_per_K = 0.0039, magnet_per_K = 0.002;
// d(dT)/dt of the winding above ambient.
inline double winding_heating_K_s(double resistance_K_W, double time_constant_s, double current_A, double winding_ohm, double dT_K) {
    return (current_A * current_A * winding_ohm * resistance_K_W - dT_K) / time_constant_s;
}
inline double hot_resistance_ohm(double resistance_ohm, double dT_K) { return resistance_ohm * (1 + copper_per_K * dT_K); }
inline double hot_torque_constant(double KG, double dT_K) { return KG * (1 - magnet_per_K * dT_K); }
inline double torque_constant(double KG, double change) { return KG * (1 + change); }
inline double wiring_resistance_V(double resistance_ohm, double current_A) { return resistance_ohm * current_A; }
inline double bridge_dead_time_V(double voltage_V, double current_A) { return voltage_V * sign(current_A); }

// ---- wheel force
inline double rolling_resistance_N(double coefficient, double load_N) { return coefficient * load_N; }
inline double slip_sinkage_N(double coefficient, double slip, double load_N) { return coefficient * std::fabs(slip) * load_N; }
inline double speed_resistance_N(double coefficient_s_m, double v_m_s, double load_N) {
    return coefficient_s_m * std::fabs(v_m_s) * load_N;
}
// Factors of Fm.
inline double multi_pass(double gain, double follows) { return 1 + gain * follows; } // follows: 0 leads, 1 trails
inline double soil_patch(double change, double start_m, double length_m, double place_m) {
    return place_m >= start_m && place_m < start_m + length_m ? 1 + change : 1;
}
inline double soil_gradient(double change_per_m, double path_m) {
    const double factor = 1 + change_per_m * path_m;
    return factor > 0.05 ? factor : 0.05;
}
inline double sliding_speed_loss(double coefficient_s_m, double sliding_m_s) {
    return math::exp(-coefficient_s_m * std::fabs(sliding_m_s));
}
inline double relaxation_length_m(double base_m, double added_m) { return base_m + added_m; }
inline double shear_stiffness(double shear_slip, double change) { return shear_slip * (1 + change); }
inline double wheel_radius_m(double radius_m, double change) { return radius_m * (1 + change); }
inline double lateral_scrub_N(double coefficient, double load_N) { return coefficient * load_N; } // largest sideways force

// ---- loads and body forces
// Load on one front wheel minus its static value, at acceleration a (rear: opposite).
inline double load_transfer_N(double mass_kg, double accel_m_s2, double height_m, double wheelbase_m) {
    return -mass_kg * accel_m_s2 * height_m / (2 * wheelbase_m);
}
inline double mass_offset_N(double mass_kg, double gravity_m_s2, double offset_m, double half_base_m) { // one wheel on the heavier side
    return mass_kg * gravity_m_s2 * offset_m / (4 * half_base_m);
}
inline double grade_N(double mass_kg, double gravity_m_s2, double slope_rad, double direction_rad, double yaw_rad) {
    return -mass_kg * gravity_m_s2 * math::sin(slope_rad) * math::cos(yaw_rad - direction_rad);
}
inline double tether_drag_N(double stiffness_N_m, double distance_m) { return -stiffness_N_m * distance_m; }
inline double body_drag_N(double force_N, double v_m_s) { return -force_N * sign(v_m_s); }

// ---- sensors
inline double accel_bias(double a, double bias_m_s2) { return a + bias_m_s2; }
inline double accel_drift(double a, double rate_m_s3, double t_s) { return a + rate_m_s3 * t_s; }
inline double accel_scale(double a, double change) { return a * (1 + change); }
inline double accel_tilt(double a, double gravity_m_s2, double compliance_rad_s2_m, double lagged_a) {
    return a + gravity_m_s2 * compliance_rad_s2_m * lagged_a;
}
inline double radar_scale(double v_m_s, double change) { return v_m_s * (1 + change); }
inline double radar_pitch(double v_m_s, double coefficient_s2_m, double accel_m_s2) { return v_m_s * (1 + coefficient_s2_m * accel_m_s2); }
inline double current_gain(double current_A, double change) { return current_A * (1 + change); }
inline double current_offset(double current_A, double offset_A) { return current_A + offset_A; }
inline double voltage_gain(double voltage_V, double change) { return voltage_V * (1 + change); }
inline double encoder_missed(double speed_rad_s, double fraction) { return speed_rad_s * (1 - fraction); }
inline double camera_scale(double distance_m, double change) { return distance_m * (1 + change); }
inline double delayed_time_s(double t_s, double delay_s) { return t_s - delay_s; } // camera_delay, actuation_delay

} // namespace traction::sim::law
