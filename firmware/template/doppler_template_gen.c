// doppler_template_gen - writes the spectra of a radar's echo, over a grid of speeds, as a C table for the firmware.
//
// Runs on the build machine, at build time. Nothing here is fitted to data: a flat rough ground seen by a Gaussian beam.
//
//   patch at depression th, azimuth ph:  dP = G^2(th, ph) sin^n(th) sin(th) cos(th) dth dph            (1)
//   its Doppler shift:                   f  = 2 v (f0/c) cos(th) cos(ph)                                (2)
//   S_v[k] = (1 - e) sum dP |H(f)|^2 (|W(k - f/df)|^2 + |W(k + f/df)|^2) / sum + e / bins              (3)
//   X[k] = sum_m sqrt(dP_m) |H| (z_m W(k - f_m/df) + z_m* W(k + f_m/df)) + noise,  z_m complex normal     (4)
//   grid speed = v / mean(v_found / v) over draws of (4)                                                 (5)
//   w_j: square of the Hann window over its age in ticks, Q15, sum 32768                                 (6)
//
// (1): range r = h/sin(th), ground area dA = h^2 cos(th)/sin^3(th) dth dph, power ~ G^2 sigma0 dA / r^4, sigma0 ~ sin^n(th):
// the height h drops out (derived here). (2): (11) Lhomme-Desages for one direction. (3): band-pass H, Hann window W, a real
// signal's mirror image, and a share e of white noise. (4), (5): where the firmware's search finds its minimum for echoes of this very
// model, speckle included; it lies 1 to 2 % low where few bins carry the echo, because the power that scales J is that of the same
// few bins. A closed form of second order does not converge there (tried), so the generator draws windows. (6): a sample's weight is
// shared between the two ticks around its age, so that the mean age is the window's own; the newest sample is half a sample old.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    const char *name;
    const char *title;
    double f0_Hz, beam_vertical_deg, beam_horizontal_deg;
    double rate_Hz; // of the converter
} radar_t;

// Table II, Lhomme-Desages; 512 Hz: section 4
static const radar_t radars[] = {
    {"mdu1130", "MDU1130, 9.9 GHz, 36 x 72 deg", 9.9e9, 36, 72, 512},
    {"dj_radar_2", "DJ Radar II, 24.13 GHz, 15 deg", 24.13e9, 15, 15, 512},
    {"dj_radar_3", "DJ Radar III, 24.13 GHz, 20 x 16 deg", 24.13e9, 20, 16, 512},
    {"drs1000", "DRS1000, 35.5 GHz, 12 deg", 35.5e9, 12, 12, 512},
};

static const double pi = 3.14159265358979323846;
static const double c_m_s = 299792458.0;
static const double mounting_deg = 20;   // theta_d, section 4; for the others assumed
static const double ground_exponent = 1; // n, assumed: middle of 0..2
static const double tick_Hz = 100;
static const double band_low_Hz = 3;    // section 4
static const double band_high_Hz = 80;  // section 4, at 9.9 GHz; scales with f0 for the other radars
static const double noise_share = 0.05; // e, assumed
static const double speed_low_m_s = 0.04;
static const double speed_high_m_s = 1.35;

static const double calm_share =
    0.004; // white noise in (4), assumed: 20 dB below the echo at the converter, 48 of 128 bins of it in the band

enum { LENGTH = 256, SPEEDS = 96, FINE = 2000, FIRST_BIN = 1, BINS = 120 };
enum { TICKS = 64, SAMPLES_PER_TICK = 8 };                                          // of the firmware: longest window, most samples
enum { COARSE = 4 };                                                                // of doppler.c: where it searches first
enum { QUARTERS = 4 * (BINS + 8), DRAWS = 1500, REACH = 20, EDGE = 8, SMOOTH = 4 }; // REACH: (4) is cut 5 bins from f, 1e-4 of its peak

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
static double band_power(double f, double high) { return f <= 0 ? 0 : 1 / (1 + pow(band_low_Hz / f, 4)) / (1 + pow(f / high, 4)); }

