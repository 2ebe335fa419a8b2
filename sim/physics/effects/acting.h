// acting.h - the effects that are switched on, as numbers, and what they add up to at each place where they act.
//
// One field per parameter of the catalogue, whose row names it; a strength is zero where its effect is absent, and then every function
// here returns what it was given, bit for bit. Plant, sensors and lab hold these structs and call these functions with their own state:
// an effect that is added here acts in all of them.
#pragma once

#include "catalogue.h"
#include "laws.h"

#include <array>
#include <cmath>
#include <span>

namespace traction::sim {

// On one wheel, its motor and its sensors (T: double), or on several side by side.
template <typename T> struct WheelEffectsOf {
    T coulomb_Nm = T(0.0), viscous_Nms = T(0.0), stribeck_Nm = T(0.0), stribeck_speed_rad_s = T(1.0), mesh_fraction = T(0.0);
    T play_rad = T(0.0), ripple_cos_Nm = T(0.0), ripple_sin_Nm = T(0.0), ripple_order = T(1.0);
    T heating_K_W = T(0.0), heating_time_s = T(60.0), wiring_ohm = T(0.0), dead_voltage_V = T(0.0), constant_change = T(0.0);
    T rolling = T(0.0), radius_change = T(0.0);
    T current_gain = T(0.0), current_offset_A = T(0.0), encoder_missed = T(0.0);
    T wear_in_Nm = T(0.0), wear_in_time_s = T(30.0), reverse_Nm = T(0.0), churning_Nms2 = T(0.0), speed_loss_s = T(0.0);
    T shared_ohm = T(0.0), shared_with = T(1.0);
    // Every field, for whoever copies wheels into places side by side.
    static constexpr auto all() {
        using E = WheelEffectsOf;
        return std::array{// in any order
                          &E::coulomb_Nm,     &E::viscous_Nms,   &E::stribeck_Nm,      &E::stribeck_speed_rad_s, &E::mesh_fraction,
                          &E::play_rad,       &E::ripple_cos_Nm, &E::ripple_sin_Nm,    &E::ripple_order,         &E::heating_K_W,
                          &E::heating_time_s, &E::wiring_ohm,    &E::dead_voltage_V,   &E::constant_change,      &E::rolling,
                          &E::radius_change,  &E::current_gain,  &E::current_offset_A, &E::encoder_missed,       &E::wear_in_Nm,
                          &E::wear_in_time_s, &E::reverse_Nm,    &E::churning_Nms2,    &E::speed_loss_s,         &E::shared_ohm,
                          &E::shared_with};
    }
};
using WheelEffects = WheelEffectsOf<double>;
static_assert(sizeof(WheelEffects) == WheelEffects::all().size() * sizeof(double), "all() names every field");

// On the rover as a whole, the ground under it and the sensors on its body.
struct BodyEffects {
    double slip_sinkage = 0, speed_resistance_s_m = 0, multi_pass = 0;
    double raised_m = 0, offset_x_m = 0, offset_y_m = 0;
    double patch_change = 0, patch_start_m = 0, patch_length_m = 1, gradient_1_m = 0;
    double relaxation_m = 0, sliding_loss_s_m = 0, shear_change = 0, scrub = 0;
    double slope_rad = 0, slope_direction_rad = 0, tether_N_m = 0, drag_N = 0;
    double accel_bias_m_s2 = 0, accel_drift_m_s3 = 0, accel_scale = 0, accel_tilt_rad_s2_m = 0;
    double radar_scale = 0, radar_pitch_s2_m = 0, voltage_gain = 0, camera_delay_s = 0, camera_scale = 0, actuation_delay_s = 0;
    double squared_resistance_s2_m2 = 0, drag_Ns2_m2 = 0, shear_peak = 0;
    double heavy_resistance = 0, heavy_start_m = 0, heavy_length_m = 1;
    double accel_delay_s = 0, accel_lag_s = 0, gyro_delay_s = 0, radar_delay_s = 0, current_delay_s = 0;
    double accel_ahead_m = 0, accel_left_m = 0, gyro_scale = 0;
};

// Switches an effect on: on wheel `wheel`, or with -1 on all of them and the body. Strengths add to what is there, shapes replace it.
void act(const ActiveEffect &active, std::span<WheelEffects> wheels, BodyEffects &body);

struct RoverEffects {
    std::array<WheelEffects, 6> wheel; // the plant's slots (sim/plant/layout.h); the sensors have the first four
    BodyEffects body;
};
RoverEffects act_together(std::span<const ActiveEffect> effects);

// True where an effect with one of these needs (catalogue.h) is switched on.
bool needs_any(const WheelEffects &wheel, unsigned needs);
bool needs_any(const BodyEffects &body, unsigned needs);

// ---- wheel torque
// Dry friction, as a size. By load: the part that depends on the torque the teeth transmit.
inline double load_friction_Nm(const WheelEffects &e, double transmitted_Nm, double speed_rad_s) {
    const double mesh = law::mesh_loss_Nm(e.mesh_fraction, transmitted_Nm);
    return e.speed_loss_s != 0 ? mesh + law::gear_speed_loss_Nm(e.speed_loss_s, speed_rad_s, transmitted_Nm) : mesh;
}
// since_s: time since the motors were started, which is the log's beginning.
template <typename M = law::Portable>
double dry_friction_Nm(double base_Nm, const WheelEffects &e, double speed_rad_s, double transmitted_Nm, double since_s) {
    double size = base_Nm + law::coulomb_friction_Nm(e.coulomb_Nm) + load_friction_Nm(e, transmitted_Nm, speed_rad_s);
    if (e.stribeck_Nm != 0) size += law::stribeck_friction_Nm<M>(e.stribeck_Nm, e.stribeck_speed_rad_s, speed_rad_s);
    if (e.wear_in_Nm != 0) size += law::wear_in_Nm<M>(e.wear_in_Nm, e.wear_in_time_s, since_s);
    if (e.reverse_Nm != 0) size += law::reverse_friction_Nm(e.reverse_Nm, speed_rad_s);
    if (e.churning_Nms2 != 0) size += law::churning_friction_Nm(e.churning_Nms2, speed_rad_s);
    return size;
}
inline double viscous_friction_Nm(double base_Nms, const WheelEffects &e, double speed_rad_s) {
    return law::viscous_friction_Nm(base_Nms + e.viscous_Nms, speed_rad_s);
}
// Periodic in the wheel's angle: a torque of its own sign (cogging), and a friction that varies over the turn, as a size.
template <typename M = law::Portable> double periodic_Nm(const WheelEffects &e, double angle_rad, bool friction) {
    if ((e.ripple_cos_Nm == 0 && e.ripple_sin_Nm == 0) || (e.ripple_order < 0) != friction) return 0;
    return law::torque_ripple_Nm<M>(e.ripple_cos_Nm, e.ripple_sin_Nm, e.ripple_order, angle_rad);
}

// ---- motor; heat: of the winding above ambient
inline double motor_constant(double K, const WheelEffects &e, double heat_K) {
    return law::hot_torque_constant(law::torque_constant(K, e.constant_change), heat_K);
}
inline double circuit_ohm(double winding_ohm, const WheelEffects &e) { return law::wiring_resistance_ohm(winding_ohm, e.wiring_ohm); }
// How far the temperature is from where it tends to, which it nears with heating_time_s; 0 where nothing heats.
inline double heating_gap_K(const WheelEffects &e, double current_A, double cold_ohm, double heat_K) {
    return e.heating_K_W != 0 ? law::winding_heating_K(e.heating_K_W, current_A, cold_ohm) - heat_K : 0;
}

// ---- wheel force
// Calls add(c) with the resistance over the load of each effect.
template <typename T, typename Add>
void each_resistance(const WheelEffectsOf<T> &e, const BodyEffects &b, const T &slip, const T &v_m_s, Add &&add) {
    add(law::rolling_resistance(e.rolling));
    add(law::slip_sinkage(b.slip_sinkage, slip));
    add(law::speed_resistance(b.speed_resistance_s_m, v_m_s));
    add(law::squared_resistance(b.squared_resistance_s2_m2, v_m_s));
}
// The same of the place where the wheel stands.
inline double resistance_here(const BodyEffects &b, double place_m) {
    return law::resistance_patch(b.heavy_resistance, b.heavy_start_m, b.heavy_length_m, place_m);
}
// Fm's factor by where the wheel stands; follows: 0 leads, 1 trails another in its track.
inline double strength_here(double base, const BodyEffects &b, double place_m, double path_m, double follows) {
    base *= law::soil_patch(b.patch_change, b.patch_start_m, b.patch_length_m, place_m);
    base *= law::soil_gradient(b.gradient_1_m, path_m);
    return base * law::multi_pass(b.multi_pass, follows);
}
inline bool even_strength(const BodyEffects &b) { return b.patch_change == 0 && b.gradient_1_m == 0 && b.multi_pass == 0; } // always base
// ... and by how fast it slides.
template <typename M = law::Portable, typename T> T strength_sliding(const T &base, const BodyEffects &b, const T &sliding_m_s) {
    if (b.sliding_loss_s_m == 0) return base;
    return T(base * law::sliding_speed_loss<M>(b.sliding_loss_s_m, sliding_m_s));
}
// ... and by how far its slip is beyond the curve's knee.
template <typename T> T strength_slipping(const T &base, const BodyEffects &b, const T &slip, const T &shear_slip) {
    if (b.shear_peak == 0) return base;
    return T(base * law::shear_peak(b.shear_peak, slip, shear_slip));
}

// ---- body force along the velocity; side: sgn(v), or as continuous as its caller needs
inline double dragged_N(const BodyEffects &b, double v_m_s, double side) {
    const double drag = law::body_drag_N(b.drag_N, side);
    return b.drag_Ns2_m2 != 0 ? drag + law::fluid_drag_N(b.drag_Ns2_m2, v_m_s) : drag;
}

} // namespace traction::sim
