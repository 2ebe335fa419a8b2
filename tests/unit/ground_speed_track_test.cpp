// One track [v, b] and what it is told, each part by itself: ground_speed_track.c, ground_speed_value.c, ground_speed_wheels.c,
// ground_speed_gyro.c against the equations of ground_speed.h in double, from any state.
#include "firmware/core/doppler_template.h"
#include "tests/unit/ground_speed_any.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace {

using any_state::Any, any_state::narrow, any_state::passed, any_state::square, any_state::wide;

const ground_speed_config_t &ours() {
    static const ground_speed_config_t config = rover_config_default().ground_speed;
    return config;
}

constexpr double eps = 1e-5; // of a few float operations, 2^-24 each, and of what they cancel

void expect_track(const ground_speed_track_t &is, double v, double b, double vv, double vb, double bb, double scale = 1) {
    EXPECT_NEAR(is.speed_m_s, v, eps * (std::fabs(v) + scale));
    EXPECT_NEAR(is.bias_m_s2, b, eps * (std::fabs(b) + scale));
    EXPECT_NEAR(is.p_vv, vv, eps * scale * (vv + 1e-3));
    EXPECT_NEAR(is.p_vb, vb, eps * scale * (std::fabs(vb) + 1e-3));
    EXPECT_NEAR(is.p_bb, bb, eps * scale * (bb + 1e-3));
}

TEST(GroundSpeedTrack, what_is_in_bounds_is_left_alone_and_what_is_beyond_is_brought_back_whole) {
    const double v_max = wide(ours().speed_max_m_s), b_max = wide(ours().bias_max_m_s2);
    Any any{{1}};
    int left_alone = 0;
    for (int k = 0; k < 2500; ++k) {
        const double vv = any.log_between(1e-10, 100), bb = any.log_between(1e-10, 1000), r = any.between(-1.1, 1.1);
        const ground_speed_track_t was = {narrow(any.between(-2, 2) * v_max), narrow(any.between(-2, 2) * b_max), narrow(vv),
                                          narrow(r * std::sqrt(vv * bb)), narrow(bb)};
        ground_speed_track_t is = was;
        ground_speed_hold(&ours(), &is);
        EXPECT_EQ(is.speed_m_s, std::clamp(was.speed_m_s, -ours().speed_max_m_s, ours().speed_max_m_s));
        EXPECT_EQ(is.bias_m_s2, std::clamp(was.bias_m_s2, -ours().bias_max_m_s2, ours().bias_max_m_s2));
        EXPECT_NEAR(is.p_vv, std::clamp(vv, 1e-8, 4.0), 1e-6 * vv);
        EXPECT_NEAR(is.p_bb, std::clamp(bb, 1e-8, b_max * b_max), 1e-6 * bb);
        // shrunk as a whole: by the same share as its variance
        const double vb = wide(was.p_vb) * std::fmin(1, 4 / vv) * std::fmin(1, b_max * b_max / bb), bound = wide(is.p_vv) * wide(is.p_bb);
        if (std::fabs(vb * vb / bound - 1) > 1e-4) {
            EXPECT_NEAR(is.p_vb, vb * vb < bound ? vb : 0, 1e-6 * std::fabs(vb)) << k;
        }
        EXPECT_LE(wide(is.p_vb) * wide(is.p_vb), bound * (1 + 1e-6)); // a covariance
        left_alone += is.p_vb == was.p_vb && is.p_vv == was.p_vv && is.p_bb == was.p_bb ? 1 : 0;
    }
    EXPECT_GT(left_alone, 500);
}

// F P F', F = [1 -t; 0 1].
TEST(GroundSpeedTrack, moves_by_the_change_less_its_bias_and_its_covariance_with_it) {
    Any any{{2}};
    for (int k = 0; k < 800; ++k) {
        const ground_speed_track_t was = any.track();
        const double t = any.between(0, 0.5), change = any.between(-0.5, 0.5), q = any.log_between(1e-6, 1e-3),
                     qb = any.log_between(1e-6, 0.5);
        ground_speed_track_t is = was;
        ground_speed_move(&ours(), &is, narrow(change), narrow(t), narrow(q), narrow(qb));
        expect_track(is, wide(was.speed_m_s) + change - t * wide(was.bias_m_s2), wide(was.bias_m_s2), any_state::spread_of(was, -t) + q,
                     wide(was.p_vb) - t * wide(was.p_bb), wide(was.p_bb) + qb);
    }
}

// The best linear estimate: (I - k h) P (I - k h)' + k R k', with k = P h'/(h P h' + R), whatever form the firmware has.
TEST(GroundSpeedTrack, is_corrected_as_the_best_linear_estimate_is) {
    Any any{{3}};
    for (int k = 0; k < 800; ++k) {
        const ground_speed_track_t was = any.track();
        const double tau = any.one_in(4) ? 0 : any.between(0, 0.4), R = any.log_between(1e-5, 1e-1), e = any.between(-0.5, 0.5);
        const double vv = wide(was.p_vv), vb = wide(was.p_vb), bb = wide(was.p_bb), S = vv + 2 * tau * vb + tau * tau * bb + R;
        const double kv = (vv + tau * vb) / S, kb = (vb + tau * bb) / S;
        const double a = 1 - kv, b = -kv * tau, c = -kb, d = 1 - kb * tau; // I - k h
        ground_speed_track_t is = was;
        ground_speed_correct(&ours(), &is, narrow(e), narrow(tau), narrow(R));
        const double bias = std::clamp(wide(was.bias_m_s2) + kb * e, -3.0, 3.0);
        expect_track(is, wide(was.speed_m_s) + kv * e, bias, a * a * vv + 2 * a * b * vb + b * b * bb + kv * kv * R,
                     a * c * vv + (a * d + b * c) * vb + b * d * bb + kv * kb * R, c * c * vv + 2 * c * d * vb + d * d * bb + kb * kb * R,
                     10);
        EXPECT_NEAR(ground_speed_spread_of(&was, narrow(tau)), any_state::spread_of(was, tau), eps * (vv + bb));
    }
}

TEST(GroundSpeedTrack, V_is_the_sum_of_all_accelerations_and_loses_nothing) {
    Any any{{4}};
    ground_speed_state_t state;
    ground_speed_reset(&ours(), &state);
    std::vector<double> sums{0};
    for (int k = 1; k < 3 * GROUND_SPEED_HISTORY; ++k) {
        const float accel = narrow(any.one_in(3) ? any.between(-20, 20) : any.between(-1e-3, 1e-3)); // 1e-3: ten units a tick
        ground_speed_integrate(&ours(), &state, accel);
        sums.push_back(sums.back() + wide(accel) * 0.01);
        for (int back = 1; back < GROUND_SPEED_HISTORY && back <= k; back += 7) {
            // each end is whole units of 2^-20 below its sum; each product, up to 2^18 units, is rounded to 2^-7
            EXPECT_NEAR(passed(state, 0, back), sums[static_cast<std::size_t>(k)] - sums[static_cast<std::size_t>(k - back)],
                        (2 + back * 0x1p-7) / 1048576.0);
        }
    }
    const int32_t before = state.integral_q20[state.head];
    ground_speed_integrate(&ours(), &state, 3.4e38f); // no number of a sensor
    EXPECT_LE(std::llabs(static_cast<int64_t>(state.integral_q20[state.head]) - before), int64_t{100000000});
}

