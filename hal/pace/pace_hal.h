// pace_hal.h - a HAL that wraps a HAL and keeps pace with the wall clock: a tick of 10 ms takes 10 ms. Works on any HAL.
#ifndef TRACTION_HAL_PACE_PACE_HAL_H
#define TRACTION_HAL_PACE_PACE_HAL_H

#include "hal/hal.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    hal_t inner;       // first: hal/forward.h
    int64_t due_ns;    // on CLOCK_MONOTONIC: the next tick is not given before
    uint32_t overruns; // ticks asked for more than a whole tick after they were due
} pace_hal_t;

// Fills *pace and returns its HAL. `pace` and what `inner` points to must outlive it. The first tick is given at once, tick n not before
// 10 n ms after it; a tick that comes late is given at once and the next are still due at their own times. Only wait_tick waits.
hal_t pace_hal(pace_hal_t *pace, const hal_t *inner);

#ifdef __cplusplus
}
#endif

#endif
