// The deterministic functions of sim/physics/math.h against libm in extended precision (64-bit significand: 2^-11 of a double's
// unit in the last place), so the tolerances are those of our own arithmetic alone.
#include "sim/physics/math.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace {

namespace math = traction::sim::math;

static_assert(std::numeric_limits<long double>::digits >= 64, "the oracle must be finer than a double");

constexpr double ulp = 2.220446049250313e-16; // 2^-52, the largest relative step of a double
constexpr int draws = 200000;

// splitmix64 (Steele, Lea, Flood 2014): seeded, the same on every machine.
struct Draw {
    std::uint64_t state;
    double between(double low, double high) {
        std::uint64_t z = (state += 0x9e3779b97f4a7c15u);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return low + (high - low) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
};

double relative(double value, long double exact) {
    return static_cast<double>(std::fabs((static_cast<long double>(value) - exact) / exact));
}
double absolute(double value, long double exact) { return static_cast<double>(std::fabs(static_cast<long double>(value) - exact)); }

// Worst error of `mine` over random arguments and the ends of the range.
template <class Mine, class Exact, class Error> double worst(Mine mine, Exact exact, Error error, double low, double high) {
    Draw draw{20261121};
    double most = std::fmax(error(mine(low), exact(low)), error(mine(high), exact(high)));
    for (int i = 0; i < draws; ++i) {
        const double x = draw.between(low, high);
        most = std::fmax(most, error(mine(x), exact(x)));
    }
    return most;
}

TEST(math, exp_is_right_to_three_units_in_the_last_place_over_its_whole_range) {
    const auto exact = [](double x) { return std::exp(static_cast<long double>(x)); };
    // 3 ulp: k*ln2_low is rounded (|r| error <= 2^-54 of 0.35), the last additions of the polynomial round twice more
    EXPECT_LE(worst(math::exp, exact, relative, -700, 700), 3 * ulp);
    EXPECT_LE(worst(math::exp, exact, relative, -1, 1), 3 * ulp); // as above
    EXPECT_EQ(math::exp(0), 1);
}

TEST(math, exp_neither_overflows_nor_becomes_denormal) {
    const double top = math::exp(std::numeric_limits<double>::infinity()), bottom = math::exp(-1e300);
    EXPECT_TRUE(std::isfinite(top));
    EXPECT_TRUE(std::isnormal(bottom));
    EXPECT_EQ(top, math::exp(700));
    EXPECT_EQ(bottom, math::exp(-700));
}

TEST(math, log_is_right_near_one_and_far_from_it) {
    const auto exact = [](double x) { return std::log(static_cast<long double>(x)); };
    // 4 ulp: the quotient, its square, the series' last step, the doubling and the sum with e*ln 2 round once each, partly alike
    EXPECT_LE(worst(math::log, exact, relative, 0.75, 1.4), 4 * ulp); // relative also near 1, where the logarithm vanishes
    EXPECT_LE(worst(math::log, exact, relative, 1.5, 1e6), 4 * ulp);
    EXPECT_LE(worst(math::log, exact, relative, 1e-12, 1e-3), 4 * ulp);
    EXPECT_TRUE(std::isfinite(math::log(0)));
    EXPECT_TRUE(std::isfinite(math::log(-1)));
}

TEST(math, pow_keeps_the_exponents_of_soil_mechanics) {
    for (const double power : {0.7, 1.0, 1.1, 1.44, 2.1}) {
        const auto mine = [power](double x) { return math::pow(x, power); };
        const auto exact = [power](double x) { return std::pow(static_cast<long double>(x), static_cast<long double>(power)); };
        // exp's 3 ulp, plus log's 4 ulp of |y ln x| <= 2.1*ln(1e6) = 29: 3 + 29*(4 + 1/2) = 134
        EXPECT_LE(worst(mine, exact, relative, 1e-6, 1e-1), 134 * ulp) << power;
    }
    EXPECT_LT(math::pow(0, 1.1), 1e-300); // 0^n is as good as zero for a sinkage
}

TEST(math, sine_and_cosine_are_right_within_a_million_radians) {
    const auto sine = [](double x) { return std::sin(static_cast<long double>(x)); };
    const auto cosine = [](double x) { return std::cos(static_cast<long double>(x)); };
    for (const double range : {0.8, 10.0, 1e6}) {
        // 1 ulp absolute: values are <= 1, so rounding r, the polynomial's last product and its last sum cost 3/2 of 2^-53 each
        EXPECT_LE(worst(math::sin, sine, absolute, -range, range), ulp) << range;
        EXPECT_LE(worst(math::cos, cosine, absolute, -range, range), ulp) << range;
    }
    // the reduction keeps relative precision at the zeros: the three parts hold pi/2 to 2^-118, k <= 2^20 and sin(pi) ~ 2^-53
    for (int k = 1; k < 1000; ++k) {
        const double x = k * 3.14159265358979323846;
        EXPECT_LE(relative(math::sin(x), sine(x)), 1e-12) << k;
    }
}

TEST(math, tangent_and_inverse_functions_undo_each_other) {
    const auto tangent = [](double x) { return std::tan(static_cast<long double>(x)); };
    EXPECT_LE(worst(math::tan, tangent, relative, 1e-3, 1.5), 6 * ulp); // two of 2.5 ulp relative (as above, 1/sin 45 deg) and the quotient
    const auto arcsine = [](double x) { return std::asin(static_cast<long double>(x)); };
    EXPECT_LE(worst(math::asin, arcsine, absolute, -1, 1), 4 * ulp); // angles <= pi/2: quotient, series, two sums, each <= 1 ulp
    for (int degree = -180; degree < 180; ++degree) {
        const double angle = degree * math::pi / 180;
        // 6 ulp: sin and cos 1 ulp each, angles up to pi cost 2 ulp per sum
        EXPECT_NEAR(math::atan2(math::sin(angle), math::cos(angle)), degree == -180 ? -math::pi : angle, 6 * ulp) << degree;
    }
    EXPECT_EQ(math::atan2(0, 0), 0);
}

TEST(math, bits_are_those_of_the_first_machine) {
    // change indicator, not truth: another hash means other bits in every simulated run
    std::uint64_t hash = 1469598103934665603u; // FNV-1a
    Draw draw{1};
    for (int i = 0; i < 10000; ++i) {
        const double x = draw.between(-50, 50);
        for (const double y : {math::exp(x), math::sin(x), math::cos(x), math::log(x * x), math::atan2(x, 3.0), math::pow(x * x, 0.55)})
            hash = (hash ^ std::bit_cast<std::uint64_t>(y)) * 1099511628211u;
    }
    EXPECT_EQ(hash, 2629932911542481392u);
}

} // namespace