// (6) by its definition, over 32 ticks and over six bends of four; each bend is limited to 0.125 and 0.25 m/s.
TEST(GroundSpeedTrack, noise_is_the_mean_square_of_bends_and_enters_by_an_eighth) {
    Any any{{5}};
    const auto mean = [](const ground_speed_state_t &state, int ticks, int bends, double limit) {
        double sum = 0;
        for (int i = 0; i < bends; ++i) {
            const double bend = passed(state, i * ticks, (i + 1) * ticks) - passed(state, (i + 1) * ticks, (i + 2) * ticks);
            sum += square(std::clamp(bend, -limit, limit));
        }
        return sum / bends / (2 * ticks);
    };
    int stated = 0, most = 0, slow = 0, thrice = 0, calmer = 0, as_filter = 0, slower = 0, whiter = 0;
    for (int k = 0; k < 400; ++k) {
        ground_speed_state_t state = any.past(ours());
        if (any.one_in(8)) { // a blow
            ground_speed_integrate(&ours(), &state, narrow(any.between(-90, 90)));
            for (int n = static_cast<int>(any.next() % 30); n > 0; --n) ground_speed_integrate(&ours(), &state, 0);
        }
        state.accel_noise_m2_s2 = narrow(any.log_between(1e-6, 1e-3));
        state.slow_noise_m2_s2 = narrow(any.log_between(1e-6, 1e-3));
        const double q1 = wide(state.accel_noise_m2_s2) * 0.875 + 0.125 * mean(state, 1, 32, 0.125);
        const double q4 = wide(state.slow_noise_m2_s2) * 0.875 + 0.125 * mean(state, 4, 6, 0.25);
        state.usual_noise_m2_s2 = narrow(any.log_between(4e-8, 4e-4));
        state.usual_slow_m2_s2 = narrow(any.log_between(4e-8, 4e-4));
        const auto usual = [](float was, double found) { // (30): up by 2, down by 0.85, within 0.02 and 2 m/s^2 of noise
            return std::clamp(wide(was) * (found > wide(was) ? 2 : 0.85), square(0.02 * 0.01), square(2 * 0.01));
        };
        const double found1 = mean(state, 1, 32, 0.125), found4 = mean(state, 4, 6, 0.25);
        const bool close =
            std::fabs(found1 / wide(state.usual_noise_m2_s2) - 1) < 0.02 || std::fabs(found4 / wide(state.usual_slow_m2_s2) - 1) < 0.02;
        const double usual1 = usual(state.usual_noise_m2_s2, found1), usual4 = usual(state.usual_slow_m2_s2, found4);
        ground_speed_watch_slow_noise(&state);
        ground_speed_watch_noise(&ours(), &state);
        if (!close) {
            EXPECT_NEAR(state.usual_noise_m2_s2, usual1, eps * usual1);
            EXPECT_NEAR(state.usual_slow_m2_s2, usual4, eps * usual4);
            const double claimed = std::fmin(wide(state.speed_noise_m2_s2), std::fmax(usual1, usual4)) * wide(ours().window->tau_ticks);
            EXPECT_NEAR(state.unseen_m2_s2, claimed, eps * claimed);
            (claimed < 0.99 * wide(state.speed_noise_m2_s2) * wide(ours().window->tau_ticks) ? calmer : as_filter) += 1;
            (usual4 > usual1 ? slower : whiter) += 1;
        }
        // a bend is cut to 2^-16 m/s: of one of 2^-16 rms 8e-3, by twice that times 2^-16 at most
        const double cut = 0.125 * (2 * 0x1p-16 * std::sqrt(8 * std::fmax(q1, q4) * 8) + 0x1p-32);
        EXPECT_NEAR(state.accel_noise_m2_s2, q1, cut + eps * q1);
        EXPECT_NEAR(state.slow_noise_m2_s2, q4, cut + eps * q4);
        const double noise = std::fmax(q1, std::fmin(q4, 3 * q1));
        const double low = wide(ours().speed_noise_m2_s2), high = wide(ours().speed_noise_max_m2_s2);
        EXPECT_NEAR(state.speed_noise_m2_s2, std::clamp(noise, low, high), 3 * cut + eps * noise);
        (noise < low ? stated : noise > high ? most : q4 > 3 * q1 ? thrice : q4 > q1 ? slow : stated) += 1;
    }
    EXPECT_GT(std::min({stated, most, slow, thrice, calmer, as_filter, slower, whiter}), 10);
}

// (3) from its definition: w_j less V at the window's end, which lies between two ticks.
TEST(GroundSpeedTrack, what_a_window_remembers_is_its_weighted_mean_of_the_past) {
    Any any{{6}};
    for (const std::size_t radar : {0u, 1u, 2u, 3u}) {
        ground_speed_config_t config = ours();
        const doppler_template_t *beams[] = {&doppler_template_mdu1130, &doppler_template_dj_radar_2, &doppler_template_dj_radar_3,
                                             &doppler_template_drs1000};
        config.window = &beams[radar]->window;
        const doppler_window_t &window = *config.window;
        for (int k = 0; k < 100; ++k) {
            const ground_speed_state_t state = any.past(config);
            const double late = any.one_in(4) ? 0 : any.between(-0.3, 0.15), held = std::clamp(late, -0.25, 0.12);
            const ground_speed_past_t is = ground_speed_look_back(&config, &state, narrow(late));
            const double ticks_late = std::fmax(0, held * 100);
            if (std::fabs(ticks_late - std::round(ticks_late)) < 1e-3 && ticks_late > 0) continue; // on a tick to rounding
            const int ago = static_cast<int>(ticks_late);
            double mean = 0, weights = 0;
            for (int j = 0; j < window.ticks; ++j) {
                mean += window.weight_q15[j] / 32768.0 * passed(state, ago, ago + j);
                weights += window.weight_q15[j] / 32768.0;
            }
            EXPECT_NEAR(weights, 1, 1e-9);
            const double accel = passed(state, ago, ago + window.ticks - 1) * wide(window.per_s);
            EXPECT_NEAR(is.accel_m_s2, accel, eps * (1 + std::fabs(accel)));
            EXPECT_NEAR(is.tau_s, wide(window.tau_s) + held, 1e-6);
            // each product is cut to 2^-19; the rest of a tick at the window's acceleration
            EXPECT_NEAR(is.change_m_s, mean + passed(state, 0, ago) + accel * (held - 0.01 * ago),
                        window.ticks * 0x1p-19 + eps * (1 + std::fabs(accel)))
                << late;
        }
    }
}

// --- a value

TEST(GroundSpeedTrack, a_value_is_less_and_less_sure_where_the_track_accelerates_or_the_radar_is_deaf) {
    ground_speed_config_t config = ours();
    Any any{{7}};
    for (int k = 0; k < 2500; ++k) {
        ground_speed_state_t state = {};
        any.value(config, state);
        if (any.one_in(2)) state.value_heard_m_s = narrow(any.between(0, 0.2));
        const ground_speed_track_t track = any.track();
        const double own = any.between(-3, 3), d = wide(state.value_heard_m_s), slow = wide(config.slow_m_s);
        const ground_speed_value_t is = ground_speed_value_for(&config, &state, &track, narrow(own));
        const double a2 = std::fmax(0, own * own - wide(track.p_bb)); // beyond what the bias is not known to
        EXPECT_NEAR(is.speed_m_s, std::sqrt(d * d - std::fmin(square(wide(config.doppler_spread_s)) * a2, d * d / 2)), 1e-5) << k; // (11)
        const double deaf = wide(config.deaf_noise_m2_s2) * std::clamp((slow - d) / (slow / 4), 0.0, 1.0); // all of it below 0.09 of 0.12
        const double R = wide(state.value_trust) * (wide(config.doppler_noise_m2_s2) + wide(config.doppler_noise_m_s) * d) +
                         wide(config.doppler_accel_s2) * a2 + deaf;
        EXPECT_NEAR(is.noise_m2_s2, R, eps * R + 1e-8) << k;
    }
}

