// What `./traction prove` takes as given because no interval holds it (tests/fuzz/prove.h), held here in every tick of arbitrary frames:
// extremes in a row, gaps, railed and silent sensors.
#include "firmware/core/rover_config.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <cstring>

namespace {

std::uint64_t next(std::uint64_t &random) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    return random >> 24;
}

std::int16_t count16(std::uint64_t &random, int how) {
    const auto any = static_cast<std::int16_t>(next(random));
    return how == 0   ? INT16_MIN + 1
           : how == 1 ? INT16_MAX - 1
           : how == 2 ? static_cast<std::int16_t>(any > 0 ? INT16_MAX - 1 : INT16_MIN + 1)
                      : any;
}

void hold(const control_config_t &config, const control_state_t &state, int tick) {
    for (int i = 0; i < WHEEL_COUNT; i++) {
        ASSERT_LE(std::abs(state.sense.step[i]), config.sense.encoder_step_max) << tick;
    }
    for (int i = 0; i < DOPPLER_BLOCKS; i++) {
        const int most = i == state.doppler.block ? state.doppler.in_block : DOPPLER_BLOCK;
        ASSERT_LE(state.doppler.made[i], most) << tick;
        ASSERT_LE(state.doppler.railed[i], most) << tick;
        ASSERT_GE(state.doppler.made[i], 0) << tick;
        ASSERT_GE(state.doppler.railed[i], 0) << tick;
    }
    for (const std::int32_t rest : state.sense.lean.rest_q8) {
        ASSERT_LE(rest, 32767 * 256) << tick;
        ASSERT_GE(rest, -32768 * 256) << tick;
    }
    for (const std::int32_t sum : state.sense.lean.calm_sum) {
        ASSERT_LE(std::abs(sum), state.sense.lean.calm_ticks * config.sense.lean.calm_count) << tick;
    }
    ASSERT_LT(state.sense.lean.calm_ticks, 64) << tick;
    ASSERT_LE(state.sense.lean.log2_ticks, 8) << tick;
    ASSERT_GE(state.sense.lean.log2_ticks, 0) << tick;
    ASSERT_LE(std::abs(state.ground_speed.lean_mean_q8), (1 << 26) - (1 << 17)) << tick;
    ASSERT_LE(state.safety.radar_samples, 31u) << tick;
    for (int i = 0; i < FFT_LENGTH; i++) {
        ASSERT_LE(state.doppler.window.sample[i], 16352) << tick;
        ASSERT_GE(state.doppler.window.sample[i], -16384) << tick;
    }
    const auto within = [tick](const char *what, std::int32_t value, std::int32_t low, std::int32_t high) {
        EXPECT_TRUE(value >= low && value <= high) << what << " " << value << " in tick " << tick;
    };
    within("gyro_q8", state.ground_speed.gyro_q8, -4194304, 4194304);
    within("sense.gyro_q8", state.sense.gyro_q8, -4194304, 4194304);
    within("clean", state.doppler.clean, 0, 256);
    within("late_samples", state.doppler.late_samples, -64, 191);
    within("gyro_alone_ticks", state.ground_speed.gyro_alone_ticks, 0, 1099);
    within("rolls_ticks", state.ground_speed.rolls_ticks, 0, 60);
    within("rolls_wait", state.ground_speed.rolls_wait, 0, 100);
    within("unheard_ticks", state.ground_speed.unheard_ticks, 0, 1000);
    within("still_ticks", state.ground_speed.still_ticks, 0, 1000);
    within("beyond", state.beyond, 0, 3);
    within("relief", state.doppler.relief, 0, 6);
    if (state.safety.radar_samples > 0) { // else it begins anew
        ASSERT_LE(std::abs(state.safety.radar_sum), 1023 * static_cast<int>(state.safety.radar_samples)) << tick;
    }
}

TEST(ProofAssumptions, hold_in_every_tick_of_any_frames) {
    for (const bool paper : {false, true}) {
        const control_config_t config = paper ? rover_config_paper() : rover_config_default();
        control_state_t state;
        control_reset(&config, &state);
        std::uint64_t random = 5;
        int how = 3, extremes = 0;
        std::uint32_t tick = 0, sequence = 1;
        for (int k = 0; k < 20000; k++) {
            if (next(random) % 64 == 0) {
                how = static_cast<int>(next(random) % 4);
            }
            sensor_frame_t frame = {};
            tick += next(random) % 50 == 0 ? static_cast<std::uint32_t>(next(random) % 1200) : 1u;
            frame.tick = tick;
            frame.present = next(random) % 8 == 0 ? static_cast<std::uint32_t>(next(random)) : static_cast<std::uint32_t>(FRAME_ALL);
            frame.time_us = tick * 10000u;
            frame.battery_count = 1800;
            frame.accel_x_count = count16(random, how);
            frame.accel_y_count = count16(random, how);
            frame.gyro_x_count = count16(random, how);
            frame.gyro_y_count = count16(random, how);
            frame.gyro_z_count = count16(random, how);
            const bool turns = k / 300 % 2 == 0; // as fast as they may, or wildly
            for (int i = 0; i < WHEEL_COUNT; i++) {
                frame.encoder_count[i] = turns ? static_cast<std::int32_t>(tick * 573u) : static_cast<std::int32_t>(next(random) % 3000);
                frame.current_count[i] = 2100;
            }
            frame.radar_samples = static_cast<std::uint8_t>(next(random) % (how == 0 ? 65 : 9));
            sequence += next(random) % 20 == 0 ? static_cast<std::uint32_t>(next(random) % 40) : 0u;
            frame.radar_sequence = k / 1000 % 3 == 0 ? 0u : sequence;
            sequence += frame.radar_samples;
            for (auto &count : frame.radar_count) {
                count = static_cast<std::uint16_t>(how == 0 ? 1023 : how == 1 ? 0 : next(random) % 1024);
            }
            command_t command = {};
            command.mode = k % 97 == 0 ? MODE_STOP : MODE_PLATFORM_SPEED;
            command.platform_speed_m_s = 0.5f;
            control_step(&config, &state, &command, &frame);
            hold(config, state, k);
            if (HasFatalFailure()) {
                return;
            }
            for (int i = 0; i < WHEEL_COUNT; i++) {
                extremes += state.sense.step[i] == config.sense.encoder_step_max ? 1 : 0;
            }
        }
        EXPECT_GT(extremes, 1000); // the frames reach what they are to try
    }
}

} // namespace
