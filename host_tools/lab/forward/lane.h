// lane.h - four numbers side by side, one of each of four wheels: one instruction for all where the processor has one, the same operations
// in the same order, hence the same bits, where it has not (wheel_step.cpp chooses).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace traction::lab {

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi" // a number goes to another function in memory
#define TRACTION_LANE_INLINE [[gnu::always_inline]] inline
#endif

struct Lane {
    using Four = double __attribute__((vector_size(32)));
    using Bits = std::int64_t __attribute__((vector_size(32)));
    Four of;

    Lane() = default;
    // Its own: so that it goes from function to function in memory, whatever vectors either of them was compiled for.
    TRACTION_LANE_INLINE Lane(const Lane &other) : of(other.of) {}
    TRACTION_LANE_INLINE Lane &operator=(const Lane &other) { return of = other.of, *this; }
    TRACTION_LANE_INLINE Lane(const Four &four) : of(four) {}
    TRACTION_LANE_INLINE explicit Lane(double all) : of{all, all, all, all} {}
    TRACTION_LANE_INLINE Lane(double a, double b, double c, double d) : of{a, b, c, d} {}
    TRACTION_LANE_INLINE double operator[](std::size_t i) const { return of[i]; }
    TRACTION_LANE_INLINE void set(std::size_t i, double x) { of[i] = x; }
    TRACTION_LANE_INLINE Lane &operator+=(const Lane &b) { return of += b.of, *this; }
    TRACTION_LANE_INLINE Lane &operator-=(const Lane &b) { return of -= b.of, *this; }
    TRACTION_LANE_INLINE double sum() const { return (of[0] + of[2]) + (of[1] + of[3]); }
};

TRACTION_LANE_INLINE Lane operator-(const Lane &a) { return -a.of; }
TRACTION_LANE_INLINE Lane operator+(const Lane &a, const Lane &b) { return a.of + b.of; }
TRACTION_LANE_INLINE Lane operator-(const Lane &a, const Lane &b) { return a.of - b.of; }
TRACTION_LANE_INLINE Lane operator*(const Lane &a, const Lane &b) { return a.of * b.of; }
TRACTION_LANE_INLINE Lane operator/(const Lane &a, const Lane &b) { return a.of / b.of; }
TRACTION_LANE_INLINE Lane operator+(const Lane &a, double b) { return a.of + b; }
TRACTION_LANE_INLINE Lane operator-(const Lane &a, double b) { return a.of - b; }
TRACTION_LANE_INLINE Lane operator*(const Lane &a, double b) { return a.of * b; }
TRACTION_LANE_INLINE Lane operator+(double a, const Lane &b) { return a + b.of; }
TRACTION_LANE_INLINE Lane operator-(double a, const Lane &b) { return a - b.of; }
TRACTION_LANE_INLINE Lane operator*(double a, const Lane &b) { return a * b.of; }
TRACTION_LANE_INLINE Lane operator/(double a, const Lane &b) { return a / b.of; }

// What is no number stays none in the first place.
TRACTION_LANE_INLINE Lane larger_of(const Lane &a, const Lane &b) { return b.of > a.of ? b.of : a.of; }
TRACTION_LANE_INLINE Lane smaller_of(const Lane &a, const Lane &b) { return b.of < a.of ? b.of : a.of; }
TRACTION_LANE_INLINE Lane abs(const Lane &x) {
    constexpr std::int64_t size = 0x7fffffffffffffff;
    return Lane(__builtin_bit_cast(Lane::Four, __builtin_bit_cast(Lane::Bits, x.of) & Lane::Bits{size, size, size, size}));
}
TRACTION_LANE_INLINE Lane sqrt(const Lane &x) {
#if defined(__SSE2__)
    const __m128d low = _mm_sqrt_pd(_mm_set_pd(x.of[1], x.of[0])), high = _mm_sqrt_pd(_mm_set_pd(x.of[3], x.of[2]));
    return {low[0], low[1], high[0], high[1]};
#else
    return {std::sqrt(x.of[0]), std::sqrt(x.of[1]), std::sqrt(x.of[2]), std::sqrt(x.of[3])};
#endif
}

// e^x = 2^n e^g, g = x - n ln 2 within half of ln 2, ln 2 in two parts; e^g = 1 + 2 g P(g^2) / (Q(g^2) - g P(g^2))  (the
// Cephes library, Moshier). To within two units of the last place; x is taken within -708 and 709, beyond which a double would end.
TRACTION_LANE_INLINE Lane exp(const Lane &x) {
    constexpr double per_ln_2 = 1.4426950408889634073599, ln_2_high = 0.693145751953125, ln_2_low = 1.42860682030941723212e-6;
    constexpr double p0 = 1.26177193074810590878e-4, p1 = 3.02994407707441961300e-2, p2 = 9.99999999999999999910e-1;
    constexpr double q0 = 3.00198505138664455042e-6, q1 = 2.52448340349684104192e-3, q2 = 2.27265548208155028766e-1,
                     q3 = 2.00000000000000000009e0;
    constexpr double whole = 6755399441055744; // 1.5 * 2^52: a small number added to it is rounded to a whole one, in its last bits
    const Lane within = larger_of(smaller_of(x, Lane(709.0)), Lane(-708.0));
    const Lane rounded = per_ln_2 * within + whole, n = rounded - whole;
    const Lane g = within - n * ln_2_high - n * ln_2_low, g2 = g * g;
    const Lane p = ((p0 * g2 + p1) * g2 + p2) * g, q = ((q0 * g2 + q1) * g2 + q2) * g2 + q3;
    const Lane grown = 2 * (p / (q - p)) + 1;
    const Lane::Bits power = __builtin_bit_cast(Lane::Bits, rounded.of) << 52; // what is left of it is n, times the place of the exponent
    return Lane(__builtin_bit_cast(Lane::Four, __builtin_bit_cast(Lane::Bits, grown.of) + power));
}

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

} // namespace traction::lab
