#include "doppler.h"

#include "fixed.h"

// Gain from ADC counts to the transform's input: 10 bit to within 1 bit of full scale.
enum { DOPPLER_GAIN = 32 };
enum { EARLY_TWICE = 128, EARLY_MIRRORED = 192, EARLY_YOUNGER = 64 }; // lengths of the early windows; by how many samples they are younger

// (1): the largest power of all bins but zero, as section 4 has it.
static float argmax_speed(const doppler_template_t *beam, const uint64_t *power)
{
    int32_t best = 1;
    for (int32_t k = 2; k < FFT_BINS; k++) {
        if (power[k] > power[best]) {
            best = k;
        }
    }
    return (float)best * (beam->sample_rate_Hz / (float)FFT_LENGTH) * beam->paper_m_s_per_Hz;
}

// --- (2)

enum { MADE_MAX = 80, RAILED_MAX = 128 }; // of 320 samples: a quarter, and two fifths (assumed)

enum { COARSE = 4, POWER_SUM_MAX = 128 * 256 + DOPPLER_BINS_MAX * 256 };

// J of one grid speed. It never wraps: J is linear in the powers, so its extremes have all power in one bin, and doppler_test
// tries every bin of every speed of every radar.
static int32_t cost(const doppler_template_t *beam, const int16_t *power, int32_t total, int32_t speed)
{
    const int16_t *inverse = beam->inverse + speed * beam->bins;
    return fixed_dot_product(total * beam->volume[speed], power, inverse, beam->bins);
}

// Mean power of bins [from, to) over 2^28: 100 of it are one ADC count^2 of white noise.
static uint32_t mean_power(const uint64_t *power, int32_t from, int32_t to)
{
    uint32_t sum = 0; // a full-scale line is 2^31 of it
    for (int32_t k = from; k < to; k++) {
        sum += (uint32_t)(power[k] >> 28);
    }
    return (uint32_t)((float)sum / (float)(to - from)); // no division of whole numbers: the target's library would stop at a divisor of 0
}

enum { SPARE_FROM = 96, BESIDE_LEAST = 32, LOUD = 400 }; // LOUD: 4 ADC count^2 of white noise, assumed

// What lies outside the template's bins: white noise, or an echo that is faster than they hold.
typedef struct {
    uint32_t in;     // mean power per bin of the band
    uint32_t beside; // between the band and SPARE_FROM
    uint32_t spare;  // from there on
    uint32_t noise;  // of both: the noise, unless an echo is there
    bool known;      // the band leaves room for them
    bool beyond;     // an echo is there
} outside_t;

// A mean over 32 bins of noise spreads by a quarter, so four times another one, three times in a row, is no chance.
static bool is_beyond(const outside_t *outside)
{
    const bool fast = outside->beside > 4u * outside->spare && 5u * (outside->beside - outside->spare) > outside->in;
    return outside->beside > LOUD && (fast || outside->beside > 3u * outside->in || outside->spare > 3u * outside->in);
}

static outside_t look_outside(const doppler_template_t *beam, const uint64_t *power)
{
    const int32_t end = beam->first_bin + beam->bins;
    outside_t out = {0};
    out.known = end + BESIDE_LEAST <= SPARE_FROM;
    if (out.known) {
        out.in = mean_power(power, beam->first_bin, end);
        out.beside = mean_power(power, end, SPARE_FROM);
        out.spare = mean_power(power, SPARE_FROM, FFT_BINS);
        out.noise = (out.beside + out.spare) / 2u;
        out.beyond = is_beyond(&out);
    }
    return out;
}

// Powers of the template's bins, less twice the noise (which leaves 0.14 of it), reduced so that each has at most 15 bits and their sum 16;
// returns the reduced sum. *energy is the sum of the powers over 2^22 (one ADC count^2 of variance is 12288 * 2^28 / 2^22 of it: 2^18 of
// the transform, 2^10 of the gain, 256 * 96 / 2 of the window).
static int32_t reduce(const doppler_template_t *beam, const uint64_t *power, uint64_t noise, int16_t *reduced, uint64_t *energy)
{
    uint64_t sum = 0; // at most 120 * 2^63 / 2^8
    const uint64_t *in = power + beam->first_bin;
    //@ loop unroll 120;
    for (int32_t k = 0; k < beam->bins; k++) {
        sum += in[k] >> 8;
    }
    *energy = sum >> 14;
    const uint32_t shift = (57u - (uint32_t)__builtin_clzll(sum | 127u)) & 63u; // sum >> shift is 64..127, or 0..127 unshifted
    const uint64_t floor = 2u * noise;
    uint32_t total = 0;
    //@ loop unroll 120;
    for (int32_t k = 0; k < beam->bins; k++) {
        const uint64_t echo = in[k] > floor ? in[k] - floor : 0u;
        const uint32_t low = (uint32_t)echo;
        const uint32_t high = (uint32_t)(echo >> 32);
        const uint32_t whole = shift >= 32u ? high >> (shift - 32u) : shift == 0u ? low : (low >> shift) | high << (32u - shift);
        const uint32_t value = whole & 0x7fffu; // takes nothing away: sum < 128 * 2^shift, so whole < 128 * 2^8
        reduced[k] = (int16_t)value;
        total += value;
    }
    return total < POWER_SUM_MAX ? (int32_t)total : POWER_SUM_MAX; // nor does this: 128 * 2^8 and 2^8 that >> 8 dropped per bin
}

