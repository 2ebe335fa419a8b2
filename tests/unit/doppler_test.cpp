// doppler and ground_speed on signals known in closed form; the drives over clutter are in ground_speed_test.cpp.
#include "firmware/core/doppler_template.h"
#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace {

TEST(GroundSpeed, is_bounded_for_any_input) {
    const control_config_t config = rover_config_default();
    const float inf = std::numeric_limits<float>::infinity();
    const float extremes[] = {0.0f, 1e-45f, -3e38f, 3e38f, inf, -inf, std::nanf(""), 0.4f};
    ground_speed_state_t state;
    ground_speed_reset(&config.ground_speed, &state);
    for (int repeat = 0; repeat < 4; ++repeat) {
        for (const float a : extremes) {
            for (const float b : extremes) {
                for (const float c : extremes) {
                    const ground_speed_input_t input = {.accel_x_m_s2 = a,
                                                        .doppler_m_s = b,
                                                        .doppler_late_s = c,
                                                        .wheel_m_s = a,
                                                        .slowest_m_s = 0.0f,
                                                        .wheels_part = false,
                                                        .accel_valid = true,
                                                        .doppler_fresh = true,
                                                        .doppler_quiet = repeat == 1,
                                                        .doppler_dead = false,
                                                        .busy = false,
                                                        .doppler_trust = 1,
                                                        .doppler_misfit = 0,
                                                        .doppler_relieved = false,
                                                        .elapsed_ticks = 1,
                                                        .lean_q8 = repeat == 1 ? 1 << 25 : 0};
                    const ground_speed_output_t out = ground_speed_step(&config.ground_speed, &state, &input);
                    ASSERT_LE(std::fabs(out.speed_m_s), 20.0f);
                    ASSERT_TRUE(std::isfinite(out.std_m_s));
                    ASSERT_LE(std::fabs(out.bias_m_s2), config.ground_speed.bias_max_m_s2);
                }
            }
        }
    }
}

