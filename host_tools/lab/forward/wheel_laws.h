// wheel_laws.h - what the ground does to a wheel at a given slip and speed, for one wheel (double) or four side by side (Lane).
//
//   s = (R w - v) / max(|R w|, |v|)                 slip (1) Lhomme-Desages, extended: bounded by 1, odd, 0 at rest        (1)
//   s = (s' + h (R w - v)) / (1 + h g)              where it lags, h of the step over the relaxation length L:             (2)
//                                                    s' = s_1 + (b/3)(s_1 - s_2), h = (1 - b/3) step/L
//   b = 1 / (1 + (k step^2/L)^2), k = gravity mu/sc, half of it (20)     BDF2 where the steps resolve the swing on the slip, (7)
//                                                    sqrt(k/L), backward Euler where they do not
//   g = m + r r^4/(m^4 + r^4),  m = max(|R w|, |v|),  r = 15 mm/s: at rest it is worn off (assumed)                       (5)
//   sy = (sy' - h vy) / (1 + h g),  -vy / max(|R w|, |v|) where it does not lag              sideways     (4)
//   Ft / Fm = 1 - (1 - exp(-x)) / x, x = |s| / sc   (20) janosi;  1 - exp(-x)  (21) burckhardt                             (3)
//   Ft / Fm times 1 + c x^2 exp(-x)                         a ground whose knee is not the law's, stiffness and strength the law's  (6)
#pragma once

#include "host_tools/lab/model/model.h"
#include "lane.h"

#include "sim/physics/effects/acting.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace traction::lab {

inline constexpr double rest_speed_m_s = 0.01; // below it slip is taken against this speed: no encoder tells it there, and the soil
                                               // would be too stiff for any step; assumed

inline constexpr double most_side_slip = 4; // a lagging one stays within: beyond it the ground slides whatever it is

namespace law {

inline double magnitude(double x) { return std::fabs(x); }
TRACTION_LANE_INLINE Lane magnitude(const Lane &x) { return abs(x); }
inline double larger(double a, double b) { return std::max(a, b); }
TRACTION_LANE_INLINE Lane larger(const Lane &a, const Lane &b) { return larger_of(a, b); }
TRACTION_LANE_INLINE Lane larger(const Lane &a, double b) { return larger_of(a, Lane(b)); }
inline double within(double x, double low, double high) { return std::clamp(x, low, high); }
TRACTION_LANE_INLINE Lane within(const Lane &x, double low, double high) { return smaller_of(larger_of(x, Lane(low)), Lane(high)); }
inline double root(double x) { return std::sqrt(x); }
TRACTION_LANE_INLINE Lane root(const Lane &x) { return sqrt(x); }
inline double falling(double x) { return std::exp(-x); }
TRACTION_LANE_INLINE Lane falling(const Lane &x) { return lab::exp(-x); }
// By sc, of which four wheels side by side carry the inverse: a division for each would cost.
inline double by(double x, double sc) { return x / sc; }
TRACTION_LANE_INLINE Lane by(const Lane &x, const Lane &per_sc) { return x * per_sc; }

// What the effects' laws take theirs from (sim/physics/effects/laws.h): a fit need not repeat on another machine, it must be fast.
struct Library {
    static double exp(double x) { return std::exp(x); }
    static double sin(double x) { return std::sin(x); }
    static double cos(double x) { return std::cos(x); }
    static Lane exp(const Lane &x) { return lab::exp(x); }
};

} // namespace law

// x / sqrt(x^2 + e^2): sign without the jump.
template <typename T> inline T soft_sign(const T &x, double e) { return x / law::root(T(x * x + e * e)); }

// x / (x^4 + e^4)^(1/4): the same, within 2 % of its ends from 2 e on.
template <typename T> inline T reversing(const T &x, const T &e4) {
    const T x2 = x * x;
    return x / law::root(T(law::root(T(x2 * x2 + e4))));
}

// (1), rim = R w.
template <typename T> inline T plain_slip(const T &rim, const T &v) {
    return law::within(T((rim - v) / law::larger(law::larger(law::magnitude(rim), law::magnitude(v)), rest_speed_m_s)), -1, 1);
}

