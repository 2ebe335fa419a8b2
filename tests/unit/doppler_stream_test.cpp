// What doppler does with a stream that has gaps, rails, another rate or no life in it.
#include "firmware/core/rover_config.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

// A clock of 5.12 samples a tick; what came before tick t is floor(5.12 t).
int by_clock(int tick) { return tick * 512 / 100; }

TEST(DopplerStream, numbers_tell_every_lost_sample_across_the_wrap) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const std::uint32_t from : {1u, 77777u, UINT32_MAX - 60u}) {
        for (std::uint32_t lost = 0; lost <= 40; lost++) {
            doppler_state_t state = {};
            doppler_arrival_t arrival = {from, 1, 5};
            EXPECT_EQ(doppler_missing(&config, &state, &arrival), 0); // nothing came before the first
            arrival.sequence = from + 5 + lost;
            if (arrival.sequence == 0) continue; // not numbered
            const int told = doppler_missing(&config, &state, &arrival);
            if (lost <= 32) {
                EXPECT_EQ(told, static_cast<int>(lost)) << from;
            }
            if (lost > 32) { // too long to be filled
                EXPECT_GT(told, DOPPLER_GAP_MAX) << from;
            }
            arrival.sequence += 5;
            EXPECT_EQ(doppler_missing(&config, &state, &arrival), 0);
        }
    }
}

TEST(DopplerStream, without_numbers_the_clock_tells_what_is_more_than_two_and_a_half) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int lost : {0, 4, 10, 32, 50}) {
        doppler_state_t state = {};
        int told = 0;
        for (int tick = 1; tick <= 3000; tick++) {
            const int came = by_clock(tick) - by_clock(tick - 1);
            const int less =
                tick >= 1000 && tick < 1000 + (lost + 3) / 4 ? (tick == 1000 + (lost + 3) / 4 - 1 && lost % 4 != 0 ? lost % 4 : 4) : 0;
            const doppler_arrival_t arrival = {0, 1, came - (lost > 0 ? less : 0)};
            const int now = doppler_missing(&config, &state, &arrival);
            if (tick < 1000) { // a converter of the stated rate owes nothing
                EXPECT_EQ(now, 0) << tick;
            }
            told += now;
        }
        EXPECT_NEAR(told, lost, lost > 0 ? 2.5 : 0) << lost;
    }
    doppler_state_t state = {}; // a tick without a radar, then all of it at once: nothing is lost
    doppler_arrival_t arrival = {0, 1, 5};
    doppler_missing(&config, &state, &arrival);
    for (int tick = 0; tick < 4; tick++) {
        arrival.count = 0;
        EXPECT_EQ(doppler_missing(&config, &state, &arrival), 0);
    }
    arrival.count = 25;
    EXPECT_EQ(doppler_missing(&config, &state, &arrival), 0);
    arrival = {0, 7, 5}; // six ticks missed, whose 30 samples nobody read
    EXPECT_NEAR(doppler_missing(&config, &state, &arrival), 30, 1.5);
}

// 512 ticks of memory: a rate that is x off owes 512 * 5.12 x samples, and 32 are too many: 1.22 %.
TEST(DopplerStream, a_rate_more_than_a_hundredth_and_a_quarter_off_is_refused) {
    doppler_config_t config = rover_config_default().doppler;
    for (const double off : {0.0, 0.011, -0.011, 0.0135, -0.0135}) {
        doppler_state_t state = {};
        std::uint32_t sequence = 1;
        int values = 0, spoilt = 0;
        double due = 0;
        for (int tick = 0; tick < 4000; tick++) {
            due += 5.12 * (1 + off);
            const int count = static_cast<int>(due);
            due -= count;
            std::uint16_t sample[8];
            for (int k = 0; k < count; k++)
                sample[k] = static_cast<std::uint16_t>(512 + ((sequence + static_cast<std::uint32_t>(k)) * 2654435761u >> 25) - 64);
            const doppler_arrival_t arrival = {sequence, 1, count};
            EXPECT_EQ(doppler_missing(&config, &state, &arrival), 0);
            sequence += static_cast<std::uint32_t>(count);
            config.method = DOPPLER_ARGMAX; // no spectrum is strange to it
            const doppler_output_t out = doppler_step(&config, &state, sample, count);
            if (tick < 3000 || !out.fresh) continue;
            values++;
            spoilt += out.spoilt ? 1 : 0;
        }
        EXPECT_GT(values, 50);
        EXPECT_EQ(spoilt, std::fabs(off) > 0.0122 ? values : 0) << off;
    }
}

