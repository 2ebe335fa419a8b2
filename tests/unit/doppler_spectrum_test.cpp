// What doppler makes of a spectrum: powers are put into the state as the transform would have left them, and the verdict is held to closed
// forms in double. Units as doppler.c has them: 100 * 2^28 of a bin are one count^2 of white noise.
#include "firmware/core/doppler_template.h"
#include "firmware/core/rover_config.h"

#include <cstdint>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace {

double wide(float x) { return static_cast<double>(x); }

constexpr double unit = 268435456.0; // 2^28
using Powers = std::array<double, FFT_BINS>;

const doppler_template_t &beam() { return *rover_config_default().doppler.beam; }
int end_of_band() { return beam().first_bin + beam().bins; }

doppler_state_t with(const Powers &powers) {
    doppler_state_t state = {};
    state.full = true;
    for (std::size_t k = 0; k < FFT_BINS; k++) state.power[k] = static_cast<std::uint64_t>(powers[k] * unit);
    return state;
}

doppler_output_t hear(const Powers &powers) {
    const doppler_config_t config = rover_config_default().doppler;
    doppler_state_t state = with(powers);
    state.pending = true;
    const doppler_output_t out = doppler_step(&config, &state, nullptr, 0);
    EXPECT_TRUE(out.fresh);
    return out;
}

// The template's own spectrum of a grid speed with `mean` per bin of the band, and white noise in all bins.
Powers echo(int speed, double mean, double noise) {
    Powers out{};
    double sum = 0;
    for (int k = 0; k < beam().bins; k++) sum += 1.0 / beam().inverse[speed * beam().bins + k];
    for (std::size_t k = 0; k < FFT_BINS; k++) out[k] = noise;
    for (int k = 0; k < beam().bins; k++)
        out[static_cast<std::size_t>(beam().first_bin + k)] += mean * beam().bins / sum / beam().inverse[speed * beam().bins + k];
    return out;
}

TEST(DopplerSpectrum, the_templates_own_spectrum_reads_its_speed_at_any_power) {
    for (int speed = 10; speed < 90; speed++)
        for (const double mean : {600.0, 1e4, 1e7}) {
            const doppler_output_t out = hear(echo(speed, mean, 0));
            EXPECT_FALSE(out.quiet || out.beyond || out.spoilt || out.rest || out.strange) << speed;
            EXPECT_NEAR(std::log(out.speed_m_s / beam().speed_m_s[speed]), 0, 1.0 * static_cast<double>(beam().log_step))
                << speed << " " << mean;
            EXPECT_EQ(out.trust, 1.0f);
        }
}

// Twice the noise is taken off each bin, and R grows with noise over echo: 1 + 4 N/E; below E = N there is no echo.
TEST(DopplerSpectrum, noise_is_told_by_the_bins_above_the_band_and_costs_trust) {
    for (const double noise : {300.0, 3000.0, 1e6})
        for (const double ratio : {0.5, 0.9, 1.1, 2.0, 5.0, 50.0}) {
            const doppler_output_t out = hear(echo(60, ratio * noise, noise));
            EXPECT_EQ(out.quiet, ratio < 1) << noise << " " << ratio;
            EXPECT_FALSE(out.beyond);
            if (ratio < 1) continue;
            EXPECT_NEAR(out.trust, 1 + 4 / ratio, 0.05 / ratio + 0.01) << noise << " " << ratio;
            if (ratio > 4) {
                EXPECT_NEAR(std::log(out.speed_m_s / beam().speed_m_s[60]), 0, 3 * static_cast<double>(beam().log_step));
            }
        }
}

// An echo of which more than half of the band's power is white is none, whatever stands outside.
TEST(DopplerSpectrum, more_than_half_white_within_the_band_is_quiet) {
    for (const int speed : {20, 40, 60, 80})
        for (const double white : {0.3, 0.42, 0.58, 0.8}) {
            Powers powers = echo(speed, 1e5 * (1 - white), 0);
            for (int k = 0; k < beam().bins; k++) powers[static_cast<std::size_t>(beam().first_bin + k)] += 1e5 * white;
            EXPECT_EQ(hear(powers).quiet, white > 0.5) << speed << " " << white;
        }
}

