// prove.c - what EVA is asked, by induction over ticks: a state after reset keeps the invariant; from any state that keeps it, one
// tick on any frame and any command is free of undefined behaviour and leaves a state that keeps it. So does every tick that ever is.
// Floats may be anything everywhere, NaN included. Each entry is a run of its own (cmake/prove.sh); what a run takes from another one is a
// contract in prove.h, and what no interval can hold is named there, with the test that holds it.
#include "prove.h"

#include "firmware/core/doppler_template.h"

int prove_blind(void);
int prove_lean(void);
int prove_default(void);
int prove_paper(void);
int prove_dj_radar_2(void);
int prove_dj_radar_3(void);
int prove_drs1000(void);
int prove_transform(void);

static int16_t any_sample(int low, int high) { return (int16_t)Frama_C_interval(low, high); }

// The invariant: every whole number that something is indexed with, shifted by or added to. Bytes that it does not name are unknown.
// clang-format off
#define NUMBERS(N)                                                                                                                         \
    N(doppler.filled, 0, 255)  N(doppler.sum, -8388352, 8388352) N(doppler.block, 0, 4)                   \
    N(doppler.in_block, 0, 64) N(doppler.dead_blocks, 0, 2) N(doppler.owed_q8, -73728, 65536) N(doppler.due, 0, 5)                          \
    N(doppler.last, -16384, 16352) N(doppler.low, -16384, 16352) N(doppler.high, -16384, 16352)  \
    N(doppler.young_bin, 0, 127) N(doppler.rest, 0, 5)  N(doppler.tone.bin, 0, 127)                                 \
    N(doppler.tone.re, -8453888, 8453888) N(doppler.tone.im, -8453888, 8453888) N(doppler.tone.blocks, 0, 32)                              \
    N(doppler.tone.thinks, 0, 37) N(doppler.tone.a_re, -32767, 32767) N(doppler.tone.a_im, -32767, 32767)                                   \
    N(heard.late_samples, -64, 320)  N(slip_turn, 0, 3)                                                                     \
    N(sense.head, 0, 15)  N(sense.lean.lean_q8, -66977792, 66977792)                                     \
    N(sense.lean.felt_q8[0], -16777216, 16777216) N(sense.lean.felt_q8[1], -16777216, 16777216)                                            \
    N(sense.lean.ticks, 0, 256) N(sense.lean.stood_ticks, 0, 100) N(sense.lean.calm_ticks, 0, 63) N(sense.lean.calms_apart, 0, 2)          \
    N(ground_speed.head, 0, 255) N(ground_speed.behind_ticks, 0, 1000) N(ground_speed.wheel_ticks, 0, 1000)                                \
    N(ground_speed.lean_q8, -66977792, 66977792)  N(ground_speed.gyro_denied, 0, 2)              \
       \
    N(ground_speed.refused, 0, 8) N(ground_speed.chore, 0, 15) N(ground_speed.quiet, 0, 1000) N(ground_speed.loud, 0, 1000)                \
     N(ground_speed.against, -12, 1000) \
    N(ground_speed.slide.newest, 0, 5) N(ground_speed.slide.held, 0, 6) N(ground_speed.slide.due, 0, 2)                                    \
    N(ground_speed.other.ticks, 0, 1000) N(ground_speed.agile.ticks, 0, 1000) N(ground_speed.agile_left, 0, 4)                             \
    N(ground_speed.held_values, 0, 6) N(ground_speed.waits, 0, 2) N(safety.turn, 0, 3) N(safety.radar_samples, 0, 31)
#define TRUTHS(N)                                                                                                                          \
    N(doppler.started) N(doppler.hold) N(doppler.leveled) N(doppler.pending) N(doppler.full) N(doppler.halved) N(doppler.tone.found)        \
    N(doppler.weigh_lines) N(doppler.relief_masked) N(doppler.weigh_young)                                                                 \
    N(heard.fresh) N(heard.busy) N(heard.quiet) N(heard.dead) N(heard.beyond) N(heard.rest) N(heard.strange) N(heard.relieved)             \
    N(heard.spoilt) N(sense.standing) N(sense.timed) N(circuit.past[0].driven) N(circuit.past[1].driven) N(driven) N(saturated) N(braking)                                   \
    N(ground_speed.other_alive) N(ground_speed.heard) N(ground_speed.accepted) N(ground_speed.standstill) N(ground_speed.relieved) N(ground_speed.cover.on) N(ground_speed.cover.stopped) N(ground_speed.cover.judged) N(ground_speed.cover.rested) N(ground_speed.rolls) N(ground_speed.roll_denied) N(ground_speed.value_at_most)         \
    N(sense.lean.calm_known) N(ground_speed.gyro_tried) N(ground_speed.value_parts) N(safety.started) N(safety.counting) N(safety.bridges_counting)
