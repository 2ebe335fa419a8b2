// delay_hal.h - a HAL that wraps a HAL and lets its orders take effect late, by whole ticks. Works on any HAL.
//
// An order written in tick k reaches the wrapped HAL in tick k + ticks, where the newest order would have gone: before that tick's
// wait_tick. Until the first is due nothing is written. safe_stop is never late, and forgets what was under way.
#pragma once

#include "hal/hal.h"

#include <cstdint>
#include <deque>

namespace traction::hal {

class DelayHal {
  public:
    // `inner` must outlive this object. ticks: 10 ms each; 0 passes every order on at once.
    DelayHal(const hal_t &inner, std::uint32_t ticks) : inner_(inner), ticks_(ticks) {}
    DelayHal(const DelayHal &) = delete;
    DelayHal &operator=(const DelayHal &) = delete;

    hal_t hal();
    const hal_t &inner() const { return inner_; }

  private:
    struct Order {
        std::uint64_t due; // in ticks of wait_tick
        actuator_frame_t actuator;
    };
    hal_result_t pass_on();

    hal_t inner_;
    std::uint32_t ticks_;
    std::uint64_t now_ = 0; // wait_tick calls so far
    std::deque<Order> under_way_;
    hal_result_t answer_ = HAL_OK; // to the order that was handed on last
};

} // namespace traction::hal