TEST(DopplerSpectrum, the_stated_power_is_the_least) {
    doppler_config_t config = rover_config_default().doppler;
    for (const std::uint32_t least : {2u, 50u})
        for (const double share : {0.97, 1.03}) { // sum over 2^22 is 12288 * 64 a count^2, 2^28 * 100 a bin of white noise
            config.quiet_power_count2 = least;
            doppler_state_t state = with(echo(60, share * least * 12288.0 / beam().bins, 0));
            state.pending = true;
            EXPECT_EQ(doppler_step(&config, &state, nullptr, 0).quiet, share < 1) << least;
            config.method = DOPPLER_ARGMAX;
            state.pending = true;
            EXPECT_EQ(doppler_step(&config, &state, nullptr, 0).quiet, share < 1) << least;
            config.method = DOPPLER_LIKELIHOOD;
        }
}

// What no speed's spectrum fits: mean of P/S over its own mean is 1 for an echo; beyond 0.8 it widens the claim by 0.3 of it, beyond 2.5 it
// is no ground's echo.
TEST(DopplerSpectrum, a_spectrum_that_no_speed_fits_widens_the_claim_and_is_refused_beyond_two_and_a_half) {
    int strange = 0, calm = 0;
    for (const int low : {20, 35})
        for (const int high : {75, 88})
            for (double share = 0; share <= 1; share += 0.05) { // of the faster of two echoes
                Powers powers = echo(low, 1e5 * (1 - share), 0);
                const Powers other = echo(high, 1e5 * share, 0);
                double total = 0;
                for (std::size_t k = 0; k < FFT_BINS; k++) powers[k] += other[k];
                for (int k = 0; k < beam().bins; k++) total += powers[static_cast<std::size_t>(beam().first_bin + k)];
                double least = 1e300, fit = 0;
                for (int i = 0; i < beam().speeds; i++) {
                    double J = 0;
                    for (int k = 0; k < beam().bins; k++)
                        J += powers[static_cast<std::size_t>(beam().first_bin + k)] / total * beam().inverse[i * beam().bins + k];
                    if (J + beam().volume[i] < least) least = J + beam().volume[i], fit = J / beam().exact;
                }
                const doppler_output_t out = hear(powers);
                if (std::fabs(fit - 2.5) > 0.1) {
                    EXPECT_EQ(out.strange, fit > 2.5) << fit;
                }
                EXPECT_NEAR(out.misfit, 0.3 * std::fmax(0, fit - 0.8), 0.02) << fit;
                EXPECT_EQ(out.spoilt, out.strange && !out.quiet); // noise, less its mean, is like no echo: that says nothing
                strange += fit > 2.5 ? 1 : 0;
                calm += fit < 2.5 ? 1 : 0;
            }
    EXPECT_GT(calm, 5);
    EXPECT_GT(strange, 0);
}

// White noise is none at any level; what stands beyond the band alone, or a fifth as loud as the band, is an echo too fast for it. Less
// than 4 count^2 tell nothing.
TEST(DopplerSpectrum, an_echo_beyond_the_band_is_told_from_noise_and_from_an_echos_skirt) {
    const auto outside = [](double in, double beside, double spare) {
        Powers powers = echo(60, in, 0);
        for (int k = end_of_band(); k < FFT_BINS; k++) powers[static_cast<std::size_t>(k)] = k < 96 ? beside : spare;
        return hear(powers).beyond;
    };
    for (const double level : {500.0, 5e4, 5e6}) {
        EXPECT_FALSE(outside(level, level, level));       // as loud everywhere
        EXPECT_FALSE(outside(level / 2.5, level, level)); // noise, of which the band-pass takes some
        EXPECT_TRUE(outside(level / 3.5, level, level));
        EXPECT_TRUE(outside(level / 3.5, level, 0));
        EXPECT_FALSE(outside(level, 0.18 * level, 0));
    }
    for (const double level : {1e4, 1e6}) {
        EXPECT_TRUE(outside(level, 0.22 * level, 0));
        EXPECT_TRUE(outside(level, 0.3 * level, 0.07 * level));
        EXPECT_FALSE(outside(level, 0.3 * level, 0.08 * level));  // not four times what lies beyond: it is noise
        EXPECT_FALSE(outside(level, 0.22 * level, 0.04 * level)); // 0.18 above it: an echo's skirt
        EXPECT_TRUE(outside(level, 0.6 * level, 3.2 * level));    // an alias
        EXPECT_FALSE(outside(level, 1.2 * level, 2.8 * level));
    }
    EXPECT_FALSE(outside(10, 395, 0));
    EXPECT_TRUE(outside(10, 405, 0));
}

