// doppler_template_gen - writes the spectra of a radar's echo, over a grid of speeds, as a C table for the firmware.
//
// Runs on the build machine, at build time. Nothing here is fitted to data: a flat rough ground seen by a Gaussian beam.
//
//   patch at depression th, azimuth ph:  dP = G^2(th, ph) sin^n(th) sin(th) cos(th) dth dph            (1)
//   its Doppler shift:                   f  = 2 v (f0/c) cos(th) cos(ph)                                (2)
//   S_v[k] = (1 - e) sum dP |H(f)|^2 (|W(k - f/df)|^2 + |W(k + f/df)|^2) / sum + e / bins              (3)
//
// (1): range r = h/sin(th), ground area dA = h^2 cos(th)/sin^3(th) dth dph, power ~ G^2 sigma0 dA / r^4, sigma0 ~ sin^n(th):
// the height h drops out (derived here). (2): (11) Lhomme-Desages for one direction. (3): band-pass H, Hann window W, a real
// signal's mirror image, and a share e of white noise.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    const char *name;
    const char *title;
    double f0_Hz, beam_vertical_deg, beam_horizontal_deg;
} radar_t;

// Table II, Lhomme-Desages
static const radar_t radars[] = {
    {"mdu1130", "MDU1130, 9.9 GHz, 36 x 72 deg", 9.9e9, 36, 72},
    {"dj_radar_2", "DJ Radar II, 24.13 GHz, 15 deg", 24.13e9, 15, 15},
    {"dj_radar_3", "DJ Radar III, 24.13 GHz, 20 x 16 deg", 24.13e9, 20, 16},
    {"drs1000", "DRS1000, 35.5 GHz, 12 deg", 35.5e9, 12, 12},
};

static const double pi = 3.14159265358979323846;
static const double c_m_s = 299792458.0;
static const double mounting_deg = 20;      // theta_d, section 4; for the others assumed
static const double ground_exponent = 1;    // n, assumed: middle of 0..2
static const double sample_rate_Hz = 512;   // section 4
static const double band_low_Hz = 3;        // section 4
static const double band_high_Hz = 80;      // section 4, at 9.9 GHz; scales with f0 for the other radars
static const double noise_share = 0.05;     // e, assumed
static const double speed_low_m_s = 0.04;
static const double speed_high_m_s = 1.35;

enum { LENGTH = 256, SPEEDS = 96, FINE = 2000, FIRST_BIN = 1 };

// Histogram of cos(th) cos(ph) weighted by (1): the echo's spectrum at unit speed.
static void beam_histogram(const radar_t *radar, double *weight)
{
    const double rad = pi / 180;
    const double c = cos(mounting_deg * rad), s = sin(mounting_deg * rad);
    const double sharp = 8 * log(2.0); // two-way pattern of a beam that is 3 dB down at half its width, one way
    memset(weight, 0, FINE * sizeof *weight);
    for (double th = 0.125; th < 90; th += 0.25) {
        for (double ph = -89.875; ph < 90; ph += 0.25) {
            const double x = cos(th * rad) * cos(ph * rad), y = cos(th * rad) * sin(ph * rad), z = -sin(th * rad);
            const double along = x * c - z * s, up = x * s + z * c;
            if (along <= 0) {
                continue;
            }
            const double el = asin(up) / rad / radar->beam_vertical_deg, az = atan2(y, along) / rad / radar->beam_horizontal_deg;
            const double power = exp(-sharp * (el * el + az * az)) * pow(sin(th * rad), ground_exponent + 1) * cos(th * rad);
            weight[(int)(x * FINE)] += power;
        }
    }
}

// Power response of the Hann window at d bins from its centre.
static double hann_power(double d)
{
    if (fabs(d) < 1e-9) {
        return 1;
    }
    if (fabs(fabs(d) - 1) < 1e-9) {
        return 0.25;
    }
    const double w = sin(pi * d) / (pi * d * (1 - d * d));
    return w * w;
}

// Second-order Butterworth on both sides (order assumed).
static double band_power(double f, double high)
{
    return f <= 0 ? 0 : 1 / (1 + pow(band_low_Hz / f, 4)) / (1 + pow(f / high, 4));
}

static void spectrum(const radar_t *radar, const double *weight, double v, int bins, double *S)
{
    const double high = band_high_Hz * radar->f0_Hz / radars[0].f0_Hz;
    const double df = sample_rate_Hz / LENGTH;
    double sum = 0;
    for (int k = 0; k < bins; k++) {
        S[k] = 0;
    }
    for (int i = 0; i < FINE; i++) {
        const double f = 2 * v * radar->f0_Hz / c_m_s * (i + 0.5) / FINE;
        const double p = weight[i] * band_power(f, high);
        const int near = (int)(f / df) - FIRST_BIN;
        for (int k = near - 5 < 0 ? 0 : near - 5; k < bins && k <= near + 6; k++) {
            S[k] += p * (hann_power(k + FIRST_BIN - f / df) + hann_power(k + FIRST_BIN + f / df));
        }
    }
    for (int k = 0; k < bins; k++) {
        sum += S[k];
    }
    for (int k = 0; k < bins; k++) {
        S[k] = (1 - noise_share) * S[k] / sum + noise_share / bins;
    }
}

