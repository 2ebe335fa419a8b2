// doppler.h - magnitude of the ground speed from the radar's echo, one value per hop of samples.
//
//   paper: v = f_peak c / (2 f0 cos theta_d)                                         (1)  = (11), zero frequency excluded
//   ours:  v = argmin over v of J(v) = sum_k P[k] / S_v[k]  +  a sum_k ln S_v[k],  a = sum_k P[k]     (2)
//
// Source: (11) Lhomme-Desages; without a window, over all bins but zero. (2), derived here: powers of a noise-like echo are exponentially
// distributed around a S_v[k] with sum_k S_v = 1, so -ln L = sum P/(a S_v) + sum ln(a S_v); times a, without what does not depend on v. S_v
// comes from the beam's geometry (doppler_template.h). The minimum is found on every 4th grid speed, then on its neighbours, then by a
// parabola in ln v. An echo is quiet when J is what it would be if more than half of the power were white noise, or when its power is below
// a stated one. Powers are reduced to 15 bits, their sum to 16: J is exact in 32 bits. Until 256 samples have come, 128 of them, each taken
// twice (a window of half the length, whose speed reads half), and then 192 with their mirror image make two early values (ours alone). An
// interfering line is told from an echo, whose power in a bin is exponential and sways by 1.4 bits on the mean, by its constancy:
//   l = log2 P[k];  m += (l - m)/8;  s += (|l - m| - s)/8;  line: s < 0.35 bits, and m 2 bits above that of bins k - 4 and k + 4,
//   or above that of its neighbours and within 4 bits of the loudest                                                              (3)
// No echo of constant speed is as steady in a bin (none of 38000 values of Gaussian echoes of 0.3 to 1 m/s had s < 0.35 in any). What leaps
// up by 4 bits under way, and on by half a bit, begins anew, with s = 1: a hum that begins. The steadiest bin of those is looked at for a
// line's phase before the loudest. A line inside the echo, where it sways with it, is told by its phase and taken off the samples
// (doppler_line.h); windows in which that has begun tell nothing. The five bins around a line are laid straight in l between those beside
// them: an echo's edge falls by many bits in five bins. What no speed's spectrum fits, sum_k P/S_v > 2.5 of what it should
// be, is no ground's echo and is refused; from 0.8 on it is trusted less (measured with tests/bench/outdoors_bench: calm echoes 0.1 to
// 0.9).
#ifndef TRACTION_FIRMWARE_CORE_DOPPLER_H
#define TRACTION_FIRMWARE_CORE_DOPPLER_H

#include "doppler_line.h"
#include "fft.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { DOPPLER_SPEEDS_MAX = 96, DOPPLER_BINS_MAX = 120 };

typedef enum { DOPPLER_ARGMAX = 0, DOPPLER_LIKELIHOOD } doppler_method_t;

enum { DOPPLER_WINDOW_TICKS_MAX = 128, DOPPLER_BLOCKS = 5, DOPPLER_BLOCK = 64, DOPPLER_GAP_MAX = 32, DOPPLER_SAMPLES_MAX = 64 };

// Which past a Doppler value tells of: the weight of each tick in the window's mean, newest first.
typedef struct {
    int32_t ticks;                                // that the window covers, at most DOPPLER_WINDOW_TICKS_MAX
    float tau_s;                                  // mean age
    float tau_ticks;                              // the same in ticks
    float per_s;                                  // 1 / length of the window [1/s]
    int16_t weight_q15[DOPPLER_WINDOW_TICKS_MAX]; // sum 32768
} doppler_window_t;

// Arrays, not pointers: a pointer in a constant must be relocated, hence lies in writable memory.
// Spectra of the echo on a grid of log-spaced speeds, made from a radar's geometry (firmware/template): a template is data.
typedef struct {
    float log_step;         // ln of the ratio of neighbouring grid speeds
    float paper_m_s_per_Hz; // c / (2 f0 cos theta_d) of (11)
    float sample_rate_Hz;
    int32_t speeds;    // grid size
    int32_t first_bin; // spectral bins used: first_bin .. first_bin + bins - 1
    int32_t bins;
    float speed_m_s[DOPPLER_SPEEDS_MAX]; // the grid, rising: the speeds at which (2) has its minimum there on average
    int16_t inverse[DOPPLER_SPEEDS_MAX * DOPPLER_BINS_MAX]
        __attribute__((aligned(8)));    // [speeds][bins] q / S_v[k], 0..32767, q the scale that makes the largest 32767
    int32_t volume[DOPPLER_SPEEDS_MAX]; // q * sum_k ln S_v[k]
    int32_t quiet[DOPPLER_SPEEDS_MAX];  // q * expected J/a of an echo of which half is white noise
    int32_t exact;                      // q * bins: expected (J/a - q sum ln S_v) of an echo of the template's own spectrum
    doppler_window_t window;            // at sample_rate_Hz, for ground_speed
    float spread;                       // variance of a value over that of the reference radar's at the same speed [1]
    float deaf;                         // speed below which the radar is deaf, over that of the reference radar [1], 1 or more
    bool line;                          // of a point target: the grid is even in the speed, by log_step [m/s]
    bool from_peak;                     // spectra narrower than the first search's steps: it begins at the largest power
    int8_t start[DOPPLER_BINS_MAX];     // grid speed whose spectrum peaks in first_bin + k
} doppler_template_t;

