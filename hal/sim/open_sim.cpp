#include "open_sim.h"

#include "forwarding.h"
#include "plan_operator.h"
#include "sim_rover.h"

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traction::hal {

namespace {

struct BadArgument {
    std::string message;
};

struct Request {
    sim::Scenario scenario;
    std::vector<sim::ActiveEffect> effects;
    std::uint64_t seed = 0;
};

Request request_of(std::span<const char *const> argument) {
    if (argument.empty()) throw BadArgument{"--hal sim: no scenario; give its file"};
    Request request{.scenario = sim::read_scenario(argument[0]), .effects = {}, .seed = 0};
    request.seed = request.scenario.seed;
    request.effects = effects_of(request.scenario);
    for (const std::string_view text : argument.subspan(1)) {
        if (text.starts_with("seed=")) {
            const std::string_view number = text.substr(5);
            const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), request.seed);
            if (error != std::errc() || end != number.data() + number.size())
                throw BadArgument{"--hal sim: " + std::string(text) + ": not a seed; give a whole number from 0"};
        } else if (text.starts_with("effect=")) {
            request.effects.push_back(sim::parse_effect(std::string(text.substr(7))));
        } else {
            throw BadArgument{"--hal sim: " + std::string(text) +
                              ": unknown; after the scenario come seed=N and effect=NAME:PARAMETER=VALUE"};
        }
    }
    return request;
}

// Everything the HAL owns. Exceptions end here: the loop is C.
struct Opened {
    explicit Opened(Request asked)
        : request(std::move(asked)), rover(request.scenario, request.effects, request.seed), plan(request.scenario) {}
    Request request;
    SimRover rover;
    PlanOperator plan;
    hal_t world = rover.hal();
    std::string trouble;
    const hal_t &inner() const { return world; }

    template <typename Call> hal_result_t guard(Call call) {
        try {
            return call();
        } catch (const std::exception &error) {
            trouble = error.what();
            return HAL_ERR_IO;
        }
    }
};

hal_t guarded(Opened *opened) {
    hal_t hal = forwarding(opened);
    hal.wait_tick = [](void *context) {
        auto *self = static_cast<Opened *>(context);
        return self->guard([self] { return self->world.wait_tick(self->world.context); });
    };
    hal.read = [](void *context, sensor_frame_t *frame) {
        auto *self = static_cast<Opened *>(context);
        return self->guard([self, frame] { return self->world.read(self->world.context, frame); });
    };
    hal.write = [](void *context, const actuator_frame_t *actuator) {
        auto *self = static_cast<Opened *>(context);
        return self->guard([self, actuator] { return self->world.write(self->world.context, actuator); });
    };
    return hal;
}

} // namespace

} // namespace traction::hal

hal_result_t hal_open_sim(int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]) {
    namespace world = traction::hal; // `hal` alone is the tag of hal_t
    const auto say = [message](const std::string &text) { std::snprintf(message, HAL_MESSAGE, "%s", text.c_str()); };
    message[0] = '\0';
    try {
        auto made = std::make_unique<world::Opened>(world::request_of({argument, static_cast<std::size_t>(count)}));
        if (const traction::sim::FirmwareChoice &firmware = made->request.scenario.firmware;
            firmware.config != "default" || firmware.doppler_scale > 0)
            say(made->request.scenario.file + ": its [firmware] is not used: the daemon has its own (--firmware, --parameters)");
        opened->hal = world::guarded(made.get());
        opened->command = [](void *context, const sensor_frame_t *frame, command_t *command) {
            *command = static_cast<world::Opened *>(context)->plan.command_at(frame->tick);
        };
        opened->trouble = [](void *context) { return static_cast<world::Opened *>(context)->trouble.c_str(); };
        opened->close = [](void *context) { delete static_cast<world::Opened *>(context); };
        (void)made.release();
        return HAL_OK;
    } catch (const world::BadArgument &bad) {
        say(bad.message);
        return HAL_ERR_CONFIG;
    } catch (const std::filesystem::filesystem_error &error) {
        say(error.path1().string() + ": cannot be read: " + error.code().message());
        return HAL_ERR_IO;
    } catch (const std::exception &error) {
        say(error.what());
        return HAL_ERR_IO;
    }
}
