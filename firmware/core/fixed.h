// fixed.h - the few fixed-point operations of the signal path, each with one meaning on every machine.
//
// On ARMv5TE a product of a 32-bit and a 16-bit number is one instruction; the plain C below has the same bits everywhere
// (arithmetic right shift of negative numbers: gcc and clang define it, and a unit test checks it).
#ifndef TRACTION_FIRMWARE_CORE_FIXED_H
#define TRACTION_FIRMWARE_CORE_FIXED_H

#include <stdint.h>

// 1: use the DSP multiplications of ARMv5TE, 0: plain C. Same bits either way.
#ifndef FIXED_ARM_DSP
#if defined(__ARM_FEATURE_DSP) && defined(__arm__)
#define FIXED_ARM_DSP 1
#else
#define FIXED_ARM_DSP 0
#endif
#endif

// (value * low half of q15) >> 16 and (value * high half of q15) >> 16: Q15 product, halved.
#if FIXED_ARM_DSP
static inline int32_t fixed_mul_low(int32_t value, uint32_t q15)
{
    int32_t out;
    __asm__("smulwb %0, %1, %2" : "=r"(out) : "r"(value), "r"(q15));
    return out;
}
static inline int32_t fixed_mul_high(int32_t value, uint32_t q15)
{
    int32_t out;
    __asm__("smulwt %0, %1, %2" : "=r"(out) : "r"(value), "r"(q15));
    return out;
}
// sum + ((value * high half of q15) >> 16); the sum must not overflow
static inline int32_t fixed_mac_high(int32_t sum, int32_t value, uint32_t q15)
{
    int32_t out;
    __asm__("smlawt %0, %1, %2, %3" : "=r"(out) : "r"(value), "r"(q15), "r"(sum));
    return out;
}
#else
static inline int32_t fixed_mul_low(int32_t value, uint32_t q15) { return (int32_t)(((int64_t)value * (int16_t)(q15 & 0xffffu)) >> 16); }
static inline int32_t fixed_mul_high(int32_t value, uint32_t q15) { return (int32_t)(((int64_t)value * (int16_t)(q15 >> 16)) >> 16); }
static inline int32_t fixed_mac_high(int32_t sum, int32_t value, uint32_t q15) { return sum + fixed_mul_high(value, q15); }
#endif

// 1: compare floats as whole numbers, as a machine without a floating-point unit must: one instruction, not 40. 0: plain C.
// Same bits either way (fixed_test).
#ifndef FIXED_SOFT_FLOAT
#if defined(__SOFTFP__)
#define FIXED_SOFT_FLOAT 1
#else
#define FIXED_SOFT_FLOAT 0
#endif
#endif

// The bits of a float; and, as a whole number, its place among all floats but NaN.
static inline uint32_t fixed_bits(float value)
{
    const union {
        float value;
        uint32_t bits;
    } both = {.value = value};
    return both.bits;
}
static inline int32_t fixed_order(float value)
{
    const uint32_t bits = fixed_bits(value);
    return (bits & 0x80000000u) == 0u ? (int32_t)bits : -(int32_t)(bits & 0x7fffffffu);
}

// a > b; a NaN is above every number when positive, below when negative.
static inline int fixed_greater(float a, float b) { return fixed_order(a) > fixed_order(b); }

// True for every finite number.
static inline int fixed_is_finite(float value) { return (fixed_bits(value) & 0x7f800000u) != 0x7f800000u; }

// fixed_clamp: value limited to [low, high]; NaN gives low. Requires low <= high.
// fixed_finite: the value, or 0 when it is NaN or infinite.
#if FIXED_SOFT_FLOAT
static inline float fixed_clamp(float value, float low, float high)
{
    const int is_nan = (fixed_bits(value) & 0x7fffffffu) > 0x7f800000u;
    if (is_nan || fixed_order(value) <= fixed_order(low)) {
        return low;
    }
    return fixed_order(value) < fixed_order(high) ? value : high;
}
static inline float fixed_finite(float value) { return fixed_is_finite(value) ? value : 0.0f; }
#else
static inline float fixed_clamp(float value, float low, float high)
{
    if (value != value || value <= low) {
        return low;
    }
    return value < high ? value : high;
}
static inline float fixed_finite(float value)
{
    const float largest = 3.40282347e38f;
    return value >= -largest && value <= largest ? value : 0.0f;
}
#endif

// sum + a . b, modulo 2^32; length a multiple of 8, both arrays on 8 bytes.
#if FIXED_ARM_DSP
static inline int32_t fixed_dot_product(int32_t sum, const int16_t *a, const int16_t *b, int32_t length)
{
    const int16_t *const end = a + length;
    while (a != end) {
        uint64_t x;
        uint64_t y;
        __asm__("ldrd %0, %H0, [%2], #8\n\tldrd %1, %H1, [%3], #8\n\t"
                "smlabb %4, %Q0, %Q1, %4\n\tsmlatt %4, %Q0, %Q1, %4\n\tsmlabb %4, %R0, %R1, %4\n\tsmlatt %4, %R0, %R1, %4\n\t"
                "ldrd %0, %H0, [%2], #8\n\tldrd %1, %H1, [%3], #8\n\t"
                "smlabb %4, %Q0, %Q1, %4\n\tsmlatt %4, %Q0, %Q1, %4\n\tsmlabb %4, %R0, %R1, %4\n\tsmlatt %4, %R0, %R1, %4"
                : "=&r"(x), "=&r"(y), "+r"(a), "+r"(b), "+r"(sum)
                :
                : "memory");
    }
    return sum;
}
#else
static inline int32_t fixed_dot_product(int32_t sum, const int16_t *a, const int16_t *b, int32_t length)
{
    uint32_t total = (uint32_t)sum;
    for (int32_t k = 0; k < length; k++) {
        total += (uint32_t)(a[k] * b[k]);
    }
    return (int32_t)total;
}
#endif

// -1..1 to Q15, rounded to nearest (halves away from zero), saturated; NaN gives 0.
static inline int16_t fixed_q15_from_float(float value)
{
    if (!fixed_is_finite(value)) {
        return 0;
    }
    const float scaled = fixed_clamp(value, -1.0f, 1.0f) * 32767.0f;
    return (int16_t)(scaled + (fixed_bits(scaled) >> 31 == 0u ? 0.5f : -0.5f));
}

// (value * q15) >> 16.
static inline int32_t fixed_mul(int32_t value, int16_t q15)
{
#if FIXED_ARM_DSP
    return fixed_mul_low(value, (uint32_t)(int32_t)q15);
#else
    return (int32_t)(((int64_t)value * q15) >> 16);
#endif
}

// new - old of counters that wrap at 2^32.
static inline int32_t fixed_wrap_difference(int32_t new_count, int32_t old_count)
{
    return (int32_t)((uint32_t)new_count - (uint32_t)old_count); // gcc and clang define the conversion: two's complement
}

#endif
