// doppler_line.h - an interfering line told from an echo by its phase, and taken off the radar's samples.
//
//   C[h] = 1/64 sum_n x[n] exp(-2 pi j k n/256),  n = 64 h .. 64 h + 63                    (1)
//   S(u) = sum_h C[h] exp(-2 pi j u h),  over the last N <= 32 blocks                      (2)
//   share = |S|^2 / (N sum_h |C[h]|^2)                                                     (3)
//   a = 2 S/(N D),  D = 1/64 sum_{n<64} exp(2 pi j u n/64);  x[n] -= Re(a exp(2 pi j (k/256 + u/64) n))   (4)
//
// Source: periodogram of a sinusoid in noise, derived here. A line keeps its phase for as long as it lasts, an echo for as long as a
// scatterer takes through the beam, a window or less: its blocks are as good as independent, and the largest of the 32 values of (3) is
// beyond s with a probability of 32 (1 - s)^(N - 1) (Fisher): for s = 0.4 and the 20 independent blocks of an echo of 5 Hz 0.2 %, and what
// is then taken off is a slice of N blocks' width, 0.25 Hz of the reference radar. So a line is found even inside the echo, where neither
// level nor constancy tells it. k, the bin that is looked at, is the loudest one of the mean spectrum now, or none (0) while that lies
// where no line is looked for: of a bin that was the loudest before the rover slowed down the blocks hold the skirt of its echo. The line
// may be 2 bins beside it. It ends when (3) falls below a quarter, or when a second of blocks no longer goes with S. Radars whose 32 blocks
// last less than 3 s, or whose echo is narrow, have none of this. The estimator is told of a line as strong as the echo: what it had told
// is forgotten. Cost: some 50 instructions a sample and some thousand in each of the ten ticks that think, all of them between the filter's
// ticks and the next transform. The last samples of a window are not rid of the line when it is transformed; its Hann weight is below 0.01
// there.
#ifndef TRACTION_FIRMWARE_CORE_DOPPLER_LINE_H
#define TRACTION_FIRMWARE_CORE_DOPPLER_LINE_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { DOPPLER_LINE_BLOCKS = 32, DOPPLER_LINE_BLOCK = 64 };

typedef struct {
    uint32_t bin;                                                       // k of (1), 1..127; 0: none yet
    uint32_t next;                                                      // sample of the stream that comes next, counted from the first
    int32_t re, im;                                                     // of the block's sum, (1)
    int16_t past_re[DOPPLER_LINE_BLOCKS], past_im[DOPPLER_LINE_BLOCKS]; // C[h], a ring by h
    int32_t blocks;                                                     // N
    uint32_t thinks;                                                    // cells of (2) that are made; 0: it rests
    uint32_t cell[DOPPLER_LINE_BLOCKS];                                 // |S|^2 / 2^12 at u = cell/32
    uint32_t place;                                                     // u of the largest of them, 2^32 of a turn
    bool found;                                                         // a and turn are a line's
    uint32_t turn;                                                      // 2^32 (k/256 + u/64) of (4)
    int32_t a_re, a_im;
} doppler_line_t; // zeroed = reset

// The loudest bin of the mean spectrum: looked at unless a line is found already.
void doppler_line_suggest(doppler_line_t *line, uint32_t bin);

// The stream's next `count` samples: a line that is found is taken off them, and off *sum, which stays their sum. `mean`: the converter's
// offset. Samples stay in [low, high].
typedef struct {
    int32_t count, mean, low, high;
} doppler_line_span_t;
void doppler_line_take(doppler_line_t *line, const doppler_line_span_t *span, int16_t *sample, int32_t *sum);

// `count` samples of the stream have gone by unseen.
void doppler_line_skip(doppler_line_t *line, uint32_t count);

// A part of (2) to (4); true while there is more. For ticks that have time.
bool doppler_line_think(doppler_line_t *line);

#ifdef __cplusplus
}
#endif

#endif