// exp(x) for |x| <= 0.05: error below 3e-7.
static float exp_small(float x) { return 1.0f + x * (1.0f + x * (0.5f + x * (1.0f / 6.0f))); }

// Spectra narrower than four steps of the grid are missed between two of them: the largest power tells the place, to a bin.
static int32_t peak_speed(const doppler_template_t *beam, const int16_t *reduced)
{
    int32_t best = 0;
    for (int32_t k = 1; k < beam->bins; k++) {
        best = reduced[k] > reduced[best] ? k : best;
    }
    const int32_t at = (int32_t)beam->start[best];
    return at < 0 ? 0 : at >= beam->speeds ? beam->speeds - 1 : at;
}

static float likelihood_speed(const doppler_template_t *beam, const int16_t *reduced, int32_t total, bool *white, bool *top, float *fit)
{
    int32_t best = beam->from_peak ? peak_speed(beam, reduced) : 0;
    int32_t least = beam->from_peak ? cost(beam, reduced, total, best) : INT32_MAX;
    for (int32_t i = COARSE / 2; i < beam->speeds && !beam->from_peak; i += COARSE) {
        const int32_t J = cost(beam, reduced, total, i);
        if (J < least) {
            least = J;
            best = i;
        }
    }
    //@ split best;
    int32_t around[2 * COARSE + 1]; // J at best - COARSE .. best + COARSE
    const int32_t low = best - COARSE;
    int32_t fine = COARSE;
    around[fine] = least;
    //@ loop unroll 9;
    for (int32_t j = 0; j <= 2 * COARSE; j++) {
        const int32_t i = low + j;
        if (j == COARSE) {
            continue;
        }
        around[j] = i < 0 || i >= beam->speeds ? INT32_MAX : cost(beam, reduced, total, i);
        fine = around[j] < around[fine] ? j : fine;
    }
    *white = around[fine] >= total * beam->quiet[low + fine];
    *top = low + fine == beam->speeds - 1;
    *fit = ((float)around[fine] / (float)(total > 0 ? total : 1) - (float)beam->volume[low + fine]) / (float)beam->exact;
    float offset = 0.0f;
    if (fine > 0 && fine < 2 * COARSE && around[fine - 1] != INT32_MAX && around[fine + 1] != INT32_MAX) {
        const float left = (float)around[fine - 1] - (float)around[fine];
        const float right = (float)around[fine + 1] - (float)around[fine];
        if (left + right > 0.0f) {
            offset = 0.5f * (left - right) / (left + right); // vertex of the parabola, within +-1/2
        }
    }
    const float at = beam->speed_m_s[low + fine];
    return beam->line ? at + offset * beam->log_step : at * exp_small(offset * beam->log_step);
}

static const float made_trust = 0.05f; // [1] per filled sample of 320
static const float railed_trust = 0.02f;
static const float noise_trust = 4.0f; // [1] R = R0 (1 + this noise/echo), powers of the band

// --- (3)

enum {
    LINE_FROM = 8,
    LINE_SIDE = 4,
    LINE_SWAY_Q8 = 90,
    LINE_ABOVE_Q8 = 512,
    LINE_LEAP_Q8 = 1024,
    LINE_LEAPS_ON_Q8 = 128,
    SWAY_LEAPT_Q8 = 256,
    STEADY_BELOW_Q8 = 1024,
    LEVEL_SHARE = 8,
    SWAY_START_Q8 = 512,
    LINE_DUE = 5,
    TONE_FROM = 12
};

// log2 of a power, Q8, its mantissa as a straight line: within 0.09.
static int32_t log2_q8(uint64_t power)
{
    const uint64_t one = power | 1u;
    const int32_t exponent = 63 - __builtin_clzll(one);
    const uint64_t mantissa = exponent >= 8 ? one >> (exponent - 8) : one << (8 - exponent);
    return exponent * 256 + (int32_t)(mantissa & 255u);
}

