// The self-test tick by tick, on a bench whose motors, encoders and sensors do what each case says: order and size of its pulses, each
// limit from both sides, each failure with its wheel. With plant and soils: tests/loop/self_test_test.cpp.
#include "firmware/core/rover_config.h"
#include "firmware/core/self_test.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace {

constexpr std::uint32_t all_bits = FRAME_ALL;

struct Bench {
    self_test_config_t config = rover_config_default().self_test;
    sense_config_t sense = rover_config_default().sense;
    self_test_state_t state{};
    self_test_result_t result{};
    sensor_frame_t frame{};
    trace_t trace{};
    std::vector<command_t> commands;
    // what the rover does
    std::array<double, 4> count_per_duty{40, 40, 40, 40}; // pulses a tick at full duty
    std::array<double, 4> flows{0.7, 0.7, 0.7, 0.7};      // share of duty V/Ra
    std::array<double, 4> turned{};
    std::function<void(Bench &, int tick)> also; // before a frame is shown

    Bench() {
        self_test_begin(&state, &result);
        frame.present = all_bits;
        for (auto &count : frame.encoder_count) count = 1000;
        frame.radar_samples = 4;
        radar(0, 1.2);
        frame.accel_x_count = 900; // what the converter says of x is in the trace, less its offset
        frame.accel_z_count = static_cast<std::int16_t>(std::lround(9.81 / static_cast<double>(config.accel_m_s2_per_count)));
        trace.battery_voltage_V = 7.2f;
    }
    // counts of mean `offset` beside the description's and of standard deviation `noise`, four samples a tick: mean -+ noise
    void radar(double offset, double noise) {
        for (int k = 0; k < 4; k++)
            frame.radar_count[k] =
                static_cast<std::uint16_t>(std::lround(config.radar_rest_count + offset + (k % 2 == 0 ? noise : -noise)));
    }
    float expected_A(float duty) const { return duty * trace.battery_voltage_V * config.winding_1_ohm; }

    const self_test_result_t &run(int most = 400) {
        command_t command{};
        for (int tick = 0; tick < most && !result.done; tick++) {
            for (int i = 0; i < 4; i++) {
                turned[static_cast<std::size_t>(i)] += count_per_duty[static_cast<std::size_t>(i)] * static_cast<double>(command.duty[i]);
                frame.encoder_count[i] =
                    static_cast<std::int32_t>(static_cast<std::uint32_t>(start[static_cast<std::size_t>(i)]) +
                                              static_cast<std::uint32_t>(std::lround(turned[static_cast<std::size_t>(i)])));
                trace.wheel[i].current_A = static_cast<float>(flows[static_cast<std::size_t>(i)]) * expected_A(command.duty[i]);
            }
            if (also) also(*this, tick);
            command = self_test_step(&config, &sense, &state, &frame, &trace, &result);
            commands.push_back(command);
        }
        return result;
    }
    std::array<std::int32_t, 4> start{1000, -70000, 0, INT32_MAX - 3}; // the last one wraps
};

std::uint32_t of(const std::function<void(Bench &)> &change) {
    Bench bench;
    change(bench);
    return bench.run().failures;
}