// A track that knows nothing but the value has the value as what (3) expects, with its variance, and the bias as it was given.
TEST(GroundSpeedTrack, what_a_value_told_alone_expects_that_value) {
    Any any{{8}};
    for (int k = 0; k < 1000; ++k) {
        ground_speed_state_t state = {};
        any.value(ours(), state);
        const double sign = any.either(), bias = any.between(-2, 2), p_bb = any.log_between(1e-4, 2), tau = wide(state.value_tau_s);
        const ground_speed_track_t is = ground_speed_told(&ours(), &state, narrow(sign), narrow(bias), narrow(p_bb));
        EXPECT_NEAR(any_state::mean_of(is, tau) - wide(state.value_change_m_s), sign * wide(state.value_m_s), eps);
        EXPECT_NEAR(any_state::spread_of(is, tau), wide(state.value_noise_m2_s2), 1e-6);
        EXPECT_EQ(is.bias_m_s2, narrow(bias));
        EXPECT_EQ(is.p_bb, narrow(p_bb));
    }
}

TEST(GroundSpeedTrack, the_papers_filter_is_a_mean_by_variances_with_the_wheels_sign) {
    const ground_speed_config_t paper = rover_config_paper().ground_speed;
    Any any{{9}};
    for (int k = 0; k < 500; ++k) {
        ground_speed_state_t state = any.past(paper);
        const double v = wide(state.speed_m_s), P = wide(state.p_vv), R = wide(paper.doppler_noise_m2_s2);
        const double d = any.between(-0.5, 15), wheel = any.one_in(5) ? 0 : any.between(-1, 1);
        const double z = (wheel < 0 ? -1 : 1) * std::clamp(d, 0.0, wide(paper.speed_max_m_s)); // a magnitude, of no more than there is
        ground_speed_update_paper(&paper, &state, narrow(d), narrow(wheel));
        EXPECT_NEAR(state.speed_m_s, (v * R + z * P) / (P + R), eps * 10);
        EXPECT_NEAR(state.p_vv, P * R / (P + R), eps * P);
        EXPECT_EQ(state.p_vb, 0);
        EXPECT_EQ(state.p_bb, 0);
    }
}

// Of a value on the best track, far from zero: (3), (4), (5), (8), the gate, and what is kept for those who see it later.
TEST(GroundSpeedTrack, a_value_corrects_or_is_refused_and_is_kept_for_the_others) {
    const ground_speed_config_t &config = ours();
    Any any{{10}};
    int refused = 0, jumped = 0, believed = 0, relieved = 0, early_refused = 0;
    for (int k = 0; k < 2500; ++k) {
        ground_speed_state_t state = any.past(config);
        state.speed_m_s = narrow(any.either() * any.between(1.0, 1.5));
        state.bias_m_s2 = narrow(any.between(-1, 1));
        state.p_vv = narrow(any.log_between(1e-5, 1e-2));
        state.p_bb = narrow(any.log_between(1e-5, 1e-2));
        state.p_vb = narrow(any.between(-0.9, 0.9) * std::sqrt(wide(state.p_vv) * wide(state.p_bb)));
        state.one_sided = narrow(any.between(-1.99, 1.99));
        state.misfit = narrow(any.between(1, 10));
        state.alike_m_s = narrow(any.between(0, 0.1));
        state.accepted = !any.one_in(4);
        state.refused = static_cast<int32_t>(any.next() % static_cast<unsigned>(config.gate_patience + 1));
        state.relieved = any.one_in(2);
        state.slide.held = 3;
        state.agile_left = 2;
        state.against = -5;
        const double late = any.one_in(4) ? -0.12 : any.one_in(2) ? 0 : 0.034;
        const ground_speed_past_t window = ground_speed_look_back(&config, &state, narrow(late));
        const ground_speed_track_t was = ground_speed_best_of(&state);
        const double tau = wide(window.tau_s), middle = any_state::mean_of(was, tau) - wide(window.change_m_s);
        const double scatter = any.one_in(2) ? 0.3 : 0.05;
        ground_speed_input_t input = {};
        input.doppler_fresh = true;
        input.doppler_late_s = narrow(late);
        input.doppler_trust = narrow(any.one_in(2) ? 0 : any.log_between(0.5, 20));
        input.doppler_misfit = narrow(any.between(0, 0.5));
        input.doppler_m_s = narrow(std::clamp(std::fabs(middle) * (1 + scatter * any.normal()), wide(config.slow_m_s), 3.0));
        input.doppler_relieved = any.one_in(3);
        input.wheels_part = any.one_in(2);
        input.wheel_m_s = narrow(any.either() * any.between(0.1, 1));
        const ground_speed_state_t before = state;
        const double own = wide(window.accel_m_s2) - wide(was.bias_m_s2), a2 = std::fmax(0, own * own - wide(was.p_bb));
        if (std::fabs(std::fabs(own) - 0.2) < 1e-4) continue;
        ground_speed_update_doppler(&config, &state, &input);
        if (late < 0 && std::fabs(own) > 0.2) { // a short window: only while the speed is steady
            EXPECT_EQ(state.speed_m_s, before.speed_m_s);
            EXPECT_EQ(state.value_heard_m_s, before.value_heard_m_s);
            EXPECT_EQ(state.slide.newest, before.slide.newest);
            early_refused++;
            continue;
        }
        const double heard = wide(input.doppler_m_s),
                     trust = std::fmax(1, wide(input.doppler_trust)) * wide(before.misfit) * (late < 0 ? 2.5 : 1);
        const double z = std::sqrt(heard * heard - std::fmin(square(wide(config.doppler_spread_s)) * a2, heard * heard / 2));
        const double R =
            trust * (wide(config.doppler_noise_m2_s2) + wide(config.doppler_noise_m_s) * heard) + wide(config.doppler_accel_s2) * a2;
        const double S = any_state::spread_of(was, tau) + R, sign = middle < 0 ? -1 : 1, e = sign * z - middle, cost = e * e / S;
        EXPECT_NEAR(state.value_heard_m_s, heard, 1e-6);
        EXPECT_NEAR(state.value_m_s, z, 1e-5);
        EXPECT_NEAR(state.value_noise_m2_s2, R, 1e-4 * R);
        EXPECT_NEAR(state.value_trust, trust, 1e-5 * trust);
        EXPECT_EQ(state.value_tau_s, window.tau_s);
        EXPECT_EQ(state.value_change_m_s, window.change_m_s);
        EXPECT_EQ(state.value_accel_m_s2, window.accel_m_s2);
        EXPECT_EQ(state.value_parts, input.wheels_part);
        EXPECT_EQ(state.value_wheel_m_s, ground_speed_hint(&config, &input, state.value_m_s));
        EXPECT_NEAR(state.alike_m_s, 0.75 * wide(before.alike_m_s) + 0.25 * wide(input.doppler_misfit) * heard, eps);
        if (std::fabs(cost - 4) < 0.01 || std::fabs(cost - 12.25) < 0.03 || std::fabs(middle) < 0.3) continue;
        const bool anew = input.doppler_relieved && !before.relieved && cost > 4; // what was believed was the line's
        EXPECT_EQ(state.slide.held, (anew ? 0 : 3) + (late < 0 ? 0 : 1));         // a full window is remembered
        if (anew) {
            EXPECT_TRUE(state.relieved);
            EXPECT_FALSE(state.refused);
            EXPECT_TRUE(state.accepted);
            EXPECT_EQ(state.rolls_ticks, 0);
            EXPECT_EQ(state.agile_left, 0);
            ground_speed_track_t at = {was.speed_m_s, window.accel_m_s2, 1, 0, 1}; // (1 m/s)^2, (1 m/s^2)^2, as if it rolled along
            const double m = any_state::mean_of(at, tau) - wide(window.change_m_s), spread = 1 + tau * tau + R;
            const double nearest = (m < 0 ? -z : z) - m, share = nearest * std::fabs(nearest) / spread;
            EXPECT_EQ(state.against, 0); // (27): what the line had answered is open
            EXPECT_NEAR(state.value_scatter, std::fabs(share), 1e-3 * (1 + std::fabs(share)));
            EXPECT_NEAR(state.value_cost, std::fabs(share) + wide(ground_speed_ln_rough(narrow(spread))), 1e-3);
            EXPECT_NEAR(state.misfit, std::fabs(share) > 12.25 ? 1 : std::fmax(1, 1 + 0.02 * (std::fabs(share) - 1)), 1e-3);
            const double sided = 0.75 * wide(before.one_sided) + 0.25 * std::clamp(share, -4.0, 4.0);
            if (std::fabs(std::fabs(sided) - 2) < 1e-3 || std::fabs(m) < 1e-3) continue;
            if (std::fabs(sided) > 2) at.p_bb += config.jump_m2_s4;
            ground_speed_correct(&config, &at, narrow(wide(state.value_sign) * z - m), narrow(tau), narrow(R));
            EXPECT_NEAR(state.speed_m_s, at.speed_m_s, 1e-4);
            EXPECT_NEAR(state.bias_m_s2, at.bias_m_s2, 1e-4);
            EXPECT_NEAR(state.p_vv, at.p_vv, 1e-4);
            EXPECT_NEAR(state.p_bb, at.p_bb, 1e-4);
            relieved++;
            continue;
        }
        EXPECT_EQ(state.relieved, input.doppler_relieved && before.relieved);
        EXPECT_EQ(state.against, -5);
        EXPECT_NEAR(state.value_scatter, cost, 1e-3 * (1 + cost));                                           // of (28), refused or not
        const double m = 0.75 * wide(before.one_sided) + 0.25 * std::clamp(e * std::fabs(e) / S, -4.0, 4.0); // (4)
        const bool jump = std::fabs(m) > wide(config.jump_limit);
        if (std::fabs(std::fabs(m) - 2) > 1e-3) {
            EXPECT_NEAR(state.one_sided, jump ? 0 : m, 1e-3);
        }
        if (cost > 12.25 && before.accepted && before.refused < config.gate_patience) {
            EXPECT_EQ(state.refused, before.refused + 1);
            EXPECT_EQ(state.speed_m_s, before.speed_m_s);
            EXPECT_EQ(state.p_vv, before.p_vv);
            EXPECT_EQ(state.misfit, before.misfit);
            EXPECT_NEAR(state.value_cost, cost + wide(ground_speed_ln_rough(narrow(S))), 1e-3 * (1 + cost));
            EXPECT_EQ(state.value_sign, narrow(sign));
            EXPECT_EQ(state.waits, 2);
            refused++;
            continue;
        }
        EXPECT_EQ(state.refused, 0);
        EXPECT_TRUE(state.accepted);
        EXPECT_EQ(state.waits, 2);
        ground_speed_track_t from = was;
        if (cost > 12.25) {
            from.p_vv = 1;
            from.p_vb = 0;
            believed++;
            EXPECT_EQ(state.misfit, before.misfit);
        } else {
            EXPECT_NEAR(state.misfit, std::clamp(wide(before.misfit) * (1 + 0.02 * (cost - 1)), 1.0, 30.0), 1e-3); // (8)
        }
        if (std::fabs(std::fabs(m) - 2) < 1e-3) continue;
        if (jump) { // (5)
            from.p_bb += config.jump_m2_s4;
            jumped++;
        }
        const double spread = any_state::spread_of(from, tau) + R;
        const double kv = (wide(from.p_vv) + tau * wide(from.p_vb)) / spread, kb = (wide(from.p_vb) + tau * wide(from.p_bb)) / spread;
        // (9): sure of its sign where 4 z |m|/S is beyond 18; else the wheels may have another
        const double told =
            cost > 12.25 ? e * e / spread : cost; // a value that is believed against the gate is judged by what is known then
        EXPECT_NEAR(state.value_cost, told + wide(ground_speed_ln_rough(narrow(cost > 12.25 ? spread : S))), 1e-3 * (1 + told));
        if (4 * z * std::fabs(middle) / (cost > 12.25 ? spread : S) > 18.1) {
            EXPECT_EQ(state.value_sign, narrow(sign));
        }
        const double moved = wide(state.value_sign) * z - middle;
        EXPECT_NEAR(state.speed_m_s, wide(was.speed_m_s) + kv * moved, 1e-4 * std::fabs(kv * moved) + 3 * eps) << k;
        EXPECT_NEAR(state.bias_m_s2, std::clamp(wide(was.bias_m_s2) + kb * moved, -3.0, 3.0), 1e-4 * std::fabs(kb * moved) + 3 * eps) << k;
    }
    EXPECT_GT(std::min({refused, jumped, believed, relieved, early_refused}), 10)
        << refused << ' ' << jumped << ' ' << believed << ' ' << relieved << ' ' << early_refused;
}

