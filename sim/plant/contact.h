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

#include <algorithm>
#include <cmath>

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

// ---- inline: what every wheel of every step calls
namespace detail {
inline constexpr double stretch_m = 2e-4, rolling_damping = 0.3; // assumed: below any sensor's resolution; as in contact_force
inline double faster(const ContactInput &in) { return std::max(std::fabs(in.rim_m_s), std::fabs(in.along_m_s)); }
} // namespace detail

inline double total_slip(const ContactState &state) { return std::sqrt(state.slip * state.slip + state.side_slip * state.side_slip); }

inline SlipChange slip_step(const ContactInput &in, ContactState &state, double dt_s) {
    constexpr double fast_m_s = 0.05, slow_m_s = 0.001, springy = 0.2; // (4), assumed
    const double speed = detail::faster(in), total = total_slip(state), kept = springy * in.shear_slip;
    if (speed < state.speed_m_s && speed < fast_m_s && total > kept) { // (4)
        const double share = (speed + slow_m_s) / (std::min(state.speed_m_s, fast_m_s) + slow_m_s);
        const double scale = (kept + (total - kept) * share) / total;
        state.slip *= scale, state.side_slip *= scale;
    }
    state.speed_m_s = speed;
    const double before = state.slip, side_before = state.side_slip;
    const double share = dt_s / in.relaxation_m, keep = 1 / (1 + share * speed);
    // beyond full sliding the state carries no more force: let it not wind up at rest
    const double full = 8 * in.shear_slip + 2;
    state.slip = std::clamp((before + share * (in.rim_m_s - in.along_m_s)) * keep, -full, full);
    state.side_slip = std::clamp((side_before - share * in.across_m_s) * keep, -full, full);
    return {state.slip - before, state.side_slip - side_before};
}

inline ContactForce contact_force(const ContactInput &in, const ContactState &state, const SlipChange &change, double traction_N,
                                  double dt_s) {
    ContactForce force;
    if (in.grip_N <= 0) return force;
    const double total = total_slip(state);
    if (total > 0) {
        const double size = traction_N / total;
        force.along_N = size * state.slip;
        force.across_N = size * state.side_slip;
    }
    constexpr double fade_m_s = 0.2, damping_ratio = 0.3; // assumed: quick settling without a force of its own when rolling
    const double near_rest = 1 - detail::faster(in) / fade_m_s;
    if (near_rest > 0) {
        const double slope = in.grip_N / in.shear_slip * (in.law == TractionLaw::janosi ? 0.5 : 1.0); // dF/ds at s = 0
        const double damping = 2 * damping_ratio * std::sqrt(slope / in.relaxation_m * in.load_kg) * near_rest * near_rest;
        const double rate = in.relaxation_m / dt_s;
        force.along_N += damping * rate * change.along;
        force.across_N += damping * rate * change.across;
        const double size = std::sqrt(force.along_N * force.along_N + force.across_N * force.across_N);
        if (size > in.grip_N) {
            force.along_N *= in.grip_N / size;
            force.across_N *= in.grip_N / size;
        }
    }
    force.across_N *= in.side_ratio;
    return force;
}

inline double rolling_step(ContactState &state, double along_m_s, double resistance_N, double load_kg, double dt_s) {
    const double before = state.rolling, share = dt_s / detail::stretch_m;
    state.rolling = std::clamp((before + share * along_m_s) / (1 + share * std::fabs(along_m_s)), -1.0, 1.0);
    if (resistance_N <= 0) return state.rolling;
    const double damping = 2 * detail::rolling_damping * std::sqrt(resistance_N / detail::stretch_m * load_kg);
    const double rate_m_s = (state.rolling - before) * detail::stretch_m / dt_s;
    return std::clamp(state.rolling + damping * rate_m_s / resistance_N, -1.0, 1.0);
}

inline ContactForce contact_step(const ContactInput &in, ContactState &state, double dt_s) {
    const SlipChange change = slip_step(in, state, dt_s);
    const double traction_N = in.grip_N * traction_share(in.law, total_slip(state), in.shear_slip);
    return contact_force(in, state, change, traction_N, dt_s);
}

} // namespace traction::sim