inline double slip_of(double rim, double v) { return plain_slip(rim, v); }
TRACTION_LANE_INLINE Lane slip_of(const Lane &rim, const Lane &v) { return plain_slip(rim, v); }

// (5), the speed at which a slip is worn off: at rest it is not kept, for the tyres turn what stands on them until nothing pulls any more,
// which the measured yaw rate does not resolve. Below 15 mm/s alone (assumed): a wheel at 5 cm/s loses 0.24 % of its slip by it.
template <typename T> inline T wears_m_s(const T &rim, const T &v) {
    constexpr double rest_m_s = 0.015, rest_4 = rest_m_s * rest_m_s * rest_m_s * rest_m_s;
    const T faster = law::larger(law::magnitude(rim), law::magnitude(v)), square = faster * faster;
    return faster + rest_m_s * rest_4 / (square * square + rest_4);
}

// (7). Backward Euler damps what swings at omega by omega^2 step/4, as much as the slip's forgetting does at 0.3 m/s: a relaxation length
// was told up to a third too long. BDF2 rings where it does not resolve the swing.
inline double second_order(double k_m_s2, double step_s, double relaxation_m) {
    const double x = k_m_s2 * step_s * step_s / relaxation_m;
    return 1 / (1 + x * x);
}
// Of (2): the share of a step k that is implicit, and s' of the last slip and the one before.
inline double implicit_share(std::size_t k, double b) { return k < 2 ? 1.0 : 1 - b / 3; }
template <typename T> inline T remembered(std::size_t k, double b, const T &last, const T &before) {
    return k < 2 ? last : T(last + (b / 3) * (last - before));
}

// (2); h_1_m: 0 where it does not lag.
template <typename T> inline T lagging_slip(const T &slip_before, const T &h_1_m, const T &rim, const T &v) {
    return law::within(T((slip_before + h_1_m * (rim - v)) / (1 + h_1_m * wears_m_s(rim, v))), -1, 1);
}

// (4), of a wheel centre that moves sideways at vy, where it lags ...
template <typename T> inline T side_slip(const T &side_before, const T &h_1_m, const T &rim, const T &v, const T &vy) {
    return law::within(T((side_before - h_1_m * vy) / (1 + h_1_m * wears_m_s(rim, v))), -most_side_slip, most_side_slip);
}
// ... and where it does not: against least_m_s at least.
template <typename T> inline T side_slip(const T &rim, const T &v, const T &vy, double least_m_s) {
    return -vy / law::larger(law::larger(law::magnitude(rim), law::magnitude(v)), least_m_s);
}

// (3) with (6) over x, for x > 0; constant below 1e-4, where the quotient would lose digits and the curve is straight.
template <typename T> inline T traction_slope(SoilLaw soil, const T &size, const T &curve) {
    const T x = law::larger(size, 1e-4), per_x = 1 / x, falling = law::falling(x), risen = 1 - falling;
    return (soil == SoilLaw::burckhardt ? T(risen * per_x) : T((1 - risen * per_x) * per_x)) * (1 + curve * x * x * falling);
}

// What a wheel pulls along its heading and across it at slips s, sy. Combined slip S = |(s, sy)|, (Ft, Fy) = f(S)/S (Fm s, Fym sy) inside
// the friction ellipse, Fym = share Fm (Pacejka's similarity). Where the body is not followed sideways its sideways speed is only
// presumed, and `share` is the part of it that slides: S = |(s, share sy)|.
template <typename T> struct Grip { T traction, side; };
template <typename T>
inline Grip<T> grip_of(SoilLaw soil, const T &Fm, const T &sc, const T &curve, const T &slip, const T &side_slip, const T &share,
                       bool followed) {
    const T across = share * side_slip, side = followed ? side_slip : across;
    const T grip = T(law::by(Fm, sc)) * traction_slope(soil, T(law::by(T(law::root(T(slip * slip + side * side))), sc)), curve);
    return {T(grip * slip), T(grip * across)};
}

} // namespace traction::lab
