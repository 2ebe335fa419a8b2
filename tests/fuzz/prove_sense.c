// prove_sense.c - sense.c, and what is asked of measure_wheel alone: its pulses a tick are a quotient by the ticks.
#include "prove.h"

#include "firmware/core/sense.c"

int prove_step(void) {
    const control_config_t config = rover_config_default();
    const int32_t most = config.sense.encoder_step_max;
    sensor_frame_t frame;
    sense_state_t state;
    sense_output_t out;
    Frama_C_make_unknown((char *)&frame, sizeof frame);
    //@ loop unroll 1000;
    for (int ticks = 1; ticks <= 1000; ticks++) {
        Frama_C_make_unknown((char *)&state, sizeof state);
        Frama_C_make_unknown((char *)&out, sizeof out);
        state.head = Frama_C_interval(0, 15);
        state.step[2] = Frama_C_interval(-most, most);
        state.silent_ticks[2] = 0;
        out.elapsed_ticks = (uint32_t)ticks; // the law knows the sum of both alone
        measure_wheel(&config.sense, &state, &frame, 2, 10000u, &out);
        //@ check -most <= state.step[2] <= most;
    }
    return out.usable != 0u;
}

// Counts beyond the rail are not usable, whichever is the first of them; so nobody reads them (prove_blind).
int prove_railed_radar(void) {
    const control_config_t config = rover_config_default();
    sensor_frame_t frame;
    sense_output_t out;
    //@ loop unroll 64;
    for (int first = 0; first < RADAR_SAMPLES_PER_TICK_MAX; first++) {
        Frama_C_make_unknown((char *)&frame, sizeof frame);
        frame.radar_samples = (uint8_t)Frama_C_interval(first + 1, 64);
        frame.radar_count[first] = (uint16_t)Frama_C_interval(1024, 65535);
        out.usable = 0;
        out.absurd = 0;
        check_radar(&config.sense, &frame, &out);
        //@ check out.usable == 0;
    }
    frame.radar_samples = (uint8_t)Frama_C_interval(65, 255);
    check_radar(&config.sense, &frame, &out);
    //@ check out.usable == 0;
    return 0;
}