TEST(Doppler, hears_nothing_in_white_noise_and_in_a_dead_converter) {
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

TEST(Doppler, argmax_finds_a_pure_tone_to_half_a_bin) {
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

// A window of noise with the spectrum that the template gives a grid speed, and white noise; 256 samples. No trigonometry but a table: this
// runs on the target too.
std::vector<uint16_t> echo_of(const doppler_template_t &beam, int speed, double rms_count, double white_count, clutter::Random &random) {
    static const std::vector<double> cosine = [] {
        std::vector<double> table;
        for (int n = 0; n < 256; ++n) {
            table.push_back(std::cos(2 * clutter::pi * n / 256));
        }
        return table;
    }();
    double sum = 0;
    std::vector<double> x(256, 0.0);
    for (int k = 0; k < beam.bins; ++k) {
        const double power = 1.0 / beam.inverse[speed * beam.bins + k], re = random.normal(), im = random.normal();
        sum += power;
        for (int n = 0; n < 256; ++n) {
            const int turn = n * (k + beam.first_bin);
            x[static_cast<std::size_t>(n)] += std::sqrt(power) * (re * cosine[static_cast<std::size_t>(turn % 256)] +
                                                                  im * cosine[static_cast<std::size_t>((turn + 192) % 256)]);
        }
    }
    std::vector<uint16_t> out;
    for (const double value : x) {
        const double count = 512 + rms_count * value / std::sqrt(sum) + white_count * random.normal();
        out.push_back(static_cast<uint16_t>(std::fmax(0, std::fmin(1023, std::floor(count + 0.5)))));
    }
    return out;
}

// Equation (2) in double over the whole grid, from the powers of the window: the reference that the integers and the coarse search are held
// to.
TEST(Doppler, speed_is_the_vertex_of_the_likelihood_over_the_whole_grid) {
    doppler_config_t config = rover_config_default().doppler;
    const doppler_template_t &beam = *config.beam;
    clutter::Random random{17};
    int elsewhere = 0, windows = 0;
    for (int speed = 20; speed < 94; ++speed) { // 0.08 m/s and more: the grid's ends have no neighbours
        doppler_state_t state = {};
        state.full = true; // no early values
        for (const uint16_t sample : echo_of(beam, speed, 100, 3, random)) {
            doppler_step(&config, &state, &sample, 1);
        }
        const doppler_output_t out = doppler_step(&config, &state, nullptr, 0);
        ASSERT_TRUE(out.fresh);
        EXPECT_FALSE(out.quiet);
        std::vector<double> J;
        for (int i = 0; i < beam.speeds; ++i) {
            double sum = 0;
            for (int k = 0; k < beam.bins; ++k) {
                sum += static_cast<double>(state.power[beam.first_bin + k]) * (beam.inverse[i * beam.bins + k] + beam.volume[i]);
            }
            J.push_back(sum);
        }
        const auto best = static_cast<std::size_t>(std::min_element(J.begin(), J.end()) - J.begin());
        if (best == 0 || best + 1 == J.size()) {
            continue;
        }
        const double left = J[best - 1] - J[best], right = J[best + 1] - J[best];
        const auto step = static_cast<double>(beam.log_step);
        const double expected = static_cast<double>(beam.speed_m_s[best]) * std::exp(0.5 * (left - right) / (left + right) * step);
        ++windows;
        if (std::fabs(std::log(static_cast<double>(out.speed_m_s) / expected)) >
            0.02 * step) { // 15 bits: the reference itself is flat to this
            ++elsewhere;
        }
    }
    EXPECT_GE(windows, 70);
    EXPECT_LE(elsewhere, windows / 20); // a window with two valleys: the coarse grid may see the other one
}

TEST(Doppler, an_echo_below_the_stated_power_is_quiet) {
    doppler_config_t config = rover_config_default().doppler;
    const doppler_template_t &beam = *config.beam;
    config.quiet_power_count2 = 400;
    clutter::Random random{23};
    for (const double share : {0.7, 1.4}) { // of the stated variance, realised in this very window
        std::vector<uint16_t> window = echo_of(beam, 60, 100, 0, random);
        double square = 0; // through the window that the power is measured with
        for (std::size_t n = 0; n < 256; ++n) {
            square += std::pow((window[n] - 512.0) * (1 - std::cos(2 * clutter::pi * static_cast<double>(n) / 256)) / 2, 2) / 96;
        }
        for (uint16_t &value : window) {
            value = static_cast<uint16_t>(std::lround(512 + (value - 512.0) * std::sqrt(share * 400 / square)));
        }
        doppler_state_t state = {};
        state.full = true;
        for (const uint16_t sample : window) {
            doppler_step(&config, &state, &sample, 1);
        }
        EXPECT_EQ(doppler_step(&config, &state, nullptr, 0).quiet, share < 1) << share;
    }
}

TEST(Doppler, every_hop_gives_what_a_fresh_window_of_the_same_samples_gives) {
    doppler_config_t config = rover_config_paper().doppler;
    clutter::Random random{29};
    for (const int hop : {64, 30, 63, 1, 256, 0, -4, 300}) {
        config.hop = hop;
        const int real = hop >= 1 && hop <= 256 ? hop : 256; // no other hop makes sense
        std::vector<uint16_t> samples;
        for (int n = 0; n < 800; ++n) {
            samples.push_back(static_cast<uint16_t>(random.next() % 1024));
        }
        doppler_state_t state = {};
        int values = 0;
        for (std::size_t n = 0; n < samples.size(); ++n) {
            const doppler_output_t out = doppler_step(&config, &state, &samples[n], 1);
            ASSERT_EQ(out.fresh, n >= 256 && (static_cast<int>(n) - 256) % real == 0) << hop << " " << n;
            if (out.fresh) {
                int16_t window[256];
                uint64_t power[FFT_BINS];
                for (std::size_t j = 0; j < 256; ++j) {
                    window[j] = static_cast<int16_t>((samples[n - 256 + j] - 512) * 32);
                }
                int32_t sum = 0;
                for (const int16_t value : window) {
                    sum += value;
                }
                fft_power_flat(window, sum / 256, power); // the paper's method
                if (real > 1) {                           // at hop 1 the powers are already the next window's
                    ASSERT_TRUE(std::equal(power, power + FFT_BINS, state.power)) << hop << " " << n;
                }
                ++values;
            }
        }
        EXPECT_EQ(values, (800 - 257) / real + 1);
    }
}

TEST(Doppler, counts_beyond_the_converter_are_its_largest) {
    const doppler_config_t config = rover_config_paper().doppler;
    doppler_state_t rail = {}, beyond = {};
    for (int n = 0; n < 256; ++n) {
        const bool high = n % 25 < 12;
        const uint16_t at = high ? 1023 : 0, above = high ? static_cast<uint16_t>(1024 + 300 * n) : 0;
        doppler_step(&config, &rail, &at, 1);
        doppler_step(&config, &beyond, &above, 1);
    }
    EXPECT_TRUE(std::equal(rail.power, rail.power + FFT_BINS, beyond.power));
}

TEST(Doppler, a_value_says_how_many_samples_came_after_its_window) {
    const doppler_config_t config = rover_config_default().doppler;
    doppler_state_t state = {};
    const uint16_t sample[8] = {512, 600, 512, 400, 512, 600, 512, 400};
    int total = 0, values = 0;
    for (int call = 0; total < 700; ++call) {
        const int count = call % 3 == 0 ? 6 : 5;
        const doppler_output_t out = doppler_step(&config, &state, sample, count);
        total += count;
        if (!out.fresh) {
            continue;
        }
        const int end = 128 + 64 * values; // samples in when the window was full
        double younger = 0;
        if (values < 2) { // mean age of the samples by the square of the Hann window: 128 each taken twice, or 192 and their mirror image
            double weight = 0, age = 0;
            for (int n = 0; n < 256; ++n) {
                const double h = std::pow((1 - std::cos(2 * clutter::pi * n / 256)) / 2, 2);
                weight += h;
                age += h * (values == 0 ? 127 - n / 2 : n < 192 ? 191 - n : n - 192);
            }
            younger = 127.5 - age / weight;
        }
        EXPECT_NEAR(out.late_samples, total - end - younger, 0.5) << values; // whole samples
        ++values;
    }
    EXPECT_EQ(values, 9); // 128, 192, ... 640
}

class OfRadar : public ::testing::TestWithParam<const doppler_template_t *> {};

// J of doppler.c is linear in the powers, and what it adds to the first term is not negative: its extremes over all powers with a sum
// of at most `total` have all of it in one bin. So these cases are all cases.
TEST_P(OfRadar, likelihood_never_leaves_32_bits) {
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

TEST_P(OfRadar, template_is_a_normalised_spectrum_with_rising_speeds) {
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

INSTANTIATE_TEST_SUITE_P(Doppler, OfRadar,
                         ::testing::Values(&doppler_template_mdu1130, &doppler_template_dj_radar_2, &doppler_template_dj_radar_3,
                                           &doppler_template_drs1000));

} // namespace
