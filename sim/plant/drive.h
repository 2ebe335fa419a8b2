// drive.h - one wheel's drive train: bridge, winding, gear, friction, wheel spin.
//
//   I = (u - ke*w_m)/Ra, u = duty*V - (losses of the bridge and the wires)                                 (1) docs/sources.md section 3
//   J*dw/dt = KG*I - Gr(w) - R*Ft                                                        (17) Lhomme-Desages
//   Gr(w) = (b*|w| + t0)*sgn(w), Coulomb part implicit: at rest it takes up to t0                          (18)
// With backlash the rotor's share of J and the wheel's are two masses with a dead zone between them.
#pragma once

#include "sim/physics/effects/acting.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace traction::sim {

struct DriveParameters {
    double torque_constant_Nm_A = 0.265; // KG at the wheel; the back-EMF constant is the same number in SI (assumed)
    double resistance_ohm = 3.24;        // assumed: V^2/(4 Ra) = 4 W of mechanical power
    double inductance_H = 0;             // 0: the winding's lag (0.3 ms for 1 mH) is below the step, assumed
    double current_limit_A = std::numeric_limits<double>::infinity(); // of the bridge; the paper names none
    double inertia_kg_m2 = 5e-3;                                      // J, rotor and wheel together
    double wheel_inertia_kg_m2 = 5e-4;                                // share of J on the wheel's side of the backlash, assumed
    double viscous_Nms = 1.6e-3;                                      // (18)
    double coulomb_Nm = 0.03;                                         // (18)
    double gear_stiffness_Nm_rad = 40;                                // of the teeth once they touch, with backlash only, assumed
    double gear_damping_Nms_rad = 0.05;                               // the same, assumed
    bool operator==(const DriveParameters &) const = default;
};

struct DriveState {
    double motor_angle_rad = 0, motor_speed_rad_s = 0; // behind the gear, at the wheel's scale
    double wheel_angle_rad = 0, wheel_speed_rad_s = 0;
    double current_A = 0;
    double heat_K = 0;  // winding temperature above ambient
    double since_s = 0; // time since the start
};

// What one step did, for the energy audit [J].
struct DriveWork {
    double motor = 0, friction = 0;
};

// Current of (1) for a duty and a supply voltage, within the bridge's limit; with inductance the one after dt, implicit in I.
// others_A: what flows in the other motors of a shared lead.
double drive_current(const DriveParameters &parameters, const WheelEffects &effects, const DriveState &state, double duty, double supply_V,
                     double dt_s, double others_A = 0);

// Advances by dt under the current in `state` and the traction torque R*Ft [N m] that brakes the wheel.
DriveWork drive_step(const DriveParameters &parameters, const WheelEffects &effects, DriveState &state, double traction_torque_Nm,
                     double dt_s);

// ---- inline: what every motor of every step calls
namespace detail {

inline double torque_constant(const DriveParameters &p, const WheelEffects &e, const DriveState &s) {
    return motor_constant(p.torque_constant_Nm_A, e, s.heat_K);
}

// What friction takes at the most, the Coulomb-like part of Gr >= 0.
inline double dry_friction(const DriveParameters &p, const WheelEffects &e, double speed_rad_s, double angle_rad, double load_Nm,
                           double since_s) {
    return std::max(dry_friction_Nm(p.coulomb_Nm, e, speed_rad_s, load_Nm, since_s) + periodic_Nm(e, angle_rad, true), 0.0);
}

// One mass under a torque, viscous friction and Coulomb friction, both implicit. Returns the energy friction took.
inline double advance(double &speed_rad_s, double inertia, double torque_Nm, double viscous_Nms, double dry_Nm, double dt_s) {
    const double before = speed_rad_s;
    const double free = (before + dt_s * torque_Nm / inertia) / (1 + dt_s * viscous_Nms / inertia);
    const double most = dt_s * dry_Nm / inertia / (1 + dt_s * viscous_Nms / inertia);
    const double taken = std::clamp(free, -most, most);
    speed_rad_s = free - taken;
    const double mean = 0.5 * (before + speed_rad_s);
    return (torque_Nm * dt_s - inertia * (speed_rad_s - before)) * mean; // what did not become momentum
}
} // namespace detail