TEST(GroundSpeedTrack, a_value_is_a_magnitude_of_no_more_than_there_is) {
    Any any{{16}};
    for (const double said : {-1.0, 0.0, 0.03, 0.5, 1e6}) {
        ground_speed_state_t state = any.past(ours());
        ground_speed_input_t input = {};
        input.doppler_m_s = narrow(said);
        ground_speed_update_doppler(&ours(), &state, &input);
        EXPECT_EQ(state.value_heard_m_s, narrow(std::clamp(said, 0.0, wide(ours().speed_max_m_s))));
    }
}

TEST(GroundSpeedTrack, a_quiet_echo_pulls_the_windows_mean_to_zero_unless_it_is_a_fade) {
    Any any{{11}};
    int fades = 0;
    for (int k = 0; k < 1000; ++k) {
        ground_speed_state_t state = any.past(ours());
        state.other_alive = true;
        const ground_speed_track_t was = ground_speed_best_of(&state);
        ground_speed_input_t input = {};
        input.doppler_late_s = narrow(any.between(0, 0.1));
        const ground_speed_past_t window = ground_speed_look_back(&ours(), &state, input.doppler_late_s);
        const double tau = wide(window.tau_s), middle = any_state::mean_of(was, tau) - wide(window.change_m_s);
        const double S = any_state::spread_of(was, tau) + wide(ours().quiet_noise_m2_s2), cost = middle * middle / S;
        if (std::fabs(cost - 12.25) < 0.02) continue;
        ground_speed_update_quiet(&ours(), &state, &input);
        EXPECT_EQ(state.other_alive, cost > 12.25);
        const double after = any_state::mean_of(ground_speed_best_of(&state), tau) - wide(window.change_m_s);
        if (cost > 12.25) {
            EXPECT_EQ(state.speed_m_s, was.speed_m_s);
            fades++;
        } else if (std::fabs(wide(state.bias_m_s2)) < 2.99) {
            EXPECT_NEAR(after, middle * wide(ours().quiet_noise_m2_s2) / S, 1e-4);
        }
    }
    EXPECT_GT(fades, 50);
}

// --- wheels

