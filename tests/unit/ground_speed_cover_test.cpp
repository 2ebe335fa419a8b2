// (38) of ground_speed.h: an echo that falls silent is of a body that has stopped, or of a radar that sees nothing any more.
extern "C" {
#include "firmware/core/ground_speed_parts.h"
}
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace {

const ground_speed_config_t &ours() {
    static const control_config_t config = rover_config_default();
    return config.ground_speed;
}

// A rover with exact sensors: what it does in a tick, and what it hears in every twelfth.
struct Rover {
    ground_speed_state_t state{};
    ground_speed_output_t out{};
    int tick = 0;
    double v = 0, bias = 0.2;

    Rover() { ground_speed_reset(&ours(), &state); }

    enum Hears { echo, quiet, nothing };
    void drive(double seconds, double accel_m_s2, double wheel_m_s, Hears hears) {
        for (int k = 0; k < static_cast<int>(std::lround(seconds * 100)); ++k, ++tick) {
            v += accel_m_s2 * 0.01;
            ground_speed_input_t input{};
            input.accel_x_m_s2 = static_cast<float>(accel_m_s2 + bias);
            input.accel_valid = true;
            input.wheel_m_s = static_cast<float>(wheel_m_s);
            input.elapsed_ticks = 1;
            if (tick % 12 == 0 && hears != nothing) {
                input.doppler_fresh = true;
                input.doppler_quiet = hears == quiet;
                input.doppler_m_s = hears == quiet ? 0.0f : static_cast<float>(std::fabs(v));
            }
            out = ground_speed_step(&ours(), &state, &input);
        }
    }
    // At v_m_s for five seconds, from rest, with wheels that roll.
    static Rover rolling(double v_m_s) {
        Rover rover;
        rover.drive(2, 0, 0, quiet);
        EXPECT_TRUE(rover.out.standstill);
        for (int k = 0; k < 50; ++k) rover.drive(0.01, v_m_s / 0.5, rover.v + v_m_s / 50, std::fabs(rover.v) > 0.1 ? echo : quiet);
        rover.drive(5, 0, rover.v, echo);
        EXPECT_NEAR(rover.out.speed_m_s, v_m_s, 0.02);
        return rover;
    }
};

double at_most(const Rover &rover) { return std::fabs(static_cast<double>(rover.out.speed_m_s) - rover.v); }

TEST(GroundSpeedCover, a_radar_that_is_covered_while_the_wheels_roll_on_is_no_stop) {
    for (const double v : {0.2, 0.4, 0.8, -0.3}) {
        Rover rover = Rover::rolling(v);
        for (int second = 1; second <= 30; ++second) {
            rover.drive(1, 0, rover.v, Rover::quiet);
            EXPECT_TRUE(rover.state.cover.on);
            EXPECT_LT(at_most(rover), 0.1 + 0.1 * std::fabs(v)) << v << " after " << second;
            EXPECT_LT(at_most(rover), 2 * static_cast<double>(rover.out.std_m_s)) << v << " after " << second;
        }
        EXPECT_GT(static_cast<double>(rover.out.std_m_s), 0.01 + 0.08 * std::fabs(v)); // nothing tells of the speed but the wheels
        rover.drive(2, 0, rover.v, Rover::echo);
        EXPECT_FALSE(rover.state.cover.on);
        EXPECT_LT(at_most(rover), 0.02) << v;
    }
}

TEST(GroundSpeedCover, a_body_that_stops_under_turning_wheels_is_felt_and_stands) {
    for (const double v : {0.3, 0.6})
        for (const double took_s : {0.1, 0.4}) {
            Rover rover = Rover::rolling(v);
            rover.drive(took_s, -v / took_s, v, Rover::nothing); // values of such a window are spoilt
            ASSERT_NEAR(rover.v, 0, 1e-9);
            rover.drive(1, 0, v, Rover::quiet);
            EXPECT_FALSE(rover.state.cover.on);
            EXPECT_LT(at_most(rover), 0.05) << v << ' ' << took_s;
            rover.drive(5, 0, v, Rover::quiet);
            EXPECT_LT(at_most(rover), 0.05) << v << ' ' << took_s;
        }
}

TEST(GroundSpeedCover, wheels_that_spin_up_under_a_body_that_feels_nothing_drive_nothing) {
    for (const bool moves : {false, true}) {
        Rover rover;
        rover.drive(3, 0, 0, Rover::quiet);
        ASSERT_TRUE(rover.out.standstill);
        for (int k = 1; k <= 50; ++k) rover.drive(0.01, moves ? 0.6 : 0, 0.006 * k, Rover::quiet);
        rover.drive(4, 0, 0.3, Rover::quiet);
        EXPECT_EQ(rover.state.cover.on, moves);
        EXPECT_LT(at_most(rover), moves ? 0.15 : 0.05);
        rover.drive(1, moves ? -rover.v : 0, 0, Rover::quiet); // slow wheels end it
        EXPECT_FALSE(rover.state.cover.on);
        rover.drive(2, 0, 0, Rover::quiet);
        EXPECT_TRUE(rover.out.standstill);
    }
}

// (42): the accelerometer's bias is wrong by what it drifts in 30 s; before, the claim grew and the speed with it.
TEST(GroundSpeedCover, wheels_that_rolled_as_long_as_the_radar_heard_roll_on) {
    for (const double v : {0.1, 0.2, 0.4, 0.8, -0.3}) {
        Rover rover = Rover::rolling(v);
        for (int second = 1; second <= 30; ++second) {
            rover.bias += 0.002;
            rover.drive(1, 0, 1.08 * rover.v, Rover::quiet);
            EXPECT_TRUE(rover.state.cover.on);
            EXPECT_LT(at_most(rover), 0.05 + 0.12 * std::fabs(v)) << v << " after " << second;
            EXPECT_LT(rover.out.std_m_s, 0.06 + 0.15 * std::fabs(v)) << v << " after " << second;
        }
    }
}

TEST(GroundSpeedCover, wheels_beside_which_the_body_departs_after_that_are_not_asked_so_any_more) {
    Rover rover = Rover::rolling(0.4);
    rover.drive(2, 0, 0.4, Rover::quiet);
    EXPECT_GT(rover.state.rolled_values, 0);
    EXPECT_LT(rover.out.std_m_s, 0.08f);
    rover.drive(0.4, -1, 0.4, Rover::quiet); // it stops, or a slope begins
    rover.drive(2, 0, 0.4, Rover::quiet);
    EXPECT_EQ(rover.state.rolled_values, 0);
    EXPECT_LT(at_most(rover), 2.5 * static_cast<double>(rover.out.std_m_s)); // nothing tells which
}

TEST(GroundSpeedCover, noise_that_passes_for_an_echo_now_and_then_is_none) {
    Rover rover = Rover::rolling(0.4);
    rover.drive(1, 0, 0.4, Rover::quiet);
    for (int k = 0; k < 20; ++k) {
        rover.v = k % 2 == 0 ? 0.9 : 0.2; // what it hears
        rover.drive(0.24, 0, 0.4, Rover::echo);
        rover.v = 0.4;
        EXPECT_LT(at_most(rover), 0.03) << k;
        rover.drive(0.96, 0, 0.4, Rover::quiet);
        EXPECT_TRUE(rover.state.cover.on) << k;
    }
    rover.v = 0.6; // four in a row are heard, and believed two seconds later, (41)
    rover.drive(4, 0, 0.4, Rover::echo);
    EXPECT_LT(at_most(rover), 0.05);
}

TEST(GroundSpeedCover, is_no_part_of_the_papers_method) {
    ground_speed_config_t paper = ours();
    paper.method = GROUND_SPEED_PAPER;
    Rover rover = Rover::rolling(0.4);
    ground_speed_input_t input{};
    input.wheel_m_s = 0.4f, input.accel_valid = input.doppler_fresh = input.doppler_quiet = true, input.elapsed_ticks = 1;
    ground_speed_state_t ours_state = rover.state, papers = rover.state;
    ground_speed_step(&ours(), &ours_state, &input);
    ground_speed_step(&paper, &papers, &input);
    EXPECT_TRUE(ours_state.cover.on);
    EXPECT_FALSE(papers.cover.on);
}

// A value stands beside the bias before its window, three values ago, and beside what was known of it then; at rest both are known.
TEST(GroundSpeedCover, remembers_the_bias_of_three_values_ago_and_how_unsure_it_was) {
    ground_speed_state_t state;
    ground_speed_reset(&ours(), &state);
    for (int k = 0; k < 8; ++k) {
        state.slide.newest = k % SLIDE_VALUES;
        state.bias_m_s2 = 0.1f * static_cast<float>(k), state.p_bb = 0.01f * static_cast<float>(k + 1);
        ground_speed_watch_cover(&state);
        if (k < GROUND_SPEED_BEFORE) continue;
        EXPECT_EQ(state.slide.bias_m_s2[state.slide.newest], 0.1f * static_cast<float>(k - GROUND_SPEED_BEFORE)) << k;
        EXPECT_EQ(state.slide.bias_m2_s4[state.slide.newest], 0.01f * static_cast<float>(k - GROUND_SPEED_BEFORE + 1)) << k;
    }
    ground_speed_watch_rest(&state);
    ground_speed_watch_cover(&state);
    EXPECT_EQ(state.slide.bias_m_s2[state.slide.newest], state.bias_m_s2);
    EXPECT_EQ(state.slide.bias_m2_s4[state.slide.newest], 4e-4f); // (0.02 m/s^2)^2
}

// By the words of (38), of states made by hand.
TEST(GroundSpeedCover, is_told_by_half_of_the_rims_speed_from_the_oldest_value_or_the_last_rest) {
    int on = 0, off = 0, unknown = 0, of_rest = 0, hardly_heard = 0, stops = 0, goes_on = 0, unsure_stop = 0, newer = 0;
    std::uint32_t seed = 7;
    const auto between = [&](double low, double high) {
        seed = seed * 1664525u + 1013904223u;
        return low + (high - low) * (seed >> 8) / 16777216.0;
    };
    for (int k = 0; k < 3000; ++k) {
        ground_speed_state_t state;
        ground_speed_reset(&ours(), &state);
        const double wheel = (between(0, 1) < 0.5 ? -1 : 1) * between(0.05, 0.6), slow = 0.6 * static_cast<double>(ours().slow_m_s);
        state.slide.ticks = 10000;
        state.slide.newest = static_cast<int32_t>(between(0, 6));
        state.slide.held = static_cast<int32_t>(between(0, 7));
        state.speed_m_s = static_cast<float>(between(-0.6, 0.6));
        state.head = 17;
        state.integral_q20[17] = static_cast<int32_t>(between(-1e6, 1e6));
        const double newest = between(0, 0.6);
        for (int i = 0; i < SLIDE_VALUES; ++i) {
            const int at = (state.slide.newest + SLIDE_VALUES - i) % SLIDE_VALUES;
            state.slide.came[at] = static_cast<std::uint32_t>(10000 - 12 * i - 30);
            state.slide.heard_m_s[at] = static_cast<float>(i == 0 ? newest : between(0.1, 0.6));
            state.slide.sign[at] = between(0, 1) < 0.5 ? -1.0f : 1.0f;
            state.slide.tau_s[at] = 0.25f;
            state.slide.bias_m_s2[at] = static_cast<float>(between(-1, 1));
            const double settles = between(0, 1);
            state.slide.bias_m2_s4[at] = settles < 0.6 ? 1e-4f : settles < 0.8 ? 1e-3f : settles < 0.9 ? 0.01f : 0.04f;
            state.slide.q20[at] = static_cast<int32_t>(between(-1e6, 1e6));
        }
        state.cover.rested = between(0, 1) < 0.5;
        const double rest_ago = std::floor(between(10, 400));
        state.cover.rest_ended = static_cast<std::uint32_t>(10000 - rest_ago);
        state.cover.rest_q20 = static_cast<int32_t>(between(-1e6, 1e6));
        state.cover.rest_bias_m_s2 = static_cast<float>(between(-1, 1));

        const auto place = [&](int i) { return (state.slide.newest + SLIDE_VALUES - i) % SLIDE_VALUES; };
        const auto variance = [&](int i) { return std::max(4e-4, static_cast<double>(state.slide.bias_m2_s4[place(i)])); };
        int from = state.slide.held - 1; // the oldest
        const bool value = state.slide.held > 0 && (!state.cover.rested || 30 + 12.0 * from + 25 < rest_ago);
        for (int i = from - 1; value && i >= 0 && variance(from) > 1.6e-3; --i) // had not settled: a newer one that had rather
            if (variance(i) < variance(from)) from = i, ++newer;
        const int oldest = value ? place(from) : 0;
        const double ago = value ? 30 + 12.0 * from + 25 : rest_ago, bias2 = value ? variance(from) : 4e-4;
        const bool known = value || (state.cover.rested && rest_ago < 300);
        const double V = state.integral_q20[17];
        const double e = value
                             ? static_cast<double>(state.slide.sign[oldest] * state.slide.heard_m_s[oldest]) +
                                   (V - state.slide.q20[oldest]) / 1048576 - 0.01 * ago * static_cast<double>(state.slide.bias_m_s2[oldest])
                             : (V - state.cover.rest_q20) / 1048576 - 0.01 * ago * static_cast<double>(state.cover.rest_bias_m_s2);
        const double along = (wheel < 0 ? -1 : 1) * (known ? e : static_cast<double>(state.speed_m_s));
        const double hears = 1.25 * static_cast<double>(ours().slow_m_s), gap = along - 0.5 * std::fabs(wheel);
        if (std::fabs(gap) < 1e-4 || std::fabs(std::fabs(wheel) - slow) < 1e-6 || std::fabs(std::fabs(wheel) - hears) < 1e-6) continue;
        const double noise2 = ago * static_cast<double>(state.speed_noise_m2_s2) + std::pow(0.01 * ago, 2) * bias2,
                     sigma = std::sqrt(noise2);
        const double beyond = std::fabs(e) - static_cast<double>(ours().slow_m_s); // of what is quiet
        if (known && std::min({std::fabs(std::fabs(gap) - sigma), std::fabs(gap + 2 * sigma), std::fabs(beyond - sigma)}) < 1e-4) continue;
        const bool turns = std::fabs(wheel) > slow, falls = turns && known && value && gap < -2 * sigma;
        const bool stopped = falls && beyond < sigma;
        const bool goes = turns && gap > (known ? sigma : 0);
        const bool hardly = turns && known && value && std::fabs(wheel) < hears && !goes && !stopped;
        const bool is = goes || hardly;

        ground_speed_input_t input{};
        input.doppler_fresh = input.doppler_quiet = true;
        input.wheel_m_s = static_cast<float>(wheel);
        input.accel_x_m_s2 = 0;
        input.accel_valid = true;
        input.elapsed_ticks = 1;
        ground_speed_state_t pulled = state; // quiet values that were believed before
        pulled.quiet = ours().quiet_needed;
        ground_speed_state_t free = pulled; // too few to be believed: nothing has pulled
        free.quiet = ours().quiet_needed - 1;
        ground_speed_step(&ours(), &pulled, &input);
        ground_speed_step(&ours(), &free, &input);
        if (is && known) {
            EXPECT_NEAR(pulled.speed_m_s, e, 0.011) << k; // the tick's own: at most 1 m/s^2
            EXPECT_NEAR(free.speed_m_s, state.speed_m_s, 0.011) << k;
        }
        ground_speed_step(&ours(), &state, &input);
        EXPECT_EQ(state.cover.on, is) << k << " wheel " << wheel << " e " << e << " known " << known << " value " << value;
        EXPECT_EQ(state.heard, !is); // what is covered is no value
        EXPECT_EQ(state.cover.stopped, stopped) << k;
        EXPECT_EQ(state.cover.judged, goes && known) << k; // what has stopped is asked again: it may set off
        stops += stopped ? 1 : 0, goes_on += falls && !stopped ? 1 : 0;
        unsure_stop += turns && known && value && gap < -sigma && gap > -2 * sigma ? 1 : 0;
        (is ? on : off) += 1;
        unknown += known ? 0 : 1, of_rest += known && !value ? 1 : 0, hardly_heard += is && hardly ? 1 : 0;
    }
    EXPECT_GT(std::min({on, off, unknown, of_rest}), 100);
    EXPECT_GT(std::min({stops, goes_on, unsure_stop, newer, hardly_heard}), 10);
}

} // namespace
