#include "doppler.h"

// Gain from ADC counts to the transform's input: 10 bit to within 1 bit of full scale.
enum { DOPPLER_GAIN = 32 };

// (1): the largest power in the template's band.
static float argmax_speed(const doppler_template_t *beam, const uint64_t *power)
{
    int32_t best = beam->first_bin;
    for (int32_t k = beam->first_bin; k < beam->first_bin + beam->bins && k < FFT_BINS; k++) {
        if (power[k] > power[best]) {
            best = k;
        }
    }
    return (float)best * (beam->sample_rate_Hz / (float)FFT_LENGTH) * beam->paper_m_s_per_Hz;
}

// True when the mean in-band power, as ADC counts squared, is below the noise.
static bool is_quiet(const doppler_config_t *config, const uint64_t *power)
{
    uint64_t sum = 0;
    const int32_t last = config->beam->first_bin + config->beam->bins;
    for (int32_t k = config->beam->first_bin; k < last && k < FFT_BINS; k++) {
        sum += power[k] >> 8;
    }
    // sum |X|^2 over positive bins = 2^18 gain^2 (N sum(h^2)/2) variance = 2^18 2^10 (256 * 96 / 2) variance, less the shift by 8
    const float per_count2 = 268435456.0f * 12288.0f / 256.0f;
    return (float)sum < config->quiet_power_count2 * per_count2;
}

// --- (2)

enum { COARSE = 4, BINS_MAX = 124 };

// J of one grid speed.
static int32_t cost(const doppler_template_t *beam, const int16_t *power, int32_t total, int32_t speed)
{
    const int16_t *inverse = beam->inverse + speed * beam->bins;
    int32_t sum = total * beam->volume[speed];
    for (int32_t k = 0; k < beam->bins; k += 4) {
        sum += power[k] * inverse[k];
        sum += power[k + 1] * inverse[k + 1];
        sum += power[k + 2] * inverse[k + 2];
        sum += power[k + 3] * inverse[k + 3];
    }
    return sum;
}

// Powers of the template's bins, reduced so that their sum has at most 15 bits; returns the sum.
static int32_t reduce(const doppler_template_t *beam, const uint64_t *power, int16_t *reduced)
{
    uint64_t sum = 0; // at most 124 * 2^61 / 2^8
    for (int32_t k = 0; k < beam->bins; k++) {
        sum += power[beam->first_bin + k] >> 8;
    }
    int32_t shift = 0;
    while (sum >> shift > 127u) {
        shift++;
    }
    int32_t total = 0;
    for (int32_t k = 0; k < beam->bins; k++) {
        reduced[k] = (int16_t)(power[beam->first_bin + k] >> shift); // sum < 128 * 2^8 = 2^15
        total += reduced[k];
    }
    return total;
}

// exp(x) for |x| <= 0.05: error below 3e-7.
static float exp_small(float x) { return 1.0f + x * (1.0f + x * (0.5f + x * (1.0f / 6.0f))); }

static float likelihood_speed(const doppler_template_t *beam, const uint64_t *power, bool *white)
{
    int16_t reduced[BINS_MAX];
    const int32_t total = reduce(beam, power, reduced);
    int32_t best = 0;
    int32_t least = INT32_MAX;
    for (int32_t i = COARSE / 2; i < beam->speeds; i += COARSE) {
        const int32_t J = cost(beam, reduced, total, i);
        if (J < least) {
            least = J;
            best = i;
        }
    }
    int32_t around[2 * COARSE + 1]; // J at best - COARSE .. best + COARSE
    const int32_t low = best - COARSE;
    int32_t fine = COARSE;
    around[fine] = least;
    for (int32_t j = 0; j <= 2 * COARSE; j++) {
        const int32_t i = low + j;
        around[j] = i < 0 || i >= beam->speeds ? INT32_MAX : cost(beam, reduced, total, i);
        fine = around[j] < around[fine] ? j : fine;
    }
    *white = around[fine] >= total * beam->quiet[low + fine];
    float offset = 0.0f;
    if (fine > 0 && fine < 2 * COARSE && around[fine - 1] != INT32_MAX && around[fine + 1] != INT32_MAX) {
        const float left = (float)around[fine - 1] - (float)around[fine];
        const float right = (float)around[fine + 1] - (float)around[fine];
        if (left + right > 0.0f) {
            offset = 0.5f * (left - right) / (left + right); // vertex of the parabola, within +-1/2
        }
    }
    return beam->speed_m_s[low + fine] * exp_small(offset * beam->log_step);
}

static void measure(const doppler_config_t *config, const uint64_t *power, doppler_output_t *out)
{
    bool white = false;
    const float speed_m_s = config->method == DOPPLER_LIKELIHOOD ? likelihood_speed(config->beam, power, &white)
                                                                 : argmax_speed(config->beam, power);
    out->speed_m_s = config->scale * speed_m_s;
    out->quiet = white || is_quiet(config, power);
    out->fresh = true;
}

doppler_output_t doppler_step(const doppler_config_t *config, doppler_state_t *state, const uint16_t *sample, int32_t count)
{
    doppler_output_t out = {false, false, 0.0f, 0};
    for (int32_t i = 0; i < count; i++) {
        const int32_t limited = sample[i] > 1023u ? 1023 : (int32_t)sample[i];
        if (state->filled < FFT_LENGTH) {
            state->sample[state->filled] = (int16_t)((limited - config->offset_count) * DOPPLER_GAIN);
            state->filled++;
        }
        if (state->filled == FFT_LENGTH) {
            uint64_t power[FFT_BINS];
            fft_power(state->sample, power);
            measure(config, power, &out);
            out.late_samples = count - 1 - i;
            const int32_t hop = config->hop >= 1 && config->hop <= FFT_LENGTH ? config->hop : FFT_LENGTH;
            for (int32_t j = hop; j < FFT_LENGTH; j++) {
                state->sample[j - hop] = state->sample[j];
            }
            state->filled = FFT_LENGTH - hop;
        }
    }
    return out;
}
