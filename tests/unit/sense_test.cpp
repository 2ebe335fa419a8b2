#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

sensor_frame_t quiet_frame() {
    sensor_frame_t frame = {};
    frame.present = FRAME_ALL;
    for (auto &count : frame.current_count) {
        count = 2048;
    }
    frame.battery_count = 1800;
    frame.radar_samples = 5;
    for (auto &count : frame.radar_count) {
        count = 512;
    }
    return frame;
}

TEST(Sense, speed_and_its_derivative_follow_a_ramp_across_the_counters_wrap) {
    const sense_config_t config = rover_config_default().sense;
    sense_state_t state = {};
    const double q = 2 * M_PI / 6000;
    for (int k = 0; k < 200; ++k) {
        const double t = 0.01 * k;
        const double angle = 2.0 * t + 0.5 * 3.0 * t * t; // w = 2 + 3 t
        sensor_frame_t frame = quiet_frame();
        const auto pulses = static_cast<uint32_t>(std::floor(angle / q));
        for (auto &count : frame.encoder_count) {
            count = static_cast<int32_t>(0x7ffffff0u + pulses);
        }
        const sense_output_t out = sense_measure(&config, &state, &frame);
        if (k > 10) {
            EXPECT_NEAR(out.speed_rad_s[0], 2 + 3 * (t - 0.005), q / 0.01 + 1e-4); // delay T/2; one pulse
            EXPECT_NEAR(out.accel_rad_s2[0], 3, 2 * q / (0.04 * 0.04) + 1e-3);     // two pulses over (4T)^2, the worst rounding of (2)
        }
        EXPECT_EQ(out.usable, 0xfffu);
    }
}

TEST(Sense, noise_of_the_speed_is_what_the_header_says) {
    const sense_config_t config = rover_config_default().sense;
    sense_state_t state = {};
    const double q = 2 * M_PI / 6000;
    double sum_w = 0, sum_a = 0;
    const int n = 20000;
    for (int k = 0; k < n; ++k) {
        sensor_frame_t frame = quiet_frame();
        // The golden ratio makes the rounding error uniform.
        frame.encoder_count[0] = static_cast<int32_t>(std::floor(k * 50.618033988749895));
        const sense_output_t out = sense_measure(&config, &state, &frame);
        if (k >= 10) {
            sum_w += std::pow(static_cast<double>(out.speed_rad_s[0]) - 50.618033988749895 * q / 0.01, 2);
            sum_a += std::pow(static_cast<double>(out.accel_rad_s2[0]), 2);
        }
    }
    // A rotation by an irrational number correlates neighbouring rounding errors, so the bound is two-sided but wide.
    EXPECT_NEAR(std::sqrt(sum_w / n), 0.043, 0.02);
    EXPECT_NEAR(std::sqrt(sum_a / n), 0.46, 0.25);
}

TEST(Sense, a_silent_encoder_is_bridged_without_a_false_speed) {
    const sense_config_t config = rover_config_default().sense;
    sense_state_t state = {};
    for (int k = 0; k < 50; ++k) {
        sensor_frame_t frame = quiet_frame();
        frame.encoder_count[2] = 40 * k;
        if (k >= 20 && k < 25) {
            frame.present &= ~(static_cast<unsigned>(FRAME_ENCODER_0) << 2u);
        }
        const sense_output_t out = sense_measure(&config, &state, &frame);
        if (k > 9) {
            EXPECT_NEAR(out.speed_rad_s[2], 40 * config.encoder_rad_per_count / 0.01f, 0.22f); // two pulses: the bridge truncates
        }
        EXPECT_EQ((out.usable >> 2u) & 1u, k >= 20 && k < 25 ? 0u : 1u);
    }
}