static void spectrum(const radar_t *radar, const double *weight, double v, int bins, double *S)
{
    const double high = band_high_Hz * radar->f0_Hz / radars[0].f0_Hz;
    const double df = radar->rate_Hz / LENGTH;
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
    fprintf(out,
            "// %s, %.0f deg below horizontal, ground exponent %.0f. Mean shift over that of the axis: %.3f, mode %.3f;\n"
            "// standard deviation over mean: %.3f.\n",
            radar->title, mounting_deg, ground_exponent, mean / cos(mounting_deg * pi / 180),
            (mode + 0.5) / FINE / cos(mounting_deg * pi / 180), sqrt(square / sum - mean * mean) / mean);
}

// --- (4), (5)

typedef struct {
    int bins;
    double step;
    double inverse[SPEEDS][BINS], volume[SPEEDS]; // as the firmware has them: whole numbers
} table_t;

static double uniform(uint64_t *state) // splitmix64
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double normal(uint64_t *state)
{
    double sum = -6;
    for (int i = 0; i < 12; i++) {
        sum += uniform(state);
    }
    return sum;
}

// Amplitude of the Hann window at d bins from its centre, without its phase.
static double hann_amplitude(double d)
{
    return fabs(fabs(d) - 1) < 1e-9 ? 0.5 : fabs(d) < 1e-9 ? 1 : sin(pi * d) / (pi * d * (1 - d * d));
}

// Amplitudes sqrt(dP) |H| of (4) on quarters of a bin, scaled so that the powers of (4) have the sum 1.
static void amplitudes(const radar_t *radar, const double *weight, double v, int bins, double *amplitude)
{
    const double high = band_high_Hz * radar->f0_Hz / radars[0].f0_Hz;
    double power[QUARTERS] = {0}, sum = 0;
    for (int i = 0; i < FINE; i++) {
        const double f = 2 * v * radar->f0_Hz / c_m_s * (i + 0.5) / FINE;
        const int m = (int)(4 * f * LENGTH / radar->rate_Hz + 0.5);
        power[m < QUARTERS ? m : QUARTERS - 1] += weight[i] * band_power(f, high);
    }
    for (int m = 1; m < QUARTERS; m++) {
        for (int k = FIRST_BIN; k < FIRST_BIN + bins; k++) {
            sum += power[m] * (hann_power(k - 0.25 * m) + hann_power(k + 0.25 * m));
        }
    }
    for (int m = 0; m < QUARTERS; m++) {
        amplitude[m] = m == 0 ? 0 : sqrt(power[m] / sum);
    }
}

// Powers of one window of (4).
static void draw(const double *amplitude, int bins, uint64_t *state, double *power)
{
    static double re[QUARTERS], im[QUARTERS], noise[2][BINS + 2], hann[2 * QUARTERS];
    for (int m = 0; hann[0] == 0 && m < 2 * QUARTERS; m++) {
        hann[2 * QUARTERS - 1 - m] = hann_amplitude(0.25 * (2 * QUARTERS - 1 - m));
    }
    for (int m = 0; m < QUARTERS; m++) {
        re[m] = amplitude[m] > 0 ? amplitude[m] * normal(state) * sqrt(0.5) : 0;
        im[m] = amplitude[m] > 0 ? amplitude[m] * normal(state) * sqrt(0.5) : 0;
    }
    for (int k = 0; k < bins + 2; k++) { // the window's mean square is 3/8
        noise[0][k] = normal(state) * sqrt(0.5 * calm_share / (0.375 * bins));
        noise[1][k] = normal(state) * sqrt(0.5 * calm_share / (0.375 * bins));
    }
    for (int k = 0; k < bins; k++) {
        const int centre = 4 * (k + FIRST_BIN);
        double x[2];
        for (int part = 0; part < 2; part++) {
            x[part] = 0.5 * noise[part][k + 1] + 0.25 * (noise[part][k] + noise[part][k + 2]);
        }
        for (int m = centre > REACH ? centre - REACH : 1; m <= centre + REACH && m < QUARTERS; m++) {
            const double w = hann[abs(centre - m)], mirrored = hann[centre + m];
            x[0] += re[m] * (w + mirrored);
            x[1] += im[m] * (w - mirrored);
        }
        power[k] = x[0] * x[0] + x[1] * x[1];
    }
}

static double cost(const table_t *table, const double *power, double total, int speed)
{
    double sum = total * table->volume[speed];
    for (int k = 0; k < table->bins; k++) {
        sum += power[k] * table->inverse[speed][k];
    }
    return sum;
}