static uint64_t power_of(int32_t log2_q8)
{
    const int32_t exponent = log2_q8 >> 8;
    const uint64_t mantissa = (uint64_t)256u + ((uint32_t)log2_q8 & 255u);
    return exponent >= 8 ? mantissa << ((uint32_t)(exponent - 8) & 63u) : mantissa >> ((uint32_t)(8 - exponent) & 63u);
}

static bool is_line(const doppler_state_t *state, int32_t k) { return (state->line[(uint32_t)k / 32u] >> ((uint32_t)k % 32u) & 1u) != 0u; }

enum { REST = 5, LOOK_LEAST_S = 3 }; // ticks that the filter has after a value; a scatterer is in the beam for less time than that
enum { LINE_REST_BITS = 3 };         // a line's rest: 9 dB below it, as its first fit may leave (outdoors_test)
enum { TONE_ASIDE = 2 };             // bins by which a line may lie beside the one that is looked at, doppler_line.h
// An echo of YOUNG_FROM bins and more is as wide as a line's ring; the search inside the echo has its blocks by YOUNG_SAMPLES.
enum { YOUNG_FROM = 16, YOUNG_SAMPLES = (DOPPLER_LINE_BLOCKS + 4) * DOPPLER_LINE_BLOCK };
enum { RELIEF_VALUES = 6, RELIEF_MIXED = 2 }; // a window that is rid of the line wholly has come by then; above that, with hops of 64, not

static bool any_line(const doppler_state_t *state) { return (state->line[0] | state->line[1] | state->line[2] | state->line[3]) != 0u; }

// Whether the lines hold more than half of what the other bins do: the five bins around each, as without_lines has it.
static bool lines_prevail(const doppler_template_t *beam, const doppler_state_t *state)
{
    uint64_t all = 0;
    uint64_t lines = 0;
    int32_t until = -1; // bins up to there are a line's
    for (int32_t k = 0; k < beam->first_bin + beam->bins; k++) {
        until = k + 2 < FFT_BINS && is_line(state, k + 2) ? k + 4 : until;
        all += state->power[k] >> 8;
        lines += k <= until ? state->power[k] >> 8 : 0u;
    }
    return 3u * lines > all;
}

static void watch_lines(const doppler_template_t *beam, doppler_state_t *state)
{
    const int32_t end = beam->first_bin + beam->bins;
    int32_t loudest = LINE_FROM - LINE_SIDE;
    int32_t most = INT32_MIN;
    int32_t steadiest = LINE_FROM;
    const bool known_long = state->leveled && state->tone.next >= YOUNG_SAMPLES; // before, a level may be that of a fade
    for (int32_t k = LINE_FROM - LINE_SIDE; k < end; k++) {
        const int32_t level = log2_q8(state->power[k]);
        const int32_t rises = level - (state->leveled ? state->level_q8[k] : level);
        const bool leapt = state->sway_q8[k] == SWAY_LEAPT_Q8;
        const bool leaps = known_long && rises > (leapt ? LINE_LEAPS_ON_Q8 : LINE_LEAP_Q8);
        const int32_t away = leaps ? 0 : rises;
        const int32_t sway = !state->leveled ? SWAY_START_Q8 : leaps ? SWAY_LEAPT_Q8 : state->sway_q8[k];
        const int32_t mean = level - away + away / LEVEL_SHARE;
        loudest = mean > most ? k : loudest;
        most = mean > most ? mean : most;
        state->level_q8[k] = (int16_t)mean;
        state->sway_q8[k] = (int16_t)(leaps ? sway : sway + ((away < 0 ? -away : away) - sway) / LEVEL_SHARE);
    }
    state->leveled = true;
    const bool known = any_line(state);
    for (int32_t i = 0; i < 4; i++) {
        state->line[i] = 0;
    }
    for (int32_t k = LINE_FROM; k < end - LINE_SIDE; k++) {
        steadiest = state->sway_q8[k] < state->sway_q8[steadiest] ? k : steadiest;
        const int32_t at = state->level_q8[k];
        const int32_t above = at - LINE_ABOVE_Q8;
        const bool apart = above > state->level_q8[k - LINE_SIDE] && above > state->level_q8[k + LINE_SIDE];
        const bool peak = at >= state->level_q8[k - 1] && at > state->level_q8[k + 1] && at > most - STEADY_BELOW_Q8;
        if (state->sway_q8[k] < LINE_SWAY_Q8 && (apart || (peak && !beam->from_peak))) {
            state->line[(uint32_t)k / 32u] |= 1u << ((uint32_t)k % 32u);
        }
    }
    state->weigh_lines = !known && any_line(state);
    // Of a narrow beam an echo at constant speed is as narrow as a line; at the band's edge the line may be one that lies beyond. A place
    // that was the loudest is no longer looked at: what is heard there is the skirt of an echo that is slower now.
    if (!beam->from_peak) {
        const bool steady = state->sway_q8[steadiest] < LINE_SWAY_Q8 && state->level_q8[steadiest] > most - STEADY_BELOW_Q8;
        const int32_t looked = steady ? steadiest : loudest;
        const bool inside = (steady || loudest >= TONE_FROM) && looked < end - TONE_ASIDE;
        const bool long_enough = beam->sample_rate_Hz * (float)LOOK_LEAST_S <= (float)(DOPPLER_LINE_BLOCKS * DOPPLER_LINE_BLOCK);
        doppler_line_suggest(&state->tone, inside && long_enough ? (uint32_t)looked : 0u);
    }
}