TEST(SelfTestSteps, a_whole_rover_passes_and_one_motor_at_a_time_gets_a_small_pulse) {
    Bench bench;
    EXPECT_EQ(bench.run().failures, 0u);
    EXPECT_EQ(bench.result.wheels, 0u);
    ASSERT_TRUE(bench.result.done);
    std::vector<int> order;
    int quiet = 0;
    for (std::size_t tick = 0; tick < bench.commands.size(); tick++) {
        const command_t &command = bench.commands[tick];
        int driven = -1;
        for (int i = 0; i < 4; i++)
            if (command.duty[i] != 0.0f) {
                EXPECT_EQ(driven, -1) << "two motors in tick " << tick;
                driven = i;
                EXPECT_GT(command.duty[i], 0.0f);
                EXPECT_LE(command.duty[i], bench.config.duty_max);
            }
        if (tick < static_cast<std::size_t>(bench.config.rest_ticks)) { // a second of rest, braked
            EXPECT_EQ(command.mode, MODE_STOP) << tick;
            EXPECT_EQ(driven, -1);
        } else if (tick + 1 < bench.commands.size()) { // the others shorted: open loop with duty 0
            EXPECT_EQ(command.mode, MODE_OPEN_LOOP) << tick;
        }
        if (driven >= 0 && (order.empty() || order.back() != driven)) {
            if (!order.empty()) { // the wheel before has come to rest
                EXPECT_GE(quiet, bench.config.settle_ticks);
            }
            order.push_back(driven);
        }
        quiet = driven >= 0 ? 0 : quiet + 1;
    }
    EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(bench.commands.back().mode, MODE_STOP);
    for (const double turned : bench.turned) { // it ends at `enough`, and not before: one tick's duty later at most
        EXPECT_GE(turned, bench.config.enough_count - 0.5);
        EXPECT_LE(turned, bench.config.enough_count + 40 * static_cast<double>(bench.config.duty_max));
    }
    const command_t later = self_test_step(&bench.config, &bench.sense, &bench.state, &bench.frame, &bench.trace, &bench.result);
    EXPECT_EQ(later.mode, MODE_STOP);
}

// (2): to duty_max in 0.2 s, in equal steps, and no longer; the wheels after it at the same distance.
TEST(SelfTestSteps, a_pulse_that_turns_nothing_is_a_ramp_of_a_fifth_of_a_second) {
    Bench bench;
    bench.count_per_duty.fill(0);
    bench.run();
    EXPECT_EQ(bench.result.failures, static_cast<std::uint32_t>(SELF_TEST_ENCODER_DEAD));
    EXPECT_EQ(bench.result.wheels, 0xfu);
    std::array<std::vector<std::size_t>, 4> when;
    for (std::size_t tick = 0; tick < bench.commands.size(); tick++)
        for (std::size_t i = 0; i < 4; i++)
            if (bench.commands[tick].duty[i] != 0.0f) when[i].push_back(tick);
    for (std::size_t i = 0; i < 4; i++) {
        ASSERT_EQ(when[i].size(), 20u); // 0.2 s of 10 ms
        EXPECT_EQ(when[i].back() - when[i].front(), 19u);
        for (std::size_t k = 0; k < 20; k++) EXPECT_FLOAT_EQ(bench.commands[when[i][k]].duty[i], 0.5f * static_cast<float>(k + 1) / 20.0f);
        if (i > 0) {
            EXPECT_EQ(when[i].front() - when[i - 1].front(), when[1].front() - when[0].front());
        }
    }
    EXPECT_EQ(when[0].front(), 100u);
}

TEST(SelfTestSteps, what_it_measured_at_rest_is_what_was_there) {
    Bench bench;
    bench.radar(3, 2);
    bench.frame.accel_y_count = 100;
    bench.also = [](Bench &b, int tick) {
        b.trace.accel_x_m_s2 = tick % 2 == 0 ? 0.5f : 0.3f;
        b.trace.battery_voltage_V = tick % 2 == 0 ? 7.0f : 7.4f;
    };
    bench.run();
    EXPECT_EQ(bench.result.failures, 0u);
    EXPECT_NEAR(bench.result.radar_offset_count, 3.0f, 1e-4f);
    EXPECT_NEAR(bench.result.radar_noise_count, 2.0f, 1e-4f);
    EXPECT_NEAR(bench.result.accel_m_s2[0], 0.4f, 1e-4f);
    EXPECT_NEAR(bench.result.accel_m_s2[1], 100 * static_cast<double>(bench.config.accel_m_s2_per_count), 1e-4f);
    EXPECT_NEAR(bench.result.accel_m_s2[2], 9.81f, bench.config.accel_m_s2_per_count);
    EXPECT_NEAR(bench.result.battery_V, 7.2f, 1e-4f);
}

