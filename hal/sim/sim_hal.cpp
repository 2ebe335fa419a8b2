#include "sim_hal.h"

#include <utility>

namespace traction::hal {

namespace {
constexpr int steps_per_tick = TICK_US / 1000; // the plant's step is 1 ms
} // namespace

SimHal::SimHal(const SimHalConfig &config, std::unique_ptr<Bus> bus)
    : config_(config), plant_(config.plant), sensors_(config.sensors, config.seed, plant_.truth()), bus_(std::move(bus)) {
    if (!bus_ && config.can_bus)
        bus_ = make_can_bus({.faults = config.can_faults, .latency_ms = config.bus_latency_ms, .seed = config.seed});
}

// An order that comes twice is none. Braking shorts the winding: a driven bridge whose duty is 0.
void SimHal::obey(const Order &order) {
    if (last_sequence_ == order.sequence) return;
    last_sequence_ = order.sequence;
    heard_ms_ = now_ms_;
    for (int wheel = 0; wheel < sim::wheel_count; wheel++)
        plant_.set_duty(wheel, order.drive == DRIVE_ON ? order.duty[static_cast<std::size_t>(wheel)] : 0);
    if (config_.plant.rover.layout.kind == sim::Layout::six) // the firmware knows four wheels: a middle one follows its side
        for (int side = 0; side < 2; side++) {
            const auto rear = static_cast<std::size_t>(side), front = rear + 2;
            plant_.set_duty(4 + side, order.drive == DRIVE_ON ? 0.5 * (order.duty[rear] + order.duty[front]) : 0);
        }
    plant_.set_curvature(order.curvature_1_m); // the servo has a supply of its own: it holds while the motors are released
    plant_.set_enabled(order.drive == DRIVE_ON || order.drive == DRIVE_BRAKE);
}

// Each node's own say. While one drives or brakes, a bridge that let go is an open winding; when all have, nothing flows.
void SimHal::obey_nodes() {
    std::array<bool, sim::wheel_count> driven{};
    bool any = false, ordered = false;
    for (int wheel = 0; wheel < sim::wheel_count; wheel++) {
        const std::optional<BridgeOrder> order = bus_->bridge(wheel);
        ordered = ordered || order.has_value();
        const drive_state_t drive = order ? order->drive : DRIVE_OFF;
        if (order) plant_.set_duty(wheel, drive == DRIVE_ON ? order->duty_q15 / 32767.0 : 0);
        driven[static_cast<std::size_t>(wheel)] = drive == DRIVE_ON || drive == DRIVE_BRAKE;
        any = any || driven[static_cast<std::size_t>(wheel)];
    }
    if (ordered) plant_.set_enabled(any);
    for (std::size_t i = 0; i < driven.size(); i++) let_go_[i] = any && !driven[i];
}

// One tick of the world under the orders that have come into effect.
void SimHal::advance() {
    for (int i = 0; i < steps_per_tick; i++) {
        while (!orders_.empty() && orders_.front().due_ms <= now_ms_) {
            obey(orders_.front());
            orders_.pop_front();
        }
        if (bus_) {
            bus_->step(now_ms_);
            obey_nodes();
        } else if (now_ms_ - heard_ms_ > BRIDGE_RELEASE_MS)
            plant_.set_enabled(false); // signals.h: it releases itself
        const double t_s = static_cast<double>(now_ms_) * 1e-3;
        for (const WheelBlock &block : config_.wheel_blocks) {
            if (t_s >= block.to_s && t_s < block.to_s + 1.5e-3) plant_.block_wheel(block.wheel, false);
            if (t_s >= block.from_s && t_s < block.to_s) plant_.block_wheel(block.wheel, true);
        }
        fail_motors(t_s);
        plant_.step();
        now_ms_++;
        sensors_.step(i + 1 < steps_per_tick ? plant_.truth_of_body() : plant_.truth()); // of the wheels the last alone is measured
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
    if (config_.open_motors.empty() && config_.supply_sags.empty() && !bus_) return;
    for (int wheel = 0; wheel < sim::wheel_count; wheel++) {
        bool open = let_go_[static_cast<std::size_t>(wheel)];
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
        if (!self->bus_) {
            to_counts(self->config_.scale, self->measured_, frame);
            return HAL_OK;
        }
        sensor_frame_t devices{};
        to_counts(self->config_.scale, self->measured_, &devices);
        frame->present = FRAME_TIME; // the computer's own
        return self->bus_->read(self->now_ms_, devices, frame);
    };
    hal.write = [](void *context, const actuator_frame_t *actuator) {
        auto *self = static_cast<SimHal *>(context);
        if (self->bus_) {
            const hal_result_t written = self->bus_->write(self->now_ms_, *actuator);
            self->lost_writes_ += written == HAL_ERR_TIMEOUT ? 1 : 0;
            return written;
        }
        Order order{.due_ms = self->now_ms_ + self->config_.bus_latency_ms,
                    .duty = {},
                    .drive = actuator->drive,
                    .sequence = actuator->sequence,
                    .curvature_1_m = static_cast<double>(actuator->curvature_1_m)};
        for (std::size_t i = 0; i < sim::wheel_count; i++) order.duty[i] = actuator->duty_q15[i] / 32767.0;
        self->orders_.push_back(order);
        return HAL_OK;
    };
    hal.safe_stop = [](void *context) {
        auto *self = static_cast<SimHal *>(context);
        self->orders_.clear();
        if (self->bus_) self->bus_->forget();
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
    status->lost_writes = lost_writes_;
}

} // namespace traction::hal
