// safety_step by itself, against a model of its own of safety.h and of the table in docs/firmware.md: any inputs, one after the other.
#include "firmware/core/rover_config.h"
#include "firmware/core/safety.h"
#include "tests/unit/clutter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace {

double wide(float x) { return static_cast<double>(x); }
float narrow(double x) { return static_cast<float>(x); }

struct Rover {
    safety_config_t config = rover_config_default().safety;
    safety_state_t state = {};
    sensor_frame_t frame = {};
    safety_input_t input = {};
    safety_output_t out = {};

    Rover() {
        input.usable = 0xfff;
        input.battery_V = 7.2f;
        frame.present = FRAME_ALL;
        frame.radar_samples = 0;
        for (float &speed : input.speed_rad_s) speed = 3;
        input.high_rad_s = 3;
        input.least_rad_s = 3;
    }
    const safety_output_t &step(int ticks = 1) {
        for (int k = 0; k < ticks; ++k) {
            input.frame = &frame;
            out = safety_step(&config, &state, &input);
            frame.tick++;
        }
        return out;
    }
};

// In which call a lasting cause raises `fault`; 0: not within `most`. Until then, no fault at all.
int when(const std::function<void(Rover &)> &cause, uint32_t fault, int most = 400) {
    Rover rover;
    rover.step(3);
    cause(rover);
    for (int k = 1; k <= most; ++k) {
        rover.step();
        if (rover.out.faults != 0) {
            EXPECT_EQ(rover.out.faults, fault);
            EXPECT_EQ(rover.out.motors_off, (fault & ~static_cast<uint32_t>(SAFETY_LIMITING)) != 0);
            return k;
        }
        EXPECT_EQ(rover.out.wheels, 0u);
        EXPECT_EQ(rover.out.limited, 0u);
    }
    return 0;
}

TEST(SafetySteps, each_sensor_has_its_latch_and_its_wheel_after_its_patience) {
    const uint32_t lost[] = {FAULT_ENCODER_LOST, FAULT_ENCODER_LOST, FAULT_ENCODER_LOST, FAULT_ENCODER_LOST,
                             FAULT_CURRENT_LOST, FAULT_CURRENT_LOST, FAULT_CURRENT_LOST, FAULT_CURRENT_LOST,
                             FAULT_BATTERY_LOST, FAULT_ACCEL_LOST,   FAULT_GYRO_LOST,    FAULT_RADAR_LOST};
    for (uint32_t bit = 0; bit < 12; ++bit) {
        for (const bool absurd : {false, true}) {
            const uint32_t fault = absurd ? static_cast<uint32_t>(FAULT_ABSURD_SENSOR) : lost[bit];
            const auto spoil = [&](Rover &rover) {
                if (absurd)
                    rover.input.absurd = 1u << bit;
                else
                    rover.input.usable &= ~(1u << bit);
            };
            EXPECT_EQ(when(spoil, fault), 8) << bit; // 7 bad ticks are forgiven: 80 ms
            Rover rover;
            spoil(rover);
            rover.step(8);
            EXPECT_EQ(rover.out.wheels, bit < 8 ? 1u << bit % 4 : 0u);
            Rover forgiven; // one good tick clears the count
            for (int round = 0; round < 5; ++round) {
                spoil(forgiven);
                EXPECT_EQ(forgiven.step(7).faults, 0u) << bit;
                forgiven.input.absurd = 0;
                forgiven.input.usable = 0xfff;
                EXPECT_EQ(forgiven.step().faults, 0u);
            }
            Rover other; // a count that runs is not lost while another sensor begins to fail, nor by one that stays well
            spoil(other);
            other.step(4);
            other.input.usable &= ~(1u << (bit + 1) % 12);
            EXPECT_EQ(other.step(3).faults, 0u);
            EXPECT_EQ(other.step().faults, fault);
        }
    }
    Rover without; // who does not have it does not miss it, but what it says must make sense
    without.config.required = 0;
    without.input.usable = 0;
    without.frame.present = 0;
    EXPECT_EQ(without.step(30).faults, 0u);
    without.input.absurd = 4;
    EXPECT_EQ(without.step(8).faults, static_cast<uint32_t>(FAULT_ABSURD_SENSOR));
}