// Each limit of (1) from both sides, and on both sides of zero.
TEST(SelfTestSteps, rest_is_judged_by_limits_that_hold_from_both_sides) {
    for (const double sign : {1.0, -1.0}) {
        EXPECT_EQ(of([&](Bench &b) { b.radar(sign * 10, 2); }), 0u);
        EXPECT_EQ(of([&](Bench &b) { b.radar(sign * 11, 2); }), static_cast<std::uint32_t>(SELF_TEST_RADAR_OFFSET));
        EXPECT_EQ(of([&](Bench &b) { b.trace.gyro_z_rad_s = static_cast<float>(sign * 0.049); }), 0u);
        EXPECT_EQ(of([&](Bench &b) { b.trace.gyro_z_rad_s = static_cast<float>(sign * 0.051); }),
                  static_cast<std::uint32_t>(SELF_TEST_GYRO));
        const auto lean = [&](double along, double length) { // gravity of `length`, `along` of it along x
            return of([&](Bench &b) {
                b.trace.accel_x_m_s2 = static_cast<float>(sign * along);
                b.frame.accel_y_count = static_cast<std::int16_t>(
                    std::lround(0.6 * std::sqrt(length * length - along * along) / static_cast<double>(b.config.accel_m_s2_per_count)));
                b.frame.accel_z_count = static_cast<std::int16_t>(
                    std::lround(0.8 * std::sqrt(length * length - along * along) / static_cast<double>(b.config.accel_m_s2_per_count)));
            });
        };
        EXPECT_EQ(lean(2.05, 9.81), 0u); // 12 deg are 2.04 m/s^2
        EXPECT_EQ(lean(2.15, 9.81), static_cast<std::uint32_t>(SELF_TEST_ACCEL));
        EXPECT_EQ(lean(0.0, 9.81 + sign * 0.48), 0u);
        EXPECT_EQ(lean(0.0, 9.81 + sign * 0.52), static_cast<std::uint32_t>(SELF_TEST_ACCEL));
        for (int wheel = 0; wheel < 4; wheel++) {
            const auto zero = [&](double share) {
                Bench b;
                b.also = [&](Bench &at, int tick) {
                    if (tick < 100) at.trace.wheel[wheel].current_A = static_cast<float>(sign * share) * 7.2f / 3.24f;
                };
                b.run();
                EXPECT_EQ(b.result.wheels, b.result.failures != 0u ? 1u << static_cast<std::uint32_t>(wheel) : 0u);
                return b.result.failures;
            };
            EXPECT_EQ(zero(0.029), 0u); // 3 % of the stall current
            EXPECT_EQ(zero(0.031), static_cast<std::uint32_t>(SELF_TEST_CURRENT_ZERO));
            const auto rolls = [&](std::int32_t counts) {
                Bench b;
                b.also = [&](Bench &at, int tick) {
                    if (tick > 50 && tick < 100) at.frame.encoder_count[wheel] += static_cast<std::int32_t>(sign) * counts;
                };
                b.start.fill(0);
                b.run();
                EXPECT_EQ(b.result.wheels, b.result.failures != 0u ? 1u << static_cast<std::uint32_t>(wheel) : 0u);
                return b.result.failures;
            };
            EXPECT_EQ(rolls(21), 0u); // 2 + 0.02 rad of 6000 pulses a turn
            EXPECT_EQ(rolls(22), static_cast<std::uint32_t>(SELF_TEST_MOVING));
        }
    }
    EXPECT_EQ(of([](Bench &b) { b.radar(0, 1); }), 0u); // 0.8 count^2 are too few, 25 too many
    EXPECT_EQ(of([](Bench &b) { b.radar(0, 0); }), static_cast<std::uint32_t>(SELF_TEST_RADAR_DEAD));
    EXPECT_EQ(of([](Bench &b) {
                  b.radar(0, 1);
                  b.frame.radar_count[0]--; // variance 3/4 - 1/16 = 0.69
                  b.frame.radar_count[3]++;
                  b.frame.radar_count[1]++;
              }),
              static_cast<std::uint32_t>(SELF_TEST_RADAR_DEAD));
    EXPECT_EQ(of([](Bench &b) { b.radar(0, 5); }), 0u);
    EXPECT_EQ(of([](Bench &b) { b.radar(0, 6); }), static_cast<std::uint32_t>(SELF_TEST_RADAR_NOISY));
    EXPECT_EQ(of([](Bench &b) { b.trace.battery_voltage_V = 5.41f; }), 0u);
    EXPECT_EQ(of([](Bench &b) { b.trace.battery_voltage_V = 5.39f; }), static_cast<std::uint32_t>(SELF_TEST_BATTERY));
    EXPECT_EQ(of([](Bench &b) { b.trace.gyro_z_rad_s = NAN; }), 0u); // not a number counts as 0, as everywhere
}

