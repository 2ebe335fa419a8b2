// math.h - exp, log, sin, cos, tan, pow, atan2 and asin whose bits do not change with the CPU or its C library.
//
// libm picks an implementation by the CPU at run time, and so changes last bits between machines; these are polynomials in plain
// multiplications and additions (built with -ffp-contract=off). Branch-free where a loop over nodes should become vector code.
//   exp(x) = 2^k * exp(r),  k = round(x/ln 2), |r| <= ln(2)/2, Taylor to r^12: remainder 0.3466^13/13! = 1.7e-16            (1)
//   sin, cos: x - k*pi/2 in three parts, Taylor to 17th and 16th power on |r| <= pi/4: remainder < 1e-17; |x| < 1e6           (2)
//   log(m*2^e) = e*ln 2 + 2*atanh((m-1)/(m+1)), m in [sqrt 1/2, sqrt 2], series to the 21st power: remainder 1e-19           (3)
//   atan: |t| <= tan(pi/8) after one reduction, series to the 39th power: remainder 5e-18                                    (4)
// Accuracy: a few units in the last place (tests/plant/math_test.cpp). Derived here.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace traction::sim::math {

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double ln2 = 0.69314718055994530942;

// x is clamped to [-700, 700]: no infinity, no denormal.
inline double exp(double x) {
    x = x > 700 ? 700 : x;
    x = x < -700 ? -700 : x;
    constexpr double round_by = 6755399441055744.0; // 1.5 * 2^52: adding it rounds to an integer held in the low bits
    const double shifted = x * 1.4426950408889634074 + round_by;
    const double k = shifted - round_by;
    const double r = (x - k * 0.693147180369123816490) - k * 1.90821492927058770002e-10; // ln 2 in two parts
    const double r2 = r * r, r4 = r2 * r2;
    const double a = 1 + r, b = 1.0 / 2 + r * (1.0 / 6), c = 1.0 / 24 + r * (1.0 / 120), d = 1.0 / 720 + r * (1.0 / 5040);
    const double e = 1.0 / 40320 + r * (1.0 / 362880), f = 1.0 / 3628800 + r * (1.0 / 39916800), g = 1.0 / 479001600;
    const double p = (a + r2 * b) + r4 * ((c + r2 * d) + r4 * ((e + r2 * f) + r4 * g));
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(shifted) << 52; // k, moved into the exponent; the rest shifts out
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(p) + bits);
}

// x > 0 and normal; anything else gives the logarithm of the smallest normal number.
inline double log(double x) {
    x = x >= 2.2250738585072014e-308 ? x : 2.2250738585072014e-308;
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t offset = 0x3fe6a09e667f3bcdu;                                 // sqrt(1/2)
    const std::uint64_t biased = (bits - offset + (std::uint64_t{1023} << 52)) >> 52; // e + 1023: unsigned shifts exist as vectors
    const double m = std::bit_cast<double>(bits - ((biased - 1023) << 52));
    const double e = std::bit_cast<double>(biased | 0x4330000000000000u) - (4503599627370496.0 + 1023); // integer to double by 2^52
    const double f = (m - 1) / (m + 1), q = f * f;
    const double s =
        1 + q * (1.0 / 3 +
                 q * (1.0 / 5 +
                      q * (1.0 / 7 +
                           q * (1.0 / 9 +
                                q * (1.0 / 11 + q * (1.0 / 13 + q * (1.0 / 15 + q * (1.0 / 17 + q * (1.0 / 19 + q * (1.0 / 21))))))))));
    return e * ln2 + 2 * f * s;
}

// x >= 0; 0^y is taken as (smallest normal)^y, that is 0 for the powers of soil mechanics.
inline double pow(double x, double y) { return exp(y * log(x)); }

namespace detail {
inline double sine(double r) {
    const double q = r * r;
    return r + r * q *
                   (-1.0 / 6 +
                    q * (1.0 / 120 +
                         q * (-1.0 / 5040 + q * (1.0 / 362880 +
                                                 q * (-1.0 / 39916800 + q * (1.0 / 6227020800.0 + q * (-1.0 / 1307674368000.0 +
                                                                                                       q * (1.0 / 355687428096000.0))))))));
}
inline double cosine(double r) {
    const double q = r * r;
    return 1 + q * (-1.0 / 2 +
                    q * (1.0 / 24 +
                         q * (-1.0 / 720 +
                              q * (1.0 / 40320 + q * (-1.0 / 3628800 + q * (1.0 / 479001600 +
                                                                            q * (-1.0 / 87178291200.0 + q * (1.0 / 20922789888000.0))))))));
}
// (4) over t, q = -t^2. Terms below 2^-80 of the sum are left out: they change no bit but once in 1e8 calls.
template <int last> inline double atan_terms(double q) {
    double sum = 1.0 / last;
#pragma GCC unroll 20
    for (int n = last - 2; n >= 1; n -= 2) sum = 1.0 / n + q * sum;
    return sum;
}
inline double atan_series(double q) {
    if (q > -0x1p-20) return atan_terms<7>(q);
    return q > -0x1p-10 ? atan_terms<15>(q) : atan_terms<39>(q);
}
inline double reduce(double x, std::int64_t &quadrant) {
    const double k = std::floor(x * 0.63661977236758134308 + 0.5);
    quadrant = static_cast<std::int64_t>(k) & 3;
    return ((x - k * 1.57079632673412561417) - k * 6.07710050630396597660e-11) - k * 2.02226624879595063154e-21;
}
} // namespace detail

inline double sin(double x) {
    std::int64_t quadrant = 0;
    const double r = detail::reduce(x, quadrant);
    const double value = (quadrant & 1) != 0 ? detail::cosine(r) : detail::sine(r);
    return (quadrant & 2) != 0 ? -value : value;
}

inline double cos(double x) {
    std::int64_t quadrant = 0;
    const double r = detail::reduce(x, quadrant);
    const double value = (quadrant & 1) != 0 ? detail::sine(r) : detail::cosine(r);
    return quadrant == 1 || quadrant == 2 ? -value : value;
}

inline double tan(double x) { return sin(x) / cos(x); }

// atan2(0, 0) = 0.
inline double atan2(double y, double x) {
    const double ay = std::fabs(y), ax = std::fabs(x);
    const double small = ay < ax ? ay : ax, large = ay < ax ? ax : ay;
    if (!(large > 0)) return 0;
    double t = small / large, base = 0;
    if (t > 0.41421356237309504880) {
        t = (t - 1) / (t + 1);
        base = pi / 4;
    }
    const double angle_of_t = t * detail::atan_series(-t * t);
    double angle = base + angle_of_t;
    if (ay > ax) angle = pi / 2 - angle;
    if (x < 0) angle = pi - angle;
    return y < 0 ? -angle : angle;
}

inline double asin(double x) {
    x = x > 1 ? 1 : x < -1 ? -1 : x;
    return atan2(x, std::sqrt((1 - x) * (1 + x)));
}

} // namespace traction::sim::math
