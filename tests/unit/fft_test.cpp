#include "firmware/core/fft.h"
#include "firmware/core/fft_table.h"
#include "tests/unit/clutter.h"

#include <algorithm>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace {

// |X[k]| of (1), directly and in double.
std::vector<double> reference(const int16_t *x, bool flat) {
    static const std::vector<double> cosine = [] {
        std::vector<double> table;
        for (int n = 0; n < 256; ++n) {
            table.push_back(std::cos(2 * clutter::pi * n / 256));
        }
        return table;
    }();
    std::vector<double> out(128, 0.0);
    for (std::size_t k = 1; k < 128; ++k) {
        double re = 0, im = 0;
        for (std::size_t n = 0; n < 256; ++n) {
            const double windowed = flat ? x[n] / 2.0 : x[n] * (1 - cosine[n]) / 2;
            re += windowed * cosine[k * n % 256];
            im -= windowed * cosine[(k * n + 192) % 256];
        }
        out[k] = 512 * std::sqrt(re * re + im * im);
    }
    return out;
}

double snr_of(const int16_t *x, bool flat) {
    uint64_t power[FFT_BINS];
    flat ? fft_power_flat(x, 0, power) : fft_power(x, power);
    const std::vector<double> expected = reference(x, flat);
    double signal = 0, error = 0;
    for (std::size_t k = 1; k < 128; ++k) {
        signal += expected[k] * expected[k];
        error += std::pow(std::sqrt(static_cast<double>(power[k])) - expected[k], 2);
    }
    return 10 * std::log10(signal / error);
}

// With the Hann window and with none, whichever keeps less.
double snr_dB(const int16_t *x) { return std::fmin(snr_of(x, false), snr_of(x, true)); }

TEST(Fft, keeps_88_dB_from_full_scale_to_minus_60_dB) {
    for (const double level : {0.0, -20.0, -40.0, -60.0}) {
        for (int i = 0; i < 12; i += 3) {
            int16_t x[256];
            for (int n = 0; n < 256; ++n) {
                const double phase = 2 * clutter::pi * (3.3 + 10.17 * i) * n / 256 + i;
                x[n] = static_cast<int16_t>(std::floor(32767 * std::pow(10, level / 20) * std::sin(phase) + 0.5));
            }
            EXPECT_GE(snr_dB(x), 88) << level << " dBFS, tone " << i; // goal of docs/evidence.md section 1
        }
    }
}

TEST(Fft, keeps_88_dB_for_noise) {
    clutter::Random random{3};
    int16_t x[256];
    for (auto &value : x) {
        value = static_cast<int16_t>(std::fmax(-32768, std::fmin(32767, 8000 * random.normal())));
    }
    EXPECT_GE(snr_dB(x), 88);
}

TEST(Fft, neither_wraps_nor_saturates_at_any_extreme) {
    for (int k = 1; k < 128; k += 21) {
        for (const double turn : {0.0, 0.3}) {
            int16_t x[256];
            for (int n = 0; n < 256; ++n) {
                x[n] = static_cast<int16_t>(
                    std::cos(2 * clutter::pi * (k * n / 256.0 + turn)) >= 0 ? INT16_MAX : INT16_MIN); // drives bin k to its largest
            }
            EXPECT_GE(snr_dB(x), 88) << "bin " << k;
        }
    }
    for (const int16_t value : {int16_t{INT16_MIN}, int16_t{INT16_MAX}}) {
        int16_t x[256];
        std::fill(std::begin(x), std::end(x), value);
        uint64_t power[FFT_BINS];
        fft_power(x, power);
        const double expected = std::pow(512.0 * 64 * value, 2);               // a constant through the Hann window: bin 1 is half of bin 0
        EXPECT_NEAR(static_cast<double>(power[1]), expected, 1e-4 * expected); // Q15 twiddles: 2 * 2^-15
        EXPECT_LT(static_cast<double>(power[5]), 1e-8 * expected);             // nothing but rounding: 80 dB down
    }
}

TEST(Fft, of_silence_is_silence) {
    const int16_t x[256] = {};
    uint64_t power[FFT_BINS];
    fft_power(x, power);
    for (const uint64_t value : power) {
        EXPECT_EQ(value, 0u);
    }
}

TEST(Fft, tables_are_their_formulas) {
    for (int n = 0; n < 64; ++n) {
        for (int half = 0; half < 2; ++half) {
            const double h = (1 - std::cos(2 * clutter::pi * (n + 64 * half) / 256)) / 2;
            EXPECT_NEAR(fft_hann_q28[2 * n + half], h * (1 << 28), 0.51); // rounding
        }
    }
    const auto check = [](const uint32_t *table, int m) {
        for (int k = 1; k < m / 2; ++k) {
            for (int j = 1; j <= 3; ++j) {
                const uint32_t word = table[3 * (k - 1) + j - 1];
                const double angle = 2 * clutter::pi * j * k / (4 * m);
                EXPECT_NEAR(static_cast<int16_t>(word & 0xffffu), std::fmin(32767, 32768 * std::cos(angle)), 0.51);
                EXPECT_NEAR(static_cast<int16_t>(word >> 16), std::fmin(32767, 32768 * std::sin(angle)), 0.51);
            }
        }
    };
    check(fft_twiddle_4_q15, 4);
    check(fft_twiddle_16_q15, 16);
    check(fft_twiddle_64_q15, 64);
}

} // namespace
