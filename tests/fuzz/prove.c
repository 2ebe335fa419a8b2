// prove.c - what EVA is asked, by induction over ticks: a state after reset keeps the invariant; from any state that keeps it, one
// tick on any frame and any command is free of undefined behaviour and leaves a state that keeps it. So does every tick that ever is.
// And the transform on any 256 samples. Floats may be anything everywhere, NaN included.
#include "firmware/core/doppler_template.h"
#include "firmware/core/rover_config.h"

#include <__fc_builtin.h>

int prove(void);

static int16_t any_sample(int low, int high) { return (int16_t)Frama_C_interval(low, high); }

// The invariant: every whole number that something is indexed with or added to. Bytes that it does not name are unknown.
/*@ predicate in_window(doppler_state_t *d) =
      0 <= d->filled < 256 && -64 <= d->late_samples <= 160 && -8388352 <= d->sum <= 8388352 && 0 <= d->block < 5 && 0 <= d->in_block <= 64
   && 0 <= d->dead_blocks <= 2 && -65536 <= d->owed_q8 <= 65536 && 0 <= d->due <= 5 &&
      (\forall integer n; 0 <= n < 5 ==> 0 <= d->made[n] <= 64 && 0 <= d->railed[n] <= 64) &&
      \forall integer n; 0 <= n < 256 ==> -16384 <= d->window.sample[n] <= 16352 && -16384 <= d->twice[n] <= 16352;
    predicate in_order(control_state_t *s) = in_window(&s->doppler) && 0 <= s->sense.head < 16 && 0 <= s->ground_speed.head < 128 && 0 <=
   s->beyond <= 3 && 0 <= s->ground_speed.refused <= 8 && 0 <= s->ground_speed.quiet <= 1000 && 0 <= s->ground_speed.still_ticks <= 1000 &&
      0 <= s->safety.turn < 4 && 0 <= s->ground_speed.rolls_ticks <= 60 && 0 <= s->ground_speed.rolls_wait <= 100 &&
      \forall integer n; 0 <= n < 4 ==> 0 <= s->sense.silent_ticks[n] <= 1000;
*/