TEST(Sense, impossible_counts_are_called_absurd_and_not_used) {
    const sense_config_t config = rover_config_default().sense;
    sense_state_t state = {};
    sensor_frame_t frame = quiet_frame();
    sense_measure(&config, &state, &frame);
    frame.encoder_count[1] = 100000;
    frame.current_count[3] = 4095;
    frame.battery_count = 0;
    frame.accel_x_count = INT16_MIN;
    frame.gyro_z_count = INT16_MAX;
    frame.radar_count[2] = 1024;
    const sense_output_t out = sense_measure(&config, &state, &frame);
    EXPECT_EQ(out.absurd, (FRAME_ENCODER_0 << 1u) | (FRAME_CURRENT_0 << 3u) | FRAME_BATTERY | FRAME_ACCEL | FRAME_GYRO | FRAME_RADAR);
    EXPECT_EQ(out.usable, 0xfffu & ~out.absurd);
    EXPECT_EQ(out.speed_rad_s[1], 0.0f);
    EXPECT_FLOAT_EQ(out.battery_V, 7.2f);
}

TEST(Sense, scales_every_raw_count) {
    const sense_config_t config = rover_config_default().sense;
    sense_state_t state = {};
    sensor_frame_t frame = quiet_frame();
    frame.current_count[0] = 2048 + 500;
    frame.accel_x_count = -250;
    frame.gyro_z_count = 2000;
    const sense_output_t out = sense_measure(&config, &state, &frame);
    EXPECT_FLOAT_EQ(out.current_A[0], 1.0f);
    EXPECT_FLOAT_EQ(out.accel_x_m_s2, -1.0f);
    EXPECT_FLOAT_EQ(out.gyro_z_rad_s, 1.0f);
    EXPECT_FLOAT_EQ(out.battery_V, 7.2f);
}

TEST(Sense, derivative_is_its_formula_for_a_wheel_that_jumps) {
    const sense_config_t config = rover_config_default().sense;
    sense_state_t state = {};
    sensor_frame_t frame = quiet_frame();
    std::vector<int> counts;
    for (int k = 0; k < 40; ++k) {
        counts.push_back(k < 20 ? 100 : counts.back() + 300); // 31 rad/s from one tick to the next, as no grip holds it
        for (auto &count : frame.encoder_count) {
            count = counts.back();
        }
        const sense_output_t out = sense_measure(&config, &state, &frame);
        if (k >= 8) {
            const std::size_t n = static_cast<std::size_t>(k);
            const double bend = counts[n] - 2 * counts[n - 4] + counts[n - 8];
            EXPECT_NEAR(out.accel_rad_s2[2], bend * (2 * M_PI / 6000) / (0.04 * 0.04), 1e-3) << k; // (2); float roundings of 800
        }
    }
}

TEST(Sense, an_encoder_that_falls_silent_after_its_first_count_is_at_rest) {
    const sense_config_t config = rover_config_default().sense;
    sense_state_t state = {};
    sensor_frame_t frame = quiet_frame();
    for (auto &count : frame.encoder_count) {
        count = 1234567;
    }
    for (const float accel : sense_measure(&config, &state, &frame).accel_rad_s2) {
        EXPECT_EQ(accel, 0); // nothing to differentiate yet
    }
    frame.present &= ~15u;
    for (int k = 0; k < 30; ++k) {
        const sense_output_t out = sense_measure(&config, &state, &frame);
        for (int i = 0; i < WHEEL_COUNT; ++i) {
            EXPECT_EQ(out.speed_rad_s[i], 0);
            EXPECT_EQ(out.accel_rad_s2[i], 0);
        }
    }
}

TEST(Sense, both_rails_of_a_signed_converter_are_absurd) {
    const sense_config_t config = rover_config_default().sense;
    for (const int16_t rail : {int16_t{INT16_MIN}, int16_t{INT16_MAX}}) {
        sense_state_t state = {};
        sensor_frame_t frame = quiet_frame();
        frame.accel_x_count = rail;
        EXPECT_EQ(sense_measure(&config, &state, &frame).absurd, static_cast<uint32_t>(FRAME_ACCEL));
        frame.accel_x_count = 0;
        frame.gyro_z_count = rail;
        EXPECT_EQ(sense_measure(&config, &state, &frame).absurd, static_cast<uint32_t>(FRAME_GYRO));
    }
}

} // namespace