// A line is 5 bins of a Hann window wide: 1, 1/4 beside it.
void add_line(Powers &powers, int bin, double power) {
    const double shape[5] = {0.003, 0.25, 1, 0.25, 0.003};
    for (int j = -2; j <= 2; j++)
        if (bin + j < FFT_BINS) powers[static_cast<std::size_t>(bin + j)] += power * shape[j + 2];
}

doppler_state_t look_outside(const Powers &powers) {
    const doppler_config_t config = rover_config_default().doppler;
    doppler_state_t state = with(powers);
    state.weigh_outside = true;
    doppler_step(&config, &state, nullptr, 0); // a call that has time
    EXPECT_FALSE(state.weigh_outside);
    return state;
}

TEST(DopplerSpectrum, up_to_three_lines_beyond_the_band_are_no_echo_and_the_noise_is_what_they_leave) {
    for (const std::vector<int> &bins : {std::vector<int>{60}, {50, 100}, {60, 80, 120}, {49, 75, 127}}) {
        const Powers plain = echo(20, 2e4, 500);
        Powers powers = plain;
        for (std::size_t i = 0; i < bins.size(); i++) add_line(powers, bins[i], 4e5 / static_cast<double>(i + 1));
        const doppler_state_t state = look_outside(powers);
        EXPECT_TRUE(state.outside_lines) << bins.size() << " " << bins[0];
        double sum = 0, count = 0; // of what is no line's, from eight bins below the band's end on
        for (int k = end_of_band() - 8; k < FFT_BINS; k++) {
            bool line = false;
            for (const int bin : bins) {
                line = line || std::abs(k - bin) <= 2;
            }
            sum += line ? 0 : plain[static_cast<std::size_t>(k)];
            count += line ? 0 : 1;
        }
        EXPECT_NEAR(state.outside_noise, sum / count, 2) << bins.size() << " " << bins[0];
        const doppler_config_t config = rover_config_default().doppler;
        doppler_state_t next = state;
        next.pending = true;
        const doppler_output_t out = doppler_step(&config, &next, nullptr, 0);
        EXPECT_FALSE(out.beyond);
        EXPECT_NEAR(out.trust, 1 + 4 * sum / count / 2e4, 0.05);
        EXPECT_NEAR(std::log(out.speed_m_s / beam().speed_m_s[20]), 0, 2 * static_cast<double>(beam().log_step));
    }
    Powers four = echo(50, 2e4, 500);
    for (const int bin : {55, 70, 85, 110}) add_line(four, bin, 4e5);
    EXPECT_TRUE(look_outside(four).outside_noise > 1000); // the fourth stays
    Powers fast = echo(50, 1e3, 500);                     // an echo is as wide as it is fast
    for (std::size_t k = 58; k < 90; k++) fast[k] += 4e4;
    EXPECT_FALSE(look_outside(fast).outside_lines);
    Powers noise = echo(50, 1e4, 500);
    EXPECT_FALSE(look_outside(noise).outside_lines);
    add_line(noise, 70, 500 * 4); // no louder than noise may be: eight times the others
    EXPECT_FALSE(look_outside(noise).outside_lines);
}

// (3) in double: l = log2 P;  m += (l - m)/8;  s += (|l - m| - s)/8;  line: s < 0.35, and m 2 above that of k - 4 and k + 4.
TEST(DopplerSpectrum, a_line_is_what_stands_out_and_does_not_sway) {
    const doppler_config_t config = rover_config_default().doppler;
    doppler_state_t state = {};
    state.full = true;
    std::array<double, FFT_BINS> mean{}, sway{};
    std::uint32_t random = 1;
    int checked = 0, lines = 0;
    for (int value = 0; value < 60; value++) {
        for (int k = 0; k < FFT_BINS; k++) {
            random = random * 1664525u + 1013904223u;
            const double chance = -std::log((random + 1.0) / 4294967297.0);           // exponential, as an echo's powers
            const double steady = (random >> 8) % 100 / 100.0 - 0.5;                  // of a line
            const bool constant = k == 20 || k == 40 || k == 10 || k == 30 || k == 4; // 30 stands out too little, 4 lies too low
            const double level = k == 20 ? 1e5 : k == 40 ? 3e3 : k == 10 ? 1e4 : k == 30 ? 150 : k == 4 ? 1e5 : 100;
            const double power = constant ? level * std::pow(2.0, 0.6 * steady) : level * chance;
            state.power[k] = static_cast<std::uint64_t>(power * unit);
            const double l = std::log2(static_cast<double>(state.power[k] | 1u));
            const double away = value == 0 ? 0 : l - mean[static_cast<std::size_t>(k)];
            if (value == 0) mean[static_cast<std::size_t>(k)] = l, sway[static_cast<std::size_t>(k)] = 2;
            sway[static_cast<std::size_t>(k)] += (std::fabs(away) - sway[static_cast<std::size_t>(k)]) / 8;
            mean[static_cast<std::size_t>(k)] += away / 8;
        }
        state.due = 1;
        doppler_step(&config, &state, nullptr, 0);
        for (int k = 4; k < end_of_band(); k++) {
            const auto at = static_cast<std::size_t>(k);
            EXPECT_NEAR(state.level_q8[k] / 256.0, mean[at], 0.13) << k; // 0.09 of log2_q8, and rounding
            EXPECT_NEAR(state.sway_q8[k] / 256.0, sway[at], 0.16) << k;
            const bool told = (state.line[k / 32] >> (k % 32) & 1u) != 0u;
            if (k < 8 || k >= end_of_band() - 4) {
                EXPECT_FALSE(told) << k;
                continue;
            }
            const double above = mean[at] - std::fmax(mean[at - 4], mean[at + 4]);
            const bool line = sway[at] < 0.35 && above > 2;
            if (std::fabs(sway[at] - 0.35) < 0.17 || std::fabs(above - 2) < 0.26) continue; // within what whole numbers cost
            EXPECT_EQ(told, line) << k << " sway " << sway[at] << " above " << above;
            checked++;
            lines += line ? 1 : 0;
        }
    }
    EXPECT_GT(checked, 1500);
    EXPECT_GT(lines, 30);
}

