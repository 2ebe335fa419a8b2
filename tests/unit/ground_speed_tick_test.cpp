// What ground_speed.c does in a tick: prediction, standing, the wheels' witness, the standard deviation, and who sees a value when. From
// any state, against ground_speed.h in double.
#include "tests/unit/ground_speed_any.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace {

using any_state::Any, any_state::narrow, any_state::passed, any_state::square, any_state::wide;

const ground_speed_config_t &ours() {
    static const ground_speed_config_t config = rover_config_default().ground_speed;
    return config;
}

constexpr double eps = 1e-5;

// A past that some ticks have gone by in, with wheels that turn as before: a tick changes what it says it does and nothing else.
ground_speed_state_t calm(Any &any) {
    ground_speed_state_t state = any.past(ours());
    any.value(ours(), state);
    state.std_m_s = 0.1f;
    state.wheel_mean_m_s = state.wheel_m_s;
    state.wheel_q20 = state.integral_q20[state.head];
    state.misfit = 1;
    state.p_bb = narrow(any.log_between(1e-5, 0.5));
    state.p_vb = narrow(any.between(-0.9, 0.9) * std::sqrt(wide(state.p_vv) * wide(state.p_bb)));
    state.rolls_wait = 50; // (13) has a test of its own
    state.chore = 1;       // the next is nobody's
    return state;
}

ground_speed_input_t same(const ground_speed_state_t &state, double accel) {
    ground_speed_input_t input = {};
    input.accel_x_m_s2 = narrow(accel);
    input.wheel_m_s = state.wheel_m_s;
    input.accel_valid = true;
    input.elapsed_ticks = 1;
    return input;
}

TEST(GroundSpeedTick, at_reset_nothing_is_known_but_that_it_is_slow_and_rather_level) {
    ground_speed_state_t state;
    ground_speed_reset(&ours(), &state);
    EXPECT_EQ(state.p_vv, 1); // (1 m/s)^2
    EXPECT_EQ(state.p_vb, 0);
    EXPECT_EQ(state.p_bb, 1); // +-1 m/s^2: 6 deg
    EXPECT_EQ(state.speed_m_s, 0);
    EXPECT_EQ(state.misfit, 1);
    EXPECT_EQ(state.scatter, 0.5f); // (28): what it is where R is right
    EXPECT_EQ(state.calm, 1);
    EXPECT_EQ(state.speed_noise_m2_s2, ours().speed_noise_m2_s2);
    EXPECT_EQ(state.usual_noise_m2_s2, ours().speed_noise_m2_s2); // (30): the stated one, until looks have told
    EXPECT_EQ(state.usual_slow_m2_s2, ours().speed_noise_m2_s2);
    EXPECT_NEAR(state.unseen_m2_s2, wide(ours().speed_noise_m2_s2) * wide(ours().window->tau_ticks), 1e-9);
    EXPECT_EQ(state.felt_trust, 1);
    EXPECT_NEAR(state.per_felt_most_s2_m2, 1 / (16 * 12.5 * wide(ours().speed_noise_m2_s2)), 1);
}

