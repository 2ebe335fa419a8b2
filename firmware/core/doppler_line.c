#include "doppler_line.h"

#include "fft_table.h"
#include "fixed.h"

enum { CELLS_A_CALL = 4, BLOCKS_LEAST = 16, THINK_EVERY = 4, LAST = 8, D_STEP = 4, ALL = DOPPLER_LINE_BLOCKS };

static const float share_found = 0.5f; // of (3)
static const float share_last = 0.25f; // of the last second: three standard deviations below 1 for a line as strong as the echo beside it
static const float share_lost = 0.25f; // a line as strong as the echo beside it has 0.5 and more

// cos(2 pi turn/2^32), Q15, at the nearest lower 256th of a turn: h of the Hann window is (1 - cos)/2.
static int32_t cos_q15(uint32_t turn)
{
    const uint32_t at = turn >> 24; // h[n], h[n + 64] stand side by side, and h[n + 128] = 1 - h[n]
    const int32_t cosine = ((1 << 27) - fft_hann_q28[2u * (at % 64u) + at / 64u % 2u]) >> 12;
    const int32_t held = cosine > 32767 ? 32767 : cosine < -32767 ? -32767 : cosine;
    return at < 128u ? held : -held;
}

static int32_t sin_q15(uint32_t turn) { return cos_q15(turn - (1u << 30)); }

static int32_t hold(int32_t value, int32_t most) { return value > most ? most : value < -most ? -most : value; }

static void forget(doppler_line_t *line)
{
    line->blocks = 0;
    line->thinks = 0;
    line->found = false;
}

void doppler_line_suggest(doppler_line_t *line, uint32_t bin)
{
    const uint32_t held = bin < 127u ? bin : 127u;
    const bool same = held + 1u >= line->bin && held <= line->bin + 1u;
    if (!line->found && !same) {
        forget(line);
        line->bin = held;
        line->re = 0;
        line->im = 0;
    }
}

// (1): C[h] of the block that ends.
static void end_block(doppler_line_t *line)
{
    const uint32_t h = (line->next / DOPPLER_LINE_BLOCK - 1u) % ALL;
    line->past_re[h] = (int16_t)hold(line->re / DOPPLER_LINE_BLOCK, 32767);
    line->past_im[h] = (int16_t)hold(line->im / DOPPLER_LINE_BLOCK, 32767);
    line->re = 0;
    line->im = 0;
    line->blocks = line->blocks < ALL ? line->blocks + 1 : ALL;
    if (line->blocks >= BLOCKS_LEAST && h % THINK_EVERY == 0u && line->thinks == 0u) {
        line->thinks = 1;
    }
}

void doppler_line_take(doppler_line_t *line, const doppler_line_span_t *span, int16_t *sample, int32_t *sum)
{
    if (line->bin == 0u) {
        line->next += (uint32_t)span->count;
        return;
    }
    const uint32_t per_sample = line->bin << 24;
    const int32_t most = 4 * 32767 * DOPPLER_LINE_BLOCK;
    const int32_t count = span->count;
    for (int32_t i = 0; i < count; i++) {
        const int32_t x = hold((int32_t)sample[i] - span->mean, 65535);
        const uint32_t turn = per_sample * line->next;
        line->re = hold(line->re, most) + ((x * cos_q15(turn)) >> 15);
        line->im = hold(line->im, most) - ((x * sin_q15(turn)) >> 15);
        if (line->found) { // (4)
            const uint32_t at = line->turn * line->next;
            const int32_t said = ((line->a_re * cos_q15(at)) >> 15) - ((line->a_im * sin_q15(at)) >> 15);
            const int32_t left = (int32_t)sample[i] - said;
            const int32_t held = left > span->high ? span->high : left < span->low ? span->low : left;
            *sum += held - (int32_t)sample[i];
            sample[i] = (int16_t)held;
        }
        line->next++;
        if (line->next % DOPPLER_LINE_BLOCK == 0u) {
            end_block(line);
        }
    }
}

void doppler_line_skip(doppler_line_t *line, uint32_t count)
{
    const uint32_t before = line->next / DOPPLER_LINE_BLOCK;
    line->next += count;
    if (line->next / DOPPLER_LINE_BLOCK != before) { // a block that did not end
        forget(line);
        line->re = 0;
        line->im = 0;
    }
}

typedef struct {
    int32_t re, im;
} sum_t;

// (2) over `count` blocks, the oldest one's number `first`.
static sum_t sum_of(const doppler_line_t *line, uint32_t first, uint32_t count, uint32_t turn)
{
    sum_t out = {0, 0};
    for (uint32_t j = 0; j < count; j++) {
        const uint32_t h = first + j;
        const int32_t re = line->past_re[h % ALL];
        const int32_t im = line->past_im[h % ALL];
        const int32_t c = cos_q15(turn * h);
        const int32_t s = sin_q15(turn * h);
        out.re += (re * c + im * s) >> 15;
        out.im += (im * c - re * s) >> 15;
    }
    return out;
}

static sum_t sum_at(const doppler_line_t *line, uint32_t first, uint32_t turn)
{
    return sum_of(line, first, (uint32_t)line->blocks < ALL ? (uint32_t)line->blocks : ALL, turn);
}

static uint64_t square_of(sum_t sum) { return (uint64_t)((int64_t)sum.re * sum.re) + (uint64_t)((int64_t)sum.im * sum.im); }