// Without the axes that tell gravity's length, only what no slope explains is a failure; without a radar, its counts mean nothing.
TEST(SelfTestSteps, what_is_not_there_is_not_judged) {
    EXPECT_EQ(of([](Bench &b) {
                  b.config.required &= ~static_cast<std::uint32_t>(FRAME_ACCEL_YZ);
                  b.frame.present &= ~static_cast<std::uint32_t>(FRAME_ACCEL_YZ);
                  b.frame.accel_z_count = 0;
                  b.trace.accel_x_m_s2 = 2.0f;
              }),
              0u);
    const auto deaf = [](Bench &b) {
        b.config.required &= ~static_cast<std::uint32_t>(FRAME_RADAR);
        b.frame.present &= ~static_cast<std::uint32_t>(FRAME_RADAR);
        b.radar(300, 100);
    };
    EXPECT_EQ(of(deaf), 0u);
    Bench bench; // the sums are of the first thousand samples: ten a tick for a second
    bench.frame.radar_samples = 64;
    bench.also = [](Bench &b, int tick) {
        for (int k = 0; k < 64; k++) b.frame.radar_count[k] = static_cast<std::uint16_t>((tick < 16 ? 512 : 0) + (k % 2 == 0 ? 2 : -2));
        if (tick == 15)
            for (int k = 40; k < 64; k++) b.frame.radar_count[k] = 1000; // beyond the 1000th: not listened to
    };
    bench.run();
    EXPECT_EQ(bench.result.failures, 0u);
    EXPECT_NEAR(bench.result.radar_noise_count, 2.0f, 1e-4f);
}

TEST(SelfTestSteps, a_device_silent_in_more_than_half_of_the_ticks_is_named_with_its_wheel) {
    for (std::uint32_t bit = 0; bit < 20; bit++) {
        const auto silent = [&](int ticks) {
            Bench bench;
            bench.also = [&](Bench &b, int tick) { b.frame.present = tick < ticks ? all_bits & ~(1u << bit) : all_bits; };
            bench.run();
            return bench.result;
        };
        const bool required = (rover_config_default().self_test.required >> bit & 1u) != 0u;
        EXPECT_EQ(silent(50).failures, 0u) << bit;
        const self_test_result_t most = silent(51);
        EXPECT_EQ(most.failures, required ? static_cast<std::uint32_t>(SELF_TEST_SILENT) : 0u) << bit;
        std::uint32_t wheels = 0;
        for (std::uint32_t i = 0; i < 4; i++)
            wheels |= 1u << bit == static_cast<std::uint32_t>(FRAME_ENCODER_0) << i ||
                              1u << bit == static_cast<std::uint32_t>(FRAME_CURRENT_0) << i
                          ? 1u << i
                          : 0u;
        EXPECT_EQ(most.wheels, wheels) << bit;
    }
    Bench bridge; // where a description asks for one
    bridge.config.required |= FRAME_BRIDGE_0 << 2u;
    bridge.frame.present &= ~(static_cast<unsigned>(FRAME_BRIDGE_0) << 2u);
    EXPECT_EQ(bridge.run().failures, static_cast<std::uint32_t>(SELF_TEST_SILENT));
    EXPECT_EQ(bridge.result.wheels, 4u);
}

TEST(SelfTestSteps, a_failure_at_rest_drives_no_motor) {
    Bench bench;
    bench.trace.battery_voltage_V = 5.0f;
    bench.run();
    EXPECT_EQ(bench.commands.size(), 100u);
    for (const command_t &command : bench.commands) EXPECT_EQ(command.mode, MODE_STOP);
}