TEST(SafetySteps, line_bridges_and_command_have_theirs) {
    EXPECT_EQ(when([](Rover &r) { r.frame.emergency_stop = true; }, FAULT_EMERGENCY_STOP), 1);
    EXPECT_EQ(when([](Rover &r) { r.frame.present &= ~static_cast<uint32_t>(FRAME_EMERGENCY_STOP); }, FAULT_EMERGENCY_STOP), 8);
    EXPECT_EQ(when([](Rover &r) { r.input.command_age_ticks = 9; }, FAULT_COMMAND_TIMEOUT), 1);
    EXPECT_EQ(when([](Rover &r) { r.input.command_age_ticks = 8; }, FAULT_COMMAND_TIMEOUT), 0);
    EXPECT_EQ(when([](Rover &r) { r.input.estimator = FAULT_SPEED_BEYOND; }, FAULT_SPEED_BEYOND), 1);
    for (uint32_t wheel = 0; wheel < 4; ++wheel) {
        const auto silent = [&](Rover &r) { r.frame.present &= ~(static_cast<uint32_t>(FRAME_BRIDGE_0) << wheel); };
        const auto ill = [&](Rover &r) { r.frame.bridge_status[wheel] = 2; };
        EXPECT_EQ(when(silent, FAULT_BRIDGE), 8);
        EXPECT_EQ(when(ill, FAULT_BRIDGE), 8);
        for (const bool by_silence : {true, false}) {
            Rover rover;
            rover.step(3);
            by_silence ? silent(rover) : ill(rover);
            EXPECT_EQ(rover.step(7).wheels, 0u);
            EXPECT_EQ(rover.step().wheels, 1u << wheel);
            rover.frame.present = FRAME_ALL; // what is over clears with MODE_STOP, at once
            rover.frame.bridge_status[wheel] = 0;
            EXPECT_EQ(rover.step(5).wheels, 1u << wheel);
            rover.input.command_stop = true;
            EXPECT_EQ(rover.step().faults, 0u);
            EXPECT_EQ(rover.out.wheels, 0u);
            rover.input.command_stop = false;
            by_silence ? silent(rover) : ill(rover);
            EXPECT_EQ(rover.step(7).faults, 0u); // and its count with a good tick
        }
        for (const bool contradicts : {true, false}) {
            Rover rover;
            (contradicts ? rover.input.contradict : rover.input.broken) = 1u << wheel;
            rover.step();
            EXPECT_EQ(rover.out.faults, static_cast<uint32_t>(contradicts ? FAULT_ENCODER_CIRCUIT : FAULT_MOTOR_OPEN));
            EXPECT_EQ(rover.out.wheels, 1u << wheel);
            EXPECT_EQ(rover.out.limited, contradicts ? 0u : 1u << wheel);
            EXPECT_EQ(rover.out.motors_off, contradicts);
        }
    }
}

// Missed ticks: what jumps, what is forgotten, and for how long.
TEST(SafetySteps, missed_ticks_are_counted_and_one_is_forgotten_per_hundred_good_ones) {
    clutter::Random random{51};
    for (int drive = 0; drive < 20; ++drive) {
        Rover rover;
        rover.step();
        double missed = 0;
        int good = 0;
        for (int k = 0; k < 1500; ++k) {
            const auto chance = random.next() % 4000;
            const uint32_t jump = chance < 40 ? 1 + static_cast<uint32_t>(chance % 4) : chance == 50 ? 20 : chance == 51 ? UINT32_MAX : 0;
            rover.frame.tick += jump;
            rover.input.command_stop = k % 50 == 0;
            rover.step();
            if (jump != 0) {
                missed = std::fmin(missed + jump, UINT32_MAX); // time that stands still or runs back is a jump of nearly 2^32
                good = 0;
            } else if (missed > 0 && ++good == 100) {
                missed = std::fmin(missed, 6) - 1;
                good = 0;
            }
            if (rover.input.command_stop) {
                EXPECT_EQ(rover.out.faults, missed > 5 ? static_cast<uint32_t>(FAULT_MISSED_TICKS) : 0u) << k;
            } else if (missed > 5) {
                EXPECT_TRUE(rover.out.motors_off);
            }
        }
    }
}