// The five bins around a line are replaced by the mean of the bins beside them; so the echo reads its speed, and is as loud as it is.
TEST(DopplerSpectrum, a_known_line_within_the_band_is_left_out) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int bin : {8, 12, 20, 31, 32, 40}) {
        Powers powers = echo(60, 2e4, 0), plain = powers;
        // straight in log2 from bin - 3 to bin + 3, in steps of 1/256 bit, a mantissa as a straight line
        const auto level_q8 = [&plain](int k) {
            int exponent = 0;
            const double mantissa = 2 * std::frexp(std::floor(plain[static_cast<std::size_t>(k)] * unit), &exponent);
            return 256 * (exponent - 1) + static_cast<int>(256 * (mantissa - 1));
        };
        const int below = level_q8(bin - 3), step = (level_q8(bin + 3) - below) / 6;
        for (int j = 1; j <= 5; j++) {
            const int level = below + j * step;
            plain[static_cast<std::size_t>(bin - 3 + j)] = std::ldexp(1 + level % 256 / 256.0, level / 256) / unit;
        }
        add_line(powers, bin, 3e6);
        doppler_state_t state = with(powers);
        state.line[bin / 32] = 1u << (bin % 32);
        state.pending = true;
        const doppler_output_t without = doppler_step(&config, &state, nullptr, 0), expected = hear(plain);
        EXPECT_EQ(without.speed_m_s, expected.speed_m_s) << bin;
        EXPECT_EQ(without.misfit, expected.misfit) << bin;
        EXPECT_NE(hear(powers).speed_m_s, expected.speed_m_s) << bin; // it would have been heard
    }
}

// A line that begins beside a louder echo, at its steep edge: its steadiness tells it within 14 values, its place is looked at instead of
// the loudest bin's, and no bin of the echo is called one for an hour of values before.
TEST(DopplerSpectrum, what_is_steadier_than_any_echo_is_a_line_beside_one) {
    const doppler_config_t config = rover_config_default().doppler;
    doppler_state_t state = {};
    state.tone.next = 3000; // under way for six seconds
    std::uint64_t seed = 11;
    const auto exponential = [&seed] {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        return -std::log((static_cast<double>(seed >> 33) + 0.5) / 2147483648.0);
    };
    const auto look = [&](double line) {
        for (int k = 0; k < FFT_BINS; k++) {
            const double mean = k >= 15 && k <= 22 ? 4000 : k == 23 ? 500 : k == 24 ? 60 : 8;
            const double share = k == 25 ? 1 : k == 24 || k == 26 ? 0.25 : 0;
            state.power[k] = static_cast<std::uint64_t>((mean * exponential() + line * share) * unit);
        }
        state.due = 1;
        doppler_step(&config, &state, nullptr, 0);
    };
    for (int values = 0; values < 3600 * 8; values++) {
        look(0);
        ASSERT_EQ(state.line[0] | state.line[1] | state.line[2] | state.line[3], 0u) << values;
    }
    for (int values = 0; values < 14; values++) look(2500);
    EXPECT_EQ(state.line[0], 1u << 25); // 4 bins below, the echo is louder
    EXPECT_EQ(state.tone.bin, 25u);
}

