#include "sync_clock.h"

#include "firmware/core/signals.h"

namespace traction::bus_world {

namespace {
constexpr std::int64_t tick_ns = std::int64_t{TICK_US} * 1000, silence_ns = 50 * tick_ns, gain = 8;
}

std::int64_t SyncClock::sync(std::int64_t now_ns) {
    if (!running_) {
        running_ = true;
        due_ns_ = came_ns_ = now_ns;
        return plant_ns_;
    }
    const std::int64_t since_ns = now_ns - due_ns_;
    const std::int64_t n = since_ns > 0 ? (since_ns + tick_ns / 2) / tick_ns : 0;
    const std::int64_t residual_ns = since_ns - n * tick_ns;
    due_ns_ = now_ns - came_ns_ > silence_ns ? now_ns : due_ns_ + n * tick_ns + residual_ns / gain; // (1)
    plant_ns_ += n * tick_ns;
    came_ns_ = now_ns;
    return plant_ns_;
}

std::int64_t SyncClock::at(std::int64_t now_ns) const {
    return now_ns > came_ns_ && running_ ? plant_ns_ + (now_ns - came_ns_) : plant_ns_;
}

} // namespace traction::bus_world
