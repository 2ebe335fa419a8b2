#include "sim_rover.h"

#include "sim/physics/effects/acting.h"

#include <utility>

namespace traction::hal {

namespace {
constexpr std::int64_t tick_ms = TICK_US / 1000;
} // namespace

std::vector<sim::ActiveEffect> effects_of(const sim::Scenario &scenario) {
    std::vector<sim::ActiveEffect> effects = scenario.effects;
    if (scenario.hidden) {
        const auto hidden = sim::draw_effects(*scenario.hidden);
        effects.insert(effects.end(), hidden.begin(), hidden.end());
    }
    return effects;
}

std::int64_t actuation_delay_ms(std::span<const sim::ActiveEffect> effects) {
    const double delay_s = sim::law::actuation_delay_s(0, sim::act_together(effects).body.actuation_delay_s);
    return static_cast<std::int64_t>(delay_s * 1000 + 0.5);
}

// Whole ticks of an order's delay are DelayHal's; what is left of a tick passes on the simulated bus.
SimHalConfig world_of(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, std::uint64_t seed) {
    sim::check_wheels(scenario, effects);
    SimHalConfig world{.plant = scenario.plant,
                       .sensors = scenario.sensors,
                       .scale = count_scale(scenario.rover),
                       .wheel_blocks = {},
                       .open_motors = {},
                       .supply_sags = {},
                       .bus_latency_ms = static_cast<int>(actuation_delay_ms(effects) % tick_ms),
                       .ticks = static_cast<std::uint32_t>(scenario.duration_s * 100 + 0.5),
                       .seed = seed,
                       .can_bus = scenario.can_bus,
                       .can_faults = scenario.can_faults};
    world.plant.audit = false; // nobody asks a HAL for it
    world.plant.effects.assign(effects.begin(), effects.end());
    const std::vector<sim::ActiveEffect> wheels = sim::wheel_differences(scenario.rover);
    world.plant.effects.insert(world.plant.effects.end(), wheels.begin(), wheels.end());
    world.plant.ground.seed = scenario.ground_seed.value_or(sim::mix64(seed));
    world.sensors.on_terrain = !scenario.plant.ground.terrain.flat();
    sim::apply_sensor_effects(effects, world.sensors);
    for (const sim::WheelBlockSpan &block : scenario.wheel_blocks) world.wheel_blocks.push_back({block.wheel, block.from_s, block.to_s});
    for (const sim::WheelBlockSpan &open : scenario.open_motors) world.open_motors.push_back({open.wheel, open.from_s, open.to_s});
    // a bridge that cannot be reached lets its motor go after its time (signals.h)
    for (const sim::SensorFault &fault : scenario.sensor_faults)
        for (int wheel = 0; fault.sensor == sim::FaultySensor::bridge && wheel < sim::wheel_count; wheel++)
            if (fault.wheel < 0 || fault.wheel == wheel)
                world.open_motors.push_back({wheel, fault.from_s + static_cast<double>(BRIDGE_RELEASE_MS) * 1e-3, fault.to_s});
    world.supply_sags = scenario.supply_sags;
    return world;
}

SimRover::SimRover(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, std::uint64_t seed)
    : SimRover(scenario, effects, world_of(scenario, effects, seed)) {}

SimRover::SimRover(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, const SimHalConfig &world,
                   std::unique_ptr<Bus> bus)
    : world_(world, std::move(bus)), delay_(world_.hal(), static_cast<std::uint32_t>(actuation_delay_ms(effects) / tick_ms)),
      faults_(delay_.hal(),
              {.sensors = scenario.sensor_faults, .emergency_stop_s = scenario.emergency_stops, .missed_ticks = scenario.missed_ticks},
              world.scale, world.seed) {}

} // namespace traction::hal