static control_state_t any_state_in_order(const control_config_t *config) {
    control_state_t state;
    Frama_C_make_unknown((char *)&state, sizeof state);
    //@ loop unroll 256;
    for (int n = 0; n < FFT_LENGTH; n++) {
        state.doppler.window.sample[n] = any_sample(-16384, 16352); // 10 bits around 512, times 32
        state.doppler.twice[n] = any_sample(-16384, 16352);
    }
    state.doppler.filled = Frama_C_interval(0, 255);
    state.doppler.late_samples = Frama_C_interval(-64, 160);
    state.doppler.sum = Frama_C_interval(-8388352, 8388352);
    state.doppler.block = Frama_C_interval(0, 4);
    state.doppler.in_block = Frama_C_interval(0, 64);
    state.doppler.dead_blocks = Frama_C_interval(0, 2);
    state.doppler.owed_q8 = Frama_C_interval(-65536, 65536);
    state.doppler.due = Frama_C_interval(0, 5);
    state.doppler.last = any_sample(-16384, 16352);
    for (int n = 0; n < DOPPLER_BLOCKS; n++) {
        state.doppler.made[n] = Frama_C_interval(0, 64);
        state.doppler.railed[n] = Frama_C_interval(0, 64);
    }
    state.doppler.started = Frama_C_interval(0, 1) != 0;
    state.doppler.hold = Frama_C_interval(0, 1) != 0;
    state.doppler.leveled = Frama_C_interval(0, 1) != 0;
    state.heard.fresh = Frama_C_interval(0, 1) != 0;
    state.heard.busy = Frama_C_interval(0, 1) != 0;
    state.heard.quiet = Frama_C_interval(0, 1) != 0;
    state.heard.dead = Frama_C_interval(0, 1) != 0;
    state.heard.beyond = Frama_C_interval(0, 1) != 0;
    state.heard.strange = Frama_C_interval(0, 1) != 0;
    state.heard.spoilt = Frama_C_interval(0, 1) != 0;
    state.heard.late_samples = Frama_C_interval(-64, 320);
    state.beyond = Frama_C_interval(0, 3);
    state.doppler.pending = Frama_C_interval(0, 1) != 0;
    state.doppler.full = Frama_C_interval(0, 1) != 0;
    state.doppler.halved = Frama_C_interval(0, 1) != 0;
    state.sense.head = Frama_C_interval(0, 15);
    const int most = config->sense.encoder_step_max;
    for (int n = 0; n < WHEEL_COUNT; n++) {
        state.sense.silent_ticks[n] = (uint32_t)Frama_C_interval(0, 1000);
        state.sense.step[n] = Frama_C_interval(-most, most);
    }
    state.driven = Frama_C_interval(0, 1) != 0;
    state.circuit.driven = Frama_C_interval(0, 1) != 0;
    state.sense.timed = Frama_C_interval(0, 1) != 0;
    state.ground_speed.head = Frama_C_interval(0, 127);
    state.ground_speed.loud = Frama_C_interval(0, 1000);
    state.ground_speed.against = Frama_C_interval(0, 1000);
    state.ground_speed.other_alive = Frama_C_interval(0, 1) != 0;
    state.ground_speed.other.ticks = Frama_C_interval(0, 1000);
    state.ground_speed.agile.ticks = Frama_C_interval(0, 1000);
    state.ground_speed.wheel_ticks = Frama_C_interval(0, 1000);
    state.ground_speed.rolls_ticks = Frama_C_interval(0, 60);
    state.ground_speed.rolls_wait = Frama_C_interval(0, 100);
    state.ground_speed.heard = Frama_C_interval(0, 1) != 0;
    state.ground_speed.accepted = Frama_C_interval(0, 1) != 0;
    state.ground_speed.behind_ticks = Frama_C_interval(0, 1000);
    state.ground_speed.agile_left = Frama_C_interval(0, 4);
    state.ground_speed.waits = Frama_C_interval(0, 2);
    state.ground_speed.refused = Frama_C_interval(0, 8);
    state.ground_speed.quiet = Frama_C_interval(0, 1000);
    state.ground_speed.still_ticks = Frama_C_interval(0, 1000);
    state.ground_speed.standstill = Frama_C_interval(0, 1) != 0;
    state.safety.turn = (uint32_t)Frama_C_interval(0, 3);
    state.safety.started = Frama_C_interval(0, 1) != 0;
    state.saturated = Frama_C_interval(0, 1) != 0;
    state.braking = Frama_C_interval(0, 1) != 0;
    //@ check in_order(&state);
    return state;
}

static int any_tick(const control_config_t *config) {
    control_state_t state;
    control_reset(config, &state);
    //@ check in_order(&state);
    state = any_state_in_order(config);
    sensor_frame_t frame;
    command_t command;
    Frama_C_make_unknown((char *)&frame, sizeof frame);
    Frama_C_make_unknown((char *)&command, sizeof command);
    frame.emergency_stop = Frama_C_interval(0, 1) != 0;
    const trace_t trace = control_step(config, &state, &command, &frame);
    //@ check in_order(&state);
    //@ check \forall integer i; 0 <= i < 4 ==> -1.0 <= trace.wheel[i].duty <= 1.0 && -32767 <= trace.actuator.duty_q15[i];
    return trace.actuator.drive == DRIVE_ON;
}

// Any 256 samples, in two cases by the sign of one: without them the interval of bin 13 is 0.1 % wider than 32 bits.
static int any_transform(void) {
    uint64_t power[FFT_BINS];
    int16_t sample[FFT_LENGTH];
    int sum = 0;
    Frama_C_make_unknown((char *)sample, sizeof sample);
    sample[111] = any_sample(INT16_MIN, -1);
    fft_power(sample, power);
    sum += power[1] > 0u;
    sample[111] = any_sample(0, INT16_MAX);
    fft_power(sample, power);
    return sum + (power[1] > 0u);
}

int prove(void) {
    const control_config_t paper = rover_config_paper();
    control_config_t ours = rover_config_default();
    int sum = any_transform() + any_tick(&paper) + any_tick(&ours);
    ours.doppler.beam = &doppler_template_dj_radar_2;
    sum += any_tick(&ours);
    ours.doppler.beam = &doppler_template_dj_radar_3;
    sum += any_tick(&ours);
    ours.doppler.beam = &doppler_template_drs1000;
    return sum + any_tick(&ours);
}
