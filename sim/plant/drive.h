// drive.h - one wheel's drive train: bridge, winding, gear, friction, wheel spin.
//
//   I = (u - ke*w_m)/Ra, u = duty*V - (losses of the bridge and the wires)                                 (1) docs/sources.md section 3
//   J*dw/dt = KG*I - Gr(w) - R*Ft                                                        (17) Lhomme-Desages
//   Gr(w) = (b*|w| + t0)*sgn(w), Coulomb part implicit: at rest it takes up to t0                          (18)
// With backlash the rotor's share of J and the wheel's are two masses with a dead zone between them.
#pragma once

#include "sim/physics/effects/acting.h"

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

} // namespace traction::sim
