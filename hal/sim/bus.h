// bus.h - what lies between the simulated rover's computer and its wheels and sensors, where the scenario says so: `bus = "can"`.
//
// SimHal asks it every millisecond what each bridge does, and every tick for what the nodes said. Without a fault the run is the one of
// `bus = "direct"`, bit for bit (`can_rover_test`).
#pragma once

#include "hal/hal.h"
#include "sim/sensors/can_fault.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace traction::hal {

struct BridgeOrder {
    drive_state_t drive = DRIVE_OFF;
    std::int16_t duty_q15 = 0;
};

class Bus {
  public:
    Bus() = default;
    Bus(const Bus &) = delete;
    Bus &operator=(const Bus &) = delete;
    virtual ~Bus() = default;
    virtual void step(std::int64_t now_ms) = 0;               // frames that are due reach their nodes
    virtual std::optional<BridgeOrder> bridge(int wheel) = 0; // what it does; nothing before its first order
    virtual hal_result_t read(std::int64_t now_ms, const sensor_frame_t &devices, sensor_frame_t *frame) = 0; // one SYNC and its answers
    virtual hal_result_t write(std::int64_t now_ms, const actuator_frame_t &actuator) = 0;
    virtual void forget() = 0; // orders under way
};

struct BusConfig {
    std::vector<sim::CanFault> faults;
    int latency_ms = 0; // of an order
    std::uint64_t seed = 1;
};

// Wheel nodes, sensor node and the computer's side of hal/can. Throws std::runtime_error in a build without cantools.
std::unique_ptr<Bus> make_can_bus(BusConfig config);

} // namespace traction::hal