// (10) over the ticks that have passed, its means, and the share that is taken for noise, (14).
TEST(GroundSpeedTrack, what_accelerometer_and_wheels_part_by_is_summed_and_forgotten) {
    const ground_speed_config_t &config = ours();
    Any any{{12}};
    int leapt = 0, rested = 0;
    for (int k = 0; k < 800; ++k) {
        ground_speed_state_t state = any.past(config);
        const int n = 1 + static_cast<int>(any.next() % 14);
        state.wheel_ticks = n;
        state.wheel_q20 = state.integral_q20[(state.head + GROUND_SPEED_HISTORY - n) % GROUND_SPEED_HISTORY];
        state.apart_m_s = narrow(any.between(-0.09, 0.09)); // it does not roll yet
        state.apart_mean_m_s = narrow(any.between(-0.2, 0.2));
        state.apart_m2_s2 = narrow(0.5 + any.uniform());
        state.apart_long_m2_s2 = narrow(any.log_between(1e-5, 1e-2));
        state.lean_q8 = static_cast<int32_t>(any.between(-1e6, 1e6));
        state.lean_mean_q8 = static_cast<int32_t>(any.between(-1e6, 1e6));
        state.rolls_wait = static_cast<int32_t>(any.next() % 30);
        state.rest_mean_m_s = narrow(any.between(-0.01, 0.01));
        state.slide.ticks = any.one_in(2) ? 10 : 11;
        ground_speed_weigh_wheels(&config, &state);
        ground_speed_input_t input = {};
        input.accel_valid = !any.one_in(4);
        input.wheels_part = any.one_in(4);
        const double turn = any.between(-0.15, 0.15) * n, keep = 1 - wide(config.apart_forget) * std::fmin(n, 10);
        if (any.one_in(3)) state.wheel_m_s = narrow(any.either() * any.between(0.5, 1.5) * wide(config.still_m_s) - turn);
        const ground_speed_state_t was = state;
        input.wheel_m_s = narrow(wide(was.wheel_m_s) + turn);
        if (std::fabs(std::fabs(turn) - 0.1 * n) < 1e-5) continue;
        ground_speed_watch_wheels(&config, &state, &input);
        const double change = passed(was, 0, n) - wide(was.bias_m_s2) * 0.01 * n - turn;
        const bool leaps = std::fabs(turn) > 0.1 * n; // 10 m/s^2: no torque does that
        const double X = leaps ? wide(was.apart_m_s) : keep * (wide(was.apart_m_s) + change);
        leapt += leaps ? 1 : 0;
        EXPECT_NEAR(state.apart_m_s, X, eps) << n;
        EXPECT_NEAR(state.apart_m2_s2, keep * wide(was.apart_m2_s2) + (1 - keep) * X * X, eps);
        EXPECT_NEAR(state.apart_mean_m_s, keep * wide(was.apart_mean_m_s) + (1 - keep) * X, eps);
        EXPECT_NEAR(state.wheel_mean_m_s, keep * wide(was.wheel_mean_m_s) + (1 - keep) * wide(input.wheel_m_s), eps);
        const double w = wide(input.wheel_m_s), rest = wide(was.rest_mean_m_s); // (24)
        EXPECT_NEAR(state.rest_mean_m_s, std::fabs(w) < wide(config.still_m_s) ? rest + (w - rest) / 16 : 0, 1e-8);
        rested += std::fabs(w) < wide(config.still_m_s) ? 1 : 0;
        EXPECT_EQ(state.wheel_m_s, input.wheel_m_s);
        EXPECT_EQ(state.wheel_q20, state.integral_q20[state.head]);
        EXPECT_EQ(state.wheel_ticks, 0);
        EXPECT_NEAR(state.lean_mean_q8, was.lean_mean_q8 + (was.lean_q8 - was.lean_mean_q8) / 32.0, 1);
        EXPECT_EQ(state.rolls_wait, leaps && was.slide.ticks > 10 ? 100 - n : std::max(0, was.rolls_wait - n)); // (21)
        EXPECT_FALSE(state.other_alive);
        // (14): of noise alone X has 12.5 Qv; what it has more of, over seconds, is no noise
        const double noise = 12.5 * wide(was.speed_noise_m2_s2), trust = std::fmin(1, noise / wide(was.apart_long_m2_s2));
        EXPECT_NEAR(was.felt_trust, trust, 1e-4);
        const double within = 1 - X * X / (16 * noise), tau = 4 * wide(config.window->tau_s);
        const double felt = within > 0 ? 2 * (1 - std::exp(-tau)) * trust * X * within * within : 0;
        EXPECT_NEAR(state.felt_m_s, input.accel_valid && !input.wheels_part ? felt : 0,
                    0.03 * std::fabs(felt) + eps); // 1 - exp(-x) within 0.03
    }
    EXPECT_GT(std::min(leapt, rested), 50);
}

TEST(GroundSpeedTrack, the_long_mean_of_what_they_part_by_follows_the_short_one_by_an_eighth) {
    Any any{{13}};
    for (int k = 0; k < 200; ++k) {
        ground_speed_state_t state = any.past(ours());
        state.apart_m2_s2 = narrow(any.log_between(1e-6, 1e-2));
        state.apart_long_m2_s2 = narrow(any.log_between(1e-6, 1e-2));
        const double mean = 0.875 * wide(state.apart_long_m2_s2) + 0.125 * wide(state.apart_m2_s2);
        ground_speed_weigh_wheels(&ours(), &state);
        EXPECT_NEAR(state.apart_long_m2_s2, mean, eps * mean);
        const double told = square(wide(state.apart_m_s)) - 0.0025 - 112 * wide(state.speed_noise_m2_s2);
        EXPECT_NEAR(ground_speed_told_by_wheels(&ours(), &state, 0.05f), told, eps); // nine times 12.5 Qv
        const ground_speed_past_t rolled = ground_speed_rolled(&state);
        EXPECT_EQ(rolled.tau_s, 0);
        EXPECT_NEAR(rolled.change_m_s, wide(state.wheel_m_s) - wide(state.wheel_mean_m_s), eps);
    }
}

// A slope of `back` begins under wheels that roll on: the accelerometer feels 1 m/s^2 for 0.2 s, the wheels nothing. Radar and wheels
// agree.
ground_speed_state_t slope_begins(double back, double felt_m_s2 = 1) {
    ground_speed_state_t state;
    ground_speed_reset(&ours(), &state);
    for (int k = 0; k < 20; ++k) ground_speed_integrate(&ours(), &state, narrow(back * felt_m_s2));
    state.speed_m_s = 0.5f;
    state.p_vv = 1e-4f;
    state.p_bb = 1e-3f;
    state.apart_m_s = narrow(back * 0.17);
    state.apart_mean_m_s = narrow(back * 0.1);
    state.apart_m2_s2 = 0.0101f;
    state.wheel_q20 = state.integral_q20[state.head];
    state.wheel_m_s = 0.5f;
    state.wheel_mean_m_s = 0.5f;
    state.value_trust = 1;
    state.value_heard_m_s = 0.5f;
    return state;
}