// Logarithm of the speed that the firmware's search finds, over that of the grid's first.
static double found(const table_t *table, const double *power)
{
    double total = 0, J[SPEEDS];
    int coarse = COARSE / 2;
    for (int k = 0; k < table->bins; k++) {
        total += power[k];
    }
    for (int i = COARSE / 2; i < SPEEDS; i += COARSE) {
        J[i] = cost(table, power, total, i);
        coarse = J[i] < J[coarse] ? i : coarse;
    }
    int best = coarse;
    for (int i = coarse - COARSE < 0 ? 0 : coarse - COARSE; i <= coarse + COARSE && i < SPEEDS; i++) {
        J[i] = cost(table, power, total, i);
        best = J[i] < J[best] ? i : best;
    }
    if (best == 0 || best == SPEEDS - 1) {
        return table->step * best;
    }
    const double left = J[best - 1] - J[best], right = J[best + 1] - J[best];
    return table->step * (best + (left + right > 0 ? 0.5 * (left - right) / (left + right) : 0));
}

// (5) over the grid. The grid's ends cannot be told apart from what lies beyond: they take the value of EDGE speeds further in.
// Averaged over neighbours, 15 % to both sides: what stays is a ripple of 0.5 % by where the echo lies between two bins of 2 Hz, which is
// narrower than the spread of the values. Sampling error 0.05 %; rounded to that, so that libraries that differ in a last bit agree.
static void mean_found(const radar_t *radar, const double *weight, const table_t *table, double *ratio)
{
    double raw[SPEEDS] = {0}, amplitude[QUARTERS], power[BINS];
    for (int i = EDGE; i < SPEEDS - EDGE; i++) {
        uint64_t state = 20 + (uint64_t)i;
        amplitudes(radar, weight, speed_low_m_s * exp(table->step * i), table->bins, amplitude);
        for (int n = 0; n < DRAWS; n++) {
            draw(amplitude, table->bins, &state, power);
            raw[i] += exp(found(table, power) - table->step * i) / DRAWS;
        }
    }
    for (int i = 0; i < SPEEDS; i++) {
        const int centre = i < EDGE ? EDGE : i >= SPEEDS - EDGE ? SPEEDS - EDGE - 1 : i;
        double sum = 0;
        int n = 0;
        for (int j = centre - SMOOTH < EDGE ? EDGE : centre - SMOOTH; j <= centre + SMOOTH && j < SPEEDS - EDGE; j++, n++) {
            sum += raw[j];
        }
        ratio[i] = floor(sum / n * 2000 + 0.5) / 2000;
    }
}

// --- (6)

static int window_ticks(const radar_t *radar) { return (int)(LENGTH * tick_Hz / radar->rate_Hz) + 1; }

static void write_window(const radar_t *radar, FILE *out)
{
    double weight[TICKS + 1] = {0}, sum = 0;
    int whole[TICKS + 1], rest = 32768, most = 0;
    for (int n = 0; n < LENGTH; n++) {
        const double hann = 0.5 - 0.5 * cos(2 * pi * n / LENGTH), age = (LENGTH - 0.5 - n) / radar->rate_Hz * tick_Hz;
        weight[(int)age] += hann * hann * (1 - (age - (int)age));
        weight[(int)age + 1] += hann * hann * (age - (int)age);
        sum += hann * hann;
    }
    for (int j = 0; j < window_ticks(radar); j++) {
        whole[j] = (int)floor(weight[j] / sum * 32768 + 0.5);
        rest -= whole[j];
        most = whole[j] > whole[most] ? j : most;
    }
    whole[most] += rest; // what rounding left
    const double tau_s = floor((LENGTH - 1) / 2.0 / radar->rate_Hz * 1000 + 0.5) / 1000;
    fprintf(out, "    .window = {.ticks = %d, .tau_s = %.3ff, .tau_ticks = %.1ff, .per_s = %.8ef, .weight_q15 = {", window_ticks(radar),
            tau_s, tau_s * tick_Hz, radar->rate_Hz / LENGTH);
    for (int j = 0; j < window_ticks(radar); j++) {
        fprintf(out, "%d, ", whole[j]);
    }
    fprintf(out, "}},\n");
}

