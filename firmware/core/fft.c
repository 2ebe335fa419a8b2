#include "fft.h"

#include "fft_table.h"
#include "fixed.h"

enum { STRIDE = 32, COS_45_Q15 = 23170 }; // distance of the four sub-transforms of any stage [complex words]; cos(pi/4), Q15

// Two 32-bit numbers, on ARMv5TE in a 64-bit word, the first in the low half: one load or store. A transform of length m has
// m/2 words: (X[0], X[m/2]), then (Re X[k], Im X[k]) for k = 1..m/2-1.
#if FIXED_ARM_DSP
typedef uint64_t word_t;
static inline int32_t first_of(word_t word) { return (int32_t)(uint32_t)word; }
static inline int32_t second_of(word_t word) { return (int32_t)(uint32_t)(word >> 32); }
// One LDRD or STRD, and two sums made in the register pair that is stored. The compiler would use two single moves each.
static inline word_t load(const word_t *from)
{
    word_t word;
    __asm__("ldrd %0, %H0, [%1]" : "=r"(word) : "r"(from), "m"(*from));
    return word;
}
static inline void store(word_t *to, word_t word) { __asm__("strd %1, %H1, [%2]" : "=m"(*to) : "r"(word), "r"(to)); }
static inline void store_power(uint64_t *to, uint64_t power) { store(to, power); }
#define WORD_OF(name, first, second)                                                                                                       \
    static inline word_t name(int32_t a, int32_t b, int32_t c, int32_t d)                                                                  \
    {                                                                                                                                      \
        word_t word;                                                                                                                       \
        __asm__(first " %Q0, %1, %2\n\t" second " %R0, %3, %4" : "=&r"(word) : "r"(a), "r"(b), "r"(c), "r"(d));                            \
        return word;                                                                                                                       \
    }
WORD_OF(add_add, "add", "add")
WORD_OF(add_sub, "add", "sub")
WORD_OF(sub_add, "sub", "add")
WORD_OF(sub_sub, "sub", "sub")
static inline uint64_t square_sum(int32_t re, int32_t im)
{
    uint64_t sum;
    __asm__("smull %Q0, %R0, %1, %1\n\tsmlal %Q0, %R0, %2, %2" : "=&r"(sum) : "r"(re), "r"(im));
    return sum;
}
#else
typedef struct {
    int32_t first, second;
} word_t;
static inline int32_t first_of(word_t word) { return word.first; }
static inline int32_t second_of(word_t word) { return word.second; }
static inline word_t load(const word_t *from) { return *from; }
static inline void store(word_t *to, word_t word) { *to = word; }
static inline void store_power(uint64_t *to, uint64_t power) { *to = power; }
static inline word_t word_of(int32_t first, int32_t second)
{
    const word_t word = {first, second};
    return word;
}
static inline word_t add_add(int32_t a, int32_t b, int32_t c, int32_t d) { return word_of(a + b, c + d); }
static inline word_t add_sub(int32_t a, int32_t b, int32_t c, int32_t d) { return word_of(a + b, c - d); }
static inline word_t sub_add(int32_t a, int32_t b, int32_t c, int32_t d) { return word_of(a - b, c + d); }
static inline word_t sub_sub(int32_t a, int32_t b, int32_t c, int32_t d) { return word_of(a - b, c - d); }
static inline uint64_t square_sum(int32_t re, int32_t im) { return (uint64_t)((int64_t)re * re) + (uint64_t)((int64_t)im * im); }
#endif