// (1), (2) and stall of four wheels at any currents.
TEST(SafetySteps, currents_are_integrated_wheel_by_wheel) {
    clutter::Random random{52};
    int hot = 0, over = 0, stalled = 0;
    for (int drive = 0; drive < 60; ++drive) {
        Rover rover;
        rover.config.temperature_rise_max_K = narrow(10 + 50 * random.uniform());
        const std::array<float, 4> warm = {1, narrow(20 * random.uniform()), -3, std::numeric_limits<float>::quiet_NaN()};
        safety_warm(&rover.config, &rover.state, warm.data());
        const double limit_K = wide(rover.config.temperature_rise_max_K);
        std::array<double, 4> rise = {1, wide(warm[1]), 0, 0.8 * limit_K}, x{}, stall{};
        uint32_t limited = 0, wheels = 0, faults = 0;
        std::array<double, 4> mean{};
        for (double &m : mean) m = 6 * random.uniform() - 3;
        for (int k = 0; k < 600; ++k) {
            bool close = false; // to a limit: the next tick tells
            for (std::size_t i = 0; i < 4; ++i) {
                const double I = mean[i] * (k % 200 < 130 ? 1 : 0.2) + 0.3 * random.normal();
                rover.input.current_A[i] = narrow(I);
                rover.input.speed_rad_s[i] = narrow((k % 300 < 220 ? 0.29 : 0.31) * (i % 2 == 0 ? 1 : -1));
                x[i] = std::fmax(0, x[i] + (I * I - 1.5 * 1.5) * 0.01); // (1) [A^2 s]
                const bool is_over = x[i] > 8;
                if (k % 4 == static_cast<int>(i)) { // (2), one wheel a tick: 4 T
                    const double Ra = 3.24, C = 4 * 0.01 * Ra / wide(rover.config.heating_K_A2),
                                 R = 0.04 / C / (1 - wide(rover.config.keeping));
                    rise[i] += 0.04 * (I * I * Ra - rise[i] / R) / C;
                }
                const bool is_hot = rise[i] > limit_K;
                stall[i] = std::fabs(I) > 1.4 && k % 300 < 220 ? stall[i] + 0.01 : 0;
                const bool is_stalled = stall[i] > 1.0;
                close = close || std::fabs(x[i] - 8) < 1e-2 || std::fabs(rise[i] - limit_K) < 1e-2 ||
                        std::fabs(std::fabs(I) - 1.4) < 1e-4 ||
                        std::fabs(stall[i] - 1) < 1e-3; // a hundredth of a second, as a sum of floats
                if (is_over) faults |= FAULT_OVER_CURRENT;
                if (is_hot) faults |= FAULT_OVER_TEMPERATURE;
                if (is_stalled) faults |= FAULT_STALL;
                limited |= is_over || is_stalled ? 1u << i : 0u;
                wheels |= is_over || is_stalled || is_hot ? 1u << i : 0u;
                over += is_over ? 1 : 0, hot += is_hot ? 1 : 0, stalled += is_stalled ? 1 : 0;
            }
            rover.step();
            if (close) continue;
            EXPECT_EQ(rover.out.faults, faults) << k;
            EXPECT_EQ(rover.out.limited, limited) << k;
            EXPECT_EQ(rover.out.wheels, wheels) << k;
            for (std::size_t i = 0; i < 4; ++i) {
                EXPECT_NEAR(rover.state.i2t_A2_ticks[i], 100 * x[i], 1e-3 * (1 + 100 * x[i]));
                EXPECT_NEAR(rover.state.rise_K[i], rise[i], 1e-3 * (1 + rise[i]));
            }
        }
    }
    EXPECT_GT(std::min({hot, over, stalled}), 20);
}

TEST(SafetySteps, a_stall_lasts_a_second_and_each_bound_is_its_own) {
    const auto stalls = [](double current, double speed) {
        return when(
            [&](Rover &r) {
                r.config.i2t_max_A2_ticks = 1e9f;
                r.config.temperature_rise_max_K = 1e9f;
                r.input.current_A[2] = narrow(current), r.input.speed_rad_s[2] = narrow(speed);
            },
            FAULT_STALL);
    };
    for (const double way : {1.0, -1.0}) {
        EXPECT_NEAR(stalls(1.41 * way, 0.29), 101, 1); // more than a second; 100 floats of 0.01 may sum up to just beyond
        EXPECT_NEAR(stalls(1.41, 0.29 * way), 101, 1);
        EXPECT_EQ(stalls(1.39 * way, 0.0), 0);
        EXPECT_EQ(stalls(3.0, 0.31 * way), 0);
    }
}

TEST(SafetySteps, a_battery_is_low_for_half_a_second_or_gone_for_thirty_milliseconds) {
    const auto at = [](float volt, uint32_t fault) { return when([&](Rover &r) { r.input.battery_V = volt; }, fault); };
    EXPECT_NEAR(at(5.39f, FAULT_LOW_BATTERY), 51, 1);
    EXPECT_EQ(at(5.41f, FAULT_LOW_BATTERY), 0);
    EXPECT_NEAR(at(4.33f, FAULT_LOW_BATTERY), 51, 1);
    EXPECT_EQ(at(4.31f, FAULT_BROWN_OUT), 3); // 0.8 of 5.4 V, more than two ticks
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(at(std::copysign(nan, 1.0f), FAULT_BROWN_OUT), 0);  // above every number,
    EXPECT_EQ(at(std::copysign(nan, -1.0f), FAULT_BROWN_OUT), 3); // or below
}

