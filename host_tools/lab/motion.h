// motion.h - the body's speed from the model's forces, the wheels' speeds being given: (1) of forward.h.
#pragma once

#include "forward.h"

#include <algorithm>
#include <cmath>

namespace traction::lab {

// Integrates over the whole grid. `guess`: a nearby trajectory that starts the root search, or nullptr; with its inverse
// Jacobians the search is a chord iteration, two evaluations a step. `keep`: store the inverse Jacobians.
void integrate(const Dataset &data, const Physics &physics, Motion &motion, const Motion *guess, bool keep);

// Slip (1) Lhomme-Desages, extended: bounded by 1, odd, 0 at rest. rim = R w.
inline double slip_of(double rim, double v) {
    const double larger = std::max(std::fabs(rim), std::fabs(v));
    if (larger < 1e-4) return (rim - v) / 1e-4; // continuous through rest
    const double s = (rim - v) / larger;
    return s > 1 ? 1 : s < -1 ? -1 : s;
}

// Ft / Fm at slip s: (20) janosi or (21) burckhardt, odd.
double traction_shape(SoilLaw law, double s, double sc);

// x / sqrt(x^2 + e^2): sign without the jump.
inline double soft_sign(double x, double e) { return x / std::sqrt(x * x + e * e); }

} // namespace traction::lab