// What the sum of a window can be. It is that anyway: a bound that needs no relation between the sum and the samples.
static int32_t held_sum(int32_t sum)
{
    const int32_t most = FFT_LENGTH * 32767;
    return sum > most ? most : sum < -most ? -most : sum;
}

enum { CLEAN_LEAST = 24, CLEAN_MOST = 64, SAMPLE_LOW = -512 * DOPPLER_GAIN, SAMPLE_HIGH = 511 * DOPPLER_GAIN };

// Takes the line off some of what has come since the last time; in ticks that have time, of which there are five or more between two
// values. True where there was little.
static bool clean(const doppler_config_t *config, doppler_state_t *state)
{
    const int32_t waiting = state->filled - state->clean;
    const int32_t some = (5 * config->per_tick_q8) / 256;
    const int32_t most = some < CLEAN_LEAST ? CLEAN_LEAST : some > CLEAN_MOST ? CLEAN_MOST : some;
    const doppler_line_span_t span = {
        .count = waiting < most ? waiting : most, .mean = state->sum / FFT_LENGTH, .low = SAMPLE_LOW, .high = SAMPLE_HIGH};
    if (span.count <= 0 || state->clean < 0 || state->clean > FFT_LENGTH - span.count) {
        return true;
    }
    int32_t sum = state->sum;
    doppler_line_take(&state->tone, &span, state->window.sample + state->clean, &sum);
    state->sum = held_sum(sum);
    state->clean += span.count;
    return 2 * span.count < most;
}

// The window's powers without the lines. Returns `copy`, or the powers themselves where there is no line.
static const uint64_t *without_lines(const doppler_template_t *beam, const doppler_state_t *state, uint64_t *copy)
{
    if (!any_line(state)) {
        return state->power;
    }
    for (int32_t k = 0; k < FFT_BINS; k++) {
        copy[k] = state->power[k];
    }
    for (int32_t k = LINE_FROM; k < beam->first_bin + beam->bins - LINE_SIDE; k++) {
        if (is_line(state, k)) {
            const int32_t below = log2_q8(copy[k - 3]); // there, a line next to this one is gone already
            const int32_t step = (log2_q8(state->power[k + 3]) - below) / 6;
            for (int32_t j = 1; j <= 5; j++) {
                copy[k - 3 + j] = power_of(below + step * j);
            }
        }
    }
    return copy;
}

static const float misfit_calm = 0.8f; // [1] of (3)'s comment
static const float misfit_strange = 2.5f;
static const float misfit_share = 0.3f; // [1] of the speed per unit of misfit: heave of 5 mm at 8 Hz makes 0.16 to 0.39

// Of a line, in the units of reduce's energy: a count^2 of variance is 12288 * 64, and a is in counts times the gain.
static uint64_t line_power(const doppler_line_t *line)
{
    const uint64_t square = (uint64_t)((int64_t)line->a_re * line->a_re) + (uint64_t)((int64_t)line->a_im * line->a_im);
    return square * (12288u * 64u / (2u * DOPPLER_GAIN * DOPPLER_GAIN));
}

// Whether half of what is heard is no more than a line may leave that was taken off, at its place; or a line that is not known well
// enough yet to be taken off. An echo there is hidden as well.
static bool is_rest(const doppler_state_t *state, uint64_t energy)
{
    const bool left = state->tone.found && line_power(&state->tone) >> LINE_REST_BITS >= energy;
    const bool young = !state->tone.found && state->young_bin > 0;
    if (!left && !young) {
        return false;
    }
    const int32_t middle = left ? (int32_t)((state->tone.turn + (1u << 23)) >> 24) : state->young_bin;
    uint64_t near = 0;
    for (int32_t k = middle - LINE_SIDE; k <= middle + LINE_SIDE; k++) {
        near += k >= 0 && k < FFT_BINS ? state->power[k] >> 22 : 0u;
    }
    return 2u * near > energy;
}

