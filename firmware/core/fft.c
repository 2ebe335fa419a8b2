#include "fft.h"

#include "fft_table.h"

// Plain radix-2 on 32-bit data with Q15 twiddles; replaced by the radix-4 transform of the header's table.
static int32_t product(int32_t value, int32_t q15) { return (int32_t)(((int64_t)value * q15) >> 15); }

void fft_power(const int16_t sample[FFT_LENGTH], uint64_t power[FFT_BINS])
{
    int32_t re[FFT_LENGTH];
    int32_t im[FFT_LENGTH];
    for (uint32_t i = 0; i < FFT_LENGTH; i++) {
        uint32_t reversed = 0;
        for (uint32_t bit = 0; bit < 8; bit++) {
            reversed |= ((i >> bit) & 1u) << (7u - bit);
        }
        re[reversed] = ((int32_t)sample[i] * fft_hann_q15[i < 128 ? i : 256 - i]) >> 6;
        im[reversed] = 0;
    }
    for (uint32_t half = 1; half < FFT_LENGTH; half *= 2) {
        for (uint32_t start = 0; start < FFT_LENGTH; start += 2 * half) {
            for (uint32_t k = 0; k < half; k++) {
                const uint32_t turn = k * (128u / half);
                const int32_t c = fft_cos_q15[turn];
                const int32_t s = turn <= 64 ? fft_cos_q15[64 - turn] : fft_cos_q15[turn - 64];
                const uint32_t a = start + k;
                const uint32_t b = a + half;
                const int32_t tr = product(re[b], c) + product(im[b], s);
                const int32_t ti = product(im[b], c) - product(re[b], s);
                re[b] = re[a] - tr;
                im[b] = im[a] - ti;
                re[a] += tr;
                im[a] += ti;
            }
        }
    }
    power[0] = 0;
    for (uint32_t k = 1; k < FFT_BINS; k++) {
        power[k] = (uint64_t)((int64_t)re[k] * re[k]) + (uint64_t)((int64_t)im[k] * im[k]);
    }
}