doppler_state_t with_samples(const doppler_config_t &config, int count, std::uint16_t value) {
    doppler_state_t state = {};
    for (int n = 0; n < count; n++) {
        const auto sample = static_cast<std::uint16_t>(value + n % 7);
        doppler_step(&config, &state, &sample, 1);
    }
    return state;
}

TEST(DopplerStream, a_gap_is_filled_along_a_straight_line) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int missing : {1, 2, 7, 32}) {
        for (const std::uint16_t next : {std::uint16_t{400}, std::uint16_t{580}, std::uint16_t{1023}}) {
            doppler_state_t state = with_samples(config, 40, 500);
            const int from = state.last, to = (next - config.offset_count) * 32;
            EXPECT_EQ(from, (500 + 39 % 7 - 512) * 32);
            doppler_gap(&config, &state, missing, next);
            EXPECT_EQ(state.filled, 40 + missing);
            for (int j = 1; j <= missing; j++)
                EXPECT_NEAR(state.window.sample[39 + j], from + static_cast<double>(to - from) * j / (missing + 1), 1.0)
                    << missing << " " << j;
        }
    }
    doppler_state_t state = with_samples(config, 40, 500);
    for (const int none : {0, -1}) doppler_gap(&config, &state, none, 700);
    EXPECT_EQ(state.filled, 40);
}

TEST(DopplerStream, a_gap_too_long_to_be_filled_begins_anew) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int missing : {32, 33, 1000}) {
        doppler_state_t state = with_samples(config, 300, 500);
        state.next_sequence = 4711;
        doppler_gap(&config, &state, missing, 600);
        const bool anew = missing > 32;
        EXPECT_EQ(state.filled == 0 && !state.full, anew);
        EXPECT_EQ(state.next_sequence, 4711u);
        EXPECT_TRUE(!anew || state.started);
        if (!anew) continue;
        int until = 0; // the first early value comes with 128 samples, one call later
        for (doppler_output_t out = {}; !out.fresh && until < 300; until++) {
            const auto sample = static_cast<std::uint16_t>(500 + until % 9);
            out = doppler_step(&config, &state, &sample, 1);
        }
        EXPECT_EQ(until, 129);
    }
    doppler_state_t empty = {}; // nothing that a line could begin at
    doppler_gap(&config, &empty, 5, 600);
    EXPECT_EQ(empty.filled, 0);
}

// What was filled in, or stood at a rail, in the last 320 samples: the value is trusted less, by a twentieth and a fiftieth of its variance
// each; more than a quarter, or two fifths, are no value.
TEST(DopplerStream, filled_and_railed_samples_cost_trust_for_as_long_as_they_are_in_the_window) {
    doppler_config_t config = rover_config_paper().doppler;
    config.hop = 64;
    struct Case {
        int made, railed;
        std::uint16_t rail;
        bool spoilt;
    };
    for (const Case &c : {Case{0, 0, 0, false}, Case{1, 0, 0, false}, Case{80, 0, 0, false}, Case{81, 0, 0, true}, Case{0, 1, 0, false},
                          Case{0, 128, 1023, false}, Case{0, 129, 1023, true}, Case{0, 129, 0, true}, Case{10, 20, 0, false}}) {
        doppler_state_t state = {};
        enum { BEFORE, MARKING, AFTER } stage = BEFORE;
        int stream = 0, values = 0, checked = 0, first = 0, last = 0;
        const auto one = [&](std::uint16_t sample) {
            const doppler_output_t out = doppler_step(&config, &state, &sample, 1);
            stream++;
            if (!out.fresh) return;
            values++;
            if (stage == BEFORE || (stage == AFTER && stream - last > 320 + 1)) {
                EXPECT_EQ(out.trust, 1.0f);
                EXPECT_FALSE(out.spoilt);
            } else if (stage == AFTER && stream - first <= 256) {
                EXPECT_NEAR(out.trust, 1.0f + 0.05f * static_cast<float>(c.made) + 0.02f * static_cast<float>(c.railed), 1e-4f);
                EXPECT_EQ(out.spoilt, c.spoilt) << c.made << " " << c.railed;
                checked++;
            }
        };
        const auto calm = [&](int count) {
            for (int n = 0; n < count; n++) one(static_cast<std::uint16_t>(stream % 2 == 0 ? 1 : 1022)); // one count short of either rail
        };
        calm(320);
        first = stream;
        stage = MARKING;
        for (int left = c.made; left > 0; left -= 27) { // three gaps of 27 in a row
            doppler_gap(&config, &state, left < 27 ? left : 27, 600);
            stream += left < 27 ? left : 27;
        }
        for (int n = 0; n < c.railed; n++) one(c.rail);
        last = stream;
        stage = AFTER;
        calm(500);
        EXPECT_GT(values, 6);
        EXPECT_GT(checked, 0);
    }
}