enum { OUTSIDE_LINES = 3, LINE_NEAR = 2, LINE_RING = 8, LINE_FAR_TIMES = 8, LINE_RING_SHARE = 16, RING_SPREAD = 13 };

// The line at `peak` taken out of the powers [from, FFT_BINS), if it is one: its ring, the bins beside its five, is no louder than the
// others but for a sixteenth of the line and three standard deviations of noise; a fast echo is as wide as it is fast. `sum` and `bins` are
// of what is left.
static bool take_line(uint32_t *left, int32_t from, int32_t peak, uint32_t *sum, int32_t *bins)
{
    uint32_t near = 0;
    uint32_t ring = 0;
    int32_t in_near = 0;
    int32_t in_ring = 0;
    for (int32_t k = peak - LINE_RING < from ? from : peak - LINE_RING; k <= peak + LINE_RING && k < FFT_BINS; k++) {
        const bool inside = k >= peak - LINE_NEAR && k <= peak + LINE_NEAR;
        near += inside ? left[k] : 0u;
        ring += inside ? 0u : left[k];
        in_near += inside ? 1 : 0;
        in_ring += inside ? 0 : 1;
    }
    const float far = (float)(*sum - near - ring) / (float)(*bins - in_near - in_ring);
    const bool loud = (float)left[peak] > (float)LINE_FAR_TIMES * far;
    if (!loud || (float)LINE_RING_SHARE * ((float)ring - (float)(in_ring + RING_SPREAD) * far) > (float)near) {
        return false;
    }
    for (int32_t k = peak - LINE_NEAR < from ? from : peak - LINE_NEAR; k <= peak + LINE_NEAR && k < FFT_BINS; k++) {
        left[k] = 0;
    }
    *sum -= near;
    *bins -= in_near;
    return true;
}

// Whether it is lines, three at most (a lamp's 100 Hz and its harmonics), that are loud beyond the band, and what noise they leave there.
static void watch_outside(const doppler_template_t *beam, doppler_state_t *state)
{
    uint32_t left[FFT_BINS];
    const int32_t end = beam->first_bin + beam->bins;
    const int32_t from = end - LINE_RING; // a line at the band's edge is heard on both sides
    uint32_t sum = 0;                     // a full-scale line is 2^31 of it
    for (int32_t k = from; k < FFT_BINS; k++) {
        left[k] = (uint32_t)(state->power[k] >> 28);
        sum += left[k];
    }
    int32_t bins = FFT_BINS - from;
    int32_t lines = 0;
    bool taken = true;
    for (int32_t looks = 0; taken && looks < OUTSIDE_LINES; looks++) {
        int32_t peak = from;
        for (int32_t k = from; k < FFT_BINS; k++) {
            peak = left[k] > left[peak] ? k : peak;
        }
        taken = take_line(left, from, peak, &sum, &bins);
        lines += taken ? 1 : 0;
    }
    outside_t outside = {.in = mean_power(state->power, beam->first_bin, end)};
    for (int32_t k = end; k < FFT_BINS; k++) {
        outside.beside += k < SPARE_FROM ? left[k] : 0u;
        outside.spare += k < SPARE_FROM ? 0u : left[k];
    }
    outside.beside = (uint32_t)((float)outside.beside / (float)(SPARE_FROM - end));
    outside.spare = (uint32_t)((float)outside.spare / (float)(FFT_BINS - SPARE_FROM));
    state->outside_lines = lines > 0 && !is_beyond(&outside);
    state->outside_noise = (uint32_t)((float)sum / (float)bins);
}

// A line inside the echo is found within four seconds. Until then a line is what is as narrow as one at a place where no echo is.
static void watch_young(doppler_state_t *state)
{
    uint32_t left[FFT_BINS];
    uint32_t sum = 0;
    int32_t peak = LINE_FROM;
    for (int32_t k = LINE_FROM; k < FFT_BINS; k++) {
        left[k] = (uint32_t)(state->power[k] >> 28);
        sum += left[k];
        peak = left[k] > left[peak] ? k : peak;
    }
    int32_t bins = FFT_BINS - LINE_FROM;
    state->young_bin = peak >= YOUNG_FROM && take_line(left, LINE_FROM, peak, &sum, &bins) ? peak : 0;
}

