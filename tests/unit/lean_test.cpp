// Gravity that the gyros turn into the accelerometer's axis, against closed forms.
#include "firmware/core/rover_config.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace {

constexpr double g = 9.81, accel_m_s2 = 0.004, gyro_rad_s = 0.0005; // the reference rover's units

struct Body {
    lean_config_t config = rover_config_default().sense.lean;
    lean_state_t state = {};
    double offset_rad_s[3] = {0, 0, 0};
    int32_t moved_q8 = 0;

    // Seconds at constant rates, seen as whole counts.
    void turn(double seconds, double x, double y, double z, bool standing = false, double accel_x = 0, double accel_y = 0,
              unsigned elapsed = 1) {
        const double rate[3] = {x, y, z}, felt[2] = {accel_x, accel_y};
        lean_input_t input = {};
        for (int i = 0; i < 3; i++) {
            input.gyro_count[i] = static_cast<int32_t>(std::lround((rate[i] + offset_rad_s[i]) / gyro_rad_s));
        }
        for (int i = 0; i < 2; i++) {
            input.accel_count[i] = static_cast<int32_t>(std::lround(felt[i] / accel_m_s2));
        }
        input.accel = true;
        input.standing = standing;
        input.elapsed_ticks = elapsed;
        input.moved_q8 = moved_q8;
        for (int k = 0; k < static_cast<int>(std::lround(100 * seconds / elapsed)); k++) {
            lean_step(&config, &state, &input);
        }
    }
    double lean_m_s2() const { return state.lean_q8 * accel_m_s2 / 256; }
};

TEST(Lean, a_slope_that_begins_comes_into_the_axis_as_gravity_does) {
    Body body;
    body.turn(2, 0, 0, 0, true);
    body.turn(0.5, 0, -0.35, 0);                                          // nose up, 10 deg
    EXPECT_NEAR(body.lean_m_s2(), g * std::sin(0.175), 0.01 * g * 0.175); // (1) takes the cosine as 1: 0.5 % at 10 deg
    body.turn(20, 0, 0, 0);
    EXPECT_NEAR(body.lean_m_s2(), g * std::sin(0.175), 0.01 * g * 0.175) << "it does not fade on a long slope";
    body.turn(0.5, 0, 0.35, 0);
    EXPECT_NEAR(body.lean_m_s2(), 0, 1e-3);
}

TEST(Lean, an_offset_of_the_gyros_is_learned_while_it_stands) {
    Body body;
    for (const double offset : {0.01, -0.35}) { // 0.6 and 20 deg/s, the worst of a cheap part
        body = Body{};
        for (double &o : body.offset_rad_s) {
            o = offset;
        }
        body.turn(3, 0, 0, 0, true);
        const double before = body.lean_m_s2();
        body.turn(60, 0, 0, 0);
        // a count's 512th at most is left of w_0: g * 60 s * 0.0005/512
        EXPECT_NEAR(body.lean_m_s2(), before, g * 60 * gyro_rad_s / 512 + 1e-3) << offset;
    }
}

TEST(Lean, what_turns_from_the_first_tick_on_is_no_slope_before_it_has_stood) {
    Body body;
    body.turn(30, 0, 0.05, 0); // an offset, for all that can be known: 30 s of it would be 86 deg
    EXPECT_LT(std::fabs(body.lean_m_s2()), 1e-6);
}

// (3): a slope that begins in the first second of a drive is no offset, and one that is far off and steady is one.
TEST(Lean, what_turns_in_the_first_second_of_a_drive_does_not_run_on) {
    for (const double rate : {0.14, -0.3}) { // 8 and 17 deg/s, for 0.6 s
        Body body;
        body.turn(0.3, 0, 0, 0);
        body.turn(0.6, 0, rate, 0);
        const double then = body.lean_m_s2();
        EXPECT_LE(std::fabs(then), g * std::fabs(rate) * 0.6);
        body.turn(60, 0, 0, 0);
        EXPECT_NEAR(body.lean_m_s2(), then, 1e-6) << rate;
    }
}

TEST(Lean, a_calm_stretch_of_a_drive_tells_the_offset) {
    Body body;
    body.offset_rad_s[1] = -0.1; // 6 deg/s
    body.turn(0.7, 0, 0, 0);
    body.turn(0.5, 0, -0.35, 0); // nose up, 10 deg
    EXPECT_NEAR(body.lean_m_s2(), g * 0.175, 0.02 * g * 0.175);
    body.turn(60, 0, 0, 0);
    EXPECT_NEAR(body.lean_m_s2(), g * 0.175, 0.02 * g * 0.175);
}

