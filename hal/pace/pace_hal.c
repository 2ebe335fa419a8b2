#define _POSIX_C_SOURCE 200809L // clock_nanosleep
#include "pace_hal.h"

#include <errno.h>
#include <time.h>

static const int64_t ns_per_s = 1000000000;

static hal_result_t wait_tick(void *context) {
    pace_hal_t *pace = context;
    if (pace->due_ns == 0) {
        struct timespec now;
        (void)clock_gettime(CLOCK_MONOTONIC, &now);
        pace->due_ns = now.tv_sec * ns_per_s + now.tv_nsec;
    }
    const struct timespec due = {.tv_sec = (time_t)(pace->due_ns / ns_per_s), .tv_nsec = (long)(pace->due_ns % ns_per_s)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL) == EINTR) { // a signal: what is left of the tick
    }
    pace->due_ns += (int64_t)TICK_US * 1000;
    return pace->inner.wait_tick(pace->inner.context);
}

static hal_result_t read_inner(void *context, sensor_frame_t *frame) {
    pace_hal_t *pace = context;
    return pace->inner.read(pace->inner.context, frame);
}

static hal_result_t write_inner(void *context, const actuator_frame_t *actuator) {
    pace_hal_t *pace = context;
    return pace->inner.write(pace->inner.context, actuator);
}

static void stop_inner(void *context) {
    pace_hal_t *pace = context;
    pace->inner.safe_stop(pace->inner.context);
}

hal_t pace_hal(pace_hal_t *pace, const hal_t *inner) {
    *pace = (pace_hal_t){.inner = *inner, .due_ns = 0};
    return (hal_t){.context = pace, .wait_tick = wait_tick, .read = read_inner, .write = write_inner, .safe_stop = stop_inner};
}
