// fft.h - Hann-windowed power spectrum of 256 real samples in fixed point.
//
//   X[k] = 2^9 * sum over n of h[n] x[n] exp(-2 pi j k n / 256),  h[n] = (1 - cos(2 pi n / 256)) / 2     (1)
//   P[k] = Re X[k]^2 + Im X[k]^2                                                                        (2)
//
// Source: derived here.
#ifndef TRACTION_FIRMWARE_CORE_FFT_H
#define TRACTION_FIRMWARE_CORE_FFT_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { FFT_LENGTH = 256, FFT_BINS = 128 };

// power[1..127] by (2); power[0] = 0, as zero frequency is never used. Any samples are accepted; nothing saturates or wraps.
void fft_power(const int16_t sample[FFT_LENGTH], uint64_t power[FFT_BINS]);

// The same of x[n] - mean. Requires that no difference leaves 16 bits, else it wraps.
void fft_power_about(const int16_t sample[FFT_LENGTH], int32_t mean, uint64_t power[FFT_BINS]);

// The same without a window: h[n] = 1/2, of the same sum as (1)'s, so that nothing wraps either.
void fft_power_flat(const int16_t sample[FFT_LENGTH], int32_t mean, uint64_t power[FFT_BINS]);

#ifdef __cplusplus
}
#endif

#endif