// (13): and each reason against it, alone, keeps it from beginning.
TEST(GroundSpeedTrack, where_a_slope_begins_under_rolling_wheels_their_word_is_taken_and_not_where_it_may_be_slip) {
    for (const double back : {1.0, -1.0}) {
        ground_speed_input_t calm = {};
        calm.wheel_m_s = 0.5f;
        calm.accel_valid = true;
        const auto begins = [&](const std::function<void(ground_speed_state_t &, ground_speed_input_t &)> &but, double felt_m_s2 = 1) {
            ground_speed_state_t state = slope_begins(back, felt_m_s2);
            ground_speed_input_t input = calm;
            but(state, input);
            ground_speed_watch_wheels(&ours(), &state, &input);
            return state.rolls_ticks > 0;
        };
        using S = ground_speed_state_t &;
        using I = ground_speed_input_t &;
        // with its bias at 0.4 of it, what pushes (1 m/s^2, against the slip that it would be) is left the accelerometer's surprise
        EXPECT_TRUE(begins([](S, I) {}));
        EXPECT_FALSE(begins([](S, I input) { input.doppler_fresh = true; })); // a value's tick is dear
        EXPECT_FALSE(begins([](S state, I) { state.p_bb = 0.1f; }));          // a bias that is not known to 0.3 m/s^2
        EXPECT_TRUE(begins([](S state, I) { state.p_bb = 0.08f; }));
        EXPECT_FALSE(begins([](S state, I) { state.rolls_wait = 5; }));
        EXPECT_FALSE(begins([](S state, I) { state.other_alive = true; })); // two signs
        EXPECT_FALSE(begins([](S, I input) { input.accel_valid = false; }));
        EXPECT_FALSE(begins([](S, I input) { input.wheels_part = true; }));
        EXPECT_FALSE(begins([&](S state, I) { state.apart_m_s = narrow(back * 0.09); })); // 0.1 m/s is the limit
        EXPECT_FALSE(begins([](S state, I) { state.apart_m2_s2 = 0.04f; }));              // the body sways
        // a sway's variance counts twice, as a sine's peak has: against X^2 - 0.1^2 - 112 Qv = 0.0162
        EXPECT_TRUE(begins([](S state, I) { state.apart_m2_s2 = 0.0175f; }));            // variance 0.0074
        EXPECT_FALSE(begins([](S state, I) { state.apart_m2_s2 = 0.0205f; }));           // 0.0102
        EXPECT_FALSE(begins([](S, I) {}, 0.2));                                          // its accelerometer tells of less than friction
        EXPECT_FALSE(begins([](S, I) {}, -1));                                           // it feels a push along the slip: that is slip
        EXPECT_FALSE(begins([&](S state, I) { state.bias_m_s2 = narrow(0.8 * back); })); // the bias knows of it: the wheels depart
        EXPECT_TRUE(begins([&](S state, I) { state.bias_m_s2 = narrow(0.6 * back); }));
        EXPECT_FALSE(begins([](S state, I) { state.value_beside_m_s = 0.07f; })); // the radar leaves the wheels: 6 (3e-5 + 2.9e-4)
        EXPECT_TRUE(begins([](S state, I) { state.value_beside_m_s = 0.035f; }));
        EXPECT_TRUE(begins([](S state, I) { state.value_beside_m_s = 0.07f, state.beside_mean_m_s = 0.05f; }));
        // (21): wheels that left their mean by two thirds of X may be what X holds
        EXPECT_FALSE(begins([](S state, I) { state.wheel_mean_m_s = 0.63f; }));
        EXPECT_FALSE(begins([](S state, I) { state.wheel_mean_m_s = 0.37f; }));
        EXPECT_TRUE(begins([](S state, I) { state.wheel_mean_m_s = 0.59f; }));
        // a lean that has just told of the slope: it is slip, unless the radar has stayed with the wheels for two values
        const int32_t leant = ours().lean_told_q8 + 100 - 3000;
        EXPECT_FALSE(begins([&](S state, I) { state.lean_q8 = 2 * leant, state.lean_mean_q8 = 0; }));
        EXPECT_FALSE(begins([&](S state, I) { state.lean_q8 = 2 * leant, state.gyro_denied = 1; }));
    }
}

TEST(GroundSpeedTrack, the_papers_filter_knows_no_rolling_wheels) {
    const ground_speed_config_t paper = rover_config_paper().ground_speed;
    ground_speed_state_t state = slope_begins(1);
    state.felt_trust = 1;
    ground_speed_input_t input = {};
    input.wheel_m_s = 0.5f;
    input.accel_valid = true;
    ground_speed_watch_wheels(&paper, &state, &input);
    EXPECT_EQ(state.rolls_ticks, 0);
    EXPECT_EQ(state.felt_m_s, 0);
}

TEST(GroundSpeedTrack, wheels_whose_word_is_taken_carry_the_speed_and_the_rest_is_bias) {
    const ground_speed_config_t &config = ours();
    for (const double back : {1.0, -1.0}) {
        ground_speed_state_t state = slope_begins(back);
        ground_speed_input_t input = {};
        input.wheel_m_s = 0.5f;
        input.accel_valid = true;
        state.bias_m_s2 = 0.1f;
        state.agile_sum = 3;
        state.agile_left = 2;
        const ground_speed_state_t was = state;
        state.wheel_ticks = 1;
        ground_speed_watch_wheels(&config, &state, &input);
        ASSERT_GT(state.rolls_ticks, 0);
        const double X = 0.96 * (back * 0.17 - 0.1 * 0.01); // (10) of one tick in which V has not moved
        EXPECT_EQ(state.rolls_ticks, 60);                   // more than a window
        EXPECT_TRUE(state.other_alive);
        EXPECT_EQ(state.odds, config.roll_odds);
        EXPECT_EQ(state.other.at.speed_m_s, was.speed_m_s); // the one that believes the accelerometer
        EXPECT_EQ(state.other.at.bias_m_s2, was.bias_m_s2);
        EXPECT_EQ(state.other.q20, state.integral_q20[state.head]);
        EXPECT_EQ(state.other.ticks, 0);
        EXPECT_NEAR(state.speed_m_s, 0.5 - X, 1e-5);
        EXPECT_NEAR(state.p_vv, 1e-4 + X * X / 4, 1e-6);
        EXPECT_EQ(state.apart_m_s, 0);
        EXPECT_EQ(state.agile_sum, 0);
        EXPECT_EQ(state.agile_left, 0);
        double v = wide(state.speed_m_s), b = wide(state.bias_m_s2), p = wide(state.p_vv);
        for (int left = 60; left > 0;) { // from here on: wheels that speed up, an accelerometer that feels 1 m/s^2 of slope
            const int n = left % 7 == 0 ? 3 : 1;
            for (int i = 0; i < n; ++i) {
                ground_speed_integrate(&config, &state, narrow(back));
                state.speed_m_s += (narrow(back) - state.bias_m_s2) * 0.01f;
            }
            input.wheel_m_s += 0.001f * narrow(n);
            state.wheel_ticks = n;
            ground_speed_watch_wheels(&config, &state, &input);
            const double felt = n * 0.01 * (back - b), rest = (1 - 0.04 * n) * (felt - 0.001 * n); // X, begun anew each time
            v += felt - rest;
            b += 0.1 / 0.01 * rest;
            p += 1.5e-5 * n;
            left = std::max(0, left - n);
            EXPECT_EQ(state.rolls_ticks, left);
            EXPECT_NEAR(state.speed_m_s, v, 1e-4) << left;
            EXPECT_NEAR(state.bias_m_s2, b, 1e-3) << left;
            EXPECT_NEAR(state.p_vv, p, 1e-6) << left;
            EXPECT_EQ(state.p_vb, 0);
            EXPECT_EQ(state.p_bb, config.roll_bias_m2_s4);
            EXPECT_EQ(state.apart_m_s, 0);
        }
        EXPECT_NEAR(state.bias_m_s2, back, 0.12); // the wheels' 0.1 m/s^2 is the body's
        state.rolls_ticks = 5;                    // the other has won
        state.gyro_tried = true;
        state.apart_m_s = 1;
        ground_speed_no_rolling(&state);
        EXPECT_EQ(state.rolls_ticks, 0);
        EXPECT_EQ(state.rolls_wait, 100);
        EXPECT_FALSE(state.gyro_tried);
        EXPECT_TRUE(state.other_alive); // a value may turn it again
        EXPECT_EQ(state.apart_m_s, 0);
    }
}

