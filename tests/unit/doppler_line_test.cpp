// doppler_line on signals known in closed form, and on echoes that hold no line.
#include "firmware/core/doppler_line.h"
#include "tests/unit/clutter.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace {

using clutter::pi;
constexpr double rate_Hz = 512, gain = 32;

struct Heard {
    std::vector<double> left; // what is left of the samples, in counts
    int found = 0, thoughts = 0;
    double Hz = 0, count = 0; // of the line that was found last
};

// 5 samples at a time, and a thought after each, as ticks would.
Heard listen(const std::vector<double> &counts, unsigned bin) {
    doppler_line_t line = {};
    Heard out;
    for (std::size_t n = 0; n + 5 <= counts.size(); n += 5) {
        if (n % 60 == 0) {
            doppler_line_suggest(&line, bin);
        }
        std::array<std::int16_t, 5> sample = {};
        for (std::size_t i = 0; i < 5; ++i) {
            sample[i] = static_cast<std::int16_t>(std::floor(counts[n + i] + 0.5) * gain);
        }
        const doppler_line_span_t span = {.count = 5, .mean = 0, .low = -16384, .high = 16352};
        int32_t sum = 0, told = 0;
        for (const std::int16_t value : sample) {
            told -= value;
        }
        doppler_line_take(&line, &span, sample.data(), &sum);
        for (const std::int16_t value : sample) {
            told += value;
            out.left.push_back(value / gain);
        }
        EXPECT_EQ(sum, told); // the sum follows what was taken
        const unsigned before = line.thinks;
        doppler_line_think(&line);
        if (before > 0 && line.thinks == 0) {
            ++out.thoughts, out.found += line.found ? 1 : 0;
            out.Hz = line.turn / 4294967296.0 * rate_Hz;
            out.count = std::hypot(line.a_re, line.a_im) / gain;
        }
    }
    return out;
}

// A ground's echo is a function of the place alone: drives of any speed over it share it.
const std::vector<double> &along_track(const clutter::Ground &ground) {
    static std::map<std::uint64_t, std::vector<double>> known;
    const auto [at, is_new] = known.try_emplace(ground.seed);
    if (is_new) {
        at->second = clutter::echo_along_track(ground);
    }
    return at->second;
}

std::vector<double> echo(double speed_m_s, std::uint64_t seed, double seconds) {
    clutter::Ground ground;
    ground.seed = seed, ground.track_m = 12;
    clutter::Adc adc;
    adc.signal_count = 75, adc.seed = seed;
    std::vector<double> out;
    const double length = ground.track_m - 0.1;
    for (const std::uint16_t value : clutter::drive(
             along_track(ground), seconds, [&](double t) { return std::fmod(speed_m_s * t, length); }, adc)) {
        out.push_back(value - 512.0);
    }
    return out;
}

double power_of(const std::vector<double> &x, std::size_t from) {
    double sum = 0;
    for (std::size_t n = from; n < x.size(); ++n) {
        sum += x[n] * x[n] / static_cast<double>(x.size() - from);
    }
    return sum;
}

// An interpolated periodogram of N blocks errs by a thirtieth of a cell of 1/(32 * 0.125 s), 0.008 Hz, and by the noise; within four
// seconds 0.01 Hz turns by 14 deg, which leaves 6 % of the line's power, and tables of 256 phases leave 0.02 %.
TEST(DopplerLine, takes_a_line_off_white_noise_and_leaves_the_noise) {
    clutter::Random random{11};
    for (const double Hz : {30.1, 33.33, 50.0, 61.7, 100.0}) {
        std::vector<double> counts;
        for (int n = 0; n < 512 * 12; ++n) {
            counts.push_back(100 * std::sin(2 * pi * Hz * n / rate_Hz + 1) + 20 * random.normal());
        }
        const Heard heard = listen(counts, static_cast<unsigned>(Hz / 2 + 0.5));
        EXPECT_NEAR(heard.Hz, Hz, 0.01);
        EXPECT_NEAR(heard.count, 100, 3); // the noise of 20 over 2048 samples is 0.6
        EXPECT_LE(power_of(heard.left, 512 * 6), 400 * 1.1 + 0.06 * 5000) << Hz;
    }
}

// Cells of (2) are 0.25 Hz wide: between them a parabola through three half cells tells the place, wherever in a cell it is.
TEST(DopplerLine, the_place_between_two_cells_is_told) {
    for (int part = 0; part < 48; ++part) {
        const double Hz = 50 + 0.5 * part / 48 + 0.003;
        std::vector<double> counts;
        for (int n = 0; n < 512 * 10; ++n) counts.push_back(100 * std::cos(2 * pi * Hz * n / rate_Hz + 0.7 * part));
        const Heard heard = listen(counts, 25);
        ASSERT_GT(heard.found, 0) << Hz;
        EXPECT_NEAR(heard.Hz, Hz, 0.01) << part;
    }
}