TEST(SelfTestSteps, each_defect_of_a_wheel_is_named_with_it) {
    for (std::size_t wheel = 0; wheel < 4; wheel++) {
        const std::uint32_t mine = 1u << wheel;
        const auto with = [&](double counts, double flows) {
            Bench b;
            b.count_per_duty[wheel] = counts;
            b.flows[wheel] = flows;
            b.run();
            EXPECT_EQ(b.result.wheels, b.result.failures != 0u ? mine : 0u);
            return b.result.failures;
        };
        EXPECT_EQ(with(-40, 0.7), static_cast<std::uint32_t>(SELF_TEST_ENCODER_SIGN));
        EXPECT_EQ(with(40, -0.7), static_cast<std::uint32_t>(SELF_TEST_CURRENT_SIGN));
        EXPECT_EQ(with(-40, -0.7), static_cast<std::uint32_t>(SELF_TEST_ENCODER_SIGN | SELF_TEST_CURRENT_SIGN)); // motor leads
        EXPECT_EQ(with(0, 0.7), static_cast<std::uint32_t>(SELF_TEST_ENCODER_DEAD));
        EXPECT_EQ(with(0, 0), static_cast<std::uint32_t>(SELF_TEST_MOTOR_OPEN)); // what does not flow moves no encoder
        EXPECT_EQ(with(40, 0.31), 0u);                                           // 0.3 of what the winding lets through
        EXPECT_EQ(with(40, 0.29), static_cast<std::uint32_t>(SELF_TEST_MOTOR_OPEN));
        // a ramp of 20 steps to 0.5 is 5.25 full ticks: 5.7 pulses are no more than the 5 that play and rounding make, 6.6 are
        EXPECT_EQ(with(5.3 / 5.25, 0.7), static_cast<std::uint32_t>(SELF_TEST_ENCODER_DEAD));
        EXPECT_EQ(with(6.3 / 5.25, 0.7), 0u);
        EXPECT_EQ(with(-6.3 / 5.25, 0.7), static_cast<std::uint32_t>(SELF_TEST_ENCODER_SIGN));
    }
    Bench reversed; // of a rover whose description says so
    reversed.sense.encoder_sign[1] = -1;
    reversed.count_per_duty[1] = -40;
    EXPECT_EQ(reversed.run().failures, 0u);
}

// Another wheel answers: by its current, or by its encoder where that alone is swapped. On hard ground all roll, and that is no answer.
TEST(SelfTestSteps, another_wheels_answer_is_told_from_a_rover_that_rolls) {
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++) {
            if (a == b) continue;
            const std::uint32_t both = 1u << static_cast<std::uint32_t>(a) | 1u << static_cast<std::uint32_t>(b);
            Bench currents;
            currents.also = [&](Bench &at, int) { std::swap(at.trace.wheel[a].current_A, at.trace.wheel[b].current_A); };
            EXPECT_EQ(currents.run().failures, static_cast<std::uint32_t>(SELF_TEST_WHEEL_ORDER)) << a << b;
            EXPECT_EQ(currents.result.wheels, both);
            Bench encoders;
            encoders.start.fill(0);
            encoders.also = [&](Bench &at, int) { std::swap(at.frame.encoder_count[a], at.frame.encoder_count[b]); };
            EXPECT_EQ(encoders.run().failures, static_cast<std::uint32_t>(SELF_TEST_WHEEL_ORDER)) << a << b;
            EXPECT_EQ(encoders.result.wheels, both);
        }
    const auto rolls = [](double share, double own) { // the others turn by `share` of what the driven wheel's own would be
        Bench bench;
        bench.count_per_duty = {40, 40, 40, 40};
        bench.start.fill(0);
        bench.also = [=](Bench &at, int tick) {
            if (tick == 0) return;
            for (int i = 0; i < 4; i++) {
                double path = 0;
                for (int k = 0; k < 4; k++) path += at.turned[static_cast<std::size_t>(k)] * (k == i ? own : share);
                at.frame.encoder_count[i] = static_cast<std::int32_t>(std::lround(path));
            }
        };
        return bench.run().failures;
    };
    EXPECT_EQ(rolls(1.0, 1.0), 0u);
    EXPECT_EQ(rolls(0.5, 1.0), 0u);
    EXPECT_EQ(rolls(1.0, 0.5), 0u);
    Bench dead; // its own is dead and the rover rolls: only the last wheel turns with it. It never answers to anybody.
    dead.count_per_duty[0] = 0;
    dead.start.fill(0);
    dead.also = [](Bench &at, int) {
        if (at.state.wheel == 0 && at.state.duty > 0.2f) at.frame.encoder_count[3] += 12;
    };
    EXPECT_EQ(dead.run().failures, static_cast<std::uint32_t>(SELF_TEST_ENCODER_DEAD));
    EXPECT_EQ(dead.result.wheels, 1u);
}