// (2), and its covariance F P F' + Q over all ticks that it has not seen: those that were busy, and those that were missed.
TEST(GroundSpeedTick, predicts_through_busy_ticks_and_missed_ones) {
    Any any{{31}};
    int blind = 0, gaps = 0;
    for (int k = 0; k < 800; ++k) {
        ground_speed_state_t state = calm(any);
        const ground_speed_state_t was = state;
        const int busy = static_cast<int>(any.next() % 9);
        double v = wide(was.speed_m_s), felt = 0;
        const double b = wide(was.bias_m_s2), vv = wide(was.p_vv), vb = wide(was.p_vb), bb = wide(was.p_bb);
        for (int i = 0; i < busy; ++i) {
            ground_speed_input_t input = same(state, any.between(-2, 2));
            input.busy = true;
            v += (wide(input.accel_x_m_s2) - b) * 0.01;
            felt += wide(input.accel_x_m_s2) * 0.01;
            const ground_speed_output_t out = ground_speed_step(&ours(), &state, &input);
            EXPECT_NEAR(out.speed_m_s, v - wide(was.less_m_s), eps);
            EXPECT_EQ(state.p_vv, was.p_vv); // a busy tick has no time for it
            EXPECT_EQ(state.behind_ticks, i + 1);
        }
        ground_speed_input_t input = same(state, any.between(-2, 2));
        input.accel_valid = !any.one_in(4);
        input.elapsed_ticks = any.one_in(2) ? static_cast<uint32_t>(any.next() % 30) : 1;
        const int missed = std::clamp(static_cast<int>(input.elapsed_ticks) - 1, 0, 16); // longer gaps are for safety
        const double a = input.accel_valid ? wide(input.accel_x_m_s2) : b;
        blind += input.accel_valid ? 0 : 1;
        gaps += missed > 0 ? 1 : 0;
        const ground_speed_output_t out = ground_speed_step(&ours(), &state, &input);
        const int n = busy + missed + 1;
        v += (a - b) * 0.01 * (missed + 1);
        felt += a * 0.01 * (missed + 1);
        EXPECT_NEAR(state.speed_m_s, v, 2 * eps);
        EXPECT_NEAR(out.speed_m_s, wide(state.speed_m_s) - wide(state.felt_m_s), eps); // (14)
        EXPECT_NEAR(passed(state, 0, n), felt, n * 2e-6);
        EXPECT_EQ(state.behind_ticks, 0);
        EXPECT_EQ(state.unheard_ticks, was.unheard_ticks + busy + 1);
        EXPECT_EQ(state.slide.ticks, was.slide.ticks + static_cast<uint32_t>(n));
        EXPECT_EQ(state.other.ticks, was.other.ticks + n);
        EXPECT_EQ(state.agile.ticks, was.agile.ticks + n);
        // while it is behind, the newest tick's noise stands for all; what was missed is blind, and so is a tick without an accelerometer
        const double q = wide(was.speed_noise_m2_s2), q_blind = wide(ours().blind_noise_m2_s2), last = input.accel_valid ? q : q_blind;
        const double Q = missed > 0 ? (busy + missed) * q_blind + last : n * last, t = 0.01 * n;
        EXPECT_NEAR(state.p_vv, std::fmin(4, vv - 2 * t * vb + t * t * bb + Q), 1e-4 * (vv + t * t * bb) + 1e-7) << busy << ' ' << missed;
        EXPECT_NEAR(state.p_vb, vb - t * bb, 1e-5 + 1e-4 * std::fabs(vb));
        EXPECT_NEAR(state.p_bb, bb + n * 5e-7, 1e-6);
        EXPECT_EQ(state.bias_m_s2, was.bias_m_s2);
    }
    EXPECT_GT(std::min(blind, gaps), 50);
}

TEST(GroundSpeedTick, what_is_no_number_is_no_measurement) {
    Any any{{32}};
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
        ground_speed_state_t state = calm(any), like = state;
        ground_speed_input_t input = same(state, bad), zero = same(state, 0);
        input.doppler_fresh = true;
        input.doppler_m_s = narrow(bad);
        ground_speed_step(&ours(), &state, &input);
        ground_speed_step(&ours(), &like, &zero);
        EXPECT_EQ(state.speed_m_s, like.speed_m_s);
        EXPECT_EQ(state.p_vv, like.p_vv);
        EXPECT_EQ(state.unheard_ticks, like.unheard_ticks);
        input = same(state, 0), zero = same(like, 0);
        input.wheel_m_s = narrow(bad);
        zero.wheel_m_s = 0;
        ground_speed_step(&ours(), &state, &input);
        ground_speed_step(&ours(), &like, &zero);
        EXPECT_EQ(state.apart_m_s, like.apart_m_s);
        EXPECT_EQ(state.wheel_m_s, 0);
        EXPECT_EQ(state.still_ticks, like.still_ticks);
    }
}

TEST(GroundSpeedTick, counts_and_the_estimate_stop_at_their_ends) {
    Any any{{40}};
    for (const bool paper : {false, true}) {
        const ground_speed_config_t config = paper ? rover_config_paper().ground_speed : ours();
        for (const double way : {1.0, -1.0}) {
            for (const int32_t count : {998, 999, 1000}) {
                ground_speed_state_t state = calm(any);
                state.speed_m_s = narrow(way) * config.speed_max_m_s;
                state.unheard_ticks = state.still_ticks = state.other.ticks = state.agile.ticks = state.wheel_ticks = state.behind_ticks =
                    count;
                state.standstill = paper; // the paper's knows no standing
                state.less_m_s = 0.01f;
                ground_speed_input_t input = same(state, 50 * way);
                input.wheel_m_s = 0;
                input.busy = true;
                ground_speed_state_t rests = state;
                ground_speed_step(&config, &rests, &input);
                EXPECT_EQ(rests.still_ticks, std::min(1000, count + 1));
                input.wheel_m_s = 1;
                const ground_speed_output_t out = ground_speed_step(&config, &state, &input);
                EXPECT_EQ(state.speed_m_s, narrow(way) * config.speed_max_m_s);
                if (paper) {
                    EXPECT_FALSE(out.standstill);
                    EXPECT_EQ(out.speed_m_s, state.speed_m_s - 0.01f);
                }
                const int32_t next = std::min(1000, count + 1);
                EXPECT_EQ(state.unheard_ticks, next);
                EXPECT_EQ(state.still_ticks, 0);
                EXPECT_EQ(state.other.ticks, next);
                EXPECT_EQ(state.agile.ticks, next);
                EXPECT_EQ(state.wheel_ticks, next);
                EXPECT_EQ(state.behind_ticks, next);
            }
        }
    }
}