// What lines leave is a relief if they held more than half of what the other bins do, five bins a line: 3 lines > all.
TEST(DopplerSpectrum, lines_that_hold_more_than_half_of_what_the_others_do_were_what_was_heard) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const double level : {800.0, 2000.0, 3000.0, 1e5}) {
        doppler_state_t state = {};
        state.full = true;
        double all = 0, lines = 0;
        for (int k = 0; k < FFT_BINS; k++) {
            const double power = k == 20 ? level : 100;
            state.power[k] = static_cast<std::uint64_t>(power * unit);
            all += k < end_of_band() ? power : 0;
            lines += k >= 18 && k <= 22 ? power : 0;
        }
        ASSERT_GT(std::fabs(3 * lines - all), 100);
        int looks = 0;
        for (; looks < 100 && !state.weigh_lines; looks++) {
            state.due = 1;
            doppler_step(&config, &state, nullptr, 0);
        }
        ASSERT_TRUE(state.weigh_lines) << level;
        EXPECT_EQ(state.line[0], 1u << 20) << level;
        doppler_step(&config, &state, nullptr, 0);
        EXPECT_FALSE(state.weigh_lines);
        EXPECT_EQ(state.relief_masked, 3 * lines > all) << level;
        EXPECT_EQ(state.relief > 0, 3 * lines > all) << level;
    }
}

// A relief that no line of (3) gave stays one of the other kind; a look at the lines leaves none of those before it.
TEST(DopplerSpectrum, what_was_relieved_keeps_its_kind_and_old_lines_are_forgotten) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const bool masked : {false, true}) {
        doppler_state_t state = with(echo(60, 2e4, 10));
        state.pending = true;
        state.relief = 3;
        state.relief_masked = masked;
        EXPECT_TRUE(doppler_step(&config, &state, nullptr, 0).fresh);
        EXPECT_EQ(state.relief, 2);
        EXPECT_EQ(state.relief_masked, masked);
    }
    doppler_state_t state = with(echo(60, 2e4, 10));
    for (std::uint32_t &word : state.line) word = ~0u;
    state.due = 1;
    doppler_step(&config, &state, nullptr, 0);
    for (const std::uint32_t word : state.line) EXPECT_EQ(word, 0u);
}

// The search begins at every fourth grid speed, or at the largest power: either must reach both ends, where there is no parabola.
TEST(DopplerSpectrum, both_ends_of_every_grid_are_heard) {
    for (const doppler_template_t *radar :
         {&doppler_template_mdu1130, &doppler_template_dj_radar_2, &doppler_template_dj_radar_3, &doppler_template_drs1000}) {
        doppler_config_t config = rover_config_default().doppler;
        config.beam = radar;
        for (const bool from_peak : {radar->from_peak, false, true}) {
            for (const int end : {0, 1, 2, 3, 5, 6, radar->speeds - 4, radar->speeds - 3, radar->speeds - 2, radar->speeds - 1}) {
                doppler_template_t own = *radar; // whichever search finds it
                config.beam = &own;
                doppler_state_t state = {};
                state.full = true;
                state.pending = true;
                double least = 1e300;
                int nearest = 0;
                std::vector<double> powers;
                for (int k = 0; k < radar->bins; k++) powers.push_back(1.0 / (radar->inverse[end * radar->bins + k] + 1e-3));
                double total = 0, most = 0;
                int peak = 0;
                for (const double power : powers) total += power;
                for (int k = 0; k < radar->bins; k++) {
                    state.power[radar->first_bin + k] =
                        static_cast<std::uint64_t>(powers[static_cast<std::size_t>(k)] / total * 1e6 * unit);
                    if (powers[static_cast<std::size_t>(k)] > most) most = powers[static_cast<std::size_t>(k)], peak = k;
                }
                own.from_peak = from_peak;
                if (from_peak && !radar->from_peak)
                    own.start[peak] = static_cast<std::int8_t>(end < 6 ? end - 3 : end + 3); // beyond the grid, too
                for (int i = 0; i < radar->speeds; i++) {
                    double J = radar->volume[i];
                    for (int k = 0; k < radar->bins; k++)
                        J += powers[static_cast<std::size_t>(k)] / total * radar->inverse[i * radar->bins + k];
                    if (J < least) least = J, nearest = i;
                }
                const doppler_output_t out = doppler_step(&config, &state, nullptr, 0);
                const double steps = radar->line ? (wide(out.speed_m_s) - wide(radar->speed_m_s[nearest])) / wide(radar->log_step)
                                                 : std::log(wide(out.speed_m_s) / wide(radar->speed_m_s[nearest])) / wide(radar->log_step);
                if (radar->from_peak && !from_peak) continue; // narrower than four steps: that search misses them
                EXPECT_NEAR(steps, 0, nearest == 0 || nearest == radar->speeds - 1 ? 1e-3 : 0.55) << end << ' ' << from_peak;
            }
        }
    }
}