// SPEED_DISAGREE over any speeds: the fastest wheel that turns this way, times 1.5, and 0.15 m/s, less three sigma.
TEST(SafetySteps, the_ground_passes_faster_than_wheels_explain) {
    clutter::Random random{53};
    int disagreed = 0;
    for (int k = 0; k < 300; ++k) {
        Rover rover;
        const double v = 3 * random.uniform() - 1.5, high = 6 * random.uniform(), low = -6 * random.uniform(), std = 0.1 * random.uniform();
        rover.input.ground_speed_m_s = narrow(v);
        rover.input.ground_speed_std_m_s = narrow(std);
        rover.input.high_rad_s = narrow(high);
        rover.input.low_rad_s = narrow(low);
        const double radius = wide(rover.config.disagree_ratio_m) / 1.5;
        const double beyond = std::fabs(v) - 3 * std - 1.5 * radius * (v < 0 ? -low : high) - 0.15;
        if (std::fabs(beyond) < 1e-4) continue;
        rover.step(99);
        EXPECT_EQ(rover.out.faults, 0u);
        rover.step(3);
        EXPECT_EQ(rover.out.faults, beyond > 0 ? static_cast<uint32_t>(FAULT_SPEED_DISAGREE) : 0u) << v << ' ' << high << ' ' << low;
        disagreed += beyond > 0 ? 1 : 0;
    }
    EXPECT_GT(disagreed, 30);
    Rover rover; // an uncertainty that runs below zero claims no disagreement of its own
    rover.input.ground_speed_std_m_s = -1;
    EXPECT_EQ(rover.step(200).faults, 0u);
}

// (3) by its definition, whatever the blocks fall into.
TEST(SafetySteps, a_front_end_is_dead_after_six_blocks_without_noise_while_wheels_turn) {
    clutter::Random random{54};
    int dead = 0, alive = 0;
    for (int drive = 0; drive < 60; ++drive) {
        Rover rover;
        std::vector<int> block;
        int blocks = 0;
        const double noise = 0.6 + 0.6 * random.uniform(), drift = drive % 3 == 0 ? 2 : 0;
        const bool stops = drive % 4 == 1, absent = drive % 4 == 2;
        double level = 200;
        uint32_t faults = 0;
        for (int k = 0; k < 300; ++k) {
            const bool turning = !(stops && k % 30 == 29), here = !(absent && k % 3 == 0);
            rover.input.least_rad_s = turning ? 1.01f * rover.config.turning_rad_s : 0.99f * rover.config.turning_rad_s;
            rover.input.usable = here ? 0xfffu : 0x7ffu;
            rover.frame.radar_samples = static_cast<uint8_t>(4 + random.next() % 4);
            for (int n = 0; n < rover.frame.radar_samples; ++n) {
                level = level + drift > 1000 ? 200 : level + drift;
                rover.frame.radar_count[n] = static_cast<uint16_t>(std::lround(level + noise * random.normal()));
            }
            if (!turning && here) {
                block.clear();
                blocks = 0;
            }
            for (int n = 0; turning && here && n < rover.frame.radar_samples; ++n) {
                block.push_back(rover.frame.radar_count[n]);
                if (block.size() < 32) continue;
                double sum = 0, square = 0;
                for (const int x : block) sum += x, square += static_cast<double>(x) * x;
                const double variance = square / 32 - sum / 32 * sum / 32;
                blocks = variance < wide(narrow(rover.config.radar_dead_count2)) / 1024 ? blocks + 1 : 0;
                block.clear();
            }
            rover.step();
            if (here && turning && blocks >= 6) faults = FAULT_RADAR_LOST;
            EXPECT_EQ(rover.out.faults, faults) << drive << ' ' << k;
        }
        (faults != 0 ? dead : alive) += 1;
    }
    EXPECT_GT(std::min(dead, alive), 5);
    EXPECT_EQ(rover_config_default().safety.radar_dead_blocks, 6u); // 0.3 s and a block
}

TEST(SafetySteps, what_nobody_knows_of_a_winding_is_that_it_is_warm) {
    Rover rover;
    safety_warm(&rover.config, &rover.state, nullptr);
    for (const float rise : rover.state.rise_K) EXPECT_FLOAT_EQ(rise, 0.8f * rover.config.temperature_rise_max_K);
    const float infinity = std::numeric_limits<float>::infinity();
    const float given[] = {40, -5, 2000, infinity};
    safety_warm(&rover.config, &rover.state, given);
    EXPECT_EQ(rover.state.rise_K[0], 40);
    EXPECT_EQ(rover.state.rise_K[1], 0);
    EXPECT_EQ(rover.state.rise_K[2], 1000);
    EXPECT_FLOAT_EQ(rover.state.rise_K[3], 0.8f * rover.config.temperature_rise_max_K);
}

} // namespace
