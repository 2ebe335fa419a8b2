#include "contact.h"

#include <algorithm>
#include <cmath>

namespace traction::sim {

ContactForce contact_step(const ContactInput &in, ContactState &state, double dt_s) {
    const double speed = std::max(std::fabs(in.rim_m_s), std::fabs(in.along_m_s));
    const double before = state.slip, side_before = state.side_slip;
    const double share = dt_s / in.relaxation_m;
    state.slip = (before + share * (in.rim_m_s - in.along_m_s)) / (1 + share * speed);
    state.side_slip = (side_before - share * in.across_m_s) / (1 + share * speed);
    // beyond full sliding the state carries no more force: let it not wind up at rest
    const double full = 8 * in.shear_slip + 2;
    state.slip = std::clamp(state.slip, -full, full);
    state.side_slip = std::clamp(state.side_slip, -full, full);

    const double total = std::sqrt(state.slip * state.slip + state.side_slip * state.side_slip);
    ContactForce force;
    if (in.grip_N <= 0) return force;
    if (total > 0) {
        const double size = in.grip_N * traction_share(in.law, total, in.shear_slip) / total;
        force.along_N = size * state.slip;
        force.across_N = size * state.side_slip;
    }
    constexpr double fade_m_s = 0.2, damping_ratio = 0.3; // assumed: quick settling without a force of its own when rolling
    const double near_rest = std::max(0.0, 1 - speed / fade_m_s);
    if (near_rest > 0) {
        const double slope = in.grip_N / in.shear_slip * (in.law == TractionLaw::janosi ? 0.5 : 1.0); // dF/ds at s = 0
        const double damping = 2 * damping_ratio * std::sqrt(slope / in.relaxation_m * in.load_kg) * near_rest * near_rest;
        const double rate = in.relaxation_m / dt_s;
        force.along_N += damping * rate * (state.slip - before);
        force.across_N += damping * rate * (state.side_slip - side_before);
        const double size = std::sqrt(force.along_N * force.along_N + force.across_N * force.across_N);
        if (size > in.grip_N) {
            force.along_N *= in.grip_N / size;
            force.across_N *= in.grip_N / size;
        }
    }
    return force;
}

} // namespace traction::sim
