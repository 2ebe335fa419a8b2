// daemon.h - the rover's main loop: open; while wait_tick: read, control_step, write, kick the watchdog, log; safe_stop; close.
//
// The world is a hal_t, the operator and the log are two function pointers, so the loop is the same on the rover (tractiond), in
// simulate, tune and replay (through host_tools/loop) and in a test. It ends with the motors stopped, whatever ended it. It never
// waits but in wait_tick.
#ifndef TRACTION_FIRMWARE_APP_DAEMON_H
#define TRACTION_FIRMWARE_APP_DAEMON_H

#include "firmware/core/control.h"
#include "hal/hal.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    void *context;
    // What is asked for in the tick that `frame` was read in; *command comes as MODE_STOP. Fills age_ticks, which ends the drive when
    // it grows (FAULT_COMMAND_TIMEOUT). Must not block.
    void (*command)(void *context, const sensor_frame_t *frame, command_t *command);
    // One tick as it was. May be null. Must not block.
    void (*log)(void *context, const sensor_frame_t *frame, const command_t *command, const trace_t *trace);
} daemon_link_t;

// How a run begins. All zero: without a self-test, on a rover whose windings are cold.
typedef struct {
    bool self_test;             // before the first command: what fails ends the run, and no motor was driven by any but the test
    bool warm;                  // safety_warm with rise_K, or, where it is null, with what is assumed of windings of unknown past
    const float *rise_K;        // [WHEEL_COUNT]
    volatile float *rise_out_K; // [WHEEL_COUNT] how warm they are, written in every tick; null: nowhere
} daemon_start_t;

typedef struct {
    hal_result_t ended_by;        // HAL_END, or the error that ended the loop
    uint32_t ticks;               // ticks that were controlled
    uint32_t faults;              // fault_t bits seen on the way
    self_test_result_t self_test; // done: it was made; with failures the run ended there, by HAL_END
} daemon_result_t;

// Runs until wait_tick says so or a device is lost. A device that did not answer in time (HAL_ERR_TIMEOUT) is what its bits in
// `present` say, and safety decides; orders that no bridge takes end the run when as many are lost in a row as the bridges forgive
// (BRIDGE_RELEASE_MS); any other error stops the rover at once.
daemon_result_t daemon_run(const hal_t *hal, const control_config_t *config, const daemon_link_t *link);

// The same, begun as `start` says.
daemon_result_t daemon_run_from(const hal_t *hal, const control_config_t *config, const daemon_link_t *link, const daemon_start_t *start);

#ifdef __cplusplus
}
#endif

#endif