// Samples that go by unseen end the block that they fall into, and those before it; within a block they are only counted.
TEST(DopplerLine, a_skip_forgets_the_blocks_that_it_breaks) {
    doppler_line_t line = {};
    doppler_line_suggest(&line, 25);
    line.re = 7, line.im = -9, line.blocks = 4, line.next = 10;
    doppler_line_skip(&line, DOPPLER_LINE_BLOCK - 11);
    EXPECT_EQ(line.next, DOPPLER_LINE_BLOCK - 1u);
    EXPECT_EQ(line.re, 7);
    EXPECT_EQ(line.blocks, 4);
    doppler_line_skip(&line, 1);
    EXPECT_EQ(line.next, static_cast<std::uint32_t>(DOPPLER_LINE_BLOCK));
    EXPECT_EQ(line.re, 0);
    EXPECT_EQ(line.im, 0);
    EXPECT_EQ(line.blocks, 0);
}

// 33.3 Hz lies in the middle of the echo of 0.5 m/s, which sways as the sum does.
TEST(DopplerLine, is_found_inside_the_echo_and_taken_off_it) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        std::vector<double> counts = echo(0.5, seed, 16);
        const double alone = power_of(counts, 512 * 8);
        for (std::size_t n = 0; n < counts.size(); ++n) {
            counts[n] += 75 * 1.414 * std::sin(2 * pi * 33.3 * static_cast<double>(n) / rate_Hz);
        }
        const Heard heard = listen(counts, 17);
        EXPECT_NEAR(heard.Hz, 33.3, 0.05) << seed;
        EXPECT_LE(power_of(heard.left, 512 * 8), 1.3 * alone) << seed; // the line's own power is 1.0 of it
    }
}

// Fisher's test: fewer than one in a hundred, at the bins where the echo is loudest.
TEST(DopplerLine, no_echo_of_any_speed_is_called_a_line) {
    int thoughts = 0, found = 0;
    for (const double speed_m_s : {0.4, 0.5, 0.7, 1.0, 1.3}) {
        for (const std::uint64_t seed : {1u, 2u}) {
            const std::vector<double> counts = echo(speed_m_s, seed, 60);
            const Heard heard = listen(counts, static_cast<unsigned>(62.0 * speed_m_s / 2)); // 62 Hz per m/s: 2 f0 cos(20 deg)/c
            thoughts += heard.thoughts, found += heard.found;
        }
    }
    EXPECT_GE(thoughts, 1000);
    EXPECT_LE(found, thoughts / 100);
}

TEST(DopplerLine, a_line_that_ends_is_given_up_within_two_seconds) {
    clutter::Random random{3};
    std::vector<double> counts;
    for (int n = 0; n < 512 * 16; ++n) {
        counts.push_back((n < 512 * 8 ? 100 * std::sin(2 * pi * 40.2 * n / rate_Hz) : 0) + 20 * random.normal());
    }
    const Heard heard = listen(counts, 20);
    EXPECT_LE(power_of(heard.left, 512 * 10), 400 * 1.1); // a second of blocks, and half a one between two thoughts
}

TEST(DopplerLine, is_bounded_for_any_samples) {
    doppler_line_t line = {};
    clutter::Random random{7};
    line.next = UINT32_MAX - 700; // the count of samples wraps
    for (int k = 0; k < 20000; ++k) {
        if (k % 100 == 0) {
            doppler_line_suggest(&line, static_cast<unsigned>(random.next() % 400));
        }
        if (k % 777 == 0) {
            doppler_line_skip(&line, static_cast<unsigned>(random.next() % 100));
        }
        std::array<std::int16_t, 8> sample = {};
        for (std::int16_t &value : sample) {
            const std::uint64_t pick = random.next() % 4;
            value = static_cast<std::int16_t>(pick == 0 ? -16384 : pick == 1 ? 16352 : static_cast<int>(random.next() % 32000) - 16000);
        }
        const doppler_line_span_t span = {.count = 8, .mean = k % 2 == 0 ? 16352 : -16384, .low = -16384, .high = 16352};
        int32_t sum = 0;
        doppler_line_take(&line, &span, sample.data(), &sum);
        for (const std::int16_t value : sample) {
            ASSERT_GE(value, -16384);
            ASSERT_LE(value, 16352);
        }
        doppler_line_think(&line);
        ASSERT_LT(line.bin, 128u);
    }
}