// Of a window of half the length, whose samples stand twice, the bins above the band hold images: they tell of nothing.
TEST(DopplerSpectrum, a_halved_window_knows_nothing_beyond_its_band) {
    const doppler_config_t config = rover_config_default().doppler;
    Powers powers = echo(beam().speeds - 1, 2e4, 0);
    for (int k = end_of_band(); k < FFT_BINS; k++) powers[static_cast<std::size_t>(k)] = 1e5;
    for (const bool halved : {true, false}) {
        doppler_state_t state = with(powers);
        state.pending = true;
        state.halved = halved;
        const doppler_output_t out = doppler_step(&config, &state, nullptr, 0);
        EXPECT_EQ(out.beyond, !halved);
        if (halved) {
            EXPECT_EQ(out.trust, 1);
            EXPECT_NEAR(out.speed_m_s / (2 * beam().speed_m_s[beam().speeds - 1]), 1, 1e-3);
        }
    }
}

// What a line leaves that was taken off, an eighth of it, or a line that is not known well enough: no value, where it is half of what is
// heard, within four bins of its place.
TEST(DopplerSpectrum, the_rest_of_a_line_is_no_value) {
    const doppler_config_t config = rover_config_default().doppler;
    std::uint32_t random = 7;
    const auto uniform = [&] { return (random = random * 1664525u + 1013904223u) / 4294967296.0; };
    int rests = 0, values = 0, weak = 0;
    for (int round = 0; round < 600; round++) {
        const int bin = 1 + static_cast<int>(uniform() * 60);
        Powers powers{};
        for (std::size_t k = 0; k < FFT_BINS; k++) powers[k] = k < static_cast<std::size_t>(end_of_band()) ? 2e4 * uniform() : 0;
        const double boost = std::exp(4 * uniform() - 1);
        for (int k = std::max(0, bin - 4); k <= bin + 4; k++)
            powers[static_cast<std::size_t>(k)] *= k == bin - 4 || k == bin + 4 ? 3 * boost : boost;
        doppler_state_t state = with(powers);
        state.pending = true;
        double near = 0, energy = 0;
        for (int k = std::max(0, bin - 4); k <= bin + 4; k++) near += powers[static_cast<std::size_t>(k)];
        for (int k = beam().first_bin; k < end_of_band(); k++) energy += powers[static_cast<std::size_t>(k)];
        if (std::fabs(2 * near / energy - 1) < 1e-3) continue;
        const bool known = round % 2 == 0;
        const double loud = 0.6 + uniform(); // of an eighth of its power: a^2/2 counts^2, of which each is 12288 * 2^28 in all bins
        if (known) {
            state.tone.found = true;
            state.tone.turn =
                (static_cast<std::uint32_t>(bin) << 24) + (round % 4 == 0 ? 0x600000u : 0u) - (round % 4 == 2 ? 0x700000u : 0u);
            const double a = std::sqrt(2 * 8 * loud * energy / 12288) * 32;
            state.tone.a_re = static_cast<std::int32_t>(a * 0.6);
            state.tone.a_im = static_cast<std::int32_t>(a * -0.8);
            if (std::fabs(loud - 1) < 2e-2) continue;
        } else {
            state.young_bin = bin;
        }
        const doppler_output_t out = doppler_step(&config, &state, nullptr, 0);
        if (out.quiet) {
            EXPECT_FALSE(out.rest);
            continue;
        }
        const bool rest = 2 * near > energy && (!known || loud > 1);
        EXPECT_EQ(out.rest, rest) << bin << ' ' << known << ' ' << 2 * near / energy << ' ' << loud;
        EXPECT_EQ(out.spoilt, rest || out.strange);
        (rest ? rests : values) += 1;
        weak += known && loud < 1 && 2 * near > energy ? 1 : 0;
    }
    EXPECT_GT(std::min({rests, values, weak}), 20);
}