TEST(GroundSpeedTrack, the_radars_value_beside_the_wheels_is_averaged_and_refutes_them_when_it_leaves) {
    const ground_speed_config_t &config = ours();
    Any any{{14}};
    int refuted = 0, denied = 0, stood = 0;
    for (int k = 0; k < 2500; ++k) {
        ground_speed_state_t state = any.past(config);
        any.value(config, state);
        state.wheel_mean_m_s = narrow(any.either() * (wide(state.value_heard_m_s) + any.between(-0.15, 0.15)));
        state.value_beside_m_s = narrow(any.between(-0.1, 0.1));
        state.beside_mean_m_s = narrow(any.between(-0.1, 0.1));
        state.rolls_ticks = any.one_in(2) ? 0 : 20;
        state.accepted = !any.one_in(4);
        state.slide.held = static_cast<int32_t>(any.next() % 3);
        state.odds = 6;
        state.gyro_denied = static_cast<int32_t>(any.next() % 3);
        state.lean_q8 = static_cast<int32_t>(any.between(-3, 3) * config.lean_told_q8);
        state.apart_m_s = narrow(any.between(-0.4, 0.4));
        const ground_speed_state_t was = state;
        const double beside = wide(was.value_heard_m_s) - std::fabs(wide(was.wheel_mean_m_s));
        const double left2 = square(beside - wide(was.beside_mean_m_s));
        const double R =
            wide(was.value_trust) * (wide(config.doppler_noise_m2_s2) + wide(config.doppler_noise_m_s) * wide(was.value_heard_m_s));
        const double limit = 6 * (R + (was.rolls_ticks > 0 ? 9e-4 : 0)); // slip changes by 3 cm/s where a slope begins
        if (std::fabs(left2 / limit - 1) < 1e-3) continue;
        ground_speed_watch_radar(&config, &state);
        EXPECT_NEAR(state.value_beside_m_s, beside, 1e-6);
        if (was.rolls_ticks > 0) {
            EXPECT_EQ(state.beside_mean_m_s, was.beside_mean_m_s);
            EXPECT_EQ(state.roll_denied, left2 > limit) << k;
            EXPECT_EQ(state.gyro_denied, was.gyro_denied);
            refuted += left2 > limit ? 1 : 0;
            continue;
        }
        EXPECT_EQ(state.odds, was.odds);
        const double mean =
            was.accepted && was.slide.held > 0 ? 0.75 * wide(was.beside_mean_m_s) + 0.25 * wide(was.value_beside_m_s) : beside;
        EXPECT_NEAR(state.beside_mean_m_s, mean, 1e-6);
        const double told = square(wide(was.apart_m_s)) - square(wide(config.roll_told_m_s)) - 112 * wide(was.speed_noise_m2_s2);
        const bool leant = std::abs(was.lean_q8 - was.lean_mean_q8) > config.lean_told_q8;
        if (std::fabs(told) < 1e-5) continue;
        const bool is = leant && told > 0 && left2 < limit;
        EXPECT_EQ(state.gyro_denied, is ? std::min(2, was.gyro_denied + 1) : 0);
        (is ? denied : stood) += 1;
    }
    EXPECT_GT(std::min({refuted, denied, stood}), 50);
}

// (23): what is told of X is the bias's error, and each reason against it, alone, leaves all as it was.
TEST(GroundSpeedTrack, where_wheels_roll_or_creep_what_the_body_does_beside_them_is_the_biass_error) {
    const ground_speed_config_t &config = ours();
    Any any{{18}};
    int followed = 0, left = 0, told_by_creep = 0;
    for (int k = 0; k < 4000; ++k) {
        ground_speed_state_t state = any.past(config);
        any.value(config, state);
        state.speed_m_s = narrow(any.between(-1, 1));
        state.bias_m_s2 = narrow(any.between(-1, 1));
        state.p_vv = narrow(any.log_between(1e-5, 1e-2)), state.p_bb = narrow(any.log_between(1e-5, 1e-1)), state.p_vb = 0;
        state.apart_m_s = narrow(any.either() * any.between(0.005, 0.08));
        state.wheel_m_s = narrow(any.between(-0.5, 0.5));
        state.wheel_mean_m_s = narrow(wide(state.wheel_m_s) + any.between(-0.05, 0.05));
        state.beside_mean_m_s = 0;
        state.value_beside_m_s = any.one_in(4) ? 0.5f : 0;
        state.other_alive = any.one_in(6);
        state.rolls_ticks = any.one_in(6) ? 10 : 0;
        const bool creep = any.one_in(2);
        const ground_speed_state_t was = state;
        const double X = wide(was.apart_m_s), turned = std::fabs(wide(was.wheel_m_s) - wide(was.wheel_mean_m_s));
        const double noise = 1e-4 + 112 * wide(was.speed_noise_m2_s2), told = X * X - noise; // (1 cm/s)^2 of slip, and three sigma
        if (std::fabs(told) < 1e-7 || std::fabs(std::fabs(X) - 1.5 * turned) < 1e-5 || std::fabs(std::fabs(X) - 0.05) < 1e-5) continue;
        ground_speed_follow_wheels(&config, &state, creep);
        const bool stays = std::fabs(X) < 0.05 && was.value_beside_m_s < 0.1f; // a slide is not heard yet, and was none
        const bool follows = told > 0 && std::fabs(X) > 1.5 * turned && !was.other_alive && was.rolls_ticks == 0 && (creep || stays);
        const double by = follows ? told / X : 0;
        EXPECT_NEAR(state.speed_m_s, wide(was.speed_m_s) - by, eps) << k;
        EXPECT_NEAR(state.bias_m_s2, wide(was.bias_m_s2) + 4 * by, eps) << k;
        EXPECT_NEAR(state.apart_m_s, X - by, 1e-6) << k;
        EXPECT_NEAR(state.p_vv, wide(was.p_vv) + (follows ? told / 4 : 0), 1e-7) << k;
        EXPECT_NEAR(state.p_bb, follows ? std::fmax(wide(was.p_bb), 16 * noise) : wide(was.p_bb), 1e-6) << k;
        followed += follows ? 1 : 0, left += follows ? 0 : 1, told_by_creep += follows && !stays ? 1 : 0;
    }
    EXPECT_GT(std::min({followed, left, told_by_creep}), 100);
}

// (22): at the grid's end, or hardly heard and slow, a value is a limit: within it nothing moves, beyond it it corrects as any.
TEST(GroundSpeedTrack, a_value_at_the_grids_end_or_of_an_echo_in_noise_is_an_upper_limit) {
    const ground_speed_config_t &config = ours();
    const double lowest = wide(rover_config_default().doppler.beam->speed_m_s[0]);
    Any any{{19}};
    int kept = 0, unknown = 0, corrected = 0;
    for (int k = 0; k < 3000; ++k) {
        ground_speed_state_t state = any.past(config);
        std::fill(std::begin(state.integral_q20), std::end(state.integral_q20), 0); // it coasts
        state.speed_m_s = narrow(any.between(-0.2, 0.2));
        state.bias_m_s2 = 0;
        state.p_vv = narrow(any.log_between(1e-5, 1e-1)), state.p_bb = 1e-4f, state.p_vb = 0;
        state.accepted = any.one_in(2);
        state.refused = any.one_in(2) ? 1 : 0;
        state.other_alive = false;
        state.slide.held = 2;
        state.waits = 0;
        ground_speed_input_t input = {};
        input.doppler_fresh = true;
        input.doppler_late_s = any.one_in(6) ? -0.12f : 0;
        const double trust = any.one_in(2) ? any.between(1, 1.19) : any.between(1.21, 2);
        input.doppler_trust = narrow(trust);
        const double heard = any.one_in(3) ? lowest * any.between(0.95, 1.015) : any.between(1.03 * lowest, 0.16);
        input.doppler_m_s = narrow(heard);
        input.wheel_m_s = state.speed_m_s;
        if (std::fabs(heard - 0.12) < 1e-5 || std::fabs(heard - std::fabs(wide(state.speed_m_s))) < 1e-4) continue;
        const ground_speed_state_t was = state;
        ground_speed_update_doppler(&config, &state, &input);
        const bool limit = heard < 1.02 * lowest || (trust > 1.2 && heard < 0.12);
        if (!limit || input.doppler_late_s < 0 || std::fabs(wide(was.speed_m_s)) > heard) {
            EXPECT_EQ(state.waits, 2) << k; // as any value, which the others see later
            corrected++;
            continue;
        }
        const double tau = wide(config.window->tau_s), S = wide(was.p_vv) + tau * tau * 1e-4;
        const bool known = S < heard * heard;
        const double gain = known ? 0 : wide(was.p_vv) / (S + heard * heard);
        EXPECT_NEAR(state.speed_m_s, wide(was.speed_m_s) * (1 - gain), 1e-5) << k;
        EXPECT_NEAR(state.p_vv, wide(was.p_vv) * (1 - gain), 1e-5 * wide(was.p_vv)) << k;
        EXPECT_TRUE(state.accepted);
        EXPECT_EQ(state.refused, 0);
        EXPECT_FALSE(state.other_alive);
        EXPECT_EQ(state.slide.held, 3); // (15) wants to know of it
        EXPECT_EQ(state.value_heard_m_s, input.doppler_m_s);
        EXPECT_EQ(state.waits, 0);
        (known ? kept : unknown) += 1;
    }
    EXPECT_GT(std::min({kept, unknown, corrected}), 100);
}

