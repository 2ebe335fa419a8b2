// hal.h - the seam between the firmware and a world, real or simulated: a few function pointers and raw counts.
//
// The loop over it is daemon_run (firmware/app/daemon.h), the only one: open; self_test; while (wait_tick) { read; control_step; write;
// kick_watchdog; } safe_stop; close. In hal/sim, wait_tick advances the plant by one tick, so simulated time is the only time. A HAL may
// wrap a HAL (hal/forward.h): late orders (hal/sim/delay_hal.h), failing sensors (hal/sim/fault_hal.h) and the wall clock's pace
// (hal/pace/pace_hal.h) do.
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

enum { HAL_DEVICES = 20 }; // a device's number is that of its FRAME_* bit

typedef enum {
    HAL_DEVICE_ABSENT = 0, // this rover has none
    HAL_DEVICE_WORKS,
    HAL_DEVICE_SILENT, // did not answer when it was asked last; it may again
    HAL_DEVICE_BROKEN, // answered that it does not work, or cannot be reached any more
} hal_device_t;

typedef struct {
    uint32_t overruns;           // ticks that wait_tick gave later than a whole tick after they were due, since open
    uint32_t lost_writes;        // orders that no bridge took, since open
    uint8_t device[HAL_DEVICES]; // hal_device_t
} hal_status_t;

typedef struct {
    void *context; // owned by the HAL that filled this struct
    // Blocks until the next 10 ms tick. HAL_OK, HAL_END or a negative error; HAL_ERR_TIMEOUT: the tick came without its clock.
    hal_result_t (*wait_tick)(void *context);
    // Fills *frame with what the devices said since the last tick. A silent device clears its bit; it never blocks. With
    // HAL_ERR_TIMEOUT too the frame holds its tick and what the other devices said.
    hal_result_t (*read)(void *context, sensor_frame_t *frame);
    // Sets the bridges. Takes effect before the next wait_tick returns, unless a HAL in between is made to be late. HAL_ERR_TIMEOUT: an
    // order was not taken; the bridges do what the last one said, and release themselves BRIDGE_RELEASE_MS after it. Any other error
    // ends the loop.
    hal_result_t (*write)(void *context, const actuator_frame_t *actuator);
    // Motors off, whatever the state. Safe to call at any time and more than once; never fails silently on hardware.
    void (*safe_stop)(void *context);

    // The rest may be null: this HAL has nothing to do there. Called through the functions below.
    hal_result_t (*open)(void *context);                            // takes the devices; bridges DRIVE_OFF
    hal_result_t (*self_test)(void *context, hal_status_t *status); // asks every device; moves nothing; may block for a second
    hal_result_t (*status)(void *context, hal_status_t *status);    // what is known without asking; never blocks
    void (*kick_watchdog)(void *context); // the loop is alive; unless kicked for a second, the hardware resets and the bridges release
    void (*close)(void *context);         // gives the devices back; after safe_stop
} hal_t;

static inline hal_result_t hal_open_devices(const hal_t *hal) { return hal->open != 0 ? hal->open(hal->context) : HAL_OK; }

// *status is all HAL_DEVICE_ABSENT and 0 where the HAL cannot tell.
static inline hal_result_t hal_self_test(const hal_t *hal, hal_status_t *status) {
    const hal_status_t nothing = {0, 0, {0}};
    *status = nothing;
    return hal->self_test != 0 ? hal->self_test(hal->context, status) : HAL_OK;
}

static inline hal_result_t hal_status(const hal_t *hal, hal_status_t *status) {
    const hal_status_t nothing = {0, 0, {0}};
    *status = nothing;
    return hal->status != 0 ? hal->status(hal->context, status) : HAL_OK;
}

static inline void hal_kick_watchdog(const hal_t *hal) {
    if (hal->kick_watchdog != 0) hal->kick_watchdog(hal->context);
}

static inline void hal_close_devices(const hal_t *hal) {
    if (hal->close != 0) hal->close(hal->context);
}

#ifdef __cplusplus
}
#endif

#endif
