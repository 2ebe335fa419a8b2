#include "replay_hal.h"

static hal_result_t wait_tick(void *context) {
    replay_hal_t *replay = context;
    return replay->next(replay->source, &replay->frame, &replay->command);
}

static hal_result_t read_frame(void *context, sensor_frame_t *frame) {
    *frame = ((replay_hal_t *)context)->frame;
    return HAL_OK;
}

static hal_result_t write_nowhere(void *context, const actuator_frame_t *actuator) {
    (void)context;
    (void)actuator;
    return HAL_OK;
}

static void safe_stop(void *context) { (void)context; } // nothing moves

hal_t replay_hal(replay_hal_t *replay) {
    return (hal_t){.context = replay, .wait_tick = wait_tick, .read = read_frame, .write = write_nowhere, .safe_stop = safe_stop};
}
