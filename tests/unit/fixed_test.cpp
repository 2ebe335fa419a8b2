// The operations of fixed.h against independent formulas; those with a form for machines without a floating-point unit in both forms.
#include "firmware/core/fixed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace plain {
#undef TRACTION_FIRMWARE_CORE_FIXED_H
#undef FIXED_SOFT_FLOAT
#define FIXED_SOFT_FLOAT 0
#include "firmware/core/fixed.h"
} // namespace plain
namespace whole {
#undef TRACTION_FIRMWARE_CORE_FIXED_H
#undef FIXED_SOFT_FLOAT
#define FIXED_SOFT_FLOAT 1
#include "firmware/core/fixed.h"
} // namespace whole

namespace {

uint32_t bits(float value) { return std::bit_cast<uint32_t>(value); }

// xorshift32, Marsaglia 2003
uint32_t draw() {
    static uint32_t state = 20261121;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

// Both zeros, denormals, neighbours of 1, huge numbers, infinities, quiet and signalling NaN of both signs; and floats of any bits.
std::vector<float> floats(int random) {
    std::vector<float> out;
    for (const uint32_t magnitude : {0x0u, 0x1u, 0x7fffffu, 0x800000u, 0x3f7fffffu, 0x3f800000u, 0x3f800001u, 0x7f7fffffu, 0x7f800000u,
                                     0x7f800001u, 0x7fc00000u, 0x7fffffffu}) {
        out.push_back(std::bit_cast<float>(magnitude));
        out.push_back(std::bit_cast<float>(magnitude | 0x80000000u));
    }
    for (int i = 0; i < random; ++i) {
        out.push_back(std::bit_cast<float>(draw()));
    }
    return out;
}

TEST(Fixed, clamp_lies_between_its_limits_for_any_float_and_both_forms_have_the_same_bits) {
    const std::vector<float> all = floats(60);
    for (const float low : all) {
        for (const float high : all) {
            if (!(low <= high)) {
                continue; // what it requires
            }
            for (const float value : all) {
                const float limited = plain::fixed_clamp(value, low, high);
                ASSERT_EQ(bits(limited), bits(whole::fixed_clamp(value, low, high))) << value << " in " << low << ", " << high;
                ASSERT_EQ(limited, std::isnan(value) ? low : std::fmin(std::fmax(value, low), high));
            }
        }
    }
}

TEST(Fixed, finite_keeps_finite_numbers_and_both_forms_have_the_same_bits) {
    for (const float value : floats(20000)) {
        const float kept = plain::fixed_finite(value);
        ASSERT_EQ(bits(kept), bits(whole::fixed_finite(value)));
        ASSERT_EQ(bits(kept), std::isfinite(value) ? bits(value) : 0u);
        ASSERT_EQ(fixed_is_finite(value) != 0, std::isfinite(value));
    }
}

TEST(Fixed, greater_is_the_order_of_numbers_with_nan_outside) {
    const std::vector<float> all = floats(200);
    for (const float a : all) {
        for (const float b : all) {
            if (!std::isnan(a) && !std::isnan(b)) {
                ASSERT_EQ(fixed_greater(a, b) != 0, a > b) << a << " " << b;
            } else if (std::isnan(a) && !std::isnan(b)) {
                ASSERT_EQ(fixed_greater(a, b) != 0, !std::signbit(a)) << b;
            }
        }
    }
}

TEST(Fixed, products_are_the_floor_of_the_exact_quotient) {
    const std::vector<int32_t> values = {0, 1, -1, 65535, 65536, -65536, 65537, INT32_MAX, INT32_MIN, INT32_MIN + 1};
    for (int i = 0; i < 2000; ++i) {
        const int32_t value =
            static_cast<std::size_t>(i) < values.size() ? values[static_cast<std::size_t>(i)] : static_cast<int32_t>(draw());
        for (const uint32_t q : {0u, 1u, 0x7fffu, 0x8000u, 0xffffu, 0x7fff8000u, 0x80007fffu, 0xffff0001u, draw()}) {
            const auto exact = [&](uint32_t half) { // double holds 47 bits without rounding
                return std::floor(static_cast<double>(value) * static_cast<int16_t>(half) / 65536.0);
            };
            ASSERT_EQ(fixed_mul_low(value, q), exact(q & 0xffffu));
            ASSERT_EQ(fixed_mul_high(value, q), exact(q >> 16));
            ASSERT_EQ(fixed_mac_high(-5, value / 2, q),
                      -5 + std::floor(static_cast<double>(value / 2) * static_cast<int16_t>(q >> 16) / 65536.0));
            ASSERT_EQ(fixed_mul(value, static_cast<int16_t>(q & 0xffffu)), exact(q & 0xffffu));
        }
    }
}

TEST(Fixed, dot_product_is_exact_modulo_2_to_the_32) {
    alignas(8) int16_t a[120];
    alignas(8) int16_t b[120];
    for (int repeat = 0; repeat < 200; ++repeat) {
        const int32_t start = static_cast<int32_t>(draw());
        const int32_t length = 8 * (1 + repeat % 15);
        uint64_t exact = static_cast<uint64_t>(static_cast<int64_t>(start));
        for (int k = 0; k < length; ++k) {
            a[k] = repeat < 3 ? INT16_MIN : static_cast<int16_t>(draw());
            b[k] = repeat < 3 ? INT16_MIN : static_cast<int16_t>(draw());
            exact += static_cast<uint64_t>(static_cast<int64_t>(a[k]) * b[k]);
        }
        ASSERT_EQ(static_cast<uint32_t>(fixed_dot_product(start, a, b, length)), static_cast<uint32_t>(exact));
    }
}

TEST(Fixed, q15_is_the_nearest_and_saturates) {
    for (const float value : floats(20000)) {
        const double limited = std::fmin(1.0, std::fmax(-1.0, static_cast<double>(value)));
        const int16_t got = fixed_q15_from_float(value);
        if (!std::isfinite(value)) {
            ASSERT_EQ(got, 0);
        } else {
            ASSERT_NEAR(got, limited * 32767, 0.5 + 0.002); // half a step, and one rounding of a float near 32767: 2^-9
        }
    }
    for (int k = -32767; k <= 32767; ++k) {
        ASSERT_EQ(fixed_q15_from_float(static_cast<float>(k) / 32767.0f), k);
    }
}

TEST(Fixed, difference_of_wrapping_counters_is_the_short_way) {
    EXPECT_EQ(fixed_wrap_difference(INT32_MIN, INT32_MAX), 1);
    EXPECT_EQ(fixed_wrap_difference(INT32_MAX, INT32_MIN), -1);
    EXPECT_EQ(fixed_wrap_difference(3, 10), -7);
}

} // namespace
