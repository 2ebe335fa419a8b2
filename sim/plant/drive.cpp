#include "drive.h"

#include "sim/physics/math.h"

#include <algorithm>
#include <cmath>

namespace traction::sim {

namespace {

constexpr double copper_1_K = 0.0039; // temperature coefficient of copper's resistance
constexpr double magnet_1_K = 0.002;  // of a ferrite magnet's flux, negative

double torque_constant(const DriveParameters &p, const DriveEffects &e, const DriveState &s) {
    return p.torque_constant_Nm_A * (1 + e.constant_change) * (1 - magnet_1_K * s.heat_K);
}

double resistance(const DriveParameters &p, const DriveEffects &e, const DriveState &s) {
    return p.resistance_ohm * (1 + copper_1_K * s.heat_K) + e.wiring_ohm;
}

// Coulomb-like part of Gr at this speed, >= 0: what friction takes at the most.
double dry_friction(const DriveParameters &p, const DriveEffects &e, double speed_rad_s, double load_Nm) {
    double torque = p.coulomb_Nm + e.coulomb_Nm + e.mesh_fraction * std::fabs(load_Nm);
    if (e.stribeck_Nm != 0) {
        const double ratio = speed_rad_s / e.stribeck_speed_rad_s;
        torque += e.stribeck_Nm * math::exp(-ratio * ratio);
    }
    return std::max(torque, 0.0);
}

double ripple(const DriveEffects &e, double angle_rad) {
    if (e.ripple_cos_Nm == 0 && e.ripple_sin_Nm == 0) return 0;
    return e.ripple_cos_Nm * math::cos(e.ripple_order * angle_rad) + e.ripple_sin_Nm * math::sin(e.ripple_order * angle_rad);
}

// One mass under a torque, viscous friction and Coulomb friction, both implicit. Returns the energy friction took.
double advance(double &speed_rad_s, double inertia, double torque_Nm, double viscous_Nms, double dry_Nm, double dt_s) {
    const double before = speed_rad_s;
    const double free = (before + dt_s * torque_Nm / inertia) / (1 + dt_s * viscous_Nms / inertia);
    const double most = dt_s * dry_Nm / inertia / (1 + dt_s * viscous_Nms / inertia);
    const double taken = std::clamp(free, -most, most);
    speed_rad_s = free - taken;
    const double mean = 0.5 * (before + speed_rad_s);
    return (torque_Nm * dt_s - inertia * (speed_rad_s - before)) * mean; // what did not become momentum
}

} // namespace

double drive_current(const DriveParameters &p, const DriveEffects &e, const DriveState &s, double duty, double supply_V) {
    const double drop = duty * supply_V - torque_constant(p, e, s) * s.motor_speed_rad_s;
    // dead time of the bridge: no current until it is overcome
    const double left = std::copysign(std::max(std::fabs(drop) - e.dead_voltage_V, 0.0), drop);
    return left / resistance(p, e, s);
}

DriveWork drive_step(const DriveParameters &p, const DriveEffects &e, DriveState &s, double traction_torque_Nm, double dt_s) {
    const double motor_torque = torque_constant(p, e, s) * s.current_A;
    const double viscous = p.viscous_Nms + e.viscous_Nms;
    DriveWork work;
    if (e.play_rad <= 0) {
        const double before = s.wheel_speed_rad_s;
        const double torque = motor_torque - traction_torque_Nm - ripple(e, s.wheel_angle_rad);
        work.friction = advance(s.wheel_speed_rad_s, p.inertia_kg_m2, torque, viscous,
                                dry_friction(p, e, before, traction_torque_Nm), dt_s);
        const double mean = 0.5 * (before + s.wheel_speed_rad_s);
        work.motor = motor_torque * mean * dt_s;
        s.wheel_angle_rad += dt_s * s.wheel_speed_rad_s;
        s.motor_speed_rad_s = s.wheel_speed_rad_s;
        s.motor_angle_rad = s.wheel_angle_rad;
    } else {
        constexpr int substeps = 8; // the teeth ring at about 45 Hz with the wheel: 0.125 ms resolves it
        const double h = dt_s / substeps;
        const double rotor_inertia = p.inertia_kg_m2 - p.wheel_inertia_kg_m2;
        const double half_play = 0.5 * e.play_rad;
        for (int k = 0; k < substeps; ++k) {
            const double twist = s.motor_angle_rad - s.wheel_angle_rad;
            const double pressed = twist - std::clamp(twist, -half_play, half_play);
            double mesh = 0;
            if (pressed != 0) {
                mesh = p.gear_stiffness_Nm_rad * pressed +
                       p.gear_damping_Nms_rad * (s.motor_speed_rad_s - s.wheel_speed_rad_s);
                mesh = pressed > 0 ? std::max(mesh, 0.0) : std::min(mesh, 0.0); // teeth push, never pull
            }
            const double before = s.motor_speed_rad_s;
            work.friction += advance(s.motor_speed_rad_s, rotor_inertia, motor_torque - mesh - ripple(e, s.motor_angle_rad),
                                     viscous, dry_friction(p, e, before, mesh), h);
            work.motor += motor_torque * 0.5 * (before + s.motor_speed_rad_s) * h;
            s.wheel_speed_rad_s += h * (mesh - traction_torque_Nm) / p.wheel_inertia_kg_m2;
            s.motor_angle_rad += h * s.motor_speed_rad_s;
            s.wheel_angle_rad += h * s.wheel_speed_rad_s;
        }
    }
    if (e.heating_K_W > 0) { // C dT/dt = I^2 Ra - T/Rth, C = time constant / Rth
        const double heating_K_s = s.current_A * s.current_A * p.resistance_ohm * e.heating_K_W;
        s.heat_K += dt_s * (heating_K_s - s.heat_K) / e.heating_time_s;
    }
    return work;
}

} // namespace traction::sim