// clang-format on

#define KEPT(name, low, high) &&low <= s->name <= high
#define TRUE_OR_FALSE(name) &&(s->name == 0 || s->name == 1)
/*@ predicate in_order(control_state_t *s) =
      (\forall integer n; 0 <= n < 256 ==> -16384 <= s->doppler.window.sample[n] <= 16352 && -16384 <= s->doppler.twice[n] <= 16352) &&
      (\forall integer n; 0 <= n < 4 ==> 0 <= s->sense.silent_ticks[n] <= 1000) NUMBERS(KEPT) TRUTHS(TRUE_OR_FALSE);
*/

// Beyond a template's band something can be loud only where the band leaves room (look_outside of doppler.c).
static bool has_outside(const control_config_t *config) { return config->doppler.beam->first_bin + config->doppler.beam->bins + 32 <= 96; }

#define ANY(name, low, high) state->name = Frama_C_interval(low, high);
#define EITHER(name) state->name = Frama_C_interval(0, 1) != 0;
static void any_state_in_order(const control_config_t *config, control_state_t *state) {
    Frama_C_make_unknown((char *)state, sizeof *state);
    //@ loop unroll 256;
    for (int n = 0; n < FFT_LENGTH; n++) {
        state->doppler.window.sample[n] = any_sample(-16384, 16352); // 10 bits around 512, times 32
        state->doppler.twice[n] = any_sample(-16384, 16352);
    }
    NUMBERS(ANY)
    TRUTHS(EITHER)
    const bool outside = has_outside(config);
    state->doppler.weigh_outside = outside && Frama_C_interval(0, 1) != 0;
    state->doppler.outside_lines = outside && Frama_C_interval(0, 1) != 0;
    //@ loop unroll 4;
    for (int n = 0; n < WHEEL_COUNT; n++) {
        state->sense.silent_ticks[n] = (uint32_t)Frama_C_interval(0, 1000);
    }
    relations(config, state);
    //@ check in_order(state);
}

static int one_tick(const control_config_t *config, control_state_t *state, const sensor_frame_t *frame) {
    command_t command;
    Frama_C_make_unknown((char *)&command, sizeof command);
    const trace_t trace = control_step(config, state, &command, frame);
#ifdef SHOW_STATE
#define SHOWN(name, low, high) Frama_C_show_each(low, state->name, high);
#define SHOWN_TOO(name) Frama_C_show_each(0, state->name, 1);
    NUMBERS(SHOWN)
    TRUTHS(SHOWN_TOO)
    Frama_C_show_each(state->doppler.window.sample[0 + Frama_C_interval(0, 255)], state->doppler.twice[Frama_C_interval(0, 255)],
                      state->sense.silent_ticks[Frama_C_interval(0, 3)]);
#endif
    //@ check in_order(state);
    const bool outside = has_outside(config);
    //@ check beyond: outside == 1 || (state->doppler.weigh_outside == 0 && state->doppler.outside_lines == 0);
    //@ check \forall integer i; 0 <= i < 4 ==> -1.0 <= trace.wheel[i].duty <= 1.0 && -32767 <= trace.actuator.duty_q15[i];
    return trace.actuator.drive == DRIVE_ON;
}

// With a radar whose counts are within the converter's; prove_blind has the others.
static int any_tick(const control_config_t *config) {
    control_state_t state;
    control_reset(config, &state);
    //@ check in_order(&state);
    sensor_frame_t frame;
    Frama_C_make_unknown((char *)&frame, sizeof frame);
    frame.emergency_stop = Frama_C_interval(0, 1) != 0;
    //@ loop unroll 64;
    for (int i = 0; i < RADAR_SAMPLES_PER_TICK_MAX; i++) {
        frame.radar_count[i] = (uint16_t)Frama_C_interval(0, 1023);
    }
    frame.radar_samples = (uint8_t)Frama_C_interval(0, RADAR_SAMPLES_PER_TICK_MAX);
    any_state_in_order(config, &state);
    return one_tick(config, &state, &frame);
}