// (1), (2) and (3) in double, block by block: what is kept of each, what is made of them in every fourth block from the 16th on, four cells
// a call, and when a line is one. Lines that begin and end, noise, skipped samples, other bins, a count of samples that wraps.
TEST(DopplerLine, every_block_every_cell_and_every_verdict_is_its_equation) {
    clutter::Random random{23};
    int thoughts = 0, found = 0, ended = 0, full = 0, young = 0;
    for (int drive = 0; drive < 24; ++drive) {
        doppler_line_t line = {};
        line.next = drive % 3 == 0 ? UINT32_MAX - 1500 : 0;
        std::uint32_t bin = 10 + static_cast<std::uint32_t>(random.next() % 100);
        doppler_line_suggest(&line, bin);
        EXPECT_EQ(line.bin, bin);
        const double at = bin + (drive % 4 == 0 ? 0.4 : random.uniform() - 0.5), loud = drive % 6 == 5 ? 0 : 600 + 3000 * random.uniform();
        const double noise = 300 + 1500 * random.uniform(), mean = 200 * random.uniform();
        std::vector<std::array<double, 2>> blocks; // of an unbroken stretch
        std::array<double, 2> sum = {};
        bool was_found = false, done = false;
        for (int k = 0; k < 64 * 60 && !done; ++k) {
            const bool plays = k < 64 * 44;
            const double n = line.next; // modulo 2^32, of which all periods are parts
            const double x = mean + (plays ? loud * std::cos(2 * pi * std::fmod(at * n / 256, 1.0) + 0.5) : 0) + noise * random.normal();
            auto sample = static_cast<std::int16_t>(std::lround(std::clamp(x, -16000.0, 16000.0)));
            const double heard = sample - std::floor(mean);
            if (line.found) { // what has been taken off is not of this test: as if it had not been found
                line.found = false;
                was_found = true;
            }
            const double phase = 2 * pi * std::fmod(bin * n, 256.0) / 256;
            sum[0] += heard * std::cos(phase) / 64, sum[1] -= heard * std::sin(phase) / 64;
            const doppler_line_span_t span = {.count = 1, .mean = static_cast<std::int32_t>(mean), .low = -16384, .high = 16352};
            std::int32_t total = 0;
            const std::uint32_t h = line.next / 64 % 32, thought = line.thinks;
            doppler_line_take(&line, &span, &sample, &total);
            EXPECT_EQ(total, 0);
            if (line.next % 64 != 0) continue;
            blocks.push_back(sum);
            sum = {};
            if (blocks.size() > 32) blocks.erase(blocks.begin());
            const auto N = static_cast<double>(blocks.size());
            // a product is cut to 2^-15 of it, at 64 samples one unit on the mean; the cosine is a table's
            ASSERT_NEAR(line.past_re[h], blocks.back()[0], 2.5) << drive << ' ' << k;
            ASSERT_NEAR(line.past_im[h], blocks.back()[1], 2.5);
            ASSERT_EQ(line.blocks, static_cast<std::int32_t>(blocks.size()));
            EXPECT_EQ(line.re, 0);
            EXPECT_EQ(line.im, 0);
            EXPECT_EQ(line.thinks, thought != 0 ? thought : blocks.size() >= 16 && h % 4 == 0 ? 1u : 0u) << h;
            if (line.thinks == 0) {
                EXPECT_FALSE(doppler_line_think(&line));
                continue;
            }
            const std::uint32_t first = line.next / 64 - static_cast<std::uint32_t>(blocks.size());
            const auto of = [&](double u) { // |S|^2 of (2), from the blocks as they are kept
                double re = 0, im = 0;
                for (std::uint32_t j = 0; j < blocks.size(); ++j) {
                    const double c = std::cos(2 * pi * std::fmod(u * (first + j), 1.0)),
                                 s = std::sin(2 * pi * std::fmod(u * (first + j), 1.0));
                    const double a = line.past_re[(first + j) % 32], b = line.past_im[(first + j) % 32];
                    re += a * c + b * s, im += b * c - a * s;
                }
                return std::array<double, 3>{re, im, re * re + im * im};
            };
            double power = 0, most = 0;
            for (std::uint32_t j = 0; j < blocks.size(); ++j)
                power += std::pow(line.past_re[(first + j) % 32], 2) + std::pow(line.past_im[(first + j) % 32], 2);
            for (std::uint32_t c = 0; c < 32; c += 4) EXPECT_TRUE(doppler_line_think(&line)); // four a call
            for (std::uint32_t c = 0; c < 32; ++c) {
                const double S = of(c / 32.0)[2];
                // both parts of each of N terms are cut down by one unit at most, its table by 2^-15
                EXPECT_NEAR(line.cell[c], S / 4096, (2 * std::sqrt(S) * (1.42 * N + 1e-4 * std::sqrt(N * power)) + 2 * N * N) / 4096 + 1)
                    << c;
                most = std::fmax(most, S);
            }
            EXPECT_EQ(line.thinks, 33u);
            EXPECT_TRUE(doppler_line_think(&line)); // its place
            const auto S = of(line.place / 4294967296.0);
            EXPECT_GE(S[2], 0.97 * most); // no cell is better: the parabola may miss the top by a thirtieth of a cell
            EXPECT_EQ(line.place % 64, 0u);
            line.found = was_found;
            EXPECT_TRUE(doppler_line_think(&line));
            EXPECT_EQ(line.thinks, 0u);
            const double share = S[2] / (N * power); // (3)
            double last_re = 0, last_im = 0;
            const double u = line.place / 4294967296.0;
            for (std::uint32_t j = static_cast<std::uint32_t>(blocks.size()) - 8; j < blocks.size(); ++j) { // a second
                const double c = std::cos(2 * pi * std::fmod(u * (first + j), 1.0)), s = std::sin(2 * pi * std::fmod(u * (first + j), 1.0));
                const double a = line.past_re[(first + j) % 32], b = line.past_im[(first + j) % 32];
                last_re += a * c + b * s, last_im += b * c - a * s;
            }
            const double goes = (last_re * S[0] + last_im * S[1]) / (S[2] * 8 / N), least = was_found ? 0.25 : 0.5;
            thoughts++, full += N > 31 ? 1 : 0, young += N < 32 ? 1 : 0;
            if (std::fabs(share - least) > 0.02 && std::fabs(goes - 0.25) > 0.05) {
                EXPECT_EQ(line.found, share > least && goes > 0.25) << drive << ' ' << k << ' ' << share << ' ' << goes;
                found += line.found ? 1 : 0, ended += was_found && !line.found ? 1 : 0;
            }
            const double aside = static_cast<std::int32_t>(line.place) / 4294967296.0; // (4): u from -1/2 to 1/2
            EXPECT_NEAR(std::remainder(line.turn / 4294967296.0 - (bin / 256.0 + aside / 64), 1.0), 0, 1e-9);
            double d_re = 0, d_im = 0;
            for (int m = 0; m < 64; ++m) d_re += std::cos(2 * pi * aside * m / 64) / 64, d_im += std::sin(2 * pi * aside * m / 64) / 64;
            const double scale = 2 / (N * (d_re * d_re + d_im * d_im)); // a = 2 S/(N D)
            const double a_re = scale * (S[0] * d_re + S[1] * d_im), a_im = scale * (S[1] * d_re - S[0] * d_im);
            // D's terms are the middles of four, half a sample late: 2 pi 0.5 0.5/64 rad at the edge; its table is up to 2 pi/256 early
            EXPECT_NEAR(line.a_re, a_re, 0.05 * std::hypot(a_re, a_im) + 8);
            EXPECT_NEAR(line.a_im, a_im, 0.05 * std::hypot(a_re, a_im) + 8);
            was_found = line.found;
            line.found = false;
            if (drive % 5 == 2 && k > 64 * 24) { // what breaks a block is a new start
                doppler_line_skip(&line, 64);
                blocks.clear();
            } else if (drive % 5 == 4 && k > 64 * 30) {
                doppler_line_suggest(&line, bin + 1); // the same, give or take
                EXPECT_EQ(line.bin, bin);
                doppler_line_suggest(&line, bin - 1);
                EXPECT_EQ(line.bin, bin);
                EXPECT_EQ(line.blocks, static_cast<std::int32_t>(blocks.size()));
                line.found = true;
                doppler_line_suggest(&line, bin + 9); // it is found: nothing else is looked at
                EXPECT_EQ(line.bin, bin);
                line.found = false;
                line.re = line.im = 99;
                line.thinks = 3;
                doppler_line_suggest(&line, bin + 2);
                EXPECT_EQ(line.bin, bin + 2);
                EXPECT_EQ(line.re, 0);
                EXPECT_EQ(line.im, 0);
                EXPECT_EQ(line.blocks, 0);
                EXPECT_EQ(line.thinks, 0u);
                done = true;
            }
        }
    }
    EXPECT_GT(std::min({thoughts, found, full, young}), 40);
    EXPECT_GT(ended, 3);
}

} // namespace
