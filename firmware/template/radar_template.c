#include "radar_template.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double c_m_s = 299792458.0;
static const double tick_Hz = 100;
static const double noise_share = 0.05; // e, assumed
static const double line_smear = 0.002; // [1] of (7), assumed: what a body's roll and the turning of its aspect leave of a line

static const double speed_low_m_s = 0.04;
static const double lowest_bins = 1.3;   // [bins] shift of the grid's first speed, at least: what lies below is the converter's offset
static const double deaf_bins = 1.5;     // [bins] what the firmware's mean removal and the window leave deaf, assumed
static const double narrow_width = 0.05; // [1] spectra narrower than a third of four grid steps: the search begins at the peak
static const double reference_spread_m_s = 4.02e-4;                     // [m/s] of the reference radar by (4)
static const double reference_deaf_m_s = 3 * 299792458.0 / (2 * 9.9e9); // its high-pass
static const double calm_share =
    0.004; // white noise in (4), assumed: 20 dB below the echo at the converter, 48 of 128 bins of it in the band

enum { LENGTH = FFT_LENGTH, SPEEDS = DOPPLER_SPEEDS_MAX, FINE = 2000, FIRST_BIN = 1, BINS = DOPPLER_BINS_MAX };
enum { TICKS = DOPPLER_WINDOW_TICKS_MAX };
enum { COARSE = 4 };                                                                // of doppler.c: where it searches first
enum { QUARTERS = 4 * (BINS + 8), DRAWS = 1500, REACH = 20, EDGE = 8, SMOOTH = 4 }; // REACH: (4) is cut 5 bins from f, 1e-4 of its peak

