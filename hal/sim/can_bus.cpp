#include "bus.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

// 1: cantools was there when this was configured.
#ifndef HAL_WITH_CAN
#define HAL_WITH_CAN 0
#endif

#if HAL_WITH_CAN
#include "can_nodes.h"

#include "hal/can/can_master.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace traction::hal {

namespace {

constexpr std::uint32_t sensor_bits = FRAME_BATTERY | FRAME_ACCEL | FRAME_ACCEL_YZ | FRAME_GYRO | FRAME_GYRO_XY | FRAME_RADAR;

// What the computer's own converters read.
void read_sensors(const sensor_frame_t &devices, sensor_frame_t *frame) {
    frame->present |= devices.present & sensor_bits;
    frame->battery_count = devices.battery_count;
    frame->accel_x_count = devices.accel_x_count;
    frame->accel_y_count = devices.accel_y_count;
    frame->accel_z_count = devices.accel_z_count;
    frame->gyro_x_count = devices.gyro_x_count;
    frame->gyro_y_count = devices.gyro_y_count;
    frame->gyro_z_count = devices.gyro_z_count;
    frame->radar_sequence = devices.radar_sequence;
    frame->radar_samples = devices.radar_samples;
    std::copy(std::begin(devices.radar_count), std::end(devices.radar_count), frame->radar_count);
}

// The nodes, and the computer's side of hal/can.
class CanBus final : public Bus {
  public:
    explicit CanBus(BusConfig config)
        : stop_wired_(config.stop_wired), sensors_wired_(config.sensors_wired), late_ms_(std::move(config.order_late_ms)),
          nodes_(std::move(config)) {}

    void step(std::int64_t now_ms) override { nodes_.step(now_ms); }
    std::optional<BridgeOrder> bridge(int wheel) override { return nodes_.bridge(wheel); }

    hal_result_t read(std::int64_t now_ms, const sensor_frame_t &devices, sensor_frame_t *frame) override {
        can_frame_t sync;
        can_master_sync(&heard_, &master_, &sync);
        for (const can_frame_t &answer : nodes_.answers(now_ms, sync, devices)) (void)can_master_receive(&heard_, &master_, &answer);
        can_master_take(&master_, frame);
        if (sensors_wired_) read_sensors(devices, frame);
        if (stop_wired_) {
            frame->present |= devices.present & static_cast<std::uint32_t>(FRAME_EMERGENCY_STOP);
            frame->emergency_stop = devices.emergency_stop;
        }
        const std::uint32_t told = FRAME_ALL & ~static_cast<std::uint32_t>(FRAME_TIME);
        return (frame->present & told) == 0u ? HAL_ERR_TIMEOUT : HAL_OK;
    }

    hal_result_t write(std::int64_t now_ms, const actuator_frame_t &actuator) override {
        if (nodes_.computer_off(now_ms)) return HAL_ERR_TIMEOUT; // the controller says so
        can_frame_t orders[WHEEL_COUNT];
        can_master_orders(&actuator, orders);
        const auto tick = static_cast<std::size_t>(now_ms * 1000 / TICK_US - 1);
        for (std::size_t i = 0; i < WHEEL_COUNT; i++) // if nobody hears them, nobody tells
            nodes_.order(now_ms + (tick < late_ms_.size() ? late_ms_[tick][i] : 0), orders[i]);
        return HAL_OK;
    }

    void forget() override { nodes_.forget(); }

  private:
    bool stop_wired_, sensors_wired_;
    std::vector<std::array<int, WHEEL_COUNT>> late_ms_;
    can_master_config_t heard_{true, !sensors_wired_, !stop_wired_};
    CanNodes nodes_;
    can_master_state_t master_{};
};

} // namespace

std::unique_ptr<Bus> make_can_bus(BusConfig config) { return std::make_unique<CanBus>(std::move(config)); }

} // namespace traction::hal
#else
namespace traction::hal {
std::unique_ptr<Bus> make_can_bus(BusConfig config) {
    static_cast<void>(std::move(config));
    throw std::runtime_error(
        "bus = \"can\": this build has no CAN, because cantools was not there; ./traction build brings it (python3-venv and "
        "the package index), or leave bus out");
}
} // namespace traction::hal
#endif