// Two orders on one motor's leads: it answers to another wheel's pulse with current and encoder alike, which is an order and no dead
// encoder.
TEST(SelfTestSteps, a_motor_that_answers_to_two_orders_is_an_order_of_the_wheels_alone) {
    for (std::size_t a = 0; a < 4; a++)
        for (std::size_t b = 0; b < 4; b++) {
            if (a == b) continue;
            Bench bench;
            bench.start.fill(0);
            double turned = 0;
            bench.also = [&](Bench &at, int) {
                const command_t none{};
                const command_t &last = at.commands.empty() ? none : at.commands.back();
                turned += 40 * static_cast<double>(last.duty[a]);
                at.frame.encoder_count[b] += static_cast<std::int32_t>(std::lround(turned));
                at.frame.encoder_count[a] = 0;
                at.trace.wheel[b].current_A += at.trace.wheel[a].current_A;
                at.trace.wheel[a].current_A = 0;
            };
            EXPECT_EQ(bench.run().failures, static_cast<std::uint32_t>(SELF_TEST_WHEEL_ORDER)) << a << b;
            EXPECT_EQ(bench.result.wheels, 1u << a | 1u << b) << a << b;
        }
}

// A pulse that has turned its wheel is over: the wheel comes to rest for as long as after any other, and is judged by that pulse alone.
TEST(SelfTestSteps, each_wheel_settles_for_as_long_however_soon_its_pulse_has_ended) {
    for (const double counts : {0.0, 10.0, 40.0, 400.0}) {
        Bench bench;
        bench.count_per_duty.fill(counts);
        bench.run();
        EXPECT_EQ(bench.result.failures, counts > 0 ? 0u : static_cast<std::uint32_t>(SELF_TEST_ENCODER_DEAD)) << counts;
        int wheel = -1;
        std::size_t last = 0;
        std::vector<std::size_t> rests;
        for (std::size_t tick = 0; tick < bench.commands.size(); tick++)
            for (int i = 0; i < 4; i++)
                if (bench.commands[tick].duty[i] != 0.0f) {
                    if (wheel >= 0 && i != wheel) rests.push_back(tick - last - 1);
                    wheel = i, last = tick;
                }
        ASSERT_EQ(rests.size(), 3u) << counts;
        for (const std::size_t rest : rests) { // the tick that judges, those it settles in, and the one in which the next begins
            EXPECT_EQ(rest, static_cast<std::size_t>(bench.config.settle_ticks) + 1) << counts;
        }
    }
}

TEST(SelfTestSteps, safety_ends_it_but_for_what_only_limits_a_wheel) {
    const std::uint32_t limiting = FAULT_MOTOR_OPEN | FAULT_OVER_CURRENT | FAULT_STALL;
    for (std::uint32_t bit = 0; bit < 20; bit++) {
        Bench bench;
        bench.also = [&](Bench &b, int tick) {
            b.trace.faults = tick == 110 ? 1u << bit : 0u;
            b.trace.fault_wheels = 8u;
        };
        bench.run();
        const bool stops = (limiting >> bit & 1u) == 0u;
        EXPECT_EQ(bench.result.failures, stops ? static_cast<std::uint32_t>(SELF_TEST_STOPPED) : 0u) << bit;
        EXPECT_EQ(bench.result.wheels, stops ? 8u : 0u);
        EXPECT_EQ(bench.commands.size(), stops ? 111u : bench.commands.size());
        EXPECT_EQ(bench.commands.back().mode, MODE_STOP);
    }
}

