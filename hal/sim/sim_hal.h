// sim_hal.h - the HAL of a simulated rover: the plant and its sensors behind hal_t, in lockstep.
//
// wait_tick advances the plant by one tick (10 steps of 1 ms); simulated time is the only time. Nothing here waits for a device,
// so a dead sensor never stalls the loop. The first wait_tick ends at t = 10 ms and gives tick 0.
#pragma once

#include "bus.h"
#include "counts.h"

#include "hal/hal.h"
#include "sim/plant/plant.h"
#include "sim/scenario/scenario.h"
#include "sim/sensors/sensors.h"

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace traction::hal {

struct WheelBlock {
    int wheel = 0;
    double from_s = 0, to_s = 0; // the wheel is held in between
};

struct SimHalConfig {
    sim::PlantConfig plant;
    sim::SensorConfig sensors;
    CountScale scale;
    std::vector<WheelBlock> wheel_blocks;
    std::vector<WheelBlock> open_motors; // no current flows in between
    std::vector<sim::SupplySag> supply_sags;
    int bus_latency_ms = 0;  // 0..9: an order acts so long after it is written; whole ticks are delay_hal.h's
    std::uint32_t ticks = 0; // HAL_END after so many
    std::uint64_t seed = 1;
    bool can_bus = false; // between computer, wheels and sensors: bus.h
    std::vector<sim::CanFault> can_faults;
};

class SimHal {
  public:
    // `bus`: instead of the one of config.can_bus.
    explicit SimHal(const SimHalConfig &config, std::unique_ptr<Bus> bus = nullptr);
    SimHal(const SimHal &) = delete;
    SimHal &operator=(const SimHal &) = delete;

    hal_t hal();

    // What no device of the rover tells: for the record and for tests.
    const sim::Truth &truth() const { return plant_.truth(); }
    std::span<const sim::Pose> camera() const { return measured_.camera; } // poses taken in the last tick

  private:
    void advance();
    SimHalConfig config_;
    sim::Plant plant_;
    sim::Sensors sensors_;
    sim::Measurements measured_;
    std::uint32_t done_ticks_ = 0, read_ticks_ = 0;
    std::int64_t heard_ms_ = 0;                  // when the bridges took their last order
    std::optional<std::uint32_t> last_sequence_; // of that order
    std::int64_t now_ms_ = 0;
    struct Order {
        std::int64_t due_ms;
        std::array<double, sim::wheel_count> duty;
        drive_state_t drive;
        std::uint32_t sequence;
        double curvature_1_m;
    };
    void obey(const Order &order);
    void obey_nodes();
    void fail_motors(double t_s);
    void tell(hal_status_t *status) const;
    std::deque<Order> orders_;                    // written, not yet in effect
    std::unique_ptr<Bus> bus_;                    // null: direct
    std::array<bool, sim::wheel_count> let_go_{}; // by its own node alone, while others drive
    std::uint32_t lost_writes_ = 0;
};

} // namespace traction::hal