// --- standing

// Whether it stands, by the words of docs/firmware.md and (19). `felt_m_s`: what the accelerometer felt within the last second.
bool stands(const ground_speed_state_t &s, double felt_m_s) {
    const double slow = wide(ours().slow_m_s);
    if (s.still_ticks < 25) return false; // wheels at rest for a quarter of a second
    const bool silent = s.unheard_ticks >= 100;
    if (!silent && s.loud >= 3) { // three loud values end it, unless it stood and has felt no push: then not before two minutes of them
        return s.standstill && s.loud < 900 && std::fabs(felt_m_s) <= slow / 2;
    }
    if (s.quiet >= 3) return true;                                                                 // three quiet echoes
    if (s.heard && std::fabs(wide(s.speed_m_s)) < slow && wide(s.p_vv) < slow * slow) return true; // a low speed that is known to as much
    return s.still_ticks >= 100 && (silent || (s.loud == 0 && s.unheard_ticks < 25)); // at rest for a second, and nothing tells of a speed
}

TEST(GroundSpeedTick, stands_where_wheels_rest_and_nothing_tells_of_a_speed) {
    Any any{{33}};
    int stood = 0, moved = 0, pushed = 0, unfelt = 0, calmer = 0, shaken = 0;
    const auto one_of = [&](std::initializer_list<int> list) { return *(list.begin() + any.next() % list.size()); };
    for (int k = 0; k < 4000; ++k) {
        ground_speed_state_t state = calm(any);
        ground_speed_input_t input = same(state, 0);
        input.busy = true; // nothing else is done
        const double felt = any.one_in(2) ? any.between(-0.2, 0.2) : any.between(-0.05, 0.05);
        state.bias_m_s2 = narrow(any.between(-1, 1));
        input.accel_x_m_s2 = state.bias_m_s2;
        const int64_t bias_q20 = std::llround(wide(state.bias_m_s2) * 0.01 * 1048576), step = std::llround(felt * 1048576 / 99);
        for (int i = 0; i < GROUND_SPEED_HISTORY; ++i) { // V of a bias and a push; the tick makes the hundredth
            state.integral_q20[(state.head + GROUND_SPEED_HISTORY - i) % GROUND_SPEED_HISTORY] =
                static_cast<int32_t>(-i * (bias_q20 + (i <= 99 ? step : 0)));
        }
        input.wheel_m_s = narrow(any.either() * (any.one_in(8) ? 1.01 : 0.99) * wide(ours().still_m_s));
        state.rest_mean_m_s = narrow(any.either() * (any.one_in(8) ? 0.26 : 0.24) * wide(ours().still_m_s)); // (24)
        state.still_ticks = one_of({0, 22, 23, 24, 25, 97, 98, 99, 500, 1000});
        state.unheard_ticks = one_of({0, 5, 23, 24, 98, 99, 100, 1000});
        state.loud = one_of({0, 0, 1, 2, 3, 4, 899, 900, 901});
        state.quiet = one_of({0, 0, 0, 1, 2, 3, 4});
        state.standstill = any.one_in(2);
        state.heard = any.one_in(2);
        state.speed_m_s = narrow(any.either() * (any.one_in(2) ? any.between(0.05, 0.19) : 0.5));
        state.p_vv = narrow(any.one_in(2) ? any.between(0.005, 0.025) : 0.1);
        state.p_vb = 0;
        state.less_m_s = 0.01f;
        state.other_alive = true;
        state.waits = 0;
        state.agile_left = 3;
        state.agile_sum = 1;
        state.alike_m_s = 0.3f;
        state.apart_claim_m2_s2 = 0.1f;
        state.apart_m2_s2 = narrow(any.log_between(1e-7, 1));
        state.gyro_doubt_m2_s2 = any.one_in(2) ? 0 : 0.002f;
        ground_speed_state_t now = state;
        const bool rests = std::fabs(wide(input.wheel_m_s)) < wide(ours().still_m_s) &&
                           std::fabs(wide(state.rest_mean_m_s)) < 0.25 * wide(ours().still_m_s);
        now.still_ticks = rests ? std::min(1000, state.still_ticks + 1) : 0;
        now.unheard_ticks = std::min(1000, state.unheard_ticks + 1);
        if (std::fabs(std::fabs(felt) - 0.06) < 3e-4) continue; // whole units
        const bool is = stands(now, felt);
        const ground_speed_output_t out = ground_speed_step(&ours(), &state, &input);
        EXPECT_EQ(out.standstill, is) << k;
        EXPECT_EQ(state.still_ticks, now.still_ticks);
        EXPECT_EQ(state.unheard_ticks, now.unheard_ticks);
        EXPECT_EQ(state.other_alive, !is);
        EXPECT_EQ(state.agile_left, is ? 0 : 3);
        EXPECT_EQ(state.agile_sum, is ? 0 : 1);
        EXPECT_EQ(state.accepted, is); // rest is known: what the radar says next is no first value
        const double P = wide(now.p_vv), R = wide(ours().standing_noise_m2_s2), share = is ? R / (P + R) : 1;
        EXPECT_NEAR(state.speed_m_s, wide(now.speed_m_s) * share, eps); // (1 cm/s)^2 per tick
        EXPECT_NEAR(out.speed_m_s, wide(state.speed_m_s) - (is ? 0 : 0.01), eps);
        EXPECT_NEAR(state.p_vv, P * share, eps);
        if (is) {
            const double shakes = 0.16 * wide(now.apart_m2_s2) + square(wide(now.rest_mean_m_s));                 // (29)
            EXPECT_NEAR(out.std_m_s, std::sqrt(std::fmin(P * share, shakes) + wide(now.gyro_doubt_m2_s2)), 1e-5); // whatever else parted
            (shakes < P * share ? calmer : shaken) += 1;
        }
        if (!is) {
            EXPECT_EQ(out.std_m_s != now.std_m_s, now.standstill) << k; // (29) ends with the rest
        }
        (is ? stood : moved) += 1;
        if (now.still_ticks >= 25 && now.loud >= 3 && now.loud < 40 && now.standstill && now.unheard_ticks < 100)
            (is ? unfelt : pushed) += 1;
    }
    EXPECT_GT(std::min({stood, moved, pushed, unfelt, calmer, shaken}), 50);
}