typedef struct {
    const doppler_template_t *beam;
    doppler_method_t method;
    int32_t offset_count;        // ADC value of no signal
    int32_t hop;                 // samples between values, 1..256
    float scale;                 // calibrated speed over geometric speed [1]
    int32_t max_count;           // the converter's rail
    int32_t per_tick_q8;         // samples per tick, by the template's rate
    float per_sample_s;          // 1/rate
    uint32_t quiet_power_count2; // variance of the band below which there is no echo [ADC count^2]
} doppler_config_t;

typedef struct {
    union {
        int16_t sample[FFT_LENGTH]; // oldest first
        struct {
            int16_t sample[4];
        } __attribute__((aligned(8))) four[FFT_LENGTH / 4];
    } window;
    int16_t twice[FFT_LENGTH];              // the first 128 samples, each twice
    int32_t filled;                         // valid samples so far
    uint64_t power[FFT_BINS];               // of the last full window
    int32_t late_samples;                   // samples since that window's end
    int16_t level_q8[DOPPLER_BINS_MAX + 1]; // of (3), by bin
    int16_t sway_q8[DOPPLER_BINS_MAX + 1];
    uint32_t line[4];    // bit k % 32 of word k / 32: bin k is a line
    int32_t due;         // calls until the lines are looked at
    bool leveled;        // (3) has begun
    doppler_line_t tone; // the line inside the echo
    int32_t clean;       // samples of the window that are rid of it
    bool weigh_lines;    // (3) has found the first one
    bool relief_masked;  // it was left out by (3)
    bool weigh_young;    // may a line be what is heard, while the search for one inside the echo is young?
    int32_t young_bin;   // it is, and where; 0: it is not
    bool weigh_outside;  // beyond the band something is loud; is it lines?
    bool outside_lines;  // it is, and the mean power of the other bins there, over 2^28
    uint32_t outside_noise;
    int32_t rest;                                         // calls that are the filter's
    int32_t relief;                                       // values that may still be the first without it
    int32_t sum;                                          // of the samples in the window
    int32_t made[DOPPLER_BLOCKS], railed[DOPPLER_BLOCKS]; // samples that were filled in, and at a rail, by blocks of 64 of the stream
    int32_t block, in_block;                              // the block that is being filled, and how much of it is
    int16_t last;                                         // newest sample
    int16_t low, high;                                    // of the block
    int32_t dead_blocks;                                  // blocks in a row without any noise
    uint32_t next_sequence;                               // of the sample after the newest one
    int32_t owed_q8;                                      // samples that the clock says should have come, less those that came
    bool started;
    bool hold;     // that window was filled by doppler_gap in this tick
    bool pending;  // its speed is not made yet
    bool halved;   // that window is `twice`: it reads half the speed
    bool full;     // the window has been filled once
} doppler_state_t; // zeroed = reset

typedef struct {
    bool fresh;           // a value was made in this call
    bool busy;            // a transform was made in this call
    bool quiet;           // no echo above the noise: the speed means nothing
    bool dead;            // for a quarter of a second or more no noise at all: the front end is dead (in every call, fresh or not)
    bool beyond;          // an echo of more speed than the template's band holds: the speed is a lower bound
    bool rest;            // no more is heard than a line that was taken off may leave
    bool strange;         // no speed's spectrum fits: interference, or no ground
    bool relieved;        // what came before told of an interfering line as strong as the echo, which is taken off from here on
    bool spoilt;          // strange and not quiet, a rest, or too many samples were lost, or stood at a rail: the speed means nothing
    float speed_m_s;      // magnitude
    float misfit;         // share of the speed that may be wrong because no spectrum fits [1]
    float trust;          // by how much its variance exceeds that of a calm echo without noise [1], 1 or more
    int32_t late_samples; // samples that arrived after the window's end; less for the first two values, whose window is shorter
} doppler_output_t;

// The transform runs in the call that fills the window, the search for the speed in the next one, so that no tick pays for both.
// Which samples this is, before doppler_step: how many of the converter's were lost before the `count` that `sequence` numbers, told by
// their numbers or, where a HAL does not number them (sequence 0), by the clock. To be called in every tick, with count 0 where there is
// none.
typedef struct {
    uint32_t sequence;      // of sample[0]
    uint32_t elapsed_ticks; // since the call before
    int32_t count;
} doppler_arrival_t;
int32_t doppler_missing(const doppler_config_t *config, doppler_state_t *state, const doppler_arrival_t *arrival);

// Fills a gap of `missing` samples before `next`, in a straight line; a gap longer than DOPPLER_GAP_MAX empties the window.
void doppler_gap(const doppler_config_t *config, doppler_state_t *state, int32_t missing, uint16_t next);

// Any counts are accepted (limited to 0..1023); samples beyond `count` are not read.
doppler_output_t doppler_step(const doppler_config_t *config, doppler_state_t *state, const uint16_t *sample, int32_t count);

#ifdef __cplusplus
}
#endif

#endif
