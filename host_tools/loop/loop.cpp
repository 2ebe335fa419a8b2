#include "loop.h"

#include "hal/sim/forwarding.h"

#include <exception>

namespace traction {

namespace {

struct Guard {
    const hal_t &world;
    Link &link;
    std::exception_ptr thrown;
    const hal_t &inner() const { return world; }

    // A call that may throw; after the first throw nothing is called any more.
    template <typename Call> hal_result_t call(Call what) {
        if (thrown) return HAL_ERR_IO;
        try {
            return what();
        } catch (...) {
            thrown = std::current_exception();
            return HAL_ERR_IO;
        }
    }
};

hal_t guarded(Guard &guard) {
    hal_t hal = hal::forwarding(&guard);
    hal.wait_tick = [](void *context) {
        auto &g = *static_cast<Guard *>(context);
        return g.call([&g] { return g.link.over() ? HAL_END : g.world.wait_tick(g.world.context); });
    };
    hal.read = [](void *context, sensor_frame_t *frame) {
        auto &g = *static_cast<Guard *>(context);
        return g.call([&g, frame] { return g.world.read(g.world.context, frame); });
    };
    hal.write = [](void *context, const actuator_frame_t *actuator) {
        auto &g = *static_cast<Guard *>(context);
        return g.call([&g, actuator] { return g.world.write(g.world.context, actuator); });
    };
    return hal;
}

} // namespace

daemon_result_t run_loop(const hal_t &hal, const control_config_t &config, Link &link, const daemon_start_t &start) {
    Guard guard{.world = hal, .link = link, .thrown = {}};
    const hal_t outer = guarded(guard);
    const daemon_link_t hooks{.context = &guard,
                              .command =
                                  [](void *context, const sensor_frame_t *frame, command_t *command) {
                                      auto &g = *static_cast<Guard *>(context);
                                      g.call([&g, frame, command] { return g.link.command(*frame, *command), HAL_OK; });
                                  },
                              .log =
                                  [](void *context, const sensor_frame_t *frame, const command_t *command, const trace_t *trace) {
                                      auto &g = *static_cast<Guard *>(context);
                                      g.call([&] { return g.link.log(*frame, *command, *trace), HAL_OK; });
                                  }};
    const daemon_result_t result = daemon_run_from(&outer, &config, &hooks, &start);
    if (guard.thrown) std::rethrow_exception(guard.thrown);
    return result;
}

} // namespace traction