TEST(GroundSpeedTick, loud_and_quiet_values_are_counted_and_a_dead_front_end_is_not_quiet) {
    Any any{{34}};
    int loud = 0, quiet = 0, deaf = 0, leapt = 0;
    for (int k = 0; k < 600; ++k) {
        ground_speed_state_t state = calm(any);
        const bool dead = any.one_in(2);
        ground_speed_input_t input = same(state, 0);
        input.doppler_fresh = true;
        input.doppler_m_s = narrow(any.between(0.05, 0.3));
        input.doppler_quiet = any.one_in(2);
        input.doppler_dead = dead;
        input.wheel_m_s = narrow(any.either() * any.between(0.05, 0.15));
        state.wheel_m_s = input.wheel_m_s;
        state.speed_m_s = 0, state.slide.held = 0; // nothing goes on that a quiet value would deny, (38)
        state.quiet = any.one_in(4) ? 1000 : 5;
        state.loud = any.one_in(4) ? 1000 : 5;
        state.heard = false;
        state.standstill = any.one_in(2);
        state.loud_m_s = narrow(wide(input.doppler_m_s) + any.either() * wide(ours().slow_m_s) / 2 * any.between(0, 2));
        const ground_speed_state_t was = state;
        if (std::fabs(std::fabs(wide(input.doppler_m_s) - wide(was.loud_m_s)) - 0.06) < 1e-6) continue;
        ground_speed_step(&ours(), &state, &input);
        const bool is_loud = !input.doppler_quiet && wide(input.doppler_m_s) > wide(ours().slow_m_s);
        const bool is_deaf = dead && std::fabs(wide(input.wheel_m_s)) > 0.1; // wheels that turn make noise
        EXPECT_TRUE(state.heard);
        EXPECT_EQ(state.unheard_ticks, 0);
        const bool leaps = was.standstill && std::fabs(wide(input.doppler_m_s) - wide(was.loud_m_s)) > 0.06; // (32): half of slow
        EXPECT_EQ(state.loud, !is_loud ? 0 : leaps ? 3 : std::min(1000, was.loud + 1)) << k;
        EXPECT_EQ(state.loud_m_s, is_loud && was.standstill ? input.doppler_m_s : was.loud_m_s);
        leapt += is_loud && leaps ? 1 : 0;
        EXPECT_EQ(state.quiet, input.doppler_quiet && !is_deaf ? std::min(1000, was.quiet + 1) : 0);
        loud += is_loud ? 1 : 0, quiet += state.quiet > 0 ? 1 : 0, deaf += is_deaf ? 1 : 0;
    }
    EXPECT_GT(std::min({loud, quiet, deaf, leapt}), 50);
}