// A converter of which 64 samples differ by three counts or less, twice in a row, hears nothing alive; four are life.
TEST(DopplerStream, a_front_end_without_noise_is_dead_after_two_blocks) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int span : {0, 3, 4, 50}) {
        doppler_state_t state = {};
        int dead_from = -1;
        for (int n = 0; n < 400; n++) {
            const auto sample = static_cast<std::uint16_t>(n % 64 == 11 ? 500 + span : n % 64 == 40 ? 500 : 501 < 500 + span ? 501 : 500);
            const doppler_output_t out = doppler_step(&config, &state, &sample, 1);
            if (out.dead && dead_from < 0) dead_from = n;
            if (dead_from >= 0) {
                EXPECT_TRUE(out.dead);
            }
        }
        EXPECT_EQ(dead_from, span <= 3 ? 127 : -1) << span;
        if (dead_from < 0) continue;
        int alive = -1; // the first whole block with life in it ends it
        for (int n = 0; n < 200 && alive < 0; n++) {
            const auto sample = static_cast<std::uint16_t>(500 + 20 * (n % 2));
            alive = doppler_step(&config, &state, &sample, 1).dead ? -1 : n;
        }
        EXPECT_GE(alive, 0);
        EXPECT_LT(alive, 64);
    }
    for (const int block : {0, 1}) { // one dead block alone is chance
        doppler_state_t state = {};
        for (int n = 0; n < 128; n++) {
            const auto sample = static_cast<std::uint16_t>(n / 64 == block ? 500 : 500 + 9 * (n % 2));
            EXPECT_FALSE(doppler_step(&config, &state, &sample, 1).dead);
        }
    }
}

// No tick pays for a transform and a search: a window that a gap fills waits for one more call, and its age goes on.
TEST(DopplerStream, a_window_that_a_gap_fills_is_heard_one_call_later_and_knows_its_age) {
    doppler_config_t config = rover_config_paper().doppler;
    for (const int beyond : {0, 1, 9}) {
        doppler_state_t state = with_samples(config, 250, 500);
        doppler_gap(&config, &state, 6 + beyond, 520);
        const std::uint16_t sample[5] = {520, 530, 510, 520, 500};
        EXPECT_FALSE(doppler_step(&config, &state, sample, 5).fresh);
        const doppler_output_t out = doppler_step(&config, &state, sample, 4);
        EXPECT_TRUE(out.fresh);
        EXPECT_EQ(out.late_samples, beyond + 5 + 4);
    }
    doppler_state_t state = with_samples(config, 256, 500); // filled by itself, then a gap before the search
    doppler_gap(&config, &state, 8, 520);
    const std::uint16_t sample[2] = {520, 530};
    const doppler_output_t out = doppler_step(&config, &state, sample, 2);
    EXPECT_TRUE(out.fresh);
    EXPECT_EQ(out.late_samples, 8 + 2);
}

// The mean that is taken off is that of the window: its sum is kept by what comes and what goes, and drifts by nothing.
TEST(DopplerStream, the_sum_of_the_window_stays_that_of_its_samples) {
    doppler_config_t config = rover_config_default().doppler;
    for (const int hop : {64, 61, 3, 256}) {
        config.hop = hop;
        doppler_state_t state = {};
        std::uint32_t random = 7;
        int values = 0;
        for (int tick = 0; tick < 700; tick++) {
            std::vector<std::uint16_t> sample(5);
            for (std::uint16_t &x : sample) {
                random = random * 1664525u + 1013904223u;
                x = static_cast<std::uint16_t>(400 + (random >> 16) % 150);
            }
            values += doppler_step(&config, &state, sample.data(), 5).fresh ? 1 : 0;
            if (state.tone.found) break; // what a line leaves in them is doppler_line_test's
            std::int32_t sum = 0;
            for (int j = 0; j < state.filled; j++) sum += state.window.sample[j];
            ASSERT_EQ(state.sum, sum) << "hop " << hop << " tick " << tick;
        }
        EXPECT_GT(values, 5) << hop;
    }
}