static int write_template(const radar_t *radar, FILE *out)
{
    static double weight[FINE];
    static double S[SPEEDS][LENGTH / 2];
    static table_t table;
    double ratio[SPEEDS];
    const double shift = 2 * radar->f0_Hz / c_m_s; // [Hz per m/s] along the ground
    const double highest = fmin(speed_high_m_s, 0.46 * radar->rate_Hz / shift);
    const double step = log(highest / speed_low_m_s) / (SPEEDS - 1);
    int bins = (int)ceil(highest * shift / (radar->rate_Hz / LENGTH)) - FIRST_BIN + 1;
    bins = (bins + 7) / 8 * 8; // rows of whole 128-bit groups
    bins = bins > BINS ? BINS : bins;
    double smallest = 1;
    beam_histogram(radar, weight);
    for (int i = 0; i < SPEEDS; i++) {
        spectrum(radar, weight, speed_low_m_s * exp(step * i), bins, S[i]);
        for (int k = 0; k < bins; k++) {
            smallest = fmin(smallest, S[i][k]);
        }
    }
    const double scale = 32767 * smallest;
    for (int i = 0; i < SPEEDS; i++) {
        double ln = 0;
        for (int k = 0; k < bins; k++) {
            ln += log(S[i][k]);
            table.inverse[i][k] = floor(scale / S[i][k] + 0.5);
        }
        table.volume[i] = floor(scale * ln + 0.5);
    }
    table.bins = bins;
    table.step = step;
    mean_found(radar, weight, &table, ratio);
    fprintf(out, "// Made by doppler_template_gen from the radar's geometry; do not edit.\n");
    describe(radar, weight, out);
    fprintf(out,
            "#include \"firmware/core/doppler_template.h\"\n\nconst doppler_template_t doppler_template_%s = {\n    .log_step = %.8ef,\n"
            "    .paper_m_s_per_Hz = %.8ef,\n    .sample_rate_Hz = %.1ff,\n    .speeds = %d,\n    .first_bin = %d,\n    .bins = %d,\n"
            "    .speed_m_s = {",
            radar->name, step, 1 / (shift * cos(mounting_deg * pi / 180)), radar->rate_Hz, SPEEDS, FIRST_BIN, bins);
    for (int i = 0; i < SPEEDS; i++) {
        fprintf(out, "%.8ef, ", speed_low_m_s * exp(step * i) / ratio[i]); // (5)
    }
    fprintf(out, "},\n    .inverse = {\n");
    for (int i = 0; i < SPEEDS; i++) {
        for (int k = 0; k < bins; k++) {
            fprintf(out, "%d,", (int)table.inverse[i][k]);
        }
        fprintf(out, "\n");
    }
    fprintf(out, "},\n    .volume = {");
    for (int i = 0; i < SPEEDS; i++) {
        fprintf(out, "%d, ", (int)table.volume[i]);
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
    fprintf(out, "},\n    .exact = %d,\n", (int)floor(scale * bins + 0.5));
    write_window(radar, out);
    fprintf(out, "};\n");
    return ferror(out) ? 4 : 0;
}

int main(int argc, char **argv)
{
    for (size_t i = 0; (argc == 3 || argc == 5) && i < sizeof radars / sizeof *radars; i++) {
        if (strcmp(argv[1], radars[i].name) == 0) {
            radar_t radar = radars[i];
            if (argc == 5) { // the same radar behind a converter of another rate, under another name
                radar.rate_Hz = atof(argv[3]);
                radar.name = argv[4];
            }
            if (!(radar.rate_Hz > 0) || window_ticks(&radar) > TICKS || radar.rate_Hz > SAMPLES_PER_TICK * tick_Hz) {
                fprintf(stderr,
                        "doppler_template_gen: RATE_HZ = %g: the firmware holds %d ticks of window and %d samples a tick; give %g to %g\n",
                        radar.rate_Hz, TICKS, SAMPLES_PER_TICK, ceil(LENGTH * tick_Hz / (TICKS - 1)), SAMPLES_PER_TICK * tick_Hz);
                return 2;
            }
            FILE *out = fopen(argv[2], "w");
            if (out == NULL) {
                fprintf(stderr, "doppler_template_gen: cannot write %s\n", argv[2]);
                return 4;
            }
            const int result = write_template(&radar, out);
            return fclose(out) != 0 ? 4 : result;
        }
    }
    fprintf(stderr, "usage: doppler_template_gen mdu1130|dj_radar_2|dj_radar_3|drs1000 OUT.c [RATE_HZ NAME]\n");
    return 2;
}