inline double drive_current(const DriveParameters &p, const WheelEffects &e, const DriveState &s, double duty, double supply_V, double dt_s,
                            double others_A) {
    double drop = duty * supply_V - detail::torque_constant(p, e, s) * s.motor_speed_rad_s;
    if (e.shared_ohm != 0) drop -= law::shared_lead_V(e.shared_ohm, others_A);
    const double left = std::copysign(std::fabs(drop - law::bridge_dead_time_V(e.dead_voltage_V, drop)), drop);
    const double ohm = circuit_ohm(law::hot_resistance_ohm(p.resistance_ohm, s.heat_K), e);
    double current = left / ohm;
    if (p.inductance_H > 0) { // L dI/dt = u - ke w - R I
        const double h = dt_s / p.inductance_H;
        current = (s.current_A + h * left) / (1 + h * ohm);
    }
    return std::clamp(current, -p.current_limit_A, p.current_limit_A);
}

inline DriveWork drive_step(const DriveParameters &p, const WheelEffects &e, DriveState &s, double traction_torque_Nm, double dt_s) {
    const double motor_torque = detail::torque_constant(p, e, s) * s.current_A;
    const double viscous = viscous_friction_Nm(p.viscous_Nms, e, 1); // it is linear: its slope, for the implicit step
    DriveWork work;
    if (e.play_rad <= 0) {
        const double before = s.wheel_speed_rad_s;
        const double torque = motor_torque - traction_torque_Nm - periodic_Nm(e, s.wheel_angle_rad, false);
        work.friction = detail::advance(s.wheel_speed_rad_s, p.inertia_kg_m2, torque, viscous,
                                        detail::dry_friction(p, e, before, s.wheel_angle_rad, traction_torque_Nm, s.since_s), dt_s);
        const double mean = 0.5 * (before + s.wheel_speed_rad_s);
        work.motor = motor_torque * mean * dt_s;
        s.wheel_angle_rad += dt_s * s.wheel_speed_rad_s;
        s.motor_speed_rad_s = s.wheel_speed_rad_s;
        s.motor_angle_rad = s.wheel_angle_rad;
    } else {
        constexpr int substeps = 8; // the teeth ring at about 45 Hz with the wheel: 0.125 ms resolves it
        const double h = dt_s / substeps;
        const double rotor_inertia = p.inertia_kg_m2 - p.wheel_inertia_kg_m2;
        for (int k = 0; k < substeps; ++k) {
            const double mesh = law::backlash_Nm(e.play_rad, p.gear_stiffness_Nm_rad, p.gear_damping_Nms_rad,
                                                 s.motor_angle_rad - s.wheel_angle_rad, s.motor_speed_rad_s - s.wheel_speed_rad_s);
            const double before = s.motor_speed_rad_s;
            work.friction +=
                detail::advance(s.motor_speed_rad_s, rotor_inertia, motor_torque - mesh - periodic_Nm(e, s.motor_angle_rad, false), viscous,
                                detail::dry_friction(p, e, before, s.motor_angle_rad, mesh, s.since_s), h);
            work.motor += motor_torque * 0.5 * (before + s.motor_speed_rad_s) * h;
            s.wheel_speed_rad_s += h * (mesh - traction_torque_Nm) / p.wheel_inertia_kg_m2;
            s.motor_angle_rad += h * s.motor_speed_rad_s;
            s.wheel_angle_rad += h * s.wheel_speed_rad_s;
        }
    }
    s.since_s += dt_s;
    // with the cold resistance, as the catalogue states it
    s.heat_K += dt_s * (heating_gap_K(e, s.current_A, p.resistance_ohm, s.heat_K) / e.heating_time_s);
    return work;
}

} // namespace traction::sim