TEST(Lean, an_offset_that_was_a_slope_is_given_up_after_three_stretches) {
    Body body;
    body.turn(0.7, 0, 0.2, 0); // steady from the first tick on: taken for an offset
    EXPECT_EQ(body.state.lean_q8, 0);
    body.turn(60, 0, 0, 0);
    // 3 stretches of 0.64 s at a rate that is not there, and what is left of the one in which it ended
    EXPECT_GT(std::fabs(body.lean_m_s2()), g * 0.2 * 1.9);
    EXPECT_LT(std::fabs(body.lean_m_s2()), g * 0.2 * 2.6);
}

TEST(Lean, a_turn_on_a_side_slope_turns_gravity_into_the_axis) {
    for (const double side : {0.175, -0.175}) {
        Body body;
        body.turn(5, 0, 0, 0, true, 0, g * std::sin(side)); // left side up: the ground's reaction has a part to the left
        const auto turn_left = [&](double from_rad, int ticks) {
            for (int k = 0; k < ticks; k++) {
                const double at = from_rad + k * M_PI / 400;
                body.turn(0.01, 0, 0, M_PI / 4, false, g * std::sin(side) * std::sin(at), g * std::sin(side) * std::cos(at));
            }
        };
        turn_left(0, 200); // a quarter turn to the left: what was left is ahead
        EXPECT_NEAR(body.lean_m_s2(), g * std::sin(side), 0.02 * g * 0.175);
        turn_left(M_PI / 2, 400);
        EXPECT_NEAR(body.lean_m_s2(), -g * std::sin(side), 0.04 * g * 0.175); // the steps of 10 ms are explicit: 1 + w^2 T t/2
    }
}

// About x an offset turns gravity's part across, which a turn then brings into the axis. The accelerometer tells what is across.
TEST(Lean, a_gyro_about_x_that_lies_turns_nothing_into_the_axis) {
    for (const double offset : {0.02, -0.1}) { // 1 and 6 deg/s
        Body body;
        body.turn(5, 0, 0, 0, true);
        body.offset_rad_s[0] = offset;
        body.turn(60, 0, 0, 0);
        body.turn(2, 0, 0, M_PI / 4);
        // across is at most w_x g t, t the memory of 256 ticks, and a quarter turn brings at most pi/2 of it ahead
        EXPECT_LE(std::fabs(body.lean_m_s2()), M_PI / 2 * 2.56 * g * std::fabs(offset)) << offset;
    }
}

// What the estimator has learned while it drove is taken off the gyro about y, and of no other.
TEST(Lean, an_offset_that_moved_is_taken_off) {
    Body body;
    body.turn(5, 0, 0, 0, true);
    body.offset_rad_s[1] = 0.02;
    body.moved_q8 = static_cast<int32_t>(256 * 0.02 / gyro_rad_s);
    body.turn(60, 0, 0, 0);
    EXPECT_NEAR(body.lean_m_s2(), 0, g * 60 * gyro_rad_s / 512 + 1e-3); // as in an_offset_of_the_gyros_is_learned_while_it_stands
    body.turn(1, 0, -0.1, 0);
    EXPECT_NEAR(body.lean_m_s2(), g * 0.1, 0.02 * g * 0.1);
}

TEST(Lean, an_accelerometers_own_offset_is_not_turned) {
    Body body;
    body.turn(5, 0, 0, 0, true, 0.2, -0.2); // 0.02 g on both axes: less than a slope of 3 deg
    body.turn(4, 0, 0, M_PI / 4);
    EXPECT_EQ(body.state.lean_q8, 0);
}

TEST(Lean, missed_ticks_turn_as_far_as_others) {
    Body body;
    body.turn(2, 0, 0, 0, true);
    body.turn(0.5, 0, -0.35, 0, false, 0, 0, 5);
    EXPECT_NEAR(body.lean_m_s2(), g * std::sin(0.175), 0.01 * g * 0.175);
}

TEST(Lean, any_counts_keep_it_within_its_bounds) {
    Body body;
    uint64_t random = 1;
    for (int k = 0; k < 100000; k++) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        lean_input_t input = {};
        for (int i = 0; i < 3; i++) {
            input.gyro_count[i] = static_cast<int16_t>(random >> (16 + 11 * i));
        }
        input.accel_count[0] = static_cast<int16_t>(random >> 7) + 65535;
        input.accel_count[1] = static_cast<int16_t>(random >> 23);
        input.accel = true;
        input.standing = (random >> 60) == 0;
        input.elapsed_ticks = 1u + static_cast<uint32_t>(random >> 54);
        input.moved_q8 = static_cast<int32_t>(random >> 41) - (1 << 22);
        lean_step(&body.config, &body.state, &input);
        ASSERT_LE(std::abs(body.state.lean_q8), (1 << 26) - (1 << 17));
    }
}

