// contact.h - the force between one wheel and the ground: a slip state with relaxation length, longitudinal and lateral.
//
//   sigma ds/dt  = (R*w - v)  - U*s,   U = max(|R*w|, |v|)        implicit in s; steady: s of (1) Lhomme-Desages  (1)
//   sigma dsy/dt = -vy        - U*sy                                                                          (2)
//   (Ft, Fy) = f(S)/S (Fm s, Fym sy), S = |(s, sy)|, + c*sigma*(ds/dt, dsy/dt) faded out above 0.2 m/s; the whole
//   inside the friction ellipse (Ft/Fm)^2 + (Fy/Fym)^2 <= 1                                                   (3)
//   as U falls below 5 cm/s, what S has beyond 0.2 sc goes with (U + 1 mm/s): the ground keeps its shear when a wheel stops     (4)
// f is (20) or (21), or a given traction (contact integral). Steady slip is that of (1) Lhomme-Desages; at rest the state is a
// spring that holds the rover on a slope. With U = |v| alone the driving slip would be wrong. The damping acts on the change of
// slip, so steady slip keeps its law. (4): a sliding wheel's S is a ratio of speeds, at rest it is the stretch of a spring; soil and tyre
// give back a small part of it (assumed), else locked wheels would throw the rover back by sigma S.
// Force and combined slip point the same way: turning weakens the pull.
// Derived here; the relaxation equation is that of Pacejka's single contact point.
#pragma once

#include "sim/physics/ground.h"

namespace traction::sim {

struct ContactInput {
    TractionLaw law = TractionLaw::janosi;
    double grip_N = 0;           // Fm >= 0
    double shear_slip = 1;       // sc > 0
    double relaxation_m = 0.005; // sigma > 0
    double rim_m_s = 0;          // R*w
    double along_m_s = 0;        // v, along the wheel's heading
    double across_m_s = 0;       // along body y
    double side_ratio = 1;       // Fym/Fm, the friction ellipse's other axis
    double load_kg = 0.7;        // mass that hangs on this contact, for the damping
};

struct ContactState {
    double slip = 0, side_slip = 0;
    double speed_m_s = 0;     // U of the last step
    double rolling = 0;       // -1..1: share of the resistance to rolling, rolling_step
    double rolling_aside = 0; // of a caster's, to the left: drag_step
};

struct SlipChange { // over one step
    double along = 0, across = 0;
};

struct ContactForce {
    double along_N = 0, across_N = 0; // on the rover
};

// (1), (2): advances the slip state by dt. Grip and law are not used, shear_slip only bounds the state.
SlipChange slip_step(const ContactInput &input, ContactState &state, double dt_s);

// |(s, sy)|.
double total_slip(const ContactState &state);

// (3): `traction_N` >= 0 is what the ground gives at the total slip. Any input is accepted; grip 0 gives no force.
ContactForce contact_force(const ContactInput &input, const ContactState &state, const SlipChange &change, double traction_N, double dt_s);

// Resistance to rolling as a spring of 0.2 mm that gives way (Dahl 1968): dx/dt = (v - |v| x)/0.2 mm, implicit in x. At rest it holds,
// rolling it is full; no speed below which it fades. Returns x with the damping of a rover that stands on it, within -1..1.
double rolling_step(ContactState &state, double along_m_s, double resistance_N, double load_kg, double dt_s);

// The same for a ball that rolls any way: x is a vector within the unit circle, dx/dt = (v - |v| x)/0.2 mm. Returns the shares of the
// resistance that act ahead and to the left.
struct RollingShare {
    double along = 0, across = 0;
};
RollingShare drag_step(ContactState &state, double along_m_s, double across_m_s, double resistance_N, double load_kg, double dt_s);

// Both, with the traction of (20) or (21).
ContactForce contact_step(const ContactInput &input, ContactState &state, double dt_s);

} // namespace traction::sim
