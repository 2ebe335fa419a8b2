// hal.h - the seam between the firmware and a world, real or simulated: four function pointers and raw counts.
//
// The loop over it is daemon_run (firmware/app/daemon.h), the only one: while (wait_tick) { read; control_step; write; } safe_stop.
// In hal/sim, wait_tick advances the plant by one tick, so simulated time is the only time. A HAL may wrap a HAL: late orders
// (hal/sim/delay_hal.h), failing sensors (hal/sim/fault_hal.h) and the wall clock's pace (hal/pace/pace_hal.h) do.
#ifndef TRACTION_HAL_HAL_H
#define TRACTION_HAL_HAL_H

#include "firmware/core/signals.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    HAL_OK = 0,
    HAL_END = 1,          // wait_tick: the run is over (scenario ended, or the daemon was asked to stop)
    HAL_ERR_TIMEOUT = -1, // a device did not answer in this tick; its bits in `present` are clear
    HAL_ERR_IO = -2,      // a device is lost; the loop must call safe_stop
    HAL_ERR_CONFIG = -3,  // the HAL was opened with an impossible configuration
} hal_result_t;

typedef struct hal {
    void *context; // owned by the HAL that filled this struct
    // Blocks until the next 10 ms tick. HAL_OK, HAL_END or a negative error; HAL_ERR_TIMEOUT: the tick came without its clock.
    hal_result_t (*wait_tick)(void *context);
    // Fills *frame with what the devices said since the last tick. A silent device clears its bit; it never blocks. With
    // HAL_ERR_TIMEOUT too the frame holds its tick and what the other devices said.
    hal_result_t (*read)(void *context, sensor_frame_t *frame);
    // Sets the bridges. Takes effect before the next wait_tick returns, unless a HAL in between is made to be late. Any error
    // ends the loop, HAL_ERR_TIMEOUT too: the bridges may still do what the last tick asked for.
    hal_result_t (*write)(void *context, const actuator_frame_t *actuator);
    // Motors off, whatever the state. Safe to call at any time and more than once; never fails silently on hardware.
    void (*safe_stop)(void *context);
} hal_t;

#ifdef __cplusplus
}
#endif

#endif
