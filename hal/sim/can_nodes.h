// can_nodes.h - the nodes of the simulated rover at their end of the CAN bus, and what the bus does to frames by the scenario.
//
// Two computers sit at the other end: the simulated one of hal/sim/can_bus.cpp, and the emulated board's (host_tools/emulate). Both hear
// the same frames from the same draws of chance. Needs cantools at build time (hal/can).
#pragma once

#include "bus.h"

#include "hal/can/can_frame.h"
#include "hal/node/wheel_node.h"
#include "sim/sensors/random.h"

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace traction::hal {

class CanNodes {
  public:
    using Frames = std::vector<can_frame_t>;
    explicit CanNodes(BusConfig config);
    CanNodes(const CanNodes &) = delete;
    CanNodes &operator=(const CanNodes &) = delete;

    // A millisecond: orders that are due reach their nodes, and a bridge that hears none lets go.
    void step(std::int64_t now_ms);
    // What it does; nothing before its first order.
    std::optional<BridgeOrder> bridge(int wheel);

    // The computer's SYNC (or whatever it sends in its place): what it hears in this tick, answers that were late included. `devices`:
    // what the nodes' inputs read.
    Frames answers(std::int64_t now_ms, const can_frame_t &sync, const sensor_frame_t &devices);
    // The computer's order: takes effect in the step of now_ms + latency.
    void order(std::int64_t now_ms, const can_frame_t &frame);
    void forget() { under_way_.clear(); } // orders

    // The computer's controller hears and sends nothing; and it knows (bus-off).
    bool computer_cut_off(std::int64_t now_ms);
    bool computer_off(std::int64_t now_ms);

  private:
    struct Order {
        std::int64_t due_ms;
        can_frame_t frame;
    };
    void push(const Order &order);
    bool in_force(const sim::CanFault &fault, sim::CanNode node) const;
    bool off(sim::CanNode node) const;
    bool cut_off(sim::CanNode node) const;
    void spoil(can_frame_t &frame);
    void send(sim::CanNode from, can_frame_t frame, Frames &out);
    void to_wheels(const can_frame_t &frame, const sensor_frame_t *devices, Frames *answers);
    void to_sensors(const can_frame_t &frame, const sensor_frame_t &devices, Frames &answers);

    BusConfig config_;
    sim::Random random_;
    std::int64_t now_ms_ = 0;
    std::array<wheel_node_state_t, WHEEL_COUNT> wheel_{};
    std::deque<Order> under_way_; // in the order in which they arrive
    Frames late_answers_, later_answers_;
    bool sending_order_ = false;
};

} // namespace traction::hal
