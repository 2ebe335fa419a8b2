#include "delay_hal.h"

namespace traction::hal {

// Hands on what is due now. A bridge that does not answer is lost: what it does is not known (hal.h).
hal_result_t DelayHal::pass_on() {
    while (!under_way_.empty() && under_way_.front().due <= now_) {
        const actuator_frame_t actuator = under_way_.front().actuator;
        under_way_.pop_front();
        if (inner_.write(inner_.context, &actuator) < 0) return HAL_ERR_IO;
    }
    return HAL_OK;
}

hal_t DelayHal::hal() {
    hal_t wrapped{};
    wrapped.context = this;
    wrapped.wait_tick = [](void *context) {
        auto *self = static_cast<DelayHal *>(context);
        if (const hal_result_t written = self->pass_on(); written < 0) return written;
        self->now_++;
        return self->inner_.wait_tick(self->inner_.context);
    };
    wrapped.read = [](void *context, sensor_frame_t *frame) {
        auto *self = static_cast<DelayHal *>(context);
        return self->inner_.read(self->inner_.context, frame);
    };
    wrapped.write = [](void *context, const actuator_frame_t *actuator) {
        auto *self = static_cast<DelayHal *>(context);
        if (self->ticks_ == 0) return self->inner_.write(self->inner_.context, actuator);
        self->under_way_.push_back({.due = self->now_ + self->ticks_, .actuator = *actuator});
        return HAL_OK;
    };
    wrapped.safe_stop = [](void *context) {
        auto *self = static_cast<DelayHal *>(context);
        self->under_way_.clear();
        self->inner_.safe_stop(self->inner_.context);
    };
    return wrapped;
}

} // namespace traction::hal
