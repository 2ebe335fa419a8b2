#include "contact.h"

#include <algorithm>
#include <cmath>

namespace traction::sim {

namespace {
constexpr double stretch_m = 2e-4, rolling_damping = 0.3; // assumed: below any sensor's resolution; as in contact_force
double faster(const ContactInput &in) { return std::max(std::fabs(in.rim_m_s), std::fabs(in.along_m_s)); }
} // namespace

SlipChange slip_step(const ContactInput &in, ContactState &state, double dt_s) {
    constexpr double fast_m_s = 0.05, slow_m_s = 0.001, springy = 0.2; // (4), assumed
    const double speed = faster(in), total = total_slip(state), kept = springy * in.shear_slip;
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

double total_slip(const ContactState &state) { return std::sqrt(state.slip * state.slip + state.side_slip * state.side_slip); }

ContactForce contact_force(const ContactInput &in, const ContactState &state, const SlipChange &change, double traction_N, double dt_s) {
    ContactForce force;
    if (in.grip_N <= 0) return force;
    const double total = total_slip(state);
    if (total > 0) {
        const double size = traction_N / total;
        force.along_N = size * state.slip;
        force.across_N = size * state.side_slip;
    }
    constexpr double fade_m_s = 0.2, damping_ratio = 0.3; // assumed: quick settling without a force of its own when rolling
    const double near_rest = 1 - faster(in) / fade_m_s;
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

double rolling_step(ContactState &state, double along_m_s, double resistance_N, double load_kg, double dt_s) {
    const double before = state.rolling, share = dt_s / stretch_m;
    state.rolling = std::clamp((before + share * along_m_s) / (1 + share * std::fabs(along_m_s)), -1.0, 1.0);
    if (resistance_N <= 0) return state.rolling;
    const double damping = 2 * rolling_damping * std::sqrt(resistance_N / stretch_m * load_kg);
    const double rate_m_s = (state.rolling - before) * stretch_m / dt_s;
    return std::clamp(state.rolling + damping * rate_m_s / resistance_N, -1.0, 1.0);
}

RollingShare drag_step(ContactState &state, double along_m_s, double across_m_s, double resistance_N, double load_kg, double dt_s) {
    const RollingShare before{state.rolling, state.rolling_aside};
    const double share = dt_s / stretch_m, keep = 1 / (1 + share * std::sqrt(along_m_s * along_m_s + across_m_s * across_m_s));
    state.rolling = (before.along + share * along_m_s) * keep, state.rolling_aside = (before.across + share * across_m_s) * keep;
    RollingShare out{state.rolling, state.rolling_aside};
    if (resistance_N > 0) {
        const double damping = 2 * rolling_damping * std::sqrt(resistance_N / stretch_m * load_kg) * stretch_m / dt_s / resistance_N;
        out.along += damping * (state.rolling - before.along), out.across += damping * (state.rolling_aside - before.across);
    }
    const double size = std::sqrt(out.along * out.along + out.across * out.across);
    if (size > 1) out.along /= size, out.across /= size;
    return out;
}

ContactForce contact_step(const ContactInput &in, ContactState &state, double dt_s) {
    const SlipChange change = slip_step(in, state, dt_s);
    const double traction_N = in.grip_N * traction_share(in.law, total_slip(state), in.shear_slip);
    return contact_force(in, state, change, traction_N, dt_s);
}

} // namespace traction::sim