// The transform of the early windows and of the full one is that of their samples about their own mean: 128 samples each taken twice, 192
// with their mirror image, 256. A mean beyond 384 counts is held there.
TEST(DopplerStream, every_window_is_heard_about_the_mean_of_what_it_holds) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int level : {512, 700, 300, 1000, 3}) {
        doppler_state_t state = {};
        std::vector<std::int16_t> samples;
        std::uint32_t random = 5;
        int heard = 0;
        while (samples.size() < 256) {
            random = random * 1664525u + 1013904223u;
            const int count =
                std::min(1023, std::max(0, level + static_cast<int>(random >> 24) % 41 - 20 + (samples.size() < 100 ? 15 : 0)));
            const auto sample = static_cast<std::uint16_t>(count);
            doppler_step(&config, &state, &sample, 1);
            samples.push_back(static_cast<std::int16_t>((count - config.offset_count) * 32));
            const std::size_t n = samples.size();
            if (n != 128 && n != 192 && n != 256) continue;
            std::int16_t window[FFT_LENGTH] = {};
            long sum = 0;
            for (std::size_t i = 0; i < FFT_LENGTH; i++)
                window[i] = n == 128 ? samples[i / 2] : i < n ? samples[i] : samples[2 * n - 1 - i];
            for (const std::int16_t value : samples) sum += value;
            const long mean = std::min(384l * 32, std::max(-384l * 32, sum / static_cast<long>(n)));
            std::uint64_t power[FFT_BINS];
            fft_power_about(window, static_cast<std::int32_t>(mean), power);
            for (int k = 0; k < FFT_BINS; k++) ASSERT_EQ(state.power[k], power[k]) << n << ' ' << level << ' ' << k;
            EXPECT_TRUE(state.pending);
            EXPECT_EQ(state.halved, n == 128);
            heard++;
        }
        EXPECT_EQ(heard, 3);
    }
}

// Lines are looked at once a value of a full window, four calls after it, unless the next window's powers are there first.
TEST(DopplerStream, lines_are_looked_at_once_a_value_and_only_in_that_windows_powers) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int next : {1, 2, 3, 4, 5, 9}) { // the call in which the next window is full
        doppler_state_t state = {};
        std::uint32_t random = 3;
        std::vector<std::uint16_t> samples;
        for (int i = 0; i < 256 + 64; i++)
            samples.push_back(static_cast<std::uint16_t>(500 + ((random = random * 1664525u + 1013904223u) >> 27)));
        doppler_step(&config, &state, samples.data(), 256);
        ASSERT_TRUE(state.full);
        ASSERT_TRUE(doppler_step(&config, &state, nullptr, 0).fresh);
        for (int call = 1; call <= 12; call++) {
            EXPECT_EQ(state.leveled, call > 4 && next > 3) << next << ' ' << call;
            if (call == next) {
                doppler_step(&config, &state, samples.data() + 256, 64);
                state.pending = false; // its own value would have a look of its own
            } else {
                doppler_step(&config, &state, nullptr, 0);
            }
        }
    }
}

// However far off the rate is, and for however long: what is owed is held, not forgotten.
TEST(DopplerStream, a_rate_that_is_far_off_is_refused_for_good) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int a_tick : {0, 1, 2, 3, 8, 11, 20, 64}) {
        doppler_state_t state = {};
        doppler_arrival_t arrival = {1, 1, 5};
        doppler_missing(&config, &state, &arrival);
        double owed = 0; // 5.12 a tick should come; a 512th is forgotten
        for (int tick = 0; tick < 3000; tick++) {
            arrival.sequence = state.next_sequence;
            arrival.count = a_tick;
            EXPECT_EQ(doppler_missing(&config, &state, &arrival), 0); // none is lost: they are numbered
            owed = std::clamp((owed + 5.12 - a_tick) * (511.0 / 512), -256.0, 256.0);
            EXPECT_NEAR(state.owed_q8 / 256.0, owed, 0.05 + 1e-2 * std::fabs(owed)) << a_tick << ' ' << tick; // 5.12 is 1310/256
            if (tick > 200) {
                EXPECT_GT(std::abs(state.owed_q8), 32 * 256) << a_tick;
            }
        }
    }
}

// Five ticks' samples a call are rid of the line, 24 at least and 64 at most; none before the window is full, none twice.
TEST(DopplerStream, a_line_is_taken_off_a_few_samples_a_call) {
    for (const int per_tick_q8 : {300, 1311, 2000, 9000}) {
        doppler_config_t config = rover_config_default().doppler;
        config.per_tick_q8 = per_tick_q8;
        doppler_state_t state = {};
        state.full = true;
        state.filled = 192;
        const int some = std::clamp(5 * per_tick_q8 / 256, 24, 64);
        int clean = 0;
        for (int call = 0; call < 12; call++) {
            doppler_step(&config, &state, nullptr, 0);
            clean = std::min(192, clean + some);
            EXPECT_EQ(state.clean, clean) << per_tick_q8 << ' ' << call;
            EXPECT_EQ(state.tone.next, static_cast<std::uint32_t>(clean));
        }
    }
}

} // namespace
