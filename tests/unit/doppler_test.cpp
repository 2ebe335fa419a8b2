// doppler and ground_speed on signals known in closed form; the drives over clutter are in ground_speed_test.cpp.
#include "firmware/core/doppler_template.h"
#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

TEST(GroundSpeed, is_bounded_for_any_input)
{
    const control_config_t config = rover_config_default();
    const float inf = std::numeric_limits<float>::infinity();
    const float extremes[] = {0.0f, 1e-45f, -3e38f, 3e38f, inf, -inf, std::nanf(""), 0.4f};
    ground_speed_state_t state;
    ground_speed_reset(&config.ground_speed, &state);
    for (int repeat = 0; repeat < 4; ++repeat) {
        for (const float a : extremes) {
            for (const float b : extremes) {
                for (const float c : extremes) {
                    const ground_speed_input_t input = {.accel_x_m_s2 = a, .doppler_m_s = b, .doppler_late_s = c, .wheel_m_s = a,
                                                        .accel_valid = true, .doppler_fresh = true, .doppler_quiet = repeat == 1};
                    const ground_speed_output_t out = ground_speed_step(&config.ground_speed, &state, &input);
                    ASSERT_LE(std::fabs(out.speed_m_s), 20.0f);
                    ASSERT_TRUE(std::isfinite(out.std_m_s));
                    ASSERT_LE(std::fabs(out.bias_m_s2), config.ground_speed.bias_max_m_s2);
                }
            }
        }
    }
}

TEST(Doppler, hears_nothing_in_white_noise_and_in_a_dead_converter)
{
    const control_config_t config = rover_config_default();
    clutter::Random random{5};
    doppler_state_t state = {};
    int values = 0, quiet = 0;
    for (int n = 0; n < 512 * 20; ++n) {
        const auto count = static_cast<uint16_t>(std::fmax(0, std::fmin(1023, 512 + 12 * random.normal())));
        const doppler_output_t out = doppler_step(&config.doppler, &state, &count, 1);
        values += out.fresh ? 1 : 0;
        quiet += out.fresh && out.quiet ? 1 : 0;
    }
    EXPECT_GE(values, 150);
    EXPECT_GE(quiet, values - 3);
    doppler_state_t dead = {};
    const uint16_t same[8] = {300, 300, 300, 300, 300, 300, 300, 300};
    for (int n = 0; n < 64; ++n) {
        const doppler_output_t out = doppler_step(&config.doppler, &dead, same, 8);
        EXPECT_TRUE(!out.fresh || out.quiet || out.speed_m_s < 0.05f); // an offset is at most in the lowest bin
    }
}

TEST(Doppler, argmax_finds_a_pure_tone_to_half_a_bin)
{
    control_config_t config = rover_config_paper();
    for (double v = 0.1; v <= 1.0; v += 0.05) {
        const double f = 2 * v * 9.9e9 / 299792458.0 * std::cos(20 * clutter::pi / 180); // (11)
        doppler_state_t state = {};
        doppler_output_t out = {};
        for (int n = 0; n <= 256; ++n) { // the speed comes in the call after the window's last sample
            const auto count = static_cast<uint16_t>(512 + 200 * std::cos(2 * clutter::pi * f * n / 512));
            out = doppler_step(&config.doppler, &state, &count, 1);
        }
        ASSERT_TRUE(out.fresh);
        EXPECT_NEAR(out.speed_m_s, v, 1.001 * 0.5 * 512 / 256 * 0.016113); // half a bin of 2 Hz through (11)
    }
}

class OfRadar : public ::testing::TestWithParam<const doppler_template_t *> {};

// J of doppler.c is linear in the powers, and what it adds to the first term is not negative: its extremes over all powers with a sum
// of at most `total` have all of it in one bin. So these cases are all cases.
TEST_P(OfRadar, likelihood_never_leaves_32_bits)
{
    const doppler_template_t &beam = *GetParam();
    const int64_t total = 128 * 256 + 120 * 256; // the sum is below 128 * 2^8, and >> 8 dropped less than 2^8 in each of 120 bins
    for (int i = 0; i < beam.speeds; ++i) {
        ASSERT_GE(total * beam.volume[i], INT32_MIN);
        ASSERT_LE(total * beam.volume[i], INT32_MAX);
        ASSERT_GE(total * beam.quiet[i], INT32_MIN);
        ASSERT_LE(total * beam.quiet[i], INT32_MAX);
        for (int k = 0; k < beam.bins; ++k) {
            const int64_t inverse = beam.inverse[i * beam.bins + k];
            ASSERT_GE(inverse, 0);
            ASSERT_LE(total * (beam.volume[i] + inverse), INT32_MAX) << beam.speed_m_s[i] << " m/s, bin " << k;
        }
    }
}

TEST_P(OfRadar, template_is_a_normalised_spectrum_with_rising_speeds)
{
    const doppler_template_t &beam = *GetParam();
    for (int i = 0; i < beam.speeds; ++i) {
        EXPECT_GT(beam.speed_m_s[i], i > 0 ? beam.speed_m_s[i - 1] : 0);
        double sum = 0, ln = 0, q = 0;
        for (int k = 0; k < beam.bins; ++k) {
            sum += 1.0 / beam.inverse[i * beam.bins + k];
            EXPECT_GT(beam.inverse[i * beam.bins + k], 0);
        }
        q = 1 / sum; // sum S = 1
        for (int k = 0; k < beam.bins; ++k) {
            ln += std::log(q / beam.inverse[i * beam.bins + k]);
        }
        // inverse is at least 40 where S is largest: rounding of 0.5 makes up to 1.25 % of q
        EXPECT_NEAR(beam.volume[i], q * ln, std::fabs(q * ln) * 0.0125);
    }
}

INSTANTIATE_TEST_SUITE_P(Doppler, OfRadar, ::testing::Values(&doppler_template_mdu1130, &doppler_template_dj_radar_2,
                                                             &doppler_template_dj_radar_3, &doppler_template_drs1000));

} // namespace