// Of wheels that are not there nothing is asked, and none is driven.
TEST(SelfTestSteps, a_rover_of_two_wheels_is_asked_for_two) {
    for (const std::uint32_t wheels : {3u, 5u, 8u, 12u}) {
        Bench bench;
        bench.config.wheels = wheels;
        for (std::size_t i = 0; i < 4; i++)
            if ((wheels >> i & 1u) == 0u) bench.flows[i] = 0, bench.count_per_duty[i] = 0;
        bench.also = [&](Bench &b, int tick) {
            for (std::uint32_t i = 0; i < 4; i++)
                if ((wheels >> i & 1u) == 0u) b.frame.encoder_count[i] = tick * 977;
        };
        EXPECT_EQ(bench.run().failures, 0u) << wheels;
        std::uint32_t driven = 0;
        for (const command_t &command : bench.commands)
            for (std::uint32_t i = 0; i < 4; i++) driven |= command.duty[i] != 0.0f ? 1u << i : 0u;
        EXPECT_EQ(driven, wheels);
    }
}

TEST(SelfTestSteps, nothing_is_done_before_the_first_trace) {
    Bench bench;
    for (int i = 0; i < 10; i++) {
        const command_t command = self_test_step(&bench.config, &bench.sense, &bench.state, &bench.frame, nullptr, &bench.result);
        EXPECT_EQ(command.mode, MODE_STOP);
    }
    EXPECT_EQ(bench.run().failures, 0u);
    EXPECT_FALSE(bench.result.failures != 0u);
}

TEST(SelfTestSteps, every_failure_has_words_of_its_own) {
    for (std::int32_t i = 0; i < SELF_TEST_FAILURES; i++) {
        EXPECT_GT(std::string(self_test_name(i)).size(), 10u) << i;
        for (std::int32_t k = 0; k < i; k++) {
            EXPECT_STRNE(self_test_name(i), self_test_name(k));
        }
    }
    EXPECT_STREQ(self_test_name(-1), "");
    EXPECT_STREQ(self_test_name(SELF_TEST_FAILURES), "");
}

// What the description makes of it: 1.4 mm of the rim, three degrees, the battery's limit; of another rover its own.
TEST(SelfTestSteps, its_limits_follow_the_rover) {
    rover_parameters_t rover;
    rover_parameters_reference(&rover);
    const auto build = [&] {
        control_config_t config{};
        control_config_build(&rover, &config);
        return config.self_test;
    };
    const self_test_config_t reference = build();
    EXPECT_EQ(reference.wheels, 0xfu);
    EXPECT_EQ(reference.required, rover_config_default().safety.required);
    EXPECT_NEAR(reference.enough_count * 6.2831853 / 6000 * 0.057, 0.0014, 0.0003); // and four pulses
    EXPECT_FLOAT_EQ(reference.zero_A, 0.03f * 7.2f / 3.24f);
    EXPECT_FLOAT_EQ(reference.radar_dead_count2, 0.8f);
    EXPECT_FLOAT_EQ(reference.radar_noisy_count2, 25.0f);
    EXPECT_EQ(reference.radar_rest_count, 512);
    rover.value[ROVER_encoder_counts_per_turn] *= 2;
    rover.value[ROVER_resistance_ohm] *= 2;
    rover.value[ROVER_radar_quiet_count2] *= 2;
    rover.value[ROVER_radar_offset_count] = 500;
    rover.value[ROVER_battery_min_V] = 5;
    rover.value[ROVER_wheel_mask] = 9;
    const self_test_config_t other = build();
    EXPECT_EQ(other.enough_count, 4 + 48); // 0.025 rad of 12000 pulses a turn: 47.7
    EXPECT_EQ(other.least_count, 2 + 6);
    EXPECT_EQ(other.still_count, 2 + 38);
    EXPECT_FLOAT_EQ(other.zero_A, reference.zero_A / 2);
    EXPECT_FLOAT_EQ(other.winding_1_ohm, reference.winding_1_ohm / 2);
    EXPECT_FLOAT_EQ(other.radar_dead_count2, 1.6f);
    EXPECT_FLOAT_EQ(other.radar_noisy_count2, 50.0f);
    EXPECT_EQ(other.radar_rest_count, 500);
    EXPECT_FLOAT_EQ(other.battery_V, 5.0f);
    EXPECT_EQ(other.wheels, 9u);
}

} // namespace
