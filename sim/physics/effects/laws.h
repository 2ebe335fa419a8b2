// laws.h - the law of every effect of the catalogue as a pure function: the plant, the sensors and the lab call these and no others.
//
// Each names its effect; with the strength at zero it returns the baseline (0, 1 or the value it was given). Signs as in the catalogue.
// T is double or several wheels side by side (an Eigen array). M says whose exp, sin and cos: the plant must repeat bit for bit on any
// machine and takes math.h; the lab, which must be fast, lends its library's. What adds them up where they act: acting.h.
#pragma once

#include "sim/physics/math.h"

#include <algorithm>
#include <cmath>

namespace traction::sim::law {

struct Portable {
    static double exp(double x) { return math::exp(x); }
    static double sin(double x) { return math::sin(x); }
    static double cos(double x) { return math::cos(x); }
};

// ---- wheel torque: added to Gr of (18); dry parts are magnitudes, to be opposed to the speed
inline double coulomb_friction_Nm(double torque_Nm) { return torque_Nm; }
inline double viscous_friction_Nm(double coefficient_Nms, double speed_rad_s) { return coefficient_Nms * speed_rad_s; }
template <typename M = Portable> double stribeck_friction_Nm(double torque_Nm, double scale_rad_s, double speed_rad_s) {
    const double x = speed_rad_s / scale_rad_s;
    return torque_Nm * M::exp(-x * x);
}
inline double mesh_loss_Nm(double fraction, double transmitted_Nm) { return fraction * std::fabs(transmitted_Nm); }
inline double gear_speed_loss_Nm(double loss_per_rad_s, double speed_rad_s, double transmitted_Nm) {
    return loss_per_rad_s * std::fabs(speed_rad_s * transmitted_Nm);
}
template <typename M = Portable> double wear_in_Nm(double torque_Nm, double time_s, double since_s) {
    return torque_Nm * M::exp(-since_s / time_s);
}
inline double reverse_friction_Nm(double torque_Nm, double speed_rad_s) { return speed_rad_s < 0 ? torque_Nm : 0; }
inline double churning_friction_Nm(double coefficient_Nms2, double speed_rad_s) { return coefficient_Nms2 * speed_rad_s * speed_rad_s; }
template <typename M = Portable> double torque_ripple_Nm(double cos_Nm, double sin_Nm, double order, double angle_rad) {
    const double phase = std::fabs(order) * angle_rad; // a negative order is a friction: acting.h turns it against the motion
    return cos_Nm * M::cos(phase) + sin_Nm * M::sin(phase);
}
// How far teeth with play are pressed into each other, < 0 while they are apart; twist: motor angle minus wheel angle.
inline double backlash_rad(double play_rad, double twist_rad) { return std::fabs(twist_rad) - 0.5 * play_rad; }
// Their torque where they are elastic. Teeth push, they do not pull.
inline double backlash_Nm(double play_rad, double stiffness_Nm_rad, double damping_Nms, double twist_rad, double twist_rad_s) {
    const double over = backlash_rad(play_rad, twist_rad);
    if (over <= 0) return 0;
    const double side = twist_rad > 0 ? 1 : -1;
    const double torque = stiffness_Nm_rad * over + damping_Nms * side * twist_rad_s;
    return torque > 0 ? side * torque : 0;
}

// ---- motor
inline constexpr double copper_per_K = 0.0039, magnet_per_K = 0.002;
// Where the winding's temperature above ambient tends to; it follows with the effect's time constant.
inline double winding_heating_K(double resistance_K_W, double current_A, double winding_ohm) {
    return resistance_K_W * current_A * current_A * winding_ohm;
}
inline double hot_resistance_ohm(double resistance_ohm, double dT_K) { return resistance_ohm * (1 + copper_per_K * dT_K); }
inline double hot_torque_constant(double KG, double dT_K) { return KG * (1 - magnet_per_K * dT_K); }
inline double torque_constant(double KG, double change) { return KG * (1 + change); }
inline double wiring_resistance_ohm(double resistance_ohm, double added_ohm) { return resistance_ohm + added_ohm; }
// What a lead takes from a motor's voltage for the current of others on it; its own part belongs to the winding as measured in place.
inline double shared_lead_V(double resistance_ohm, double others_A) { return resistance_ohm * others_A; }
// Whose motors are on it: 1 those of the axle, 2 those of the side, 3 all.
inline bool shares_lead(double with, bool same_axle, bool same_side) { return with < 1.5 ? same_axle : with < 2.5 ? same_side : true; }
// What the bridge keeps of the voltage that would drive the current: all of it up to the lost voltage. over: 0, or where the sign of the
// drop is to be continuous (a fit needs its derivative at zero), the width of the change. Volts, or both as the current they would drive.
inline double bridge_dead_time_V(double lost_V, double drop_V, double over_V = 0) {
    if (over_V > 0) return lost_V * std::clamp(drop_V / std::max(std::fabs(lost_V), over_V), -1.0, 1.0);
    return std::clamp(drop_V, -lost_V, lost_V);
}

// ---- wheel force: resistances over the load
template <typename T> T rolling_resistance(const T &coefficient) { return coefficient; }
template <typename T> T slip_sinkage(double coefficient, const T &slip) {
    using std::abs;
    return T(coefficient * abs(slip));
}
template <typename T> T speed_resistance(double coefficient_s_m, const T &v_m_s) {
    using std::abs;
    return T(coefficient_s_m * abs(v_m_s));
}
template <typename T> T squared_resistance(double coefficient_s2_m2, const T &v_m_s) { return T(coefficient_s2_m2 * v_m_s * v_m_s); }
inline double resistance_patch(double coefficient, double start_m, double length_m, double place_m) {
    return place_m >= start_m && place_m < start_m + length_m ? coefficient : 0;
}
template <typename T> T lateral_scrub_N(const T &coefficient, const T &load_N) { return coefficient * load_N; } // largest sideways force
// Factors of Fm.
inline double multi_pass(double gain, double follows) { return 1 + gain * follows; } // follows: 0 leads, 1 trails
inline double soil_patch(double change, double start_m, double length_m, double place_m) {
    return place_m >= start_m && place_m < start_m + length_m ? 1 + change : 1;
}
inline double soil_gradient(double change_per_m, double path_m) { return std::max(0.05, 1 + change_per_m * path_m); }
template <typename M = Portable, typename T> T sliding_speed_loss(double coefficient_s_m, const T &sliding_m_s) {
    using std::abs;
    return M::exp(T(-coefficient_s_m * abs(sliding_m_s)));
}
// 1 - share*max(0, |s| - 2 sc), at least 0.1; 2 sc: where (21) has reached 86 % and (20) 57 % of its end. In terms of |x|, for lanes.
template <typename T> T shear_peak(double share, const T &slip, const T &shear_slip) {
    using std::abs;
    const T past = abs(slip) - 2 * shear_slip, left = 0.9 - 0.5 * share * (past + abs(past));
    return T(0.1 + 0.5 * (left + abs(left)));
}
inline double relaxation_length_m(double base_m, double added_m) { return base_m + added_m; }
inline double shear_stiffness(double shear_slip, double change) { return shear_slip * (1 + change); }
inline double wheel_radius_m(double radius_m, double change) { return radius_m * (1 + change); }

// ---- loads and body forces
inline double load_transfer_m(double centre_height_m, double raised_m) { return centre_height_m + raised_m; }
// Place of a wheel from the centre of mass, which lies `offset_m` off the middle: its moment M*g*offset tips the loads.
inline double mass_offset_m(double place_m, double offset_m) { return place_m - offset_m; }
inline double mass_offset_Nm(double weight_N, double offset_m) { return weight_N * offset_m; }
// Gravity along a slope [m/s^2], of a body that heads `turned_rad` away from the rise: forward and to the left.
struct Slope {
    double along_m_s2, across_m_s2;
};
template <typename M = Portable> Slope grade_m_s2(double gravity_m_s2, double slope_rad, double turned_rad) {
    const double steep = gravity_m_s2 * M::sin(slope_rad);
    return {-steep * M::cos(turned_rad), steep * M::sin(turned_rad)};
}
inline double tether_drag_N(double stiffness_N_m, double distance_m) { return -stiffness_N_m * distance_m; }
inline double body_drag_N(double force_N, double side) { return -force_N * side; } // side: sgn(v), or as continuous as its caller needs
inline double fluid_drag_N(double coefficient_Ns2_m2, double v_m_s) { return -coefficient_Ns2_m2 * v_m_s * std::fabs(v_m_s); }

// ---- sensors: of affine ones the law acts on the reading or, all the same, on its coefficients
inline constexpr double accel_tilt_lag_s = 0.1; // [s] assumed: the suspension's
inline double accel_bias(double a, double bias_m_s2) { return a + bias_m_s2; }
inline double accel_drift(double a, double rate_m_s3, double t_s) { return a + rate_m_s3 * t_s; }
inline double accel_tilt(double a, double gravity_m_s2, double compliance_rad_s2_m, double lagged_a) {
    return a + gravity_m_s2 * compliance_rad_s2_m * lagged_a;
}
inline double accel_scale(double scale, double change) { return scale + change; } // scale: 1, or the part that is known
// Of a sensor that far ahead of the point whose acceleration a is, and to its left: turning throws it outwards.
inline double accel_place(double a, double ahead_m, double left_m, double yaw_rate_rad_s, double yaw_accel_rad_s2) {
    return a - ahead_m * yaw_rate_rad_s * yaw_rate_rad_s - left_m * yaw_accel_rad_s2;
}
inline double gyro_scale(double scale, double change) { return scale + change; }
inline double radar_scale(double scale, double change) { return scale + change; }
inline double radar_pitch(double coefficient_s2_m, double accel_m_s2) { return 1 + coefficient_s2_m * accel_m_s2; } // a factor of the speed
inline double current_gain(double gain, double change) { return gain + change; }
inline double current_offset(double current_A, double offset_A) { return current_A + offset_A; }
inline double voltage_gain(double gain, double change) { return gain + change; }
inline double encoder_missed(double fraction) { return 1 - fraction; } // share of the counts that is left
inline double camera_scale(double scale, double change) { return scale + change; }
inline double camera_delay_s(double delay_s, double added_s) { return delay_s + added_s; }
inline double accel_delay_s(double delay_s, double added_s) { return delay_s + added_s; }
inline double accel_lag_s(double lag_s, double added_s) { return lag_s + added_s; } // time constant of a first-order low pass
inline double gyro_delay_s(double delay_s, double added_s) { return delay_s + added_s; }
inline double radar_delay_s(double delay_s, double added_s) { return delay_s + added_s; }
inline double current_delay_s(double delay_s, double added_s) { return delay_s + added_s; }
inline double actuation_delay_s(double delay_s, double added_s) { return delay_s + added_s; }

} // namespace traction::sim::law