static void measure(const doppler_config_t *config, doppler_state_t *state, doppler_output_t *out)
{
    int16_t reduced[DOPPLER_BINS_MAX] __attribute__((aligned(8)));
    uint64_t energy = 0;
    bool white = false;
    bool top = false;
    float fit = 0.0f;
    out->fresh = true;
    out->trust = 1.0f;
    if (config->method == DOPPLER_ARGMAX) {
        reduce(config->beam, state->power, 0, reduced, &energy);
        out->speed_m_s = config->scale * argmax_speed(config->beam, state->power);
        out->quiet = energy < (uint64_t)config->quiet_power_count2 * (12288u * 64u);
        return;
    }
    const outside_t none = {0};
    uint64_t copy[FFT_BINS];
    const uint64_t *const power = without_lines(config->beam, state, copy);
    outside_t outside = state->halved ? none : look_outside(config->beam, power); // twice each sample: images up there
    const bool lines = state->outside_lines;
    state->weigh_outside = outside.beyond;
    if (lines) {
        outside.noise = state->outside_noise;
        outside.beyond = false;
    }
    const int32_t total = reduce(config->beam, power, (uint64_t)(outside.beyond ? 0u : outside.noise) << 28, reduced, &energy);
    const float speed_m_s = likelihood_speed(config->beam, reduced, total, &white, &top, &fit);
    out->misfit = misfit_share * fixed_clamp(fit - misfit_calm, 0.0f, 10.0f);
    out->strange = fit > misfit_strange;
    const bool noise = outside.known && outside.in < 2u * outside.noise;
    out->speed_m_s = config->scale * speed_m_s;
    out->quiet = !outside.beyond && (white || noise || energy < (uint64_t)config->quiet_power_count2 * (12288u * 64u));
    out->rest = !out->quiet && is_rest(state, energy);
    state->weigh_young = !state->halved && state->tone.next < YOUNG_SAMPLES;
    state->young_bin = state->weigh_young ? state->young_bin : 0;
    out->relieved = state->relief > 0 && (state->relief_masked || line_power(&state->tone) > energy / 2u);
    const bool edge = top && !out->quiet && !out->rest && outside.in > 3u * outside.noise;
    out->beyond = outside.beyond || (edge && !lines);
    const bool mixed = state->relief > RELIEF_MIXED && !state->relief_masked && line_power(&state->tone) > energy / 8u;
    out->rest = out->rest || (edge && lines) || (mixed && !out->quiet);
    state->weigh_outside = state->weigh_outside || edge;
    state->outside_lines = lines && state->weigh_outside;
    if (outside.known && !out->quiet && outside.in > outside.noise) {
        const float share = (float)outside.noise / (float)(outside.in - outside.noise);
        out->trust = 1.0f + noise_trust * share;
    }
}

// Drops the oldest `hop` samples.
static void slide(doppler_state_t *state, int32_t hop)
{
    int32_t gone = 0;
    int32_t j = 0;
    for (; j + 4 <= hop; j += 4) { // a sum of four costs half of four sums
        const int16_t *four = state->window.sample + j;
        gone += four[0] + four[1] + four[2] + four[3];
    }
    for (; j < hop; j++) {
        gone += state->window.sample[j];
    }
    state->sum = held_sum(state->sum - gone);
    if (hop % 4 == 0) {
        for (j = hop / 4; j < FFT_LENGTH / 4; j++) {
            state->window.four[j - hop / 4] = state->window.four[j];
        }
    } else {
        for (j = hop; j < FFT_LENGTH; j++) {
            state->window.sample[j - hop] = state->window.sample[j];
        }
    }
    state->filled = FFT_LENGTH - hop;
    if (state->clean < hop) {
        doppler_line_skip(&state->tone, (uint32_t)(hop - state->clean));
    }
    state->clean = state->clean < hop ? 0 : state->clean - hop;
}

static const float halved_least_m_s =
    0.085f; // [m/s] just above twice the grid's lowest speed, where half a window hears the converter's offset

static void mirror(doppler_state_t *state)
{
    for (int32_t j = EARLY_MIRRORED; j < FFT_LENGTH; j++) {
        state->window.sample[j] = state->window.sample[2 * EARLY_MIRRORED - 1 - j];
    }
}

enum { MEAN_MOST = 384 * DOPPLER_GAIN }; // beyond, the echo stands at the rail; and no difference fills 16 bits

static void transform(const doppler_config_t *config, doppler_state_t *state, bool halved, int32_t late_samples)
{
    const int32_t sum = state->sum;
    const int32_t offset = state->filled == EARLY_TWICE      ? sum / EARLY_TWICE
                           : state->filled == EARLY_MIRRORED ? sum / EARLY_MIRRORED
                                                             : sum / FFT_LENGTH;
    const int32_t mean = offset > MEAN_MOST ? MEAN_MOST : offset < -MEAN_MOST ? -MEAN_MOST : offset;
    if (config->method == DOPPLER_ARGMAX) {
        fft_power_flat(state->window.sample, mean, state->power); // the paper windows nothing
    } else {
        fft_power_about(halved ? state->twice : state->window.sample, mean, state->power);
    }
    state->pending = true;
    state->due = 0; // the powers of the window before are gone
    state->halved = halved;
    state->late_samples = late_samples;
}

