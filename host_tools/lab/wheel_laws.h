// wheel_laws.h - what the ground does to a wheel at a given slip and speed, for one wheel (double) or four side by side (Lane).
//
//   s = (R w - v) / max(|R w|, |v|)                 slip (1) Lhomme-Desages, extended: bounded by 1, odd, 0 at rest        (1)
//   s = (s' + h (R w - v)) / (1 + h max(|R w|, |v|))  where it lags, h = step over relaxation length                       (2)
//   Ft / Fm = 1 - (1 - exp(-x)) / x, x = |s| / sc   (20) janosi;  1 - exp(-x)  (21) burckhardt                             (3)
#pragma once

#include "model.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace traction::lab {

using Lane = Eigen::Array<double, 4, 1>;

inline constexpr double rest_speed_m_s = 0.01; // below it slip is taken against this speed: no encoder tells it there, and the soil
                                               // would be too stiff for any step; assumed

namespace law {

inline double magnitude(double x) { return std::fabs(x); }
inline Lane magnitude(const Lane &x) { return x.abs(); }
inline double larger(double a, double b) { return std::max(a, b); }
inline Lane larger(const Lane &a, const Lane &b) { return a.max(b); }
inline Lane larger(const Lane &a, double b) { return a.max(b); }
inline double within(double x, double low, double high) { return std::clamp(x, low, high); }
inline Lane within(const Lane &x, double low, double high) { return x.max(low).min(high); }
inline double root(double x) { return std::sqrt(x); }
inline Lane root(const Lane &x) { return x.sqrt(); }
inline double falling(double x) { return std::exp(-x); }
inline Lane falling(const Lane &x) { return (-x).exp(); }
inline double where_below(double x, double limit, double below, double above) { return x < limit ? below : above; }
inline Lane where_below(const Lane &x, double limit, const Lane &below, const Lane &above) { return (x < limit).select(below, above); }

} // namespace law

// x / sqrt(x^2 + e^2): sign without the jump.
template <typename T> T soft_sign(const T &x, double e) { return x / law::root(T(x * x + e * e)); }

// (1), rim = R w.
template <typename T> T plain_slip(const T &rim, const T &v) {
    return law::within(T((rim - v) / law::larger(law::larger(law::magnitude(rim), law::magnitude(v)), rest_speed_m_s)), -1, 1);
}

inline double slip_of(double rim, double v) { return plain_slip(rim, v); }
inline Lane slip_of(const Lane &rim, const Lane &v) { return plain_slip(rim, v); }

// (2); h_1_m: 0 where it does not lag.
template <typename T> T lagging_slip(const T &slip_before, const T &h_1_m, const T &rim, const T &v) {
    return law::within(T((slip_before + h_1_m * (rim - v)) / (1 + h_1_m * law::larger(law::magnitude(rim), law::magnitude(v)))), -1, 1);
}

// (3) at the size of the slip; near zero a series, where the quotient loses digits.
template <typename T> T traction_shape(SoilLaw soil, const T &slip_size, const T &sc) {
    const T x = slip_size / sc, left = law::falling(x);
    if (soil == SoilLaw::burckhardt) return 1 - left;
    return law::where_below(x, 1e-4, T(0.5 * x), T(1 - (1 - left) / law::larger(x, T(x * 0 + 1e-300))));
}

} // namespace traction::lab