// Counts beyond the rail, or more than a frame holds, make the radar unusable (prove_railed_radar). Then nobody reads more than the first
// one, which is why the others are not even set here.
int prove_blind(void) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    sensor_frame_t known;
    sensor_frame_t frame;
    Frama_C_make_unknown((char *)&known, sizeof known);
#define FIELD(name) frame.name = known.name;
    FIELD(tick)
    FIELD(time_us)
    FIELD(elapsed_ticks)
    FIELD(battery_count)
    FIELD(accel_x_count)
    FIELD(accel_y_count)
    FIELD(accel_z_count)
    FIELD(gyro_x_count)
    FIELD(gyro_y_count)
    FIELD(gyro_z_count)
    FIELD(radar_sequence)
    FIELD(radar_samples)
    FIELD(radar_count[0])
    //@ loop unroll 4;
    for (int i = 0; i < WHEEL_COUNT; i++) {
        FIELD(encoder_count[i])
        FIELD(current_count[i])
        FIELD(bridge_status[i])
    }
    frame.emergency_stop = Frama_C_interval(0, 1) != 0;
    frame.present = known.present & ~(uint32_t)FRAME_RADAR;
    any_state_in_order(&config, &state);
    return one_tick(&config, &state, &frame);
}

// 2^8 ticks have a logarithm of 8 at most: case by case.
int prove_lean(void) {
    const control_config_t config = rover_config_default();
    control_state_t state;
    lean_input_t input;
    //@ loop unroll 9;
    for (int log2 = 0; log2 <= 8; log2++) {
        any_state_in_order(&config, &state);
        state.sense.lean.log2_ticks = log2;
        //@ loop unroll 3;
        for (int i = 0; i < 3; i++) {
            input.gyro_count[i] = Frama_C_interval(-32768, 32767);
        }
        input.accel_count[0] = Frama_C_interval(-98303, 98302);
        input.accel_count[1] = Frama_C_interval(-32768, 32767);
        input.accel = Frama_C_interval(0, 1) != 0;
        input.standing = Frama_C_interval(0, 1) != 0;
        input.moved_q8 = state.sense.gyro_q8;
        input.elapsed_ticks = (uint32_t)Frama_C_interval(1, 1000);
        lean_step(&config.sense.lean, &state.sense.lean, &input);
        //@ check 0 <= state.sense.lean.log2_ticks <= 8;
    }
    return 0;
}

int prove_default(void) {
    const control_config_t config = rover_config_default();
    return any_tick(&config);
}

int prove_paper(void) {
    const control_config_t config = rover_config_paper();
    return any_tick(&config);
}

static int of_radar(const doppler_template_t *beam) {
    control_config_t config = rover_config_default();
    config.doppler.beam = beam;
    return any_tick(&config);
}

int prove_dj_radar_2(void) { return of_radar(&doppler_template_dj_radar_2); }
int prove_dj_radar_3(void) { return of_radar(&doppler_template_dj_radar_3); }
int prove_drs1000(void) { return of_radar(&doppler_template_drs1000); }

// Any 256 samples, in two cases by the sign of one: without them the interval of bin 13 is 0.1 % wider than 32 bits. A mean that is taken
// off adds nothing: the transform knows (int16_t)(sample - mean) alone, which is any 16 bits here.
int prove_transform(void) {
    uint64_t power[FFT_BINS];
    int16_t sample[FFT_LENGTH];
    int sum = 0;
    Frama_C_make_unknown((char *)sample, sizeof sample);
    sample[111] = any_sample(INT16_MIN, -1);
    fft_power(sample, power);
    fft_power_flat(sample, 0, power);
    sum += power[1] > 0u;
    sample[111] = any_sample(0, INT16_MAX);
    fft_power(sample, power);
    fft_power_flat(sample, 0, power);
    return sum + (power[1] > 0u);
}