// --- chores: each at its place in a turn of sixteen

TEST(GroundSpeedTick, each_chore_has_its_turn_and_a_busy_tick_has_none) {
    Any any{{35}};
    for (uint32_t chore = 0; chore < 16; ++chore) {
        for (const auto &[busy, unheard] : {std::pair{false, 24}, {false, 23}, {true, 24}}) {
            ground_speed_state_t state = calm(any);
            state.chore = (chore + 15) % 16;
            state.accel_noise_m2_s2 = 1; // no noise is so large
            state.slow_noise_m2_s2 = 1;
            state.lean_q8 = 100;
            state.loud = 50;
            state.unheard_ticks = unheard;
            state.p_bb = 20; // beyond its bounds
            state.p_vv = 10;
            state.p_vb = 0;
            ground_speed_input_t input = same(state, 0);
            input.busy = busy;
            input.lean_q8 = 100;
            const ground_speed_state_t was = state;
            ground_speed_step(&ours(), &state, &input);
            EXPECT_EQ(state.chore, busy ? was.chore : chore);
            EXPECT_EQ(state.accel_noise_m2_s2 < 1, !busy && chore == 0) << chore;
            EXPECT_EQ(state.slow_noise_m2_s2 < 1, !busy && chore == 8) << chore;
            EXPECT_EQ(state.gyro_asked == state.slide.ticks, !busy && chore % 8 == 1) << chore;
            EXPECT_EQ(state.std_m_s != was.std_m_s, !busy && chore % 8 == 5) << chore;
            EXPECT_EQ(state.loud == 0, !busy && unheard == 24 && chore % 8 == 4) << chore;    // two values are missed
            if (chore % 8 == 3 && unheard == 23) continue;                                    // the last value may deny the wheels
            EXPECT_EQ(state.p_bb < 10, !busy && (chore % 8 == 6 || chore % 8 == 3)) << chore; // the wheels are asked, and it is held
        }
    }
    ground_speed_config_t fixed_noise = ours();
    fixed_noise.speed_noise_max_m2_s2 = fixed_noise.speed_noise_m2_s2; // (6) is off
    ground_speed_state_t state = calm(any);
    state.accel_noise_m2_s2 = 1;
    state.chore = 15;
    const ground_speed_input_t input = same(state, 0);
    ground_speed_step(&fixed_noise, &state, &input);
    EXPECT_EQ(state.accel_noise_m2_s2, 1);
}