// --- a gyro that lies, (16)

TEST(GroundSpeedTrack, a_lean_tells_of_a_slope_from_a_degree_on_and_either_way) {
    ground_speed_state_t state = {};
    for (const int32_t mean : {0, 5000, -5000}) {
        for (const int32_t by : {-1, 1}) {
            state.lean_mean_q8 = mean;
            state.lean_q8 = mean + by * ours().lean_told_q8;
            EXPECT_FALSE(ground_speed_gyro_tells(&ours(), &state));
            state.lean_q8 += by;
            EXPECT_TRUE(ground_speed_gyro_tells(&ours(), &state));
        }
    }
    EXPECT_NEAR(ours().lean_told_q8 * wide(ours().lean_m_s2_per_q8), 0.2, 0.001);
}

TEST(GroundSpeedTrack, the_bias_that_runs_against_a_lean_is_learned_as_the_gyros_offset) {
    const ground_speed_config_t &config = ours();
    Any any{{15}};
    int learned = 0, near = 0, alone = 0, unknown = 0, stands = 0;
    const double q8_per_m_s2 = 256 / (9.81 * 1.0) / wide(rover_config_default().sense.gyro_rad_s_per_count); // of g r, per rad/s
    for (int k = 0; k < 2500; ++k) {
        ground_speed_state_t state = any.past(config);
        state.bias_m_s2 = narrow(any.between(-3, 3));
        state.bias_mean_m_s2 = narrow(wide(state.bias_m_s2) + any.between(-0.2, 0.2));
        state.p_bb = narrow(any.log_between(1e-4, 0.3));
        state.slide.ticks = static_cast<uint32_t>(any.next());
        const uint32_t passed_ticks = any.one_in(8) ? 1000 : 1 + static_cast<uint32_t>(any.next() % 30);
        state.gyro_asked = state.slide.ticks - passed_ticks;
        state.lean_q8 = any.one_in(6) ? 0 : static_cast<int32_t>(any.between(-20000, 20000));
        state.lean_mean_q8 = static_cast<int32_t>(any.between(-20000, 20000));
        state.unheard_ticks = static_cast<int32_t>(any.next() % 40);
        state.refused = any.one_in(4) ? 1 : 0;
        state.gyro_alone_ticks = static_cast<int32_t>(any.next() % 980);
        state.standstill = any.one_in(5);
        state.other_alive = any.one_in(5);
        state.apart_m_s = 0;
        state.apart_mean_m_s = narrow(any.between(-0.05, 0.05));
        state.apart_m2_s2 = narrow(square(wide(state.apart_mean_m_s)) + any.between(0, 2e-3));
        state.gyro_q8 = static_cast<int32_t>(any.between(-2000, 2000));
        state.gyro_doubt_m2_s2 = 0.5f;
        const ground_speed_state_t was = state;
        ground_speed_watch_gyro(&config, &state);
        EXPECT_EQ(state.gyro_asked, was.slide.ticks);
        if (was.lean_q8 == 0) { // nothing leans yet: a bias that it wakes up with is a slope, and no gyro's
            EXPECT_EQ(state.bias_mean_m_s2, was.bias_m_s2);
            EXPECT_EQ(state.gyro_q8, was.gyro_q8);
            EXPECT_EQ(state.p_bb, was.p_bb);
            EXPECT_EQ(state.gyro_alone_ticks, was.gyro_alone_ticks);
            continue;
        }
        const double n = std::fmin(100, passed_ticks);
        const bool silent = was.unheard_ticks > 25 || was.refused > 0; // two values missed, or what comes is not taken
        EXPECT_EQ(state.gyro_alone_ticks, silent ? was.gyro_alone_ticks + static_cast<int32_t>(passed_ticks % 100) : 0);
        double p_bb = wide(was.p_bb);
        if (silent && !was.standstill) { // of a lean that runs off by 0.05 m/s^3, or twice that where wheels creep
            const double runs = std::fabs(wide(was.wheel_m_s)) < wide(config.slow_m_s) ? 0.1 : 0.05, t = 0.01 * state.gyro_alone_ticks;
            p_bb += 2 * runs * runs * t * 0.01 * n; // d(r^2 t^2)
            alone++;
        }
        EXPECT_NEAR(state.p_bb, p_bb, eps * p_bb);
        if (std::fabs(p_bb - 0.09) < 1e-5) continue;
        if (was.standstill || was.other_alive || p_bb > 0.09) {
            EXPECT_EQ(state.bias_mean_m_s2, was.bias_m_s2);
            EXPECT_EQ(state.gyro_doubt_m2_s2, 0);
            EXPECT_NEAR(state.gyro_q8, was.standstill ? 0.9 * was.gyro_q8 : was.gyro_q8, 1); // given back where it is learned anew
            (was.standstill ? stands : unknown) += 1;
            continue;
        }
        const double apart = wide(was.bias_m_s2) - wide(was.bias_mean_m_s2);
        EXPECT_NEAR(state.gyro_doubt_m2_s2, square(std::fmax(0, std::fabs(apart) - 0.05)), eps);
        EXPECT_NEAR(state.bias_mean_m_s2, wide(was.bias_mean_m_s2) + 0.01 * n / 1.5 * apart, eps); // t1 = 1.5 s
        const double sway = wide(was.apart_m2_s2) - square(wide(was.apart_mean_m_s));
        double r = was.gyro_q8 + q8_per_m_s2 * 0.01 * n / (1.5 * 3) * apart * 4e-4 / (4e-4 + sway); // t2 = 3 s; (16)
        if (std::fabs(wide(was.bias_m_s2)) > 0.7 * 3 && (was.bias_m_s2 < 0) != (was.lean_q8 < 0)) {
            const double leant = (was.lean_q8 - was.lean_mean_q8) * wide(config.lean_m_s2_per_q8);
            r -= 0.25 * q8_per_m_s2 / 0.36 * leant; // what the gyro has turned within the mean's 0.36 s, a quarter of it
            near++;
        }
        EXPECT_NEAR(state.gyro_q8, r, 2 + 1e-4 * std::fabs(r)) << k;
        learned++;
    }
    EXPECT_GT(std::min({learned, near, alone, unknown, stands}), 20);
    ground_speed_state_t state = {};
    state.gyro_q8 = 4194000;
    state.lean_q8 = -2000000;
    ground_speed_gyro_lied(&config, &state, 1); // half of what a gyro can read, and no more
    EXPECT_EQ(state.gyro_q8, 4194304);
    state.lean_q8 = 2000000;
    for (int i = 0; i < 1000; ++i) ground_speed_gyro_lied(&config, &state, 1);
    EXPECT_EQ(state.gyro_q8, -4194304);
}

} // namespace