// Stage 1: window, and 64 transforms of length 4 over x[n], x[n + 64], x[n + 128], x[n + 192]. h[n + 128] = 1 - h[n].
static void window_and_first_stage(const int16_t *sample, int32_t mean, const int32_t *hann, word_t *out)
{
    const int32_t one_q28 = 1 << 28;
    //@ loop unroll 64;
    for (const int16_t *end = sample + 64; sample != end; sample++, out += 2, hann += 2) {
        const int32_t h0 = hann[0];
        const int32_t h1 = hann[1];
        const int32_t x0 = fixed_mul(h0, (int16_t)(sample[0] - mean));
        const int32_t x1 = fixed_mul(h1, (int16_t)(sample[64] - mean));
        const int32_t x2 = fixed_mul(one_q28 - h0, (int16_t)(sample[128] - mean));
        const int32_t x3 = fixed_mul(one_q28 - h1, (int16_t)(sample[192] - mean));
        const int32_t a = x0 + x2;
        const int32_t c = x1 + x3;
        store(out, add_sub(a, c, a, c));
        store(out + 1, sub_sub(x0, x2, x3, x1));
    }
}

// What four sub-transforms give at one k: a = t0 + t2, b = t0 - t2, c = t1 + t3, d = t3 - t1 with t_j = S_j[k] exp(-i a_j)/2.
typedef struct {
    int32_t ar, ai, br, bi, cr, ci, dr, di;
} butterfly_t;

static inline butterfly_t twiddle(const word_t *in, const uint32_t *w)
{
    const word_t s1 = load(in + STRIDE);
    const uint32_t w1 = w[0];
    const int32_t t1r = fixed_mac_high(fixed_mul_low(first_of(s1), w1), second_of(s1), w1);
    const int32_t t1i = fixed_mul_low(second_of(s1), w1) - fixed_mul_high(first_of(s1), w1);
    const word_t s3 = load(in + 3 * STRIDE);
    const uint32_t w3 = w[2];
    const int32_t t3r = fixed_mac_high(fixed_mul_low(first_of(s3), w3), second_of(s3), w3);
    const int32_t t3i = fixed_mul_low(second_of(s3), w3) - fixed_mul_high(first_of(s3), w3);
    const word_t s2 = load(in + 2 * STRIDE);
    const uint32_t w2 = w[1];
    const int32_t t2r = fixed_mac_high(fixed_mul_low(first_of(s2), w2), second_of(s2), w2);
    const int32_t t2i = fixed_mul_low(second_of(s2), w2) - fixed_mul_high(first_of(s2), w2);
    const word_t s0 = load(in);
    const int32_t s0r = first_of(s0);
    const int32_t s0i = second_of(s0);
    const butterfly_t out = {
        .ar = t2r + (s0r >> 1),
        .ai = t2i + (s0i >> 1),
        .br = (s0r >> 1) - t2r,
        .bi = (s0i >> 1) - t2i,
        .cr = t1r + t3r,
        .ci = t1i + t3i,
        .dr = t3r - t1r,
        .di = t3i - t1i,
    };
    return out;
}

// The four sub-transforms at k = 0 (all real) and at k = m/2 (all real, turned by multiples of 45 degrees), halved.
typedef struct {
    int32_t r02_sum, r02_difference, r13_sum, r31_difference; // k = 0
    int32_t q0, q2, u, v;                                     // k = m/2
} edge_t;

static inline edge_t edge(const word_t *in)
{
    const word_t s0 = load(in);
    const word_t s1 = load(in + STRIDE);
    const word_t s2 = load(in + 2 * STRIDE);
    const word_t s3 = load(in + 3 * STRIDE);
    const int32_t r0 = first_of(s0) >> 1;
    const int32_t r1 = first_of(s1) >> 1;
    const int32_t q1 = fixed_mul_low(second_of(s1), COS_45_Q15);
    const int32_t q3 = fixed_mul_low(second_of(s3), COS_45_Q15);
    const edge_t out = {
        .r02_sum = r0 + (first_of(s2) >> 1),
        .r02_difference = r0 - (first_of(s2) >> 1),
        .r13_sum = r1 + (first_of(s3) >> 1),
        .r31_difference = (first_of(s3) >> 1) - r1,
        .q0 = second_of(s0) >> 1,
        .q2 = second_of(s2) >> 1,
        .u = q1 - q3,
        .v = q1 + q3,
    };
    return out;
}

