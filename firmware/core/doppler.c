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
    // sum |X|^2 over positive bins = 2^18 gain^2 N sum(h^2)/2 var = 2^18 2^10 (256 * 96 / 2) var, less the shift by 8
    const float per_count2 = 268435456.0f * 12288.0f / 256.0f;
    return (float)sum < config->quiet_power_count2 * per_count2;
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
            out.fresh = true;
            out.quiet = is_quiet(config, power);
            out.speed_m_s = config->scale * argmax_speed(config->beam, power);
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