// (20), and what wheels tell where nothing is known.
TEST(GroundSpeedTick, wheels_are_believed_where_they_creep_or_nothing_else_is_known) {
    Any any{{36}};
    int crept = 0, asked = 0, silent = 0, denied = 0, doubted = 0, spun = 0, unheard = 0, rested = 0;
    for (int k = 0; k < 6000; ++k) {
        ground_speed_state_t state = calm(any);
        state.chore = any.one_in(2) ? 2 : 10;
        state.wheel_m_s = narrow(any.one_in(3) ? any.between(-1, 1) : any.between(-0.15, 0.15));
        state.wheel_mean_m_s = narrow(any.one_in(2) ? wide(state.wheel_m_s) : any.between(-0.15, 0.15));
        state.asked_m_s = narrow(wide(state.wheel_m_s) + any.between(-0.08, 0.08));
        state.apart_m_s = 0;
        state.wheel_ticks = 0;
        state.speed_m_s = narrow(any.between(-0.5, 0.5));
        state.bias_m_s2 = 0;
        state.p_bb = 1e-4f;
        state.p_vb = 0;
        state.p_vv = narrow(any.log_between(1e-4, 1));
        state.other_alive = any.one_in(2);
        state.unheard_ticks = any.one_in(2) ? static_cast<int32_t>(any.next() % 22) : 22 + static_cast<int32_t>(any.next() % 4);
        state.rolls_ticks = any.one_in(5) ? 10 : 0;
        state.quiet = any.one_in(3) ? 1 : 0;
        state.accepted = any.one_in(2);
        state.value_at_most = any.one_in(3);
        state.value_heard_m_s = narrow(any.between(0.02, 0.16));
        state.value_m_s = narrow(any.between(0, 1));
        state.wheel_q20 = state.integral_q20[state.head];
        const ground_speed_input_t input = same(state, 0);
        const ground_speed_state_t was = state;
        ground_speed_step(&ours(), &state, &input);
        const double w = wide(was.wheel_m_s), mean = std::fabs(wide(was.wheel_mean_m_s) + 0.04 * (w - wide(was.wheel_mean_m_s)));
        const double slow = wide(ours().slow_m_s), heard = wide(was.value_heard_m_s);
        const bool silence = was.unheard_ticks + 1 >= 25; // two values missed
        if (std::fabs(mean - slow) < 1e-5 || std::fabs(heard - mean - 0.05) < 1e-5) continue;
        // a value that is a limit, (22), contradicts no wheels below it
        const bool deaf = was.quiet > 0 || (was.accepted && heard < slow && (was.value_at_most || heard < mean + 0.05));
        const double gains = std::fabs(w - wide(was.asked_m_s)); // a rim that spins up passes through there
        EXPECT_EQ(state.asked_m_s, was.wheel_m_s);
        if (std::fabs(gains - 0.05) < 1e-5) continue;
        const bool lost = silence && heard >= slow; // what was loud and is silent now
        const bool steady = std::fabs(w) < slow && mean < slow && !lost && was.rolls_ticks == 0 && deaf, creeps = steady && gains < 0.05;
        spun += steady && !creeps ? 1 : 0, unheard += creeps && silence ? 1 : 0;
        const bool at_rest = creeps && std::fabs(w) < wide(ours().still_m_s);
        EXPECT_EQ(state.cover.rested, was.cover.rested || at_rest) << k;
        rested += at_rest && !was.cover.rested ? 1 : 0;
        const double spread = creeps ? 0.015 + 0.2 * std::fabs(w) : 0.1 + 0.5 * std::fabs(w);
        const bool denies = !silence && std::fabs(wide(was.value_m_s) - std::fabs(w)) > 2 * spread;
        const bool undecided = !silence && was.other_alive; // which sign it is, the radar tells
        const double P = was.rolls_ticks > 0 ? wide(was.p_vv) + wide(ours().roll_noise_m2_s2) : wide(was.p_vv) + 1e-6 * 0.01;
        const double before = P + wide(was.speed_noise_m2_s2), beside2 = square(w - wide(was.speed_m_s));
        const double beyond = beside2 / (6.25 * (before + spread * spread)); // (25)
        if (std::fabs(beyond - 1) < 1e-4) continue;
        const double predicted = before + (creeps && beyond > 1 ? beside2 : 0);
        doubted += creeps && beyond > 1 ? 1 : 0;
        if (std::fabs(predicted / (1.2 * spread * spread) - 1) < 1e-3 ||
            std::fabs(std::fabs(wide(was.value_m_s) - std::fabs(w)) - 2 * spread) < 1e-5)
            continue;
        const bool asks = !denies && !undecided && predicted > 1.2 * spread * spread;
        const double R = (creeps ? 4 : 1) * spread * spread, gain = creeps || asks ? predicted / (predicted + R) : 0;
        EXPECT_NEAR(state.speed_m_s, wide(was.speed_m_s) + gain * (w - wide(was.speed_m_s)), 1e-4) << k;
        EXPECT_NEAR(state.p_vv, predicted * (1 - gain), 1e-4 * predicted + 1e-7) << k;
        EXPECT_EQ(state.other_alive, was.other_alive && gain == 0) << k;
        crept += creeps ? 1 : 0, asked += !creeps && asks ? 1 : 0, silent += asks && silence ? 1 : 0, denied += denies && !creeps ? 1 : 0;
    }
    EXPECT_GT(std::min({crept, asked, silent, denied, doubted, crept - doubted, spun, unheard}), 100);
    EXPECT_GT(rested, 20);
}