// Until the search inside the echo has its 32 blocks and four more, what is as narrow as a line at 32 Hz or more is one.
TEST(DopplerSpectrum, a_young_line_is_a_narrow_one_where_no_echo_is_narrow) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int bin : {12, 15, 16, 17, 30, 70, 100, 125})
        for (const bool narrow : {true, false}) {
            Powers powers{};
            for (double &power : powers) power = 500;
            add_line(powers, bin, 1e5);
            for (int j = -8; j <= 8 && !narrow; j++)
                if (bin + j < FFT_BINS) powers[static_cast<std::size_t>(bin + j)] += 3e4;
            doppler_state_t state = with(powers);
            state.weigh_young = true;
            state.young_bin = 99;
            doppler_step(&config, &state, nullptr, 0);
            EXPECT_FALSE(state.weigh_young);
            EXPECT_EQ(state.young_bin, narrow && bin >= 16 ? bin : 0) << bin;
        }
    for (const std::uint32_t next : {0u, 36u * 64u - 1u, 36u * 64u, 100000u})
        for (const bool halved : {false, true}) {
            doppler_state_t state = with(echo(60, 2e4, 10));
            state.pending = true;
            state.halved = halved;
            state.tone.next = next;
            state.young_bin = 20;
            doppler_step(&config, &state, nullptr, 0);
            EXPECT_EQ(state.weigh_young, next < 36 * 64 && !halved) << next; // asked anew at every value
            EXPECT_EQ(state.young_bin, state.weigh_young ? 20 : 0);
        }
}

// What is beside a line's five bins, up to eight away, may be louder than the others by a sixteenth of the line, and by what noise spreads:
// 13 of their means for all bins together. And it stands out by eight.
TEST(DopplerSpectrum, a_line_has_a_quiet_ring) {
    const doppler_config_t config = rover_config_default().doppler;
    for (const int bin : {16, 17, 40, 100, 122, 125})
        for (const double loud : {1e4, 1e6})
            for (const double times : {0.9, 1.1}) {
                Powers powers{};
                for (double &power : powers) power = 500;
                for (int j = -2; j <= 2; j++) powers[static_cast<std::size_t>(bin + j)] = j == 0 ? 1.5 * loud : loud;
                const int from = std::max(8, bin - 8), to = std::min(FFT_BINS - 1, bin + 8), ring = to - from + 1 - 5;
                for (int k = from; k <= to; k++)
                    if (std::abs(k - bin) > 2) powers[static_cast<std::size_t>(k)] = 500 + times * (5.5 * loud / 16 + 13 * 500) / ring;
                doppler_state_t state = with(powers);
                state.weigh_young = true;
                doppler_step(&config, &state, nullptr, 0);
                EXPECT_EQ(state.young_bin > 0, times < 1) << bin << ' ' << loud;
            }
    for (const double loud : {3900.0, 4100.0}) {
        Powers powers{};
        for (double &power : powers) power = 500;
        powers[50] = loud;
        doppler_state_t state = with(powers);
        state.weigh_young = true;
        doppler_step(&config, &state, nullptr, 0);
        EXPECT_EQ(state.young_bin, loud > 4000 ? 50 : 0);
    }
}

// What lines leave is weighed in the same two parts as what there was: up to bin 95, and from 96 on, each by its mean.
TEST(DopplerSpectrum, what_lines_leave_is_an_echo_beyond_the_band_from_three_times_the_bands_mean_on) {
    for (const bool far : {false, true})
        for (const double times : {0.99, 1.01}) {
            Powers powers{};
            for (std::size_t k = 0; k < FFT_BINS; k++) {
                const bool in = k < static_cast<std::size_t>(end_of_band()), spare = k >= 96;
                powers[k] = in ? 1e4 : spare == far ? 3e4 * times : far ? 5e3 : 1e4;
            }
            const int line = 60, width = 96 - end_of_band();
            for (int k = end_of_band(); k < 96 && !far; k++) // what is taken is counted as nothing in the mean
                if (std::abs(k - line) > 2) powers[static_cast<std::size_t>(k)] = 3e4 * times * width / (width - 5);
            for (int j = -2; j <= 2; j++) powers[static_cast<std::size_t>(line + j)] = j == 0 ? 4e7 : 1e7;
            EXPECT_EQ(look_outside(powers).outside_lines, times < 1) << far;
        }
}

