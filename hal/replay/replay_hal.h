// replay_hal.h - a HAL whose frames were recorded: each tick gives the next one, and what is written goes nowhere.
//
// The command recorded beside a frame is kept for whoever plays the operator; so the same drive runs again, in any loop.
#ifndef TRACTION_HAL_REPLAY_REPLAY_HAL_H
#define TRACTION_HAL_REPLAY_REPLAY_HAL_H

#include "hal/hal.h"

#ifdef __cplusplus
extern "C" {
#endif

// Set `source` and `next`, leave the rest zero.
typedef struct {
    void *source;
    // The next tick: HAL_OK, HAL_END after the last, or a negative error.
    hal_result_t (*next)(void *source, sensor_frame_t *frame, command_t *command);
    sensor_frame_t frame; // of the tick that wait_tick has given
    command_t command;    // recorded beside it
} replay_hal_t;

// `replay` must outlive the HAL; hal.context is its address.
hal_t replay_hal(replay_hal_t *replay);

#ifdef __cplusplus
}
#endif

#endif