// Four transforms of length m, at `in` and STRIDE words apart, to one of length 4 m at `out`, halved.
static inline void combine(const word_t *in, word_t *out, int m, const uint32_t *w)
{
    const edge_t e = edge(in);
    store(out, add_sub(e.r02_sum, e.r13_sum, e.r02_sum, e.r13_sum));
    store(out + m, add_add(e.r02_difference, 0, e.r31_difference, 0));
    store(out + m / 2, sub_sub(e.q0, -e.u, -e.q2, e.v));
    store(out + m + m / 2, sub_sub(e.q0, e.u, e.q2, e.v));
    word_t *up = out + 1;
    word_t *down = out + m - 1;
    //@ loop unroll 7;
    do {
        in++;
        const butterfly_t b = twiddle(in, w);
        store(up, add_add(b.ar, b.cr, b.ai, b.ci));
        store(down + m, sub_sub(b.ar, b.cr, b.ci, b.ai));
        store(up + m, sub_add(b.br, b.di, b.bi, b.dr));
        store(down, add_sub(b.br, b.di, b.dr, b.bi));
        w += 3;
        up++;
        down--;
    } while (up != down);
}

// The last stage, m = 64, straight to powers: a conjugate has the same.
static void combine_to_power(const word_t *in, uint64_t *power)
{
    const edge_t e = edge(in);
    power[0] = 0;
    power[64] = square_sum(e.r02_difference, e.r31_difference);
    power[32] = square_sum(e.q0 + e.u, e.q2 + e.v);
    power[96] = square_sum(e.q0 - e.u, e.q2 - e.v);
    const uint32_t *w = fft_twiddle_64_q15;
    uint64_t *up = power + 1;
    uint64_t *down = power + 63;
    //@ loop unroll 31;
    do {
        in++;
        const butterfly_t b = twiddle(in, w);
        store_power(up, square_sum(b.ar + b.cr, b.ai + b.ci));
        store_power(down + 64, square_sum(b.ar - b.cr, b.ci - b.ai));
        store_power(up + 64, square_sum(b.br - b.di, b.bi + b.dr));
        store_power(down, square_sum(b.br + b.di, b.dr - b.bi));
        w += 3;
        up++;
        down--;
    } while (up != down);
}

// h[n], h[n + 64] of no window, as fft_hann_q28 has them: 1/2, of the same sum, so that nothing wraps either.
#define HALF_8 1 << 27, 1 << 27, 1 << 27, 1 << 27, 1 << 27, 1 << 27, 1 << 27, 1 << 27
#define HALF_32 HALF_8, HALF_8, HALF_8, HALF_8
static const int32_t flat_q28[128] = {HALF_32, HALF_32, HALF_32, HALF_32};

// One copy for both windows: the compiler keeps the butterflies' order only where they stand once.
static __attribute__((noinline)) void power_through(const int32_t *window, const int16_t *sample, int32_t mean, uint64_t *power)
{
    word_t even[FFT_LENGTH / 2];
    word_t odd[FFT_LENGTH / 2];
    window_and_first_stage(sample, mean, window, even);
    //@ loop unroll 16;
    for (int group = 0; group < 16; group++) {
        combine(even + 2 * group, odd + 8 * group, 4, fft_twiddle_4_q15);
    }
    //@ loop unroll 4;
    for (int group = 0; group < 4; group++) {
        combine(odd + 8 * group, even + 32 * group, 16, fft_twiddle_16_q15);
    }
    combine_to_power(even, power);
}

void fft_power(const int16_t sample[FFT_LENGTH], uint64_t power[FFT_BINS]) { fft_power_about(sample, 0, power); }

void fft_power_about(const int16_t sample[FFT_LENGTH], int32_t mean, uint64_t power[FFT_BINS])
{
    power_through(fft_hann_q28, sample, mean, power);
}

void fft_power_flat(const int16_t sample[FFT_LENGTH], int32_t mean, uint64_t power[FFT_BINS])
{
    power_through(flat_q28, sample, mean, power);
}
