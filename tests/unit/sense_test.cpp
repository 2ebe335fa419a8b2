#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
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

// A model of its own: every place of every wheel at every tick there ever was, what was missed on the line between two counts. Gaps,
// silence, absurd and refused counts, another clock and counters that wrap, in any order.
struct Model {
    const sense_config_t &config;
    std::vector<long> place[WHEEL_COUNT]; // pulses, by tick
    long good[WHEEL_COUNT] = {}, step[WHEEL_COUNT] = {};
    std::size_t when[WHEEL_COUNT] = {}; // of the last good count
    double since_us[WHEEL_COUNT] = {}, speed[WHEEL_COUNT] = {}, current[WHEEL_COUNT] = {}, battery = 0, accel = 0, gyro = 0;
    bool seen[WHEEL_COUNT] = {}, stepped[WHEEL_COUNT] = {}, counted[WHEEL_COUNT] = {};
    double q = 2 * M_PI / 6000;

    explicit Model(const sense_config_t &of) : config(of) {}
    double bend(int i) const {
        const auto &p = place[i];
        const std::size_t n = p.size();
        const auto at = [&](std::size_t back) { return p[n > back ? n - 1 - back : 0]; };
        const long limit = 4l * config.encoder_step_max;
        return static_cast<double>(std::clamp(at(0) - 2 * at(4) + at(8), -limit, limit)) * config.encoder_sign[i] * q / 0.0016;
    }
    // One frame, `n` ticks and `us` after the one before; true counts `said`, or silence.
    void measure(int i, int n, double us, bool here, long said, sense_output_t &expected) {
        const uint32_t bit = 1u << static_cast<unsigned>(i);
        auto &p = place[i];
        const auto silent = static_cast<long>(p.size()) - 1 - static_cast<long>(when[i]) + n;
        since_us[i] += us;
        counted[i] = here;
        if (here && (!seen[i] || silent > 1000)) { // it begins anew
            p.assign(SENSE_RING, said);            // as if it had always been there
            when[i] = SENSE_RING - 1, good[i] = said, step[i] = 0, speed[i] = 0, since_us[i] = 0;
            seen[i] = true, stepped[i] = false;
            expected.usable |= bit;
            return;
        }
        const long ticks = std::min(silent, 1000l);
        const long base = p.empty() ? 0 : p[when[i]];
        long moved = step[i] * ticks;
        if (here) {
            const long change = said - good[i];
            if (std::labs(change) > config.encoder_step_max * ticks) {
                expected.absurd |= bit;
            } else {
                moved = change;
                const long a_tick = change / ticks;
                if (stepped[i] && std::labs(a_tick - step[i]) > config.encoder_jump_max * ticks) expected.jumped |= bit;
                stepped[i] = true;
                step[i] = a_tick;
                const bool punctual = std::fabs(since_us[i] - 10000) < 50;
                speed[i] = static_cast<double>(change) * config.encoder_sign[i] * q / (punctual ? 0.01 : since_us[i] * 1e-6); // (1)
                expected.usable |= bit;
            }
            good[i] = said;
        }
        p.resize(when[i] + 1 + static_cast<std::size_t>(silent), 0);
        for (long back = 0; back < ticks && back < 12; ++back)
            p[p.size() - 1 - static_cast<std::size_t>(back)] = base + moved - moved * back / ticks;
        if (here) when[i] = p.size() - 1, since_us[i] = 0;
    }
};