TEST(GroundSpeedTick, the_standard_deviation_holds_all_that_is_not_known) {
    Any any{{37}};
    const ground_speed_config_t &config = ours();
    std::array<int, 4> seen = {};
    for (int k = 0; k < 2000; ++k) {
        ground_speed_state_t state = calm(any);
        state.calm = narrow(any.one_in(3) ? 1 : any.one_in(2) ? any.between(0.25, 1) : any.between(1, 4));
        state.cover.on = any.one_in(3);
        state.calm_at_m2_s2 = narrow(any.log_between(1e-4, 0.1));
        state.calm_less_m2_s2 = (1 - state.calm) * state.calm_at_m2_s2;
        state.chore = any.one_in(2) ? 4 : 12;
        state.apart_m_s = 0.01f;
        state.apart_m2_s2 = narrow(any.one_in(2) ? 0 : any.log_between(1e-3, 0.1));
        state.unseen_m2_s2 = narrow(any.log_between(1e-6, 1e-2));
        state.felt_trust = narrow(any.uniform());
        state.alike_m_s = narrow(any.one_in(2) ? 0 : any.between(0, 0.2));
        state.other_alive = any.one_in(2);
        state.doubt_m_s = 0.03f;
        state.doubt_m2_s2 = narrow(any.between(0, 0.1));
        state.gyro_doubt_m2_s2 = narrow(any.one_in(2) ? 0 : any.between(0, 0.05));
        ground_speed_input_t input = same(state, any.between(-1, 1));
        input.accel_valid = !any.one_in(3);
        const ground_speed_output_t out = ground_speed_step(&config, &state, &input);
        const double claimed = wide(state.apart_claim_m2_s2); // a test of its own
        const double taken = state.felt_m_s != 0 ? 0.95 * wide(state.felt_trust) : 0;
        const double own = wide(state.p_vv) + wide(state.unseen_m2_s2) * (1 - taken), R = wide(state.calm_at_m2_s2); // (28)
        const double g = state.cover.on ? std::fmin(1, wide(state.calm)) : wide(state.calm); // no value comes that could scatter
        const double variance = own - (1 - g) * std::fmin(own, R) + claimed + square(wide(state.alike_m_s)) +
                                (state.other_alive ? wide(state.doubt_m2_s2) : 0) + wide(state.gyro_doubt_m2_s2);
        EXPECT_NEAR(out.std_m_s, std::sqrt(variance), 1e-5 + 1e-5 * std::sqrt(variance)) << k;
        EXPECT_NEAR(out.speed_m_s, wide(state.speed_m_s) - wide(state.felt_m_s) - (state.other_alive ? 0.03 : 0), eps);
        seen[0] += taken > 0 ? 1 : 0, seen[1] += state.calm < 1 && own > R ? 1 : 0, seen[2] += state.calm < 1 && own < R ? 1 : 0;
        seen[3] += claimed > own ? 1 : 0;
    }
    EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 50);
}

// (10) and (31): what X adds, less where it is the wheels' own or follows a rim's leap.
TEST(GroundSpeedTick, what_wheels_and_accelerometer_part_by_widens_the_claim_less_where_it_is_the_wheels_own) {
    Any any{{53}};
    int told_by = 0, shaken_by = 0, none = 0, leapt = 0, own = 0, noisy = 0, body = 0, contrary = 0;
    for (int k = 0; k < 3000; ++k) {
        ground_speed_state_t state = calm(any);
        state.chore = any.one_in(2) ? 1 : 4;
        state.rolls_wait = any.one_in(3) ? 50 : 0;
        state.speed_noise_m2_s2 = narrow(any.log_between(4e-6, 1e-4));
        state.apart_m_s = narrow(any.one_in(3) ? 0 : any.between(-0.3, 0.3));
        state.apart_m2_s2 = narrow(any.one_in(2) ? 0 : any.log_between(1e-4, 0.1));
        state.wheel_mean_m_s = narrow(wide(state.wheel_m_s) + any.between(-0.3, 0.3));
        state.other_alive = true; // (13) is not asked
        const ground_speed_input_t input = same(state, wide(state.bias_m_s2));
        ground_speed_step(&ours(), &state, &input);
        const double q = wide(state.speed_noise_m2_s2), least2 = square(0.03), x = std::fabs(wide(state.apart_m_s)); // what slip makes
        const double told = x * x - least2 - 112 * q, shaken = wide(state.apart_m2_s2) - least2 - 112 * q / 9;
        const double apart2 = std::clamp(std::fmax(told, shaken), 0.0, wide(ours().speed_max_m_s));
        const double wheels = std::fabs(wide(state.wheel_m_s) - wide(state.wheel_mean_m_s));
        if (std::fabs(x - 1.5 * wheels) < 1e-5 || std::fabs(wheels * wheels - 112 * q) < 1e-6) continue;
        const bool leap = state.rolls_wait > 0, theirs = wheels * wheels > 112 * q && x < 1.5 * wheels;
        const bool against = state.speed_m_s * state.wheel_m_s < 0; // the estimate or the wheels are wrong by more than that
        EXPECT_NEAR(state.apart_claim_m2_s2, apart2 / ((leap || theirs) && !against ? 9 : 1), 1e-6 + eps * apart2) << k;
        (apart2 <= 0 ? none : told > shaken ? told_by : shaken_by) += 1;
        if (apart2 > 0) (against && (leap || theirs) ? contrary : leap ? leapt : theirs ? own : x < 1.5 * wheels ? noisy : body) += 1;
    }
    EXPECT_GT(std::min({told_by, shaken_by, none, leapt, own, noisy, body, contrary}), 50);
}

TEST(GroundSpeedTick, the_papers_standard_deviation_is_the_filters_alone) {
    const ground_speed_config_t paper = rover_config_paper().ground_speed;
    Any any{{41}};
    for (int k = 0; k < 200; ++k) {
        ground_speed_state_t state = calm(any);
        state.std_m_s = 0; // it is made anew
        state.alike_m_s = 0.2f;
        state.apart_m2_s2 = 0.1f;
        state.felt_m_s = 0;
        const ground_speed_input_t input = same(state, 0.5);
        const ground_speed_output_t out = ground_speed_step(&paper, &state, &input);
        EXPECT_NEAR(out.std_m_s, std::sqrt(wide(state.p_vv)), eps);
    }
}

