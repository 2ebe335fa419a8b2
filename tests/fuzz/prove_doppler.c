// prove_doppler.c - doppler.c, and what is asked of its parts alone: of a block no more is made than has come; a sample of a gap lies
// between those at its ends; a spectrum without lines is a whole one.
#include "prove.h"

// prove_block keeps the first and the last of these; a gap's samples are in prove.h.
/*@ admit requires made: 0 <= state->made[0] <= 64 && 0 <= state->made[1] <= 64 && 0 <= state->made[2] <= 64 && 0 <= state->made[3] <= 64 &&
      0 <= state->made[4] <= 64;
    admit requires between: -16384 <= value <= 16352;
    admit requires railed: 0 <= state->railed[0] <= 64 && 0 <= state->railed[1] <= 64 && 0 <= state->railed[2] <= 64 &&
      0 <= state->railed[3] <= 64 && 0 <= state->railed[4] <= 64; */
static void take(const doppler_config_t *config, doppler_state_t *state, int16_t value, bool made, bool railed, int32_t late_samples);

// A line is five bins wide. Proved by prove_take_line, bin by bin.
/*@ assigns left[0 .. 127] \from left[0 .. 127], from, peak, *sum, *bins;
    assigns *sum \from left[0 .. 127], from, peak, *sum, *bins;
    assigns *bins \from left[0 .. 127], from, peak, *sum, *bins;
    assigns \result \from left[0 .. 127], from, peak, *sum, *bins;
    ensures five: \old(*bins) - 5 <= *bins <= \old(*bins);
    ensures \result == 0 || \result == 1; */
static bool take_line(uint32_t *left, int32_t from, int32_t peak, uint32_t *sum, int32_t *bins);

// Three lines at most, five bins each, leave some bins to divide by. Proved by prove_outside, which follows its loop.
/*@ assigns state->outside_lines, state->outside_noise \from state->power[0 .. 127], *beam;
    ensures state->outside_lines == 0 || state->outside_lines == 1; */
static void watch_outside(const doppler_template_t *beam, doppler_state_t *state);

// Proved by prove_without_lines: where it is the copy, all of it is set. Where it is not, nobody reads the copy.
/*@ assigns copy[0 .. 127] \from state->power[0 .. 127], state->line[0 .. 3], *beam;
    assigns \result \from state, copy, state->line[0 .. 3];
    ensures \initialized(copy + (0 .. 127));
    ensures \result == copy || \result == (const uint64_t *)state->power; */
static const uint64_t *without_lines(const doppler_template_t *beam, const doppler_state_t *state, uint64_t *copy);

#include "firmware/core/doppler.c"

int prove_without_lines(void) {
    const control_config_t config = rover_config_default();
    control_state_t all;
    uint64_t copy[FFT_BINS];
    Frama_C_make_unknown((char *)&all, sizeof all);
    all.doppler.line[0] = 1u << 9; // lines there are
    const uint64_t *const power = without_lines(config.doppler.beam, &all.doppler, copy);
    //@ check power == &copy[0] && \initialized(power + (0 .. 127));
    for (int i = 0; i < 4; i++) {
        all.doppler.line[i] = 0; // and there are none
    }
    const uint64_t *const same = without_lines(config.doppler.beam, &all.doppler, copy);
    //@ check same == &all.doppler.power[0];
    return power[3] > same[3];
}

int prove_outside(void) {
    const control_config_t config = rover_config_default();
    control_state_t all;
    Frama_C_make_unknown((char *)&all, sizeof all);
    watch_outside(config.doppler.beam, &all.doppler);
    //@ check all.doppler.outside_lines == 0 || all.doppler.outside_lines == 1;
    return all.doppler.outside_lines ? 1 : 0;
}

int prove_take_line(void) {
    uint32_t left[FFT_BINS];
    uint32_t sum;
    int taken = 0;
    //@ loop unroll 2;
    for (int young = 0; young < 2; young++) {
        const int32_t from = young ? LINE_FROM : 41; // of the only template that leaves room beyond its band
        //@ loop unroll 128;
        for (int32_t peak = from; peak < FFT_BINS; peak++) {
            int32_t bins = 100; // it is only subtracted from
            Frama_C_make_unknown((char *)left, sizeof left);
            Frama_C_make_unknown((char *)&sum, sizeof sum);
            taken += take_line(left, from, peak, &sum, &bins) ? 1 : 0;
            //@ check 95 <= bins <= 100;
        }
    }
    return taken;
}

int prove_block(void) {
    const control_config_t config = rover_config_default();
    control_state_t all;
    doppler_state_t *const state = &all.doppler;
    //@ loop unroll 5;
    for (int block = 0; block < DOPPLER_BLOCKS; block++) {
        //@ loop unroll 65;
        for (int came = 0; came <= DOPPLER_BLOCK; came++) {
            Frama_C_make_unknown((char *)&all, sizeof all);
            relations(&config, &all);
            state->block = block;
            state->in_block = came;
            state->made[block] = Frama_C_interval(0, came);
            state->railed[block] = Frama_C_interval(0, came);
            state->dead_blocks = Frama_C_interval(0, 2);
            state->filled = 0; // no window is full: what follows then writes none of these
            state->full = true;
            state->sum = 0;
            take(&config.doppler, state, (int16_t)Frama_C_interval(-16384, 16352), Frama_C_interval(0, 1) != 0, Frama_C_interval(0, 1) != 0,
                 0);
            const int now = came == DOPPLER_BLOCK ? (block + 1) % DOPPLER_BLOCKS : block;
            //@ check state->block == now && 0 <= state->made[now] <= state->in_block && 0 <= state->railed[now] <= state->in_block <= 64;
        }
    }
    return 0;
}