TEST(DopplerSpectrum, just_a_third_of_all_is_not_more_than_half_of_the_others_and_a_relief_ends_with_its_values) {
    const doppler_config_t config = rover_config_default().doppler;
    doppler_state_t state = {};
    state.full = true;
    const int others = end_of_band() - 5;
    for (int k = 0; k < FFT_BINS; k++) state.power[k] = static_cast<std::uint64_t>((k == 20 ? 50.0 * others - 400 : 100.0) * unit);
    state.line[0] = 1u << 20;
    state.weigh_lines = true;
    doppler_step(&config, &state, nullptr, 0);
    EXPECT_FALSE(state.weigh_lines);
    EXPECT_FALSE(state.relief_masked);
    state.power[20] += 1024;
    state.weigh_lines = true;
    doppler_step(&config, &state, nullptr, 0);
    EXPECT_TRUE(state.relief_masked);
    EXPECT_GE(state.relief * config.hop, FFT_LENGTH); // a window that is rid of the line wholly has come by then
    for (int left = state.relief - 1; left >= -1; left--) {
        state.pending = true;
        state.weigh_lines = false;
        doppler_step(&config, &state, nullptr, 0);
        EXPECT_EQ(state.relief, std::max(0, left));
        EXPECT_EQ(state.relief_masked, left > 0);
    }
}

// Powers are reduced to 15 bits: nothing that is told of a spectrum may hang on how large it is.
TEST(DopplerSpectrum, what_is_told_of_a_spectrum_is_the_same_at_any_power) {
    for (const int low : {20, 40, 70}) {
        Powers shape = echo(low, 0.6, 0);
        const Powers other = echo(85, 0.4, 0);
        for (std::size_t k = 0; k < FFT_BINS; k++) shape[k] += other[k];
        double total = 0, least = 1e300, fit = 0;
        for (int k = beam().first_bin; k < end_of_band(); k++) total += shape[static_cast<std::size_t>(k)];
        for (int i = 0; i < beam().speeds; i++) {
            double J = 0;
            for (int k = 0; k < beam().bins; k++)
                J += shape[static_cast<std::size_t>(beam().first_bin + k)] / total * beam().inverse[i * beam().bins + k];
            if (J + beam().volume[i] < least) least = J + beam().volume[i], fit = J / beam().exact;
        }
        const doppler_output_t one = hear([&] {
            Powers powers = shape;
            for (double &power : powers) power *= 1e5;
            return powers;
        }());
        for (int step = 0; step < 96; step++) { // a sixteenth of an octave each
            Powers powers = shape;
            for (double &power : powers) power *= 2e4 * std::exp2(step / 16.0);
            const doppler_output_t out = hear(powers);
            // each power is cut by one unit of 2^-8 of 64 to 127: 48 of them are 0.3 % of the sum at most, and what is cut is lost twice
            EXPECT_NEAR(wide(out.misfit) / 0.3 + 0.8, std::fmax(fit, 0.8), 0.01 * fit) << low << ' ' << step;
            EXPECT_NEAR(std::log(out.speed_m_s / one.speed_m_s), 0, 0.05 * wide(beam().log_step)) << low << ' ' << step;
        }
    }
}

// Half of what is heard is no rest, and a unit more is one.
TEST(DopplerSpectrum, a_rest_is_more_than_half_of_what_is_heard) {
    const doppler_config_t config = rover_config_default().doppler;
    int heard = 0;
    for (int speed = 20; speed < 85; speed++)
        for (const std::uint64_t more : {0u, 1u, 2u}) {
            doppler_state_t state = with(echo(speed, 2e4, 0));
            for (std::uint64_t &power : state.power) power &= ~((std::uint64_t{1} << 22) - 1); // whole units of what counts
            const int bin = static_cast<int>(std::max_element(state.power, state.power + FFT_BINS) - state.power);
            if (bin < 8 || bin + 5 > end_of_band()) continue;
            std::uint64_t others = 0, near = 0;
            for (int k = beam().first_bin; k < end_of_band(); k++) (std::abs(k - bin) > 4 ? others : near) += state.power[k] >> 22;
            const int beside =
                bin + 6 < end_of_band() ? bin + 6 : bin - 6; // it takes what the others lack, or the loudest what the nine lack
            if (near > others + more)
                state.power[beside] += (near - others - more) << 22;
            else
                state.power[bin] += (others - near + more) << 22;
            state.pending = true;
            state.young_bin = bin;
            const doppler_output_t out = doppler_step(&config, &state, nullptr, 0);
            if (out.quiet) continue;
            EXPECT_EQ(out.rest, more > 0) << speed << ' ' << more;
            heard++;
        }
    EXPECT_GT(heard, 10);
}

} // namespace