// (2) at u = c/32 for some c.
static void think_of_cells(doppler_line_t *line, uint32_t first, uint32_t from)
{
    int16_t cosine[ALL];
    for (uint32_t i = 0; i < ALL; i++) {
        cosine[i] = (int16_t)cos_q15(i << 27);
    }
    const uint32_t count = (uint32_t)line->blocks < ALL ? (uint32_t)line->blocks : ALL;
    for (uint32_t c = from; c < from + CELLS_A_CALL && c < ALL; c++) {
        sum_t sum = {0, 0};
        for (uint32_t j = 0; j < count; j++) {
            const uint32_t h = first + j;
            const int32_t re = line->past_re[h % ALL];
            const int32_t im = line->past_im[h % ALL];
            const int32_t along = cosine[c * h % ALL];
            const int32_t across = cosine[(c * h - ALL / 4u) % ALL];
            sum.re += (re * along + im * across) >> 15;
            sum.im += (im * along - re * across) >> 15;
        }
        line->cell[c] = (uint32_t)(square_of(sum) >> 12);
    }
}

// Where (2) is largest, from the cells and from two more sums half a cell beside the largest: a parabola of steps half a cell wide is right
// to a thirtieth of a cell. A multiple of 64, so that (4) keeps its phase where `next` wraps.
static uint32_t place(const doppler_line_t *line, uint32_t first)
{
    uint32_t best = 0;
    for (uint32_t c = 1; c < ALL; c++) {
        best = line->cell[c] > line->cell[best] ? c : best;
    }
    const uint32_t at = best << 27;
    const float most = (float)line->cell[best];
    const float up = (float)(uint32_t)(square_of(sum_at(line, first, at + (1u << 26))) >> 12);
    const float down = (float)(uint32_t)(square_of(sum_at(line, first, at - (1u << 26))) >> 12);
    const bool above = fixed_greater(up, most) && fixed_greater(up, down);
    const bool below = !above && fixed_greater(down, most);
    const float middle = above ? up : below ? down : most;
    const float right = above ? (float)line->cell[(best + 1u) % ALL] : below ? most : up;
    const float left = above ? most : below ? (float)line->cell[(best - 1u) % ALL] : down;
    const float bend = 2.0f * middle - right - left;
    const float aside = fixed_greater(bend, 0.0f) ? fixed_clamp((right - left) / (2.0f * bend), -0.5f, 0.5f) : 0.0f;
    const uint32_t centre = above ? at + (1u << 26) : below ? at - (1u << 26) : at;
    return centre + (uint32_t)((int32_t)(aside * (float)(1 << 20)) * 64);
}

// (3), (4)
static void decide(doppler_line_t *line, uint32_t first, uint32_t u)
{
    const sum_t S = sum_at(line, first, u);
    uint64_t power = 1;
    const uint32_t count = (uint32_t)line->blocks < ALL ? (uint32_t)line->blocks : ALL;
    for (uint32_t j = 0; j < count; j++) {
        const sum_t C = {line->past_re[(first + j) % ALL], line->past_im[(first + j) % ALL]};
        power += square_of(C);
    }
    const float share = (float)square_of(S) / ((float)count * (float)power);
    const sum_t last = sum_of(line, first + count - LAST, LAST, u); // a line that has ended is in no block since
    const float still = (float)S.re * (float)last.re + (float)S.im * (float)last.im;
    const float all = (float)square_of(S) * ((float)LAST / (float)count);
    line->found = fixed_greater(share, line->found ? share_lost : share_found) && fixed_greater(still, share_last * all);
    const int32_t per_sample = (int32_t)u / 64; // u from -1/2 to 1/2
    line->turn = (line->bin << 24) + (uint32_t)per_sample;
    sum_t D = {0, 0};
    for (uint32_t n = 2; n < DOPPLER_LINE_BLOCK; n += D_STEP) { // the middle of four: they turn by 1/32 at most
        D.re += cos_q15((uint32_t)per_sample * n) / (DOPPLER_LINE_BLOCK / D_STEP);
        D.im += sin_q15((uint32_t)per_sample * n) / (DOPPLER_LINE_BLOCK / D_STEP);
    }
    const float d_re = (float)D.re * (1.0f / 32768.0f);
    const float d_im = (float)D.im * (1.0f / 32768.0f);
    const float scale = 2.0f / ((float)count * (d_re * d_re + d_im * d_im)); // |D| is 0.63 or more
    line->a_re = (int32_t)fixed_clamp(scale * ((float)S.re * d_re + (float)S.im * d_im), -32767.0f, 32767.0f);
    line->a_im = (int32_t)fixed_clamp(scale * ((float)S.im * d_re - (float)S.re * d_im), -32767.0f, 32767.0f);
}

bool doppler_line_think(doppler_line_t *line)
{
    if (line->thinks == 0u || line->blocks < BLOCKS_LEAST) {
        return false;
    }
    const uint32_t first = line->next / DOPPLER_LINE_BLOCK - (uint32_t)(line->blocks < ALL ? line->blocks : ALL);
    if (line->thinks <= ALL) {
        think_of_cells(line, first, line->thinks - 1u);
        line->thinks += CELLS_A_CALL;
        return true;
    }
    if (line->thinks == ALL + 1u) {
        line->place = place(line, first);
        line->thinks++;
        return true;
    }
    decide(line, first, line->place);
    line->thinks = 0;
    return true;
}