// A rover without gyros about x and y, or with a converter at its rail, feels what it felt.
TEST(Lean, without_the_gyros_the_accelerometer_is_taken_as_it_is) {
    const sense_config_t config = rover_config_default().sense;
    sense_state_t state = {};
    sensor_frame_t frame = {};
    for (int k = 0; k < 400; k++) {
        frame.tick = static_cast<uint32_t>(k);
        frame.present = FRAME_ALL & ~static_cast<uint32_t>(k < 200 ? FRAME_GYRO_XY : 0);
        frame.accel_x_count = static_cast<int16_t>(k - 200);
        frame.gyro_y_count = k < 200 ? 300 : INT16_MAX;
        const sense_output_t out = sense_measure(&config, &state, &frame);
        ASSERT_EQ(out.level_m_s2, out.accel_x_m_s2) << k; // to the bit
    }
    frame.tick++;
    frame.gyro_y_count = 300;
    for (int k = 0; k < 65; k++) { // a calm stretch: its offset
        frame.tick++;
        const sense_output_t out = sense_measure(&config, &state, &frame);
        ASSERT_EQ(out.level_m_s2, out.accel_x_m_s2) << k;
    }
    frame.tick++;
    frame.gyro_y_count = -1700;
    const sense_output_t out = sense_measure(&config, &state, &frame);
    EXPECT_NEAR(out.accel_x_m_s2 - out.level_m_s2, 0.0981f, 1e-3f); // nose up at 1 rad/s for a tick
}

// (1) to (4) in double, with the firmware's rounding: stretches of standing, of calm and of turns, offsets that move, missed ticks.
struct LeanModel {
    const lean_config_t &config;
    double rest[3] = {}, felt[2] = {}, lean = 0;
    int ticks = 0, stood = 0, calm = 0, apart = 0;
    long first[3] = {}, sum[3] = {};
    bool known = false;

    explicit LeanModel(const lean_config_t &of) : config(of) {}
    static double rounded(double x) { return std::floor(x + 0.5); }
    double memory() const { return std::exp2(std::floor(std::log2(ticks))); } // a power of two, up to 256 ticks
    void take_calm() {
        double mean[3];
        bool differs = false;
        for (int i = 0; i < 3; i++) {
            mean[i] = static_cast<double>(first[i]) * 256 + static_cast<double>(sum[i]) * 4; // of 64
            differs = differs || std::fabs(mean[i] - rest[i]) > config.sudden_q8;
        }
        const bool whole = !known || (differs && apart == 2); // the first of all, or the third in a row that differs
        apart = !differs || whole ? 0 : apart + 1;
        for (int i = 0; i < 3; i++) {
            if (whole)
                rest[i] = mean[i];
            else if (!differs)
                rest[i] += std::trunc((mean[i] - rest[i]) / 16);
        }
        known = true;
    }
    double turned(const lean_input_t &input, int i) const { // radians
        const double by = input.gyro_count[i] * 256.0 - rest[i];
        if (stood < 100 && (!known || std::fabs(by) <= config.sudden_q8)) return 0;
        const double q20 =
            rounded((by - (i == 1 ? input.moved_q8 : 0)) * config.turn_q52 / 4294967296.0) * std::min(input.elapsed_ticks, 16u);
        return std::clamp(q20 / 1048576.0, -0.25, 0.25);
    }
    void step(const lean_input_t &input) {
        ticks = std::min(256, ticks + 1);
        if (input.standing) {
            if (stood == 0 && !known) ticks = 1;
            stood = std::min(100, stood + 1);
            for (int i = 0; i < 3; i++) rest[i] += std::floor((input.gyro_count[i] * 256.0 - rest[i]) / memory());
        } else if (stood < 100) {
            bool stays = calm > 0;
            for (int i = 0; i < 3; i++) stays = stays && std::abs(input.gyro_count[i] - first[i]) <= config.calm_count;
            calm = stays ? calm + 1 : 1;
            for (int i = 0; i < 3; i++) {
                if (!stays) first[i] = input.gyro_count[i], sum[i] = 0;
                sum[i] += input.gyro_count[i] - first[i];
            }
            if (calm == 64) take_calm(), calm = 0;
        }
        for (int i = 0; i < 2 && input.accel; i++) felt[i] += std::floor((input.accel_count[i] * 256.0 - felt[i]) / memory());
        const double most = config.gravity_q8, along = felt[0], across = felt[1];
        double change = -rounded(turned(input, 1) * most), aside = rounded(turned(input, 0) * most);
        if (std::fabs(along) + std::fabs(across) > config.steep_q8) {
            change += rounded(turned(input, 2) * across);
            aside -= rounded(turned(input, 2) * along);
        }
        lean = std::clamp(lean + change, -66977792.0, 66977792.0); // 2^26 - 2^17
        felt[0] = std::clamp(along + change, -most, most);
        felt[1] = std::clamp(across + aside, -most, most);
    }
};

