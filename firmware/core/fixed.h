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
static inline int32_t fixed_mul_low(int32_t value, uint32_t q15)
{
    return (int32_t)(((int64_t)value * (int16_t)(q15 & 0xffffu)) >> 16);
}
static inline int32_t fixed_mul_high(int32_t value, uint32_t q15)
{
    return (int32_t)(((int64_t)value * (int16_t)(q15 >> 16)) >> 16);
}
static inline int32_t fixed_mac_high(int32_t sum, int32_t value, uint32_t q15)
{
    return sum + fixed_mul_high(value, q15);
}
#endif

// Value limited to [low, high]; NaN gives low. Requires low <= high.
static inline float fixed_clamp(float value, float low, float high)
{
    if (!(value > low)) {
        return low;
    }
    return value < high ? value : high;
}

// True for every finite number: no libm, no NaN left through.
static inline int fixed_is_finite(float value)
{
    return value - value == 0.0f;
}

// The value, or 0 when it is NaN or infinite.
static inline float fixed_finite(float value)
{
    return fixed_is_finite(value) ? value : 0.0f;
}

// -1..1 to Q15, rounded to nearest (halves away from zero), saturated; NaN gives 0.
static inline int16_t fixed_q15_from_float(float value)
{
    if (!fixed_is_finite(value)) {
        return 0;
    }
    const float scaled = fixed_clamp(value, -1.0f, 1.0f) * 32767.0f;
    return (int16_t)(scaled >= 0.0f ? scaled + 0.5f : scaled - 0.5f);
}

// new - old of counters that wrap at 2^32.
static inline int32_t fixed_wrap_difference(int32_t new_count, int32_t old_count)
{
    const uint32_t difference = (uint32_t)new_count - (uint32_t)old_count;
    return difference <= 0x7fffffffu ? (int32_t)difference : -(int32_t)(0xffffffffu - difference) - 1;
}

#endif
