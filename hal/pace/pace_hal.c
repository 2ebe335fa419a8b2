#define _POSIX_C_SOURCE 200809L // clock_nanosleep
#include "pace_hal.h"

#include "hal/forward.h"

#include <errno.h>
#include <time.h>

static const int64_t ns_per_s = 1000000000;

static const int64_t tick_ns = (int64_t)TICK_US * 1000;

static int64_t clock_ns(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * ns_per_s + now.tv_nsec;
}

static hal_result_t wait_tick(void *context) {
    pace_hal_t *pace = context;
    const int64_t now_ns = clock_ns();
    if (pace->due_ns == 0) {
        pace->due_ns = now_ns;
    }
    if (now_ns - pace->due_ns > tick_ns) {
        pace->overruns++;
    }
    const struct timespec due = {.tv_sec = (time_t)(pace->due_ns / ns_per_s), .tv_nsec = (long)(pace->due_ns % ns_per_s)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL) == EINTR) { // a signal: what is left of the tick
    }
    pace->due_ns += tick_ns;
    return pace->inner.wait_tick(pace->inner.context);
}

static hal_result_t status_of(void *context, hal_status_t *status) {
    const pace_hal_t *pace = context;
    const hal_result_t result = hal_status(&pace->inner, status);
    status->overruns += pace->overruns;
    return result;
}

hal_t pace_hal(pace_hal_t *pace, const hal_t *inner) {
    *pace = (pace_hal_t){.inner = *inner, .due_ns = 0, .overruns = 0};
    hal_t hal = hal_forward(pace);
    hal.wait_tick = wait_tick;
    hal.status = status_of;
    return hal;
}
