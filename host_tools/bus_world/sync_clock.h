// sync_clock.h - the plant's time by the SYNCs of a computer whose clock is not ours.
//
//   n = max(0, round((t - a) / T)),   a <- a + n T + (t - a - n T) / 8,   W <- W + n T                                          (1)
//
// t: when a SYNC came; a: when the last was due; T: a tick; W: the plant's time. A SYNC that is up to half a tick early or late counts as
// one tick, and a clock that runs 1 % off is followed (its residual settles at 8 n T / 100, below T / 2). After half a second without one
// the next SYNC has a phase of its own.
#pragma once

#include <cstdint>

namespace traction::bus_world {

class SyncClock {
  public:
    // A SYNC came at now_ns, of a clock of ours: the plant's time then.
    std::int64_t sync(std::int64_t now_ns);
    // The plant's time at now_ns, no earlier than the last SYNC's; 0 before the first.
    std::int64_t at(std::int64_t now_ns) const;
    bool running() const { return running_; }

  private:
    std::int64_t due_ns_ = 0, plant_ns_ = 0, came_ns_ = 0;
    bool running_ = false;
};

} // namespace traction::bus_world
