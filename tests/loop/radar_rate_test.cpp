// The window of a Doppler value is the radar's: behind a converter of another rate the estimator has another delay, and no lag either.
#include "firmware/core/doppler_template.h"
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

extern "C" const doppler_template_t doppler_template_mdu1130_640; // made by doppler_template_gen for this test: 640 Hz

namespace {

constexpr double pi = 3.14159265358979323846;

TEST(RadarRate, the_window_of_another_rate_has_its_own_weights) {
    for (const doppler_template_t *beam : {&doppler_template_mdu1130, &doppler_template_mdu1130_640}) {
        const doppler_window_t &window = beam->window;
        const double rate_Hz = static_cast<double>(beam->sample_rate_Hz);
        int sum = 0;
        double age = 0;
        for (int j = 0; j < window.ticks; j++) sum += window.weight_q15[j], age += j * window.weight_q15[j] / 32768.0;
        EXPECT_EQ(sum, 32768);
        EXPECT_EQ(window.ticks, static_cast<int>(25600 / rate_Hz) + 1);
        EXPECT_NEAR(age, 127.5 / rate_Hz * 100, 0.005);                          // rounding of 2^-16 per weight
        EXPECT_NEAR(static_cast<double>(window.tau_s), 127.5 / rate_Hz, 0.5e-3); // whole milliseconds
        EXPECT_NEAR(static_cast<double>(window.per_s), rate_Hz / 256, 1e-6);
    }
    EXPECT_EQ(doppler_template_mdu1130_640.sample_rate_Hz, 640.0f);
}

// Largest error in a ramp of a [m/s^2] from 2 to 3 s with an exact accelerometer and an exact radar: the mean over the Hann window squared.
double worst_error(const doppler_window_t &window, double rate_Hz, double a) {
    ground_speed_config_t config = rover_config_default().ground_speed;
    config.window = &window;
    config.doppler_spread_s = 0; // this radar gives the window's mean
    ground_speed_state_t state;
    ground_speed_reset(&config, &state);
    const auto speed_at = [a](double t) { return 0.3 + (t > 2 ? a * (std::fmin(t, 3.0) - 2) : 0); };
    std::vector<double> past;
    double error = 0;
    for (int k = 0; k < 500; ++k) {
        const double t = 0.01 * (k + 1);
        for (int n = static_cast<int>(past.size()); n <= t * rate_Hz; ++n) past.push_back(speed_at(n / rate_Hz));
        const bool fresh = past.size() >= 256 && k % 12 == 0;
        double mean = 0, weight = 0;
        for (std::size_t j = 0; fresh && j < 256; ++j) {
            const double h = std::pow(std::sin(pi * static_cast<double>(j) / 256), 4);
            mean += h * past[past.size() - 256 + j];
            weight += h;
        }
        const ground_speed_input_t input = {.accel_x_m_s2 = static_cast<float>(t > 2.005 && t < 3.005 ? a : 0),
                                            .doppler_m_s = static_cast<float>(fresh ? mean / weight : 0),
                                            .doppler_late_s = 0,
                                            .wheel_m_s = static_cast<float>(speed_at(t)),
                                            .slowest_m_s = 0.0f,
                                            .wheels_part = false,
                                            .accel_valid = true,
                                            .doppler_fresh = fresh,
                                            .doppler_quiet = false,
                                            .doppler_dead = false,
                                            .busy = false,
                                            .doppler_trust = 1,
                                            .doppler_misfit = 0,
                                            .doppler_relieved = false,
                                            .elapsed_ticks = 1,
                                            .lean_q8 = 0};
        const double estimate = static_cast<double>(ground_speed_step(&config, &state, &input).speed_m_s);
        if (t > 2.1 && t < 4) error = std::fmax(error, std::fabs(estimate - speed_at(t)));
    }
    return error;
}

TEST(RadarRate, a_steady_acceleration_is_followed_without_lag_at_640_Hz) {
    // half a sample and a rounding of 2^-15 per weight, within 2 ms; the window of 512 Hz would be 50 ms off in the mean age
    EXPECT_LT(worst_error(doppler_template_mdu1130_640.window, 640, 1.0), 0.002 + 1e-4);
    EXPECT_GT(worst_error(doppler_template_mdu1130.window, 640, 1.0), 0.005);
}

} // namespace
