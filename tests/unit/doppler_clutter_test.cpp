// doppler on the tests' own clutter (clutter.h): are its values right on the mean, and is the first one early and good?
#include "firmware/core/rover_config.h"
#include "tests/unit/clutter.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace {

// From power-on over many places of the tests' own clutter, whose first half second the band-pass takes to settle as the rover's does.
TEST(Doppler, first_value_comes_after_128_samples_and_reads_the_same_speed_as_a_full_window) {
    const doppler_config_t config = rover_config_default().doppler;
    clutter::Ground ground;
    ground.track_m = 10;
    ground.density_m2 = 200;
    ground.seed = 7;
    const std::vector<double> echo = clutter::echo_along_track(ground);
    for (const double v : {0.2, 0.4, 0.8}) {
        double early = 0, late = 0, square = 0;
        const int runs = static_cast<int>(9 / (v * 0.55));
        for (int run = 0; run < runs; ++run) {
            clutter::Adc adc;
            adc.seed = static_cast<std::uint64_t>(run);
            const auto samples = clutter::drive(
                echo, 0.55, [v, run](double t) { return v * (t + 0.55 * run); }, adc);
            doppler_state_t state = {};
            std::vector<double> value;
            for (std::size_t n = 0; n < samples.size(); ++n) {
                const doppler_output_t out = doppler_step(&config, &state, &samples[n], 1);
                if (out.fresh) {
                    EXPECT_EQ(n, 128 + 64 * value.size()); // in the call after the window's last sample
                    value.push_back(static_cast<double>(out.speed_m_s));
                }
            }
            ASSERT_EQ(value.size(), 3u);
            early += value[0] / v / runs;
            late += value[2] / v / runs;
            square += std::pow(value[0] / v - 1, 2) / runs;
        }
        // A value of 128 samples spreads by 7 % at 0.2 m/s and less above; 80 runs at 0.2 m/s, 20 at 0.8 m/s: the mean to 1 %, three of
        // them
        EXPECT_NEAR(early, late, 0.03) << v;
        EXPECT_NEAR(early, 1, 0.04) << v;
        EXPECT_LT(std::sqrt(square), 0.10) << v; // its mirror image instead spread by 15 %
        EXPECT_GT(std::sqrt(square), 0.01) << v; // speckle
    }
}

// The grid's speeds are where the minimum lies on average, so on another signal of the same geometry the mean over windows is the speed.
// Before, it was 1.8 % low at 0.2 m/s.
TEST(Doppler, mean_over_windows_of_the_tests_clutter_is_the_speed) {
    const doppler_config_t config = rover_config_default().doppler;
    std::vector<std::vector<double>> echoes;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        clutter::Ground ground;
        ground.track_m = 9;
        ground.density_m2 = 200;
        ground.seed = 50 + seed;
        echoes.push_back(clutter::echo_along_track(ground));
    }
    double worst = 0;
    for (const double v : {0.15, 0.2, 0.3, 0.6}) {
        double sum = 0, square = 0;
        int n = 0;
        for (const std::vector<double> &echo : echoes) {
            doppler_state_t state = {};
            for (const uint16_t sample : clutter::drive(echo, 8.5 / v, [v](double t) { return v * t; }, {})) {
                const doppler_output_t out = doppler_step(&config, &state, &sample, 1);
                if (out.fresh && !out.quiet && out.late_samples > 0) {
                    const double ratio = static_cast<double>(out.speed_m_s) / v;
                    sum += ratio, square += ratio * ratio, ++n;
                }
            }
        }
        const double mean = sum / n, std = std::sqrt(square / n - mean * mean);
        std::printf("%.2f m/s: mean %+.2f %%, spread %.1f %% over %d windows\n", v, 100 * (mean - 1), 100 * std, n);
        // ripple of the bins 0.5 %, the two geometries 0.3 %, three sigma of the mean: three windows of four share samples
        EXPECT_NEAR(mean, 1, 0.008 + 3 * std * std::sqrt(3.0 / n)) << v;
        worst = std::fmax(worst, std::fabs(mean - 1));
    }
    EXPECT_GT(worst, 1e-4); // speckle is never averaged out to nothing
}

} // namespace
