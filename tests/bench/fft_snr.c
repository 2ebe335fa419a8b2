// fft_snr - how exact the firmware's power spectrum is, and KissFFT's where it is given, on the same samples. Prints one line a code:
// decibels of the worst of 12 tones at 0, -20, -40 and -60 dBFS, and of noise at -12 dBFS.
//
// SNR = sum |X|^2 / sum (|X^| - |X|)^2 over bins 1..127, X in double, of the samples that the code was given, through a Hann window or
// none.
#include "firmware/core/fft.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#if WITH_KISSFFT
#include "kiss_fftr.h"
#endif

static const double pi = 3.14159265358979323846;
static double cosine[FFT_LENGTH];

typedef void amplitude_t(const int16_t *sample, double *amplitude); // in units of X: sum x exp(...)

static void ours(const int16_t *sample, double *amplitude) {
    uint64_t power[FFT_BINS];
    fft_power(sample, power);
    for (int k = 1; k < FFT_BINS; k++) {
        amplitude[k] = sqrt((double)power[k]) / 512;
    }
}

#if WITH_KISSFFT
static void kissfft(const int16_t *sample, double *amplitude) {
    kiss_fft_cpx out[FFT_LENGTH / 2 + 1];
    kiss_fftr_cfg cfg = kiss_fftr_alloc(FFT_LENGTH, 0, NULL, NULL);
    kiss_fftr(cfg, sample, out);
    for (int k = 1; k < FFT_BINS; k++) {
        amplitude[k] = hypot(out[k].r, out[k].i) * FFT_LENGTH;
    }
    free(cfg);
}
static void windowed_kissfft(const int16_t *sample, double *amplitude) {
    int16_t windowed[FFT_LENGTH];
    for (int n = 0; n < FFT_LENGTH; n++) {
        windowed[n] = (int16_t)floor(sample[n] * (1 - cosine[n]) / 2 + 0.5);
    }
    kissfft(windowed, amplitude);
}
#endif

static double snr_dB(amplitude_t *code, bool hann, const int16_t *sample) {
    double amplitude[FFT_BINS] = {0};
    double signal = 0;
    double error = 0;
    code(sample, amplitude);
    for (int k = 1; k < FFT_BINS; k++) {
        double re = 0;
        double im = 0;
        for (int n = 0; n < FFT_LENGTH; n++) {
            const double x = sample[n] * (hann ? (1 - cosine[n]) / 2 : 1.0);
            re += x * cosine[k * n % FFT_LENGTH];
            im -= x * cosine[(k * n + 192) % FFT_LENGTH];
        }
        const double exact = hypot(re, im);
        signal += exact * exact;
        error += (amplitude[k] - exact) * (amplitude[k] - exact);
    }
    return 10 * log10(signal / error);
}

static void print_row(const char *name, amplitude_t *code, bool hann) {
    printf("%-44s", name);
    for (int level = 0; level >= -60; level -= 20) {
        double worst = INFINITY;
        for (int i = 0; i < 12; i++) {
            int16_t tone[FFT_LENGTH];
            for (int n = 0; n < FFT_LENGTH; n++) {
                tone[n] = (int16_t)floor(32767 * pow(10, level / 20.0) * sin(2 * pi * (3.3 + 10.17 * i) * n / FFT_LENGTH + i) + 0.5);
            }
            worst = fmin(worst, snr_dB(code, hann, tone));
        }
        printf(" %8.1f", worst);
    }
    int16_t noise[FFT_LENGTH];
    uint32_t random_state = 7;
    for (int n = 0; n < FFT_LENGTH; n++) {
        double sum = 0; // of 12 uniform numbers: nearly normal, never beyond 6 sigma
        for (int i = 0; i < 12; i++) {
            random_state = random_state * 1664525u + 1013904223u;
            sum += random_state / 4294967296.0 - 0.5;
        }
        noise[n] = (int16_t)fmax(-32768, fmin(32767, floor(8000 * sum + 0.5)));
    }
    printf(" %8.1f\n", snr_dB(code, hann, noise));
}

int main(void) {
    for (int n = 0; n < FFT_LENGTH; n++) {
        cosine[n] = cos(2 * pi * n / FFT_LENGTH);
    }
    printf("%-44s %8s %8s %8s %8s %8s\n", "SNR [dB] of the worst tone at [dBFS]", "0", "-20", "-40", "-60", "noise");
    print_row("ours: Hann, FFT, 127 powers", ours, true);
#if WITH_KISSFFT
    print_row("KissFFT int16: FFT", kissfft, false);
    print_row("KissFFT int16: Q15 Hann, FFT", windowed_kissfft, true);
#endif
    return 0;
}