static void describe(const radar_t *radar, const double *weight, FILE *out)
{
    double sum = 0, mean = 0, square = 0;
    int mode = 0;
    for (int i = 0; i < FINE; i++) {
        const double g = (i + 0.5) / FINE;
        sum += weight[i];
        mean += g * weight[i];
        square += g * g * weight[i];
        mode = weight[i] > weight[mode] ? i : mode;
    }
    mean /= sum;
    fprintf(out, "// %s, %.0f deg below horizontal, ground exponent %.0f. Mean shift over that of the axis: %.3f, mode %.3f;\n"
                 "// standard deviation over mean: %.3f.\n",
            radar->title, mounting_deg, ground_exponent, mean / cos(mounting_deg * pi / 180),
            (mode + 0.5) / FINE / cos(mounting_deg * pi / 180), sqrt(square / sum - mean * mean) / mean);
}

static int write_template(const radar_t *radar, FILE *out)
{
    static double weight[FINE];
    static double S[SPEEDS][LENGTH / 2];
    const double shift = 2 * radar->f0_Hz / c_m_s; // [Hz per m/s] along the ground
    const double highest = fmin(speed_high_m_s, 0.46 * sample_rate_Hz / shift);
    const double step = log(highest / speed_low_m_s) / (SPEEDS - 1);
    int bins = (int)ceil(highest * shift / (sample_rate_Hz / LENGTH)) - FIRST_BIN + 1;
    bins = (bins + 7) / 8 * 8; // rows of whole 128-bit groups
    bins = bins > 120 ? 120 : bins;
    double smallest = 1;
    beam_histogram(radar, weight);
    for (int i = 0; i < SPEEDS; i++) {
        spectrum(radar, weight, speed_low_m_s * exp(step * i), bins, S[i]);
        for (int k = 0; k < bins; k++) {
            smallest = fmin(smallest, S[i][k]);
        }
    }
    const double scale = 32767 * smallest;
    fprintf(out, "// Made by doppler_template_gen from the radar's geometry; do not edit.\n");
    describe(radar, weight, out);
    fprintf(out, "#include \"firmware/core/doppler_template.h\"\n\nconst doppler_template_t doppler_template_%s = {\n    .log_step = %.8ef,\n"
                 "    .paper_m_s_per_Hz = %.8ef,\n    .sample_rate_Hz = %.1ff,\n    .speeds = %d,\n    .first_bin = %d,\n    .bins = %d,\n"
                 "    .speed_m_s = {",
            radar->name, step, 1 / (shift * cos(mounting_deg * pi / 180)), sample_rate_Hz, SPEEDS, FIRST_BIN, bins);
    for (int i = 0; i < SPEEDS; i++) {
        fprintf(out, "%.8ef, ", speed_low_m_s * exp(step * i));
    }
    fprintf(out, "},\n    .inverse = {\n");
    for (int i = 0; i < SPEEDS; i++) {
        for (int k = 0; k < bins; k++) {
            fprintf(out, "%d,", (int)floor(scale / S[i][k] + 0.5));
        }
        fprintf(out, "\n");
    }
    fprintf(out, "},\n    .volume = {");
    for (int i = 0; i < SPEEDS; i++) {
        double ln = 0;
        for (int k = 0; k < bins; k++) {
            ln += log(S[i][k]);
        }
        fprintf(out, "%d, ", (int)floor(scale * ln + 0.5));
    }
    // E[J]/a where half of the power is white: sum_k ((S_v - e/bins) / (1 - e) + 1/bins) / 2 / S_v[k] + ln S_v[k]
    fprintf(out, "},\n    .quiet = {");
    for (int i = 0; i < SPEEDS; i++) {
        double mean = 0;
        for (int k = 0; k < bins; k++) {
            const double echo = (S[i][k] - noise_share / bins) / (1 - noise_share);
            mean += 0.5 * (echo + 1.0 / bins) / S[i][k] + log(S[i][k]);
        }
        fprintf(out, "%d, ", (int)floor(scale * mean + 0.5));
    }
    fprintf(out, "},\n};\n");
    return ferror(out) ? 4 : 0;
}

int main(int argc, char **argv)
{
    for (size_t i = 0; argc == 3 && i < sizeof radars / sizeof *radars; i++) {
        if (strcmp(argv[1], radars[i].name) == 0) {
            FILE *out = fopen(argv[2], "w");
            if (out == NULL) {
                fprintf(stderr, "doppler_template_gen: cannot write %s\n", argv[2]);
                return 4;
            }
            const int result = write_template(&radars[i], out);
            return fclose(out) != 0 ? 4 : result;
        }
    }
    fprintf(stderr, "usage: doppler_template_gen mdu1130|dj_radar_2|dj_radar_3|drs1000 OUT.c\n");
    return 2;
}
