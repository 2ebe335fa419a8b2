// sim_rover.h - the rover of a scenario behind one hal_t: world, then late orders, then failing sensors, each a HAL around a HAL.
//
// Whoever drives a scenario's rover (simulate, tune, tractiond) takes it from here, so all of them meet the same one.
#pragma once

#include "delay_hal.h"
#include "fault_hal.h"
#include "sim_hal.h"

#include "sim/scenario/scenario.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace traction::hal {

// The effects of a scenario, drawn and hidden ones after those it states.
std::vector<sim::ActiveEffect> effects_of(const sim::Scenario &scenario);

// The world of a scenario with `effects` (the scenario's own must be among them). Ends after the scenario's duration.
SimHalConfig world_of(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, std::uint64_t seed);

// Sum of the delays of every actuation_delay among `effects`, in the plant's steps [ms].
std::int64_t actuation_delay_ms(std::span<const sim::ActiveEffect> effects);

class SimRover {
  public:
    // Sensor faults and emergency stops are the scenario's. Noise of sensors and faults is drawn from `seed`.
    SimRover(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, std::uint64_t seed);
    // The same with a world of the caller's making, and a bus (null: the world's).
    SimRover(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, const SimHalConfig &world,
             std::unique_ptr<Bus> bus = nullptr);

    hal_t hal() { return faults_.hal(); }
    const SimHal &world() const { return world_; } // what no device of the rover tells

  private:
    SimHal world_;
    DelayHal delay_;
    FaultHal faults_;
};

} // namespace traction::hal