// Histogram of cos(th) cos(ph) weighted by (1): the echo's spectrum at unit speed.
static void beam_histogram(const radar_geometry_t *radar, double *weight)
{
    const double rad = pi / 180;
    const double c = cos(radar->depression_deg * rad), s = sin(radar->depression_deg * rad);
    const double sharp = 8 * log(2.0); // two-way pattern of a beam that is 3 dB down at half its width, one way
    memset(weight, 0, FINE * sizeof *weight);
    if (radar->target == RADAR_TARGET_POINT) { // (7)
        for (int i = -50; i <= 50; i++) {
            const int at = (int)(c * (1 + line_smear * i / 50) * FINE);
            weight[at < FINE ? at : FINE - 1] += 1;
        }
        return;
    }
    for (int row = 0; row < 360; row++) {
        for (int column = 0; column < 720; column++) {
            const double th = 0.125 + 0.25 * row, ph = -89.875 + 0.25 * column;
            const double x = cos(th * rad) * cos(ph * rad), y = cos(th * rad) * sin(ph * rad), z = -sin(th * rad);
            const double along = x * c - z * s, up = x * s + z * c;
            if (along <= 0) {
                continue;
            }
            const double el = asin(up) / rad / radar->vertical_deg, az = atan2(y, along) / rad / radar->horizontal_deg;
            const double power = exp(-sharp * (el * el + az * az)) * pow(sin(th * rad), radar->ground_exponent + 1) * cos(th * rad);
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
static double band_power(const radar_geometry_t *radar, double f)
{
    return f <= 0 ? 0 : 1 / (1 + pow(radar->band_low_Hz / f, 4)) / (1 + pow(f / radar->band_high_Hz, 4));
}

static void spectrum(const radar_geometry_t *radar, const double *weight, double v, int bins, double *S)
{
    const double df = radar->rate_Hz / LENGTH;
    double sum = 0;
    for (int k = 0; k < bins; k++) {
        S[k] = 0;
    }
    for (int i = 0; i < FINE; i++) {
        const double f = 2 * v * radar->carrier_Hz / c_m_s * (i + 0.5) / FINE;
        const double p = weight[i] * band_power(radar, f);
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

// --- (4), (5)

typedef struct {
    int bins;
    double low_m_s, step; // of the grid: ratio's logarithm, or of a line in m/s
    bool linear, from_peak;
    int start[BINS];                              // of from_peak
    double inverse[SPEEDS][BINS], volume[SPEEDS]; // as the firmware has them: whole numbers
} table_t;

static double grid_speed(const table_t *table, double i)
{
    return table->linear ? table->low_m_s + table->step * i : table->low_m_s * exp(table->step * i);
}

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
static void amplitudes(const radar_geometry_t *radar, const double *weight, double v, int bins, double *amplitude)
{
    double power[QUARTERS] = {0}, sum = 0;
    for (int i = 0; i < FINE; i++) {
        const double f = 2 * v * radar->carrier_Hz / c_m_s * (i + 0.5) / FINE;
        const int m = (int)(4 * f * LENGTH / radar->rate_Hz + 0.5);
        power[m < QUARTERS ? m : QUARTERS - 1] += weight[i] * band_power(radar, f);
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

// Place on the grid that the firmware's search finds.
static double found(const table_t *table, const double *power)
{
    double total = 0, J[SPEEDS];
    int coarse = COARSE / 2, peak = 0;
    for (int k = 0; k < table->bins; k++) {
        total += power[k];
        peak = power[k] > power[peak] ? k : peak;
    }
    for (int i = COARSE / 2; i < SPEEDS && !table->from_peak; i += COARSE) {
        J[i] = cost(table, power, total, i);
        coarse = J[i] < J[coarse] ? i : coarse;
    }
    if (table->from_peak) {
        coarse = table->start[peak];
        J[coarse] = cost(table, power, total, coarse);
    }
    const int low = coarse - COARSE < 0 ? 0 : coarse - COARSE;
    const int high = coarse + COARSE < SPEEDS ? coarse + COARSE : SPEEDS - 1;
    int best = coarse;
    for (int i = low; i <= high; i++) {
        J[i] = cost(table, power, total, i);
        best = J[i] < J[best] ? i : best;
    }
    if (best == low || best == high) { // nothing is known of what lies beyond
        return best;
    }
    const double left = J[best - 1] - J[best], right = J[best + 1] - J[best];
    return best + (left + right > 0 ? 0.5 * (left - right) / (left + right) : 0);
}

// (5) over the grid. The grid's ends cannot be told apart from what lies beyond: they take the value of EDGE speeds further in.
// Averaged over neighbours, 15 % to both sides: what stays is a ripple of 0.5 % by where the echo lies between two bins of 2 Hz, which is
// narrower than the spread of the values. Sampling error 0.05 %; rounded to that, so that libraries that differ in a last bit agree.
// *spread: mean over the grid of v var(v_found / v) [m/s].
static void mean_found(const radar_geometry_t *radar, const double *weight, const table_t *table, double *ratio, double *spread)
{
    double raw[SPEEDS] = {0}, amplitude[QUARTERS], power[BINS];
    *spread = 0;
    for (int i = EDGE; i < SPEEDS - EDGE; i++) {
        uint64_t state = 20 + (uint64_t)i;
        double square = 0;
        amplitudes(radar, weight, grid_speed(table, i), table->bins, amplitude);
        for (int n = 0; n < DRAWS; n++) {
            draw(amplitude, table->bins, &state, power);
            const double at = found(table, power);
            const double one = table->linear ? grid_speed(table, at) / grid_speed(table, i) : exp(table->step * at - table->step * i);
            raw[i] += one / DRAWS;
            square += one * one / DRAWS;
        }
        *spread += grid_speed(table, i) * fmax(square - raw[i] * raw[i], 0) / (SPEEDS - 2 * EDGE);
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

static int window_ticks(const radar_geometry_t *radar) { return (int)(LENGTH * tick_Hz / radar->rate_Hz) + 1; }

static void make_window(const radar_geometry_t *radar, doppler_window_t *window)
{
    double weight[TICKS + 1] = {0}, sum = 0;
    int rest = 32768, most = 0;
    for (int n = 0; n < LENGTH; n++) {
        const double hann = 0.5 - 0.5 * cos(2 * pi * n / LENGTH), age = (LENGTH - 0.5 - n) / radar->rate_Hz * tick_Hz;
        weight[(int)age] += hann * hann * (1 - (age - (int)age));
        weight[(int)age + 1] += hann * hann * (age - (int)age);
        sum += hann * hann;
    }
    window->ticks = window_ticks(radar);
    for (int j = 0; j < window->ticks; j++) {
        window->weight_q15[j] = (int16_t)floor(weight[j] / sum * 32768 + 0.5);
        rest -= window->weight_q15[j];
        most = window->weight_q15[j] > window->weight_q15[most] ? j : most;
    }
    window->weight_q15[most] = (int16_t)(window->weight_q15[most] + rest); // what rounding left
    const double tau_s = floor((LENGTH - 1) / 2.0 / radar->rate_Hz * 10000 + 0.5) / 10000;
    window->tau_s = (float)tau_s;
    window->tau_ticks = (float)(tau_s * tick_Hz);
    window->per_s = (float)(radar->rate_Hz / LENGTH);
}

// --- the whole

static double shift_Hz_per_m_s(const radar_geometry_t *radar) { return 2 * radar->carrier_Hz / c_m_s; } // along the ground

// Width of the echo's spectrum over its mean, without that of the window.
static void moments(const double *weight, double *mean, double *mode, double *relative_width)
{
    double sum = 0, first = 0, square = 0;
    int most = 0;
    for (int i = 0; i < FINE; i++) {
        const double g = (i + 0.5) / FINE;
        sum += weight[i];
        first += g * weight[i];
        square += g * g * weight[i];
        most = weight[i] > weight[most] ? i : most;
    }
    *mean = first / sum;
    *mode = (most + 0.5) / FINE;
    *relative_width = sqrt(fmax(square / sum - *mean * *mean, 0)) / *mean;
}

void radar_template_describe(const radar_geometry_t *radar, double *mean, double *mode, double *relative_width)
{
    static double weight[FINE];
    const double axis = cos(radar->depression_deg * pi / 180);
    beam_histogram(radar, weight);
    moments(weight, mean, mode, relative_width);
    *mean /= axis;
    *mode /= axis;
}

// The grid: even in the logarithm, as the spectra's widths are; for a line, whose width is the window's at any speed, even in the speed.
static void make_grid(const radar_geometry_t *radar, const double *weight, table_t *table)
{
    const double shift = shift_Hz_per_m_s(radar), bin_Hz = radar->rate_Hz / LENGTH;
    double mean = 0, mode = 0, width = 0;
    moments(weight, &mean, &mode, &width);
    table->linear = radar->target == RADAR_TARGET_POINT;
    table->from_peak = table->linear || width < narrow_width;
    const double along = table->linear ? mean : 1; // a line reaches the last bin at a higher speed
    const double high = fmin(radar->speed_high_m_s, 0.46 * radar->rate_Hz / (shift * along));
    table->low_m_s = fmax(table->linear ? 0 : speed_low_m_s, lowest_bins * bin_Hz / (shift * along));
    table->step = table->linear ? (high - table->low_m_s) / (SPEEDS - 1) : log(high / table->low_m_s) / (SPEEDS - 1);
    const int bins = (int)ceil(high * shift * along / bin_Hz) - FIRST_BIN + 1;
    table->bins = (bins + 7) / 8 * 8 > BINS ? BINS : (bins + 7) / 8 * 8; // rows of whole 128-bit groups
    for (int k = 0; k < BINS; k++) {
        const double v = (k + FIRST_BIN) * bin_Hz / (shift * mode);
        const double at = table->linear ? (v - table->low_m_s) / table->step : log(v / table->low_m_s) / table->step;
        table->start[k] = (int)fmin(fmax(floor(at + 0.5), 0), SPEEDS - 1);
    }
}

// As the text of a C table has it, so that a template in memory and one that was compiled are the same bits.
static float rounded(double x)
{
    char text[32];
    (void)snprintf(text, sizeof text, "%.8e", x);
    return strtof(text, NULL);
}

static double ratio_to(double value, double reference, double least)
{
    return fmin(fmax(floor(value / reference * 200 + 0.5) / 200, least), 20);
}

void radar_template_make(const radar_geometry_t *radar, doppler_template_t *out)
{
    static double weight[FINE];
    static double S[SPEEDS][LENGTH / 2];
    static table_t table;
    const doppler_template_t empty = {0};
    double ratio[SPEEDS], spread = 0;
    double smallest = 1;
    *out = empty;
    beam_histogram(radar, weight);
    make_grid(radar, weight, &table);
    const int bins = table.bins;
    for (int i = 0; i < SPEEDS; i++) {
        spectrum(radar, weight, grid_speed(&table, i), bins, S[i]);
        for (int k = 0; k < bins; k++) {
            smallest = fmin(smallest, S[i][k]);
        }
    }
    const double scale = 32767 * smallest;
    for (int i = 0; i < SPEEDS; i++) {
        double ln = 0, mean = 0;
        for (int k = 0; k < bins; k++) {
            // E[J]/a where half of the power is white: sum_k ((S_v - e/bins) / (1 - e) + 1/bins) / 2 / S_v[k] + ln S_v[k]
            const double echo = (S[i][k] - noise_share / bins) / (1 - noise_share);
            mean += 0.5 * (echo + 1.0 / bins) / S[i][k] + log(S[i][k]);
            ln += log(S[i][k]);
            table.inverse[i][k] = floor(scale / S[i][k] + 0.5);
            out->inverse[i * bins + k] = (int16_t)table.inverse[i][k];
        }
        table.volume[i] = floor(scale * ln + 0.5);
        out->volume[i] = (int32_t)table.volume[i];
        out->quiet[i] = (int32_t)floor(scale * mean + 0.5);
    }
    mean_found(radar, weight, &table, ratio, &spread);
    for (int i = 0; i < SPEEDS; i++) {
        out->speed_m_s[i] = rounded(grid_speed(&table, i) / ratio[i]); // (5)
    }
    out->log_step = rounded(table.step);
    out->paper_m_s_per_Hz = rounded(1 / (shift_Hz_per_m_s(radar) * cos(radar->depression_deg * pi / 180)));
    out->sample_rate_Hz = (float)radar->rate_Hz;
    out->speeds = SPEEDS;
    out->first_bin = FIRST_BIN;
    out->bins = bins;
    out->exact = (int32_t)floor(scale * bins + 0.5);
    make_window(radar, &out->window);
    out->line = table.linear;
    out->from_peak = table.from_peak;
    for (int k = 0; k < bins; k++) {
        out->start[k] = (int8_t)table.start[k];
    }
    const double deaf_m_s = fmax(radar->band_low_Hz, deaf_bins * radar->rate_Hz / LENGTH) / shift_Hz_per_m_s(radar);
    out->spread = (float)ratio_to(spread, reference_spread_m_s, 0.1);
    out->deaf = (float)ratio_to(deaf_m_s, reference_deaf_m_s, 1);
}

// --- what it is made from

radar_geometry_t radar_geometry_like_reference(double carrier_Hz, double vertical_deg, double horizontal_deg, double rate_Hz)
{
    const double ratio = carrier_Hz / 9.9e9;
    const radar_geometry_t radar = {
        .carrier_Hz = carrier_Hz,
        .vertical_deg = vertical_deg,
        .horizontal_deg = horizontal_deg,
        .depression_deg = 20, // theta_d, section 4; for the others assumed
        .rate_Hz = rate_Hz,
        .band_low_Hz = 3 * ratio,                            // section 4, at 9.9 GHz
        .band_high_Hz = fmin(80 * ratio, 0.46875 * rate_Hz), // section 4, at 9.9 GHz
        .speed_high_m_s = 1.35,
        .ground_exponent = 1, // n, assumed: middle of 0..2
        .target = RADAR_TARGET_GROUND,
    };
    return radar;
}

radar_geometry_t radar_geometry_reference(void) { return radar_geometry_like_reference(9.9e9, 36, 72, 512); } // table II; 512 Hz: section 4

static radar_geometry_refusal_t refuse(const char *field, double value, double low, double high, const char *mend)
{
    const radar_geometry_refusal_t refusal = {field, value, low, high, mend};
    return refusal;
}

radar_geometry_refusal_t radar_geometry_check(const radar_geometry_t *radar)
{
    const bool point = radar->target == RADAR_TARGET_POINT;
    const radar_geometry_refusal_t rows[] = {
        {"carrier_Hz", radar->carrier_Hz, 1e9, 200e9, "give the carrier in Hz: 24.125e9"},
        {"vertical_deg", radar->vertical_deg, 1, 120, "give the one-way 3 dB width of the beam, up and down, in degrees"},
        {"horizontal_deg", radar->horizontal_deg, 1, 120, "give the one-way 3 dB width of the beam, left and right, in degrees"},
        {"depression_deg", radar->depression_deg, point ? 0 : 5, 70, "give the angle between the axis and the path in degrees"},
        {"rate_Hz", radar->rate_Hz, 202, 20000, "a window of 256 samples must last 1.27 s at most, and more than a tick"},
        {"band_low_Hz", radar->band_low_Hz, 0, 0.2 * radar->rate_Hz, "a high-pass above it would leave no echo; 0 where there is none"},
        {"band_high_Hz", radar->band_high_Hz, 2 * radar->band_low_Hz, 1e9, "give a low-pass well above the high-pass"},
        {"speed_high_m_s", radar->speed_high_m_s, 0.05, 100, "give the highest speed of the grid"},
        {"ground_exponent", radar->ground_exponent, 0, 2, "sigma0 of ground falls with sin^n of the grazing angle, n of 0 to 2"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (!(rows[i].value >= rows[i].low && rows[i].value <= rows[i].high)) {
            return rows[i];
        }
    }
    const double shift = shift_Hz_per_m_s(radar), bin_Hz = radar->rate_Hz / LENGTH;
    const double high = fmin(radar->speed_high_m_s, 0.46 * radar->rate_Hz / shift);
    const double least = 4 * lowest_bins * bin_Hz / shift;
    if (high < least) {
        return refuse("rate_Hz", radar->rate_Hz, 202, 0.7 * radar->rate_Hz * high / least,
                      "fewer than five bins hold the speeds up to speed_high_m_s; sample slower, or allow a higher speed");
    }
    return refuse(0, 0, 0, 0, 0);
}
