// world.h - the world of the emulated board: a scenario's rover and the nodes on its CAN bus, advanced by what the board says and when.
//
//   tick k:   the board's SYNC nearest to t0 + 10 ms k, t0 being its first; the plant stands at 10 (k + 1) ms, as in the simulator
//   order:    acts in the plant's step of 1 ms in which it arrives, counted from its tick's SYNC                                  (1)
//
// Frames, lines and counts are the simulator's (hal/sim); there is no second model of anything. A tick without a SYNC passes for the plant.
#pragma once

#include "emulate/lockstep.h"
#include "hal/sim/sim_rover.h"
#include "sim/scenario/scenario.h"

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace traction::emulate {

enum class Sensors {
    can, // radar, IMU and battery at a node
    iio, // at the board's converters
};

struct BoardSays {
    lockstep_board_t head{};
    std::vector<lockstep_frame_t> frames;
};

struct WorldSays {
    lockstep_world_t head{};
    std::vector<lockstep_frame_t> frames;
    std::vector<std::int32_t> samples;
};

struct Span_us {
    double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
    void add(double value) {
        least = value < least ? value : least;
        most = value > most ? value : most;
    }
};

struct Counts {
    std::uint32_t ticks = 0, unread = 0;                     // of the plant; those that no SYNC asked for
    std::uint64_t frames_from = 0, frames_to = 0;            // the board
    Span_us late, order;                                     // SYNC after t0 + 10 ms k; orders after their SYNC, on the board's clock
    std::vector<std::array<int, WHEEL_COUNT>> order_late_ms; // (1): of each tick of the plant
};

class World {
  public:
    // Throws sim::ScenarioError for a fault that wires or the board's clock cannot carry. `scenario` must outlive this object.
    World(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, std::uint64_t seed, Sensors sensors,
          const std::string &where = "the emulated board"); // for messages
    World(const World &) = delete;
    World &operator=(const World &) = delete;
    ~World();

    WorldSays hear(const BoardSays &board);
    const Counts &counts() const { return counts_; }
    bool over() const { return over_; } // the scenario's duration has passed

  private:
    class Wires;
    void advance();
    void on_sync(std::int64_t time_ns, const lockstep_frame_t &frame, WorldSays &out);
    void on_order(std::int64_t time_ns, const lockstep_frame_t &frame);
    void convert(const sensor_frame_t &frame, WorldSays &out) const;

    Sensors sensors_;
    int radar_rate_Hz_;
    Wires *wires_; // the rover's
    std::unique_ptr<hal::SimRover> rover_;
    hal_t hal_{};
    Counts counts_;
    std::int64_t begin_ns_ = 0, sync_ns_ = 0;
    std::uint32_t lines_;
    bool begun_ = false, over_ = false;
};

} // namespace traction::emulate