// Until the window has been full once, two early windows. Of 128 samples each is taken twice: half the frequency, and half the Doppler
// shift, so the template holds (but for the band-pass, whose lower edge lies at half the frequency too). Of 192 the missing part is
// the mirror image of what there is: the same frequencies, no step, no influence of the offset. Either has a smaller mean age over the
// square of the Hann window, 63.25 and 63.9 samples of 127.5.
static void transform_early(const doppler_config_t *config, doppler_state_t *state, int32_t late_samples)
{
    if (state->full || (state->filled != EARLY_TWICE && state->filled != EARLY_MIRRORED)) {
        return;
    }
    if (state->filled == EARLY_MIRRORED) {
        mirror(state);
    }
    transform(config, state, state->filled == EARLY_TWICE, late_samples - EARLY_YOUNGER);
}

// Noise of 1 count rms spans 5 counts in 64 samples, of 0.3 counts 2: below that the converter hears nothing that is alive (assumed).
enum { DEAD_SPAN = 3 * DOPPLER_GAIN, DEAD_BLOCKS = 2 };

static void watch_span(doppler_state_t *state, int16_t value)
{
    if (state->in_block == 0) {
        state->low = value;
        state->high = value;
    }
    state->low = value < state->low ? value : state->low;
    state->high = value > state->high ? value : state->high;
    if (state->in_block == DOPPLER_BLOCK - 1) {
        const bool dead = state->high - state->low <= DEAD_SPAN;
        state->dead_blocks = !dead ? 0 : state->dead_blocks + (state->dead_blocks < DEAD_BLOCKS ? 1 : 0);
    }
}

// One sample into the window; `late_samples` more follow in this call.
static void take(const doppler_config_t *config, doppler_state_t *state, int16_t value, bool made, bool railed, int32_t late_samples)
{
    if (state->in_block == DOPPLER_BLOCK) {
        state->in_block = 0;
        state->block = (state->block + 1) % DOPPLER_BLOCKS;
        state->made[state->block] = 0;
        state->railed[state->block] = 0;
    }
    watch_span(state, value);
    state->in_block++;
    state->made[state->block] += made ? 1 : 0;
    state->railed[state->block] += railed ? 1 : 0;
    state->last = value;
    state->window.sample[state->filled] = value;
    state->sum = held_sum(state->sum + value);
    if (state->full) {
        state->filled++;
    } else {
        if (state->filled < EARLY_TWICE) {
            state->twice[2 * state->filled] = value;
            state->twice[2 * state->filled + 1] = value;
        }
        state->filled++;
        if (config->method == DOPPLER_LIKELIHOOD) {
            transform_early(config, state, late_samples);
        }
    }
    if (state->filled == FFT_LENGTH) {
        transform(config, state, false, late_samples);
        state->full = true;
        slide(state, config->hop >= 1 && config->hop <= FFT_LENGTH ? config->hop : FFT_LENGTH);
    }
}

static int16_t value_of(const doppler_config_t *config, uint16_t sample)
{
    const int32_t limited = sample > 1023u ? 1023 : (int32_t)sample;
    return (int16_t)((limited - config->offset_count) * DOPPLER_GAIN);
}

static void empty(doppler_state_t *state)
{
    const doppler_state_t zero = {0};
    const uint32_t next = state->next_sequence;
    *state = zero;
    state->next_sequence = next;
    state->started = true;
}

enum {
    OWED_MAX = 32 * 256,
    OWED_LEAST = 640,
    FORGET_BITS = 9
}; // Q8: 32 samples, 2.5 samples; 512 ticks: 1.2 % off the rate owes 32 samples

