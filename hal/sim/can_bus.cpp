#include "bus.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>

// 1: cantools was there when this was configured.
#ifndef HAL_WITH_CAN
#define HAL_WITH_CAN 0
#endif

#if HAL_WITH_CAN
#include "can_nodes.h"

#include "hal/can/can_master.h"

#include <utility>

namespace traction::hal {

namespace {

constexpr can_master_config_t everything{true, true, true};

// The nodes, and the computer's side of hal/can.
class CanBus final : public Bus {
  public:
    explicit CanBus(BusConfig config) : nodes_(std::move(config)) {}

    void step(std::int64_t now_ms) override { nodes_.step(now_ms); }
    std::optional<BridgeOrder> bridge(int wheel) override { return nodes_.bridge(wheel); }

    hal_result_t read(std::int64_t now_ms, const sensor_frame_t &devices, sensor_frame_t *frame) override {
        can_frame_t sync;
        can_master_sync(&everything, &master_, &sync);
        for (const can_frame_t &answer : nodes_.answers(now_ms, sync, devices)) (void)can_master_receive(&everything, &master_, &answer);
        can_master_take(&master_, frame);
        const std::uint32_t told = FRAME_ALL & ~static_cast<std::uint32_t>(FRAME_TIME);
        return (frame->present & told) == 0u ? HAL_ERR_TIMEOUT : HAL_OK;
    }

    hal_result_t write(std::int64_t now_ms, const actuator_frame_t &actuator) override {
        if (nodes_.computer_off(now_ms)) return HAL_ERR_TIMEOUT; // the controller says so
        can_frame_t orders[WHEEL_COUNT];
        can_master_orders(&actuator, orders);
        for (const can_frame_t &order : orders) nodes_.order(now_ms, order); // if nobody hears them, nobody tells
        return HAL_OK;
    }

    void forget() override { nodes_.forget(); }

  private:
    CanNodes nodes_;
    can_master_state_t master_{};
};

} // namespace

std::unique_ptr<Bus> make_can_bus(BusConfig config) { return std::make_unique<CanBus>(std::move(config)); }

} // namespace traction::hal
#else
namespace traction::hal {
std::unique_ptr<Bus> make_can_bus(BusConfig) {
    throw std::runtime_error(
        "bus = \"can\": this build has no CAN, because cantools was not there; ./traction build brings it (python3-venv and "
        "the package index), or leave bus out");
}
} // namespace traction::hal
#endif