TEST(Sense, any_frames_give_what_a_memory_of_all_of_them_gives) {
    std::uint64_t seed = 9;
    const auto next = [&] { return (seed = seed * 6364136223846793005u + 1442695040888963407u) >> 33; };
    const auto uniform = [&] { return static_cast<double>(next()) / 2147483648.0; };
    int absurd = 0, jumped = 0, refused = 0, gaps = 0, anew = 0, late = 0;
    for (int drive = 0; drive < 60; ++drive) {
        control_config_t whole = rover_config_default();
        whole.sense.encoder_sign[1] = -1;
        const sense_config_t &config = whole.sense;
        Model model(config);
        sense_state_t state = {};
        double pulses[WHEEL_COUNT] = {}, rate[WHEEL_COUNT] = {};
        sensor_frame_t frame = quiet_frame();
        const auto start = static_cast<std::uint32_t>(next() * 2);
        const bool steady = drive % 2 == 0, rough = drive % 3 == 0;
        bool timed = false;
        frame.time_us = static_cast<std::uint32_t>(-200000 + drive);
        frame.tick = 100;
        for (int k = 0; k < 200; ++k) {
            const auto chance = next() % 100;
            const int n = k == 0 || steady                ? 1
                          : chance < 6                    ? 2 + static_cast<int>(next() % 12)
                          : chance == 7 && drive % 5 == 1 ? 1001
                          : chance > 90 && drive % 5 == 2 ? 1000
                          : chance == 7 && drive % 5 == 3 ? 700
                                                          : 1;
            const int counted = n > 1000 ? 1 : n; // time that leaps is for safety
            frame.elapsed_ticks = k == 0 ? 1 : next() % 2 == 0 ? static_cast<std::uint32_t>(n) : 0;
            frame.tick += static_cast<std::uint32_t>(n);
            frame.present = FRAME_ALL;
            if (rough && next() % 8 == 0) frame.present &= ~static_cast<std::uint32_t>(FRAME_TIME);
            const double true_us = 10000.0 * n + (rough ? std::floor(300 * uniform() - 150) : std::floor(120 * uniform() - 60));
            const bool leaps = rough && next() % 16 == 0;
            const double us = leaps ? (next() % 2 == 0 ? 0.49 : 1.51) * 10000 * counted : true_us;
            frame.time_us += static_cast<std::uint32_t>(us);
            const bool has_time = (frame.present & FRAME_TIME) != 0;
            const double seen_us = has_time && timed && us > 5000.0 * counted && us < 15000.0 * counted ? us : 10000.0 * counted;
            if (!has_time) frame.time_us -= static_cast<std::uint32_t>(us); // as if it had not been asked
            timed = has_time;
            sense_output_t expected = {};
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                const auto u = static_cast<unsigned>(i);
                rate[i] = std::clamp(rate[i] + 4 * uniform() - 2 + (next() % 40 == 0 ? 200 * uniform() - 100 : 0), -400.0, 400.0);
                pulses[i] += rate[i] * counted + (next() % 60 == 0 ? 1e5 : 0);
                const auto said = static_cast<long>(std::floor(pulses[i]));
                frame.encoder_count[i] = static_cast<std::int32_t>(start + static_cast<std::uint32_t>(said));
                const bool here = !(next() % 10 == 0 || (drive % 7 == 3 && i == 2 && k > 20 && k < 30));
                if (!here) frame.present &= ~(static_cast<std::uint32_t>(FRAME_ENCODER_0) << u);
                const bool was = model.seen[i];
                model.measure(i, counted, seen_us, here, said, expected);
                anew += here && was && model.place[i].size() == SENSE_RING ? 1 : 0;
                const int current = static_cast<int>(next() % 5000) - 400;
                frame.current_count[i] = static_cast<std::uint16_t>(std::clamp(current, 0, 4095));
                if (next() % 10 == 0)
                    frame.present &= ~(static_cast<std::uint32_t>(FRAME_CURRENT_0) << u);
                else if (current <= 0 || current >= 4095)
                    expected.absurd |= FRAME_CURRENT_0 << u;
                else
                    expected.usable |= FRAME_CURRENT_0 << u, model.current[i] = (current - 2048) * 0.002;
            }
            const auto scalar = [&](std::uint32_t bit, bool sane, double &to, double value) {
                if (next() % 10 == 0)
                    frame.present &= ~bit;
                else if (!sane)
                    expected.absurd |= bit;
                else
                    expected.usable |= bit, to = value;
            };
            frame.battery_count = static_cast<std::uint16_t>(std::clamp(static_cast<int>(next() % 5000) - 400, 0, 4095));
            scalar(FRAME_BATTERY, frame.battery_count > 0 && frame.battery_count < 4095, model.battery, frame.battery_count * 0.004);
            frame.accel_x_count = static_cast<std::int16_t>(next() % 20 == 0 ? (next() % 2 == 0 ? INT16_MIN : INT16_MAX)
                                                                             : static_cast<int>(next() % 8000) - 4000);
            scalar(FRAME_ACCEL, std::abs(frame.accel_x_count) < 32767, model.accel, frame.accel_x_count * 0.004);
            frame.gyro_z_count = static_cast<std::int16_t>(next() % 20 == 0 ? (next() % 2 == 0 ? INT16_MIN : INT16_MAX)
                                                                            : static_cast<int>(next() % 8000) - 4000);
            scalar(FRAME_GYRO, std::abs(frame.gyro_z_count) < 32767, model.gyro, frame.gyro_z_count * 0.0005);
            frame.radar_samples = static_cast<std::uint8_t>(next() % 20 == 0 ? 64 + next() % 2 : next() % 7);
            for (auto &count : frame.radar_count) count = 1023;
            const auto bad = static_cast<std::size_t>(next() % 64);
            frame.radar_count[bad] = 1024;
            double none = 0;
            const bool sane = frame.radar_samples <= 64 && bad >= frame.radar_samples;
            if (sane && frame.radar_samples == 0)
                scalar(FRAME_RADAR, true, none, 0), expected.usable &= ~static_cast<std::uint32_t>(FRAME_RADAR);
            else
                scalar(FRAME_RADAR, sane, none, 0);
            const sense_state_t before = state;
            sense_output_t out = sense_measure(&config, &state, &frame);
            EXPECT_EQ(out.elapsed_ticks, static_cast<std::uint32_t>(counted));
            ASSERT_EQ(out.absurd, expected.absurd) << drive << ' ' << k;
            ASSERT_EQ(out.usable, expected.usable) << drive << ' ' << k;
            ASSERT_EQ(out.jumped, expected.jumped) << drive << ' ' << k;
            EXPECT_NEAR(out.battery_V, model.battery, 1e-4);
            EXPECT_NEAR(out.accel_x_m_s2, model.accel, 1e-4);
            EXPECT_NEAR(out.gyro_z_rad_s, model.gyro, 1e-5);
            lean_state_t lean = before.lean; // as lean.h has it, of the same counts, where all three rates are there and none at its rail
            const bool rates = (frame.present & FRAME_GYRO) != 0 && std::abs(frame.gyro_z_count) < 32767;
            lean_input_t input = {};
            input.gyro_count[0] = frame.gyro_x_count, input.gyro_count[1] = frame.gyro_y_count, input.gyro_count[2] = frame.gyro_z_count;
            input.accel_count[0] = frame.accel_x_count, input.accel_count[1] = frame.accel_y_count;
            input.accel = (frame.present & FRAME_ACCEL) != 0;
            input.standing = before.standing, input.moved_q8 = before.gyro_q8, input.elapsed_ticks = out.elapsed_ticks;
            if (rates && (frame.gyro_x_count < 32767 && frame.gyro_y_count > -32768)) lean_step(&config.lean, &lean, &input);
            EXPECT_EQ(out.lean_q8, lean.lean_q8);
            if ((expected.usable & FRAME_ACCEL) != 0) {
                EXPECT_NEAR(out.level_m_s2, model.accel - lean.lean_q8 * 0.004 / 256, 1e-4);
            }
            state.standing = k > 20 && k < 140; // long enough to know its gyros
            state.gyro_q8 = k > 150 ? 700 : 0;
            frame.gyro_x_count = static_cast<std::int16_t>(next() % 20 == 0 ? INT16_MAX : static_cast<int>(next() % 400) - 200);
            frame.gyro_y_count = static_cast<std::int16_t>(next() % 20 == 0 ? INT16_MIN : static_cast<int>(next() % 400) - 200);
            frame.accel_y_count = static_cast<std::int16_t>(static_cast<int>(next() % 800) - 400);
            for (int i = 0; i < WHEEL_COUNT; ++i) {
                EXPECT_NEAR(out.current_A[i], model.current[i], 1e-5);
                ASSERT_NEAR(out.speed_rad_s[i], model.speed[i], 1e-5 * (1 + std::fabs(model.speed[i]))) << drive << ' ' << k << ' ' << i;
                ASSERT_NEAR(out.accel_rad_s2[i], model.bend(i), 1e-5 * (1 + std::fabs(model.bend(i)))) << drive << ' ' << k << ' ' << i;
                if (next() % 12 != 0 || !model.counted[i]) continue; // another part refuses it
                const double instead = next() % 10 == 0 ? 1e6 : 30 * uniform() - 15;
                const double count = std::clamp(instead * 0.01 / model.q, -1.0 * config.encoder_step_max, 1.0 * config.encoder_step_max);
                if (std::fabs(std::fabs(count) - std::floor(std::fabs(count)) - 0.5) < 1e-3) continue;
                sense_replace(&config, &state, &out, i, static_cast<float>(instead));
                const long step = std::lround(count) * config.encoder_sign[i];
                auto &p = model.place[i];
                const long old = p.size() > 1 ? p[p.size() - 2] : p[0];
                p.back() = old + step;
                model.step[i] = step;
                model.speed[i] = count * model.q / 0.01;
                EXPECT_NEAR(out.speed_rad_s[i], model.speed[i], 1e-4 * (1 + std::fabs(model.speed[i])));
                refused++;
            }
            for (std::uint32_t bits = out.absurd & 15u; bits != 0; bits &= bits - 1) absurd++;
            for (std::uint32_t bits = out.jumped; bits != 0; bits &= bits - 1) jumped++;
            gaps += counted > 1 ? 1 : 0;
            late += std::fabs(seen_us - 10000) > 50 && counted == 1 ? 1 : 0;
        }
    }
    EXPECT_GT(anew, 0);
    EXPECT_GT(std::min({absurd, jumped, refused, gaps, late}), 20)
        << absurd << ' ' << jumped << ' ' << refused << ' ' << gaps << ' ' << late;
}

} // namespace