int32_t doppler_missing(const doppler_config_t *config, doppler_state_t *state, const doppler_arrival_t *arrival)
{
    const int32_t count = arrival->count < 0 ? 0 : arrival->count > DOPPLER_SAMPLES_MAX ? DOPPLER_SAMPLES_MAX : arrival->count;
    const int32_t ticks = arrival->elapsed_ticks < 1000u ? (int32_t)arrival->elapsed_ticks : 1000;
    state->owed_q8 += ticks * config->per_tick_q8 - count * 256;
    state->owed_q8 -= state->owed_q8 / (1 << FORGET_BITS);
    state->owed_q8 = state->owed_q8 > 8 * OWED_MAX ? 8 * OWED_MAX : state->owed_q8 < -8 * OWED_MAX ? -8 * OWED_MAX : state->owed_q8;
    if (count == 0) {
        return 0;
    }
    const bool numbered = arrival->sequence != 0u;
    const uint32_t gap = arrival->sequence - state->next_sequence;
    int32_t missing = 0;
    if (!state->started) {
        state->owed_q8 = 0;
    } else if (numbered) {
        missing = gap > (uint32_t)DOPPLER_GAP_MAX ? DOPPLER_GAP_MAX + 1 : (int32_t)gap;
    } else if (state->owed_q8 >= OWED_LEAST) {
        missing = state->owed_q8 / 256;
    }
    state->owed_q8 = missing > DOPPLER_GAP_MAX ? 0 : state->owed_q8 - missing * 256;
    state->next_sequence = arrival->sequence + (uint32_t)count;
    state->started = true;
    return missing;
}

void doppler_gap(const doppler_config_t *config, doppler_state_t *state, int32_t missing, uint16_t next)
{
    if (missing <= 0) {
        return;
    }
    if (missing > DOPPLER_GAP_MAX || (state->filled == 0 && !state->full)) {
        empty(state);
        return;
    }
    const bool pending = state->pending;
    const int32_t from = state->last;
    const float step = (float)(value_of(config, next) - from) / (float)(missing + 1);
    state->pending = false;
    for (int32_t j = 1; j <= missing; j++) {
        take(config, state, (int16_t)(from + (int32_t)(step * (float)j)), true, false, missing - j);
    }
    state->hold = state->pending;
    if (pending && !state->pending) {
        state->pending = true;
        state->late_samples += missing;
    }
}

doppler_output_t doppler_step(const doppler_config_t *config, doppler_state_t *state, const uint16_t *sample, int32_t count)
{
    doppler_output_t out = {0};
    if (state->hold) { // no tick pays for a transform and a search
        state->hold = false;
        state->late_samples += count > 0 ? count : 0;
    } else if (state->pending) {
        int32_t made = 0;
        int32_t railed = 0;
        for (int32_t i = 0; i < DOPPLER_BLOCKS; i++) {
            made += state->made[i];
            railed += state->railed[i];
        }
        measure(config, state, &out);
        if (state->halved) {
            out.speed_m_s *= 2.0f;
            out.quiet = out.quiet || fixed_greater(halved_least_m_s * config->beam->deaf, out.speed_m_s);
        }
        out.trust += made_trust * (float)made + railed_trust * (float)railed;
        const bool off_rate = state->owed_q8 > OWED_MAX || state->owed_q8 < -OWED_MAX;
        state->relief -= state->relief > 0 ? 1 : 0;
        state->relief_masked = state->relief_masked && state->relief > 0;
        out.spoilt = (out.strange && !out.quiet) || out.rest || made > MADE_MAX || railed > RAILED_MAX || off_rate;
        out.relieved = out.relieved && !out.spoilt && !out.quiet;
        out.late_samples = state->late_samples + (count > 0 ? count : 0);
        state->due = state->halved || config->beam->line || config->method == DOPPLER_ARGMAX ? 0 : LINE_DUE;
        state->pending = false;
    }
    bool busy = out.fresh;
    if (state->due > 0 && --state->due == 0) {
        watch_lines(config->beam, state);
        busy = true;
    }
    for (int32_t i = 0; i < count; i++) {
        const bool railed = sample[i] == 0u || (int32_t)sample[i] >= config->max_count;
        take(config, state, value_of(config, sample[i]), false, railed, count - 1 - i);
    }
    out.busy = state->pending;
    state->rest = out.fresh ? REST : state->rest > 0 ? state->rest - 1 : 0;
    const bool idle = !busy && !out.busy && state->rest == 0;
    if (idle && state->weigh_outside) {
        state->weigh_outside = false;
        watch_outside(config->beam, state);
    } else if (idle && state->weigh_young) {
        state->weigh_young = false;
        watch_young(state);
    } else if (idle && state->weigh_lines) {
        state->weigh_lines = false;
        state->relief_masked = lines_prevail(config->beam, state);
        state->relief = state->relief_masked ? RELIEF_VALUES : state->relief;
    } else if (idle && state->full && config->method == DOPPLER_LIKELIHOOD && clean(config, state)) {
        const bool known = state->tone.found;
        (void)doppler_line_think(&state->tone);
        const bool found = state->tone.found && !known;
        state->relief = found ? RELIEF_VALUES : state->relief;
        state->relief_masked = state->relief_masked && !found;
    }
    out.dead = state->dead_blocks >= DEAD_BLOCKS;
    return out;
}