// --- a value: the best track in its tick, the other sign in the next, the agile one in the third, the slide in the two after

TEST(GroundSpeedTick, a_value_is_seen_by_one_track_a_tick) {
    Any any{{38}};
    for (int k = 0; k < 200; ++k) {
        ground_speed_state_t state = calm(any);
        const bool other = any.one_in(2), refused = any.one_in(3), rolls = any.one_in(3), busy = any.one_in(3);
        state.other_alive = other;
        state.odds = 10;
        state.refused = refused ? 1 : 0;
        state.rolls_ticks = rolls ? 30 : 0;
        state.other.ticks = 12;
        state.other.at = ground_speed_best_of(&state);
        state.other.at.speed_m_s = -2;
        state.speed_m_s = 2;
        state.p_vv = 1e-4f;
        state.p_vb = 0;
        state.value_cost = 0;
        state.value_sign = 1;
        state.value_m_s = 2;
        state.value_heard_m_s = 2;
        state.wheel_m_s = -1.9f;
        state.wheel_mean_m_s = -1.9f;
        state.value_wheel_m_s = -1.9f; // against the sign
        state.against = 1;
        state.rolls = false;
        state.agile_left = 0;
        state.agile.ticks = 9;
        state.waits = 2;
        ground_speed_input_t input = same(state, 0);
        input.busy = busy;
        const uint32_t chore = state.chore;
        ground_speed_step(&ours(), &state, &input);
        EXPECT_EQ(state.waits, 1);
        EXPECT_EQ(state.chore, chore); // no tick pays for two
        EXPECT_EQ(state.other.ticks, other ? 1 : 13);
        EXPECT_EQ(state.against, other || refused ? 1 : state.rolls ? 3 : 2);
        EXPECT_EQ(state.agile.ticks, 10);
        EXPECT_EQ(state.slide.due, 0);
        ground_speed_step(&ours(), &state, &input);
        EXPECT_EQ(state.waits, 0);
        EXPECT_EQ(state.agile.ticks, rolls ? 11 : 2); // (3) knows no jump within its window
        EXPECT_EQ(state.agile_left, rolls ? 0 : ours().agile_values);
        EXPECT_EQ(state.slide.due, 2);
        for (const int due : {1, 0}) {
            input.busy = true;
            ground_speed_step(&ours(), &state, &input);
            EXPECT_EQ(state.slide.due, due + 1);
            input.busy = false;
            ground_speed_step(&ours(), &state, &input);
            EXPECT_EQ(state.slide.due, due);
            EXPECT_EQ(state.chore, chore);
        }
        ground_speed_step(&ours(), &state, &input);
        EXPECT_EQ(state.chore, chore + 1);
    }
}

TEST(GroundSpeedTick, a_quiet_value_corrects_from_the_third_in_a_row_on_and_a_loud_one_at_once) {
    Any any{{39}};
    for (int k = 0; k < 300; ++k) {
        ground_speed_state_t state = calm(any);
        state.speed_m_s = narrow(any.either() * 0.3);
        state.bias_m_s2 = 0;
        state.p_vv = 0.1f;
        state.p_bb = 1e-3f;
        state.p_vb = 0;
        state.accepted = false;
        state.quiet = static_cast<int32_t>(any.next() % 4);
        for (auto &V : state.integral_q20) V = 0;
        ground_speed_input_t input = same(state, 0);
        input.doppler_fresh = true;
        input.doppler_m_s = 0.5f;
        input.doppler_quiet = any.one_in(2);
        if (input.doppler_quiet) input.wheel_m_s = state.wheel_m_s = 0.06f; // slow wheels: no radar that is covered, (38)
        const ground_speed_state_t was = state;
        const ground_speed_output_t out = ground_speed_step(&ours(), &state, &input);
        const double moved = std::fabs(wide(state.speed_m_s)) - 0.3;
        if (input.doppler_quiet) {
            EXPECT_EQ(moved < -0.2, was.quiet >= 2) << was.quiet;
            EXPECT_EQ(std::fabs(moved) < 1e-4, was.quiet < 2);
            EXPECT_FALSE(state.accepted);
        } else {
            EXPECT_GT(moved, 0.15); // or through zero to the wheels' sign
            EXPECT_TRUE(state.accepted);
            EXPECT_EQ(state.waits, 2);
        }
        EXPECT_NE(out.std_m_s, was.std_m_s); // anew at each value
    }
}

} // namespace
