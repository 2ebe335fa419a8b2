// forwarding.h - hal/forward.h for C++ wrappers: every call handed on to the HAL inside, for the wrapper to change where it differs.
#pragma once

#include "hal/hal.h"

namespace traction::hal {

// `Self` has `const hal_t &inner() const` for what it wraps; `self` must outlive what is returned.
template <typename Self> hal_t forwarding(Self *self) {
    static constexpr auto of = [](void *context) -> const hal_t & { return static_cast<Self *>(context)->inner(); };
    hal_t hal{};
    hal.context = self;
    hal.wait_tick = [](void *c) { return of(c).wait_tick(of(c).context); };
    hal.read = [](void *c, sensor_frame_t *frame) { return of(c).read(of(c).context, frame); };
    hal.write = [](void *c, const actuator_frame_t *actuator) { return of(c).write(of(c).context, actuator); };
    hal.safe_stop = [](void *c) { of(c).safe_stop(of(c).context); };
    hal.open = [](void *c) { return hal_open_devices(&of(c)); };
    hal.self_test = [](void *c, hal_status_t *status) { return hal_self_test(&of(c), status); };
    hal.status = [](void *c, hal_status_t *status) { return hal_status(&of(c), status); };
    hal.kick_watchdog = [](void *c) { hal_kick_watchdog(&of(c)); };
    hal.close = [](void *c) { hal_close_devices(&of(c)); };
    return hal;
}

} // namespace traction::hal
