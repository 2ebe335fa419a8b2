#include "contact.h"

#include <algorithm>
#include <cmath>

namespace traction::sim {

// What every wheel of every step calls stands in contact.h, inline.

RollingShare drag_step(ContactState &state, double along_m_s, double across_m_s, double resistance_N, double load_kg, double dt_s) {
    const RollingShare before{state.rolling, state.rolling_aside};
    const double share = dt_s / detail::stretch_m, keep = 1 / (1 + share * std::sqrt(along_m_s * along_m_s + across_m_s * across_m_s));
    state.rolling = (before.along + share * along_m_s) * keep, state.rolling_aside = (before.across + share * across_m_s) * keep;
    RollingShare out{state.rolling, state.rolling_aside};
    if (resistance_N > 0) {
        const double damping =
            2 * detail::rolling_damping * std::sqrt(resistance_N / detail::stretch_m * load_kg) * detail::stretch_m / dt_s / resistance_N;
        out.along += damping * (state.rolling - before.along), out.across += damping * (state.rolling_aside - before.across);
    }
    const double size = std::sqrt(out.along * out.along + out.across * out.across);
    if (size > 1) out.along /= size, out.across /= size;
    return out;
}

} // namespace traction::sim
