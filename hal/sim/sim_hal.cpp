#include "sim_hal.h"

namespace traction::hal {

namespace {
constexpr int steps_per_tick = TICK_US / 1000; // the plant's step is 1 ms
} // namespace

SimHal::SimHal(const SimHalConfig &config) : config_(config), plant_(config.plant), sensors_(config.sensors, config.seed, plant_.truth()) {}

// An order that comes twice is none. Braking shorts the winding: a driven bridge whose duty is 0.
void SimHal::obey(const Order &order) {
    if (last_sequence_ == order.sequence) return;
    last_sequence_ = order.sequence;
    heard_ms_ = now_ms_;
    for (int wheel = 0; wheel < sim::wheel_count; wheel++)
        plant_.set_duty(wheel, order.drive == DRIVE_ON ? order.duty[static_cast<std::size_t>(wheel)] : 0);
    plant_.set_enabled(order.drive == DRIVE_ON || order.drive == DRIVE_BRAKE);
}

// One tick of the world under the orders that have come into effect.
void SimHal::advance() {
    for (int i = 0; i < steps_per_tick; i++) {
        while (!orders_.empty() && orders_.front().due_ms <= now_ms_) {
            obey(orders_.front());
            orders_.pop_front();
        }
        if (now_ms_ - heard_ms_ > BRIDGE_RELEASE_MS) plant_.set_enabled(false); // signals.h: it releases itself
        const double t_s = static_cast<double>(now_ms_) * 1e-3;
        for (const WheelBlock &block : config_.wheel_blocks) {
            if (t_s >= block.to_s && t_s < block.to_s + 1.5e-3) plant_.block_wheel(block.wheel, false);
            if (t_s >= block.from_s && t_s < block.to_s) plant_.block_wheel(block.wheel, true);
        }
        fail_motors(t_s);
        plant_.step();
        now_ms_++;
        sensors_.step(plant_.truth());
    }
    // the radar's FIFO and the camera's poses wait for whoever reads
    sim::Measurements now;
    sensors_.measure(now);
    if (read_ticks_ != done_ticks_) {
        now.radar_first = measured_.radar_first;
        now.radar_count.insert(now.radar_count.begin(), measured_.radar_count.begin(), measured_.radar_count.end());
        now.camera.insert(now.camera.begin(), measured_.camera.begin(), measured_.camera.end());
    }
    std::swap(measured_, now);
}

void SimHal::fail_motors(double t_s) {
    if (config_.open_motors.empty() && config_.supply_sags.empty()) return;
    for (int wheel = 0; wheel < sim::wheel_count; wheel++) {
        bool open = false;
        for (const WheelBlock &span : config_.open_motors) open = open || (span.wheel == wheel && t_s >= span.from_s && t_s < span.to_s);
        plant_.open_motor(wheel, open);
    }
    double sag_V = 0;
    for (const sim::SupplySag &sag : config_.supply_sags) sag_V += t_s >= sag.from_s && t_s < sag.to_s ? sag.sag_V : 0;
    plant_.sag_supply(sag_V);
}

hal_t SimHal::hal() {
    hal_t hal{};
    hal.context = this;
    hal.wait_tick = [](void *context) {
        auto *self = static_cast<SimHal *>(context);
        if (self->done_ticks_ >= self->config_.ticks) return HAL_END;
        self->advance();
        self->done_ticks_++;
        return HAL_OK;
    };
    hal.read = [](void *context, sensor_frame_t *frame) {
        auto *self = static_cast<SimHal *>(context);
        if (self->done_ticks_ == 0) return HAL_ERR_TIMEOUT; // nothing was measured yet
        *frame = {};
        frame->tick = self->done_ticks_ - 1;
        frame->elapsed_ticks = self->done_ticks_ - self->read_ticks_;
        frame->time_us = static_cast<std::uint32_t>(self->now_ms_ * 1000);
        self->read_ticks_ = self->done_ticks_;
        to_counts(self->config_.scale, self->measured_, frame);
        return HAL_OK;
    };
    hal.write = [](void *context, const actuator_frame_t *actuator) {
        auto *self = static_cast<SimHal *>(context);
        Order order{
            .due_ms = self->now_ms_ + self->config_.bus_latency_ms, .duty = {}, .drive = actuator->drive, .sequence = actuator->sequence};
        for (std::size_t i = 0; i < sim::wheel_count; i++) order.duty[i] = actuator->duty_q15[i] / 32767.0;
        self->orders_.push_back(order);
        return HAL_OK;
    };
    hal.safe_stop = [](void *context) {
        auto *self = static_cast<SimHal *>(context);
        self->orders_.clear();
        self->plant_.set_enabled(false);
    };
    hal.open = [](void *) { return HAL_OK; };
    hal.self_test = [](void *context, hal_status_t *status) { return static_cast<SimHal *>(context)->tell(status), HAL_OK; };
    hal.status = hal.self_test;
    return hal;
}

// Every device of the simulated rover is there.
void SimHal::tell(hal_status_t *status) const {
    for (unsigned device = 0; device < HAL_DEVICES; device++) status->device[device] = HAL_DEVICE_WORKS;
}

} // namespace traction::hal
