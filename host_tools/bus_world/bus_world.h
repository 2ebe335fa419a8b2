// bus_world.h - a scenario's rover on a CAN bus of this machine, in real time: `traction simulate SCENARIO --can vcan0`. Its wheel nodes
// and its sensor node answer whatever computer sends SYNC and orders there; the plant goes on when nobody does.
//
// The world is the emulated board's (host_tools/emulate/world.h): no second model of anything. The bridges have their supply always, and
// the emergency stop is the sensor node's, for a bus has no lines.
#pragma once

#include "sync_clock.h"

#include "hal/linux/can_socket.h"
#include "host_tools/emulate/world.h"

#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::bus_world {

class BusWorld {
  public:
    // Throws sim::ScenarioError for what no bus can carry. `scenario` must outlive this object.
    BusWorld(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, std::uint64_t seed);
    // A frame that came at now_ns, or none: what the nodes answer.
    std::vector<can_frame_t> hear(std::int64_t now_ns, const can_frame_t *frame);
    const emulate::Counts &counts() const { return world_.counts(); }
    bool begun() const { return clock_.running(); }
    bool over() const { return world_.over(); } // the scenario's duration has passed

  private:
    emulate::World world_;
    SyncClock clock_;
};

struct Hooks {
    std::function<bool()> stopped;      // asked every few milliseconds; true ends the run
    std::function<void()> begun;        // at the first SYNC
    std::function<void()> after_second; // called after every second of the plant
};

struct Run {
    emulate::Counts counts;
    std::uint64_t lost = 0; // frames for which the bus had no room
    bool interrupted = false;
};

// Opens `interface` as the nodes do. Throws std::runtime_error, with the mend, where there is none, or the kernel knows no CAN.
can_socket_t open_bus(const std::string &interface);

// Until the scenario's duration has passed. Throws std::runtime_error when the bus goes away.
Run answer(BusWorld &world, can_socket_t &bus, const std::string &interface, const Hooks &hooks);

} // namespace traction::bus_world
