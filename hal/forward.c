#include "forward.h"

static const hal_t *inner(void *context) { return context; }

static hal_result_t wait_tick(void *context) { return inner(context)->wait_tick(inner(context)->context); }
static hal_result_t read_frame(void *context, sensor_frame_t *frame) { return inner(context)->read(inner(context)->context, frame); }
static hal_result_t write_frame(void *context, const actuator_frame_t *actuator) {
    return inner(context)->write(inner(context)->context, actuator);
}
static void safe_stop(void *context) { inner(context)->safe_stop(inner(context)->context); }
static hal_result_t open_devices(void *context) { return hal_open_devices(inner(context)); }
static hal_result_t self_test(void *context, hal_status_t *status) { return hal_self_test(inner(context), status); }
static hal_result_t status_of(void *context, hal_status_t *status) { return hal_status(inner(context), status); }
static void kick_watchdog(void *context) { hal_kick_watchdog(inner(context)); }
static void close_devices(void *context) { hal_close_devices(inner(context)); }

hal_t hal_forward(void *context) {
    return (hal_t){.context = context,
                   .wait_tick = wait_tick,
                   .read = read_frame,
                   .write = write_frame,
                   .safe_stop = safe_stop,
                   .open = open_devices,
                   .self_test = self_test,
                   .status = status_of,
                   .kick_watchdog = kick_watchdog,
                   .close = close_devices};
}