TEST(Lean, any_drive_is_what_its_equations_make_of_it) {
    uint64_t random = 3;
    const auto next = [&](int n) {
        return static_cast<int>(((random = random * 6364136223846793005u + 1442695040888963407u) >> 33) % static_cast<unsigned>(n));
    };
    int calms = 0, stands = 0, turns = 0, believed = 0;
    for (int drive = 0; drive < 40; drive++) {
        const lean_config_t config = rover_config_default().sense.lean;
        LeanModel model(config);
        lean_state_t state = {};
        const bool parks = drive % 2 == 0;
        int rate[3] = {}, offset[3] = {}, phase = 0, left = 0, sway = 0;
        for (int &o : offset) o = next(301) - 150;
        for (int k = 0; k < 1500; k++) {
            if (left-- <= 0) {
                phase = next(4);
                left = 20 + next(150);
                sway = phase == 1 ? next(60) : phase == 2 ? next(90) : 200;
                for (int i = 0; i < 3; i++) {
                    rate[i] = phase == 3 ? next(1601) - 800 : 0;
                    if (next(6) == 0) offset[i] += next(401) - 200;
                }
            }
            lean_input_t input = {};
            input.standing = phase == 0 && (parks || k > 1200);
            for (int i = 0; i < 3; i++) input.gyro_count[i] = offset[i] + rate[i] + next(sway + 1) - sway / 2;
            for (int i = 0; i < 2; i++) input.accel_count[i] = next(drive % 3 == 0 ? 1200 : 120) - (i == 0 ? 40 : 300);
            input.accel = next(10) != 0;
            input.moved_q8 = k > 700 ? next(2001) - 1000 : 0;
            input.elapsed_ticks = next(12) == 0 ? 1u + static_cast<uint32_t>(next(30)) : 1u;
            const int apart = model.apart;
            lean_step(&config, &state, &input);
            model.step(input);
            for (int i = 0; i < 3; i++) ASSERT_EQ(state.rest_q8[i], model.rest[i]) << drive << ' ' << k << ' ' << i;
            for (int i = 0; i < 2; i++) ASSERT_NEAR(state.felt_q8[i], model.felt[i], 1) << drive << ' ' << k << ' ' << i;
            ASSERT_NEAR(state.lean_q8, model.lean, 1 + 0.01 * k) << drive << ' ' << k; // where a half is rounded to
            model.felt[0] = state.felt_q8[0], model.felt[1] = state.felt_q8[1], model.lean = state.lean_q8;
            calms += model.calm == 0 && model.known && !input.standing && model.stood < 100 ? 1 : 0;
            stands += model.stood == 100 ? 1 : 0;
            turns += model.turned(input, 1) != 0 ? 1 : 0;
            believed += apart == 2 && model.apart == 0 ? 1 : 0;
        }
    }
    EXPECT_GT(std::min({calms, stands, turns}), 50);
    EXPECT_GT(believed, 2);
    const lean_config_t config = rover_config_default().sense.lean; // bounds: a lean runs off no further than its end, f no further than g
    for (const int way : {1, -1}) {
        lean_state_t state = {};
        state.stood_ticks = 100;
        lean_input_t input = {};
        input.gyro_count[0] = input.gyro_count[1] = way * 30000;
        input.elapsed_ticks = 16;
        for (int k = 0; k < 1000; k++) lean_step(&config, &state, &input);
        EXPECT_EQ(state.lean_q8, -way * 66977792);
        EXPECT_EQ(state.felt_q8[0], -way * config.gravity_q8);
        EXPECT_EQ(state.felt_q8[1], way * config.gravity_q8);
    }
}

TEST(Lean, the_papers_filter_has_none) { EXPECT_EQ(rover_config_paper().sense.lean.gravity_q8, 0); }

} // namespace
