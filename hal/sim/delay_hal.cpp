#include "delay_hal.h"

#include "forwarding.h"

namespace traction::hal {

// Hands on what is due now. A bridge that does not answer is told to whoever writes next, as it would be without the delay.
hal_result_t DelayHal::pass_on() {
    hal_result_t result = HAL_OK;
    while (!under_way_.empty() && under_way_.front().due <= now_) {
        const actuator_frame_t actuator = under_way_.front().actuator;
        under_way_.pop_front();
        if (const hal_result_t written = inner_.write(inner_.context, &actuator); written < 0) result = written;
    }
    return result;
}

hal_t DelayHal::hal() {
    hal_t wrapped = forwarding(this);
    wrapped.wait_tick = [](void *context) {
        auto *self = static_cast<DelayHal *>(context);
        self->answer_ = self->pass_on();
        if (self->answer_ < 0 && self->answer_ != HAL_ERR_TIMEOUT) return self->answer_;
        self->now_++;
        return self->inner_.wait_tick(self->inner_.context);
    };
    wrapped.write = [](void *context, const actuator_frame_t *actuator) {
        auto *self = static_cast<DelayHal *>(context);
        if (self->ticks_ == 0) return self->inner_.write(self->inner_.context, actuator);
        self->under_way_.push_back({.due = self->now_ + self->ticks_, .actuator = *actuator});
        return self->answer_;
    };
    wrapped.safe_stop = [](void *context) {
        auto *self = static_cast<DelayHal *>(context);
        self->under_way_.clear();
        self->inner_.safe_stop(self->inner_.context);
    };
    return wrapped;
}

} // namespace traction::hal
