// contact.h - the force between one wheel and the ground: a slip state with relaxation length, longitudinal and lateral.
//
//   sigma ds/dt  = (R*w - v)  - U*s,   U = max(|R*w|, |v|)        implicit in s; steady: s of (1)              (1)
//   sigma dsy/dt = -vy        - U*sy                                                                          (2)
//   F = Fm*f(|(s, sy)|) along (s, sy), + c*sigma*(ds/dt, dsy/dt) faded out above 0.2 m/s, never above Fm       (3)
// f is (20) or (21). Steady slip is that of (1); at rest the state is a spring that holds the rover on a slope. With U = |v| alone
// the driving slip would be wrong. The damping acts on the change of slip, so steady slip keeps its law. Derived here; the
// relaxation equation is that of Pacejka's single contact point.
#pragma once

#include "sim/physics/ground.h"

namespace traction::sim {

struct ContactInput {
    TractionLaw law = TractionLaw::janosi;
    double grip_N = 0;            // Fm >= 0
    double shear_slip = 1;        // sc > 0
    double relaxation_m = 0.005;  // sigma > 0
    double rim_m_s = 0;           // R*w
    double along_m_s = 0;         // v, along the wheel's heading
    double across_m_s = 0;        // along body y
    double load_kg = 0.7;         // mass that hangs on this contact, for the damping
};

struct ContactState {
    double slip = 0, side_slip = 0;
};

struct ContactForce {
    double along_N = 0, across_N = 0; // on the rover
};

// Advances the slip state by dt and gives the force. Any input is accepted; grip 0 gives no force.
ContactForce contact_step(const ContactInput &input, ContactState &state, double dt_s);

} // namespace traction::sim
