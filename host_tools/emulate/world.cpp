#include "world.h"

#include "hal/sim/can_nodes.h"
#include "sim/scenario/scenario_error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

namespace traction::emulate {

namespace {

constexpr std::int64_t tick_ns = std::int64_t{TICK_US} * 1000, step_ns = 1000000, tick_ms = TICK_US / 1000;

can_frame_t of_board(const lockstep_frame_t &frame) {
    can_frame_t out{.id = frame.id & 0x7ffu, .length = std::min<std::uint8_t>(frame.length, 8), .data = {}};
    std::memcpy(out.data, frame.data, sizeof out.data);
    return out;
}

lockstep_frame_t to_board(const can_frame_t &frame) {
    lockstep_frame_t out{.id = frame.id, .length = frame.length, .zero = {}, .data = {}};
    std::memcpy(out.data, frame.data, sizeof out.data);
    return out;
}

bool of_sensor_node(const can_frame_t &frame) { return frame.id >= CAN_ACCEL && frame.id <= CAN_RADAR; }

// What happens inside the rover's computer in the simulator has no wire to come by.
void check(const sim::Scenario &scenario, Sensors sensors, const std::string &where) {
    const auto refuse = [&](const std::string &what, const std::string &mend) {
        throw sim::ScenarioError(scenario.file, 0, "fault", what, where + " cannot have it", mend);
    };
    if (scenario.rover.layout().kind != sim::Layout::four)
        throw sim::ScenarioError(scenario.file, 0, "layout.wheels", std::to_string(static_cast<int>(scenario.rover.at("layout", "wheels"))),
                                 where + " has four wheel nodes", "use `traction simulate`, where the wheels are wired");
    if (scenario.rover.drives[0] >= 0)
        throw sim::ScenarioError(scenario.file, scenario.rover.drives_line, "layout.drives", "", where + " has four wheel nodes",
                                 "use `traction simulate`, where the wheels are wired");
    if (!sim::steered_axles(scenario.rover.layout()).empty())
        throw sim::ScenarioError(scenario.file, 0, "steering", "", where + " has no steering servo",
                                 "use `traction simulate`, whose rover has one");
    if (!scenario.missed_ticks.empty()) refuse("missed_ticks", "the computer at its end misses its own ticks; leave it out");
    for (const sim::CanFault &fault : scenario.can_faults)
        if (fault.kind == sim::CanFaultKind::bus_off && (fault.node == sim::CanNode::computer || fault.node == sim::CanNode::all))
            refuse("bus_off of the computer", "vcan has no controller that leaves the bus; use how = \"silent\"");
    for (const sim::SensorFault &fault : scenario.sensor_faults) {
        const bool silent = fault.kind == sim::FaultKind::dropped || fault.kind == sim::FaultKind::timeout;
        const bool wheel = fault.sensor == sim::FaultySensor::encoder || fault.sensor == sim::FaultySensor::current ||
                           fault.sensor == sim::FaultySensor::bridge;
        const bool other = fault.sensor != sim::FaultySensor::camera && fault.sensor != sim::FaultySensor::emergency_stop &&
                           fault.sensor != sim::FaultySensor::radar;
        if (silent && wheel)
            refuse("a wheel's sensor that is dropped", "a node sends all it has or nothing: what = \"can\", how = \"silent\"");
        if (silent && sensors == Sensors::iio && other)
            refuse("a converter that is dropped", "a converter's channel always reads; use --sensors can");
    }
}

} // namespace

// The computer's place is empty: devices go to the nodes, and what the nodes do to the bridges, with the motors' supply between.
class World::Wires final : public hal::Bus {
  public:
    explicit Wires(hal::BusConfig config) : nodes(std::move(config)) {}
    void step(std::int64_t now_ms) override { nodes.step(now_ms); }
    std::optional<hal::BridgeOrder> bridge(int wheel) override {
        const std::optional<hal::BridgeOrder> order = nodes.bridge(wheel);
        return order && !supply ? hal::BridgeOrder{} : order;
    }
    hal_result_t read(std::int64_t, const sensor_frame_t &devices, sensor_frame_t *frame) override {
        const sensor_frame_t own = *frame;
        *frame = devices;
        frame->tick = own.tick;
        frame->elapsed_ticks = own.elapsed_ticks;
        frame->time_us = own.time_us;
        return HAL_OK;
    }
    hal_result_t write(std::int64_t, const actuator_frame_t &) override { return HAL_OK; }
    void forget() override { nodes.forget(); }

    hal::CanNodes nodes;
    bool supply = false; // the motor enable line
};

World::World(const sim::Scenario &scenario, std::span<const sim::ActiveEffect> effects, std::uint64_t seed, Sensors sensors,
             const std::string &where)
    : sensors_(sensors), radar_rate_Hz_(static_cast<int>(scenario.sensors.radar.rate_Hz + 0.5)), lines_(1u << LOCKSTEP_LINE_STOP_PRESENT) {
    check(scenario, sensors, where);
    auto wires = std::make_unique<Wires>(
        hal::BusConfig{.faults = scenario.can_faults, .latency_ms = static_cast<int>(hal::actuation_delay_ms(effects)), .seed = seed});
    wires_ = wires.get();
    rover_ = std::make_unique<hal::SimRover>(scenario, effects, hal::world_of(scenario, effects, seed), std::move(wires));
    hal_ = rover_->hal();
}

World::~World() = default;

void World::advance() {
    if (!over_ && hal_.wait_tick(hal_.context) == HAL_OK)
        counts_.ticks++;
    else
        over_ = true;
}

// The board's converters, where it has them.
void World::convert(const sensor_frame_t &frame, WorldSays &out) const {
    const std::int32_t raw[LOCKSTEP_RAW] = {frame.battery_count, frame.accel_x_count, frame.accel_y_count, frame.accel_z_count,
                                            frame.gyro_x_count,  frame.gyro_y_count,  frame.gyro_z_count};
    std::copy(std::begin(raw), std::end(raw), out.head.raw);
    out.head.raw_given = (1u << LOCKSTEP_RAW) - 1u;
    out.head.radar_rate_Hz = static_cast<std::uint32_t>(radar_rate_Hz_);
    if ((frame.present & FRAME_RADAR) == 0u) return;
    out.head.first_sample = frame.radar_sequence;
    out.samples.assign(frame.radar_count, frame.radar_count + frame.radar_samples);
}

void World::on_sync(std::int64_t time_ns, const lockstep_frame_t &sync, WorldSays &out) {
    if (!begun_) begin_ns_ = time_ns;
    begun_ = true;
    sync_ns_ = time_ns;
    const std::int64_t tick = (time_ns - begin_ns_ + tick_ns / 2) / tick_ns;
    const auto due = static_cast<std::uint32_t>(tick) + 1;
    if (due > counts_.ticks + 1) counts_.unread += due - counts_.ticks - 1;
    while (counts_.ticks < due && !over_) advance();
    counts_.late.add(static_cast<double>(time_ns - begin_ns_ - tick * tick_ns) * 1e-3);
    if (over_) return;
    sensor_frame_t frame{};
    (void)hal_.read(hal_.context, &frame);
    lines_ = (frame.emergency_stop ? 1u << LOCKSTEP_LINE_STOP : 0u) |
             ((frame.present & FRAME_EMERGENCY_STOP) != 0u ? 1u << LOCKSTEP_LINE_STOP_PRESENT : 0u);
    for (const can_frame_t &answer : wires_->nodes.answers(tick_ms * counts_.ticks, of_board(sync), frame))
        if (sensors_ == Sensors::can || !of_sensor_node(answer)) out.frames.push_back(to_board(answer));
    if (sensors_ == Sensors::iio) convert(frame, out);
}

void World::on_order(std::int64_t time_ns, const lockstep_frame_t &frame) {
    const std::int64_t late_ns = std::max<std::int64_t>(0, time_ns - sync_ns_), late_ms = late_ns / step_ns; // (1)
    counts_.order.add(static_cast<double>(late_ns) * 1e-3);
    counts_.order_late_ms.resize(counts_.ticks);
    counts_.order_late_ms.back()[frame.id - CAN_ORDER] = static_cast<int>(late_ms);
    wires_->nodes.order(tick_ms * counts_.ticks + late_ms, of_board(frame));
}

WorldSays World::hear(const BoardSays &board) {
    WorldSays out;
    const std::int64_t now_ns = board.head.time_ns;
    wires_->supply = (board.head.lines >> LOCKSTEP_LINE_MOTOR_ENABLE & 1u) != 0u;
    counts_.frames_from += board.frames.size();
    for (const lockstep_frame_t &frame : board.frames) {
        if (frame.id == CAN_SYNC) on_sync(now_ns, frame, out);
        if (begun_ && !over_ && frame.id >= CAN_ORDER && frame.id - CAN_ORDER < WHEEL_COUNT) on_order(now_ns, frame);
    }
    while (begun_ && !over_ && now_ns - begin_ns_ > tick_ns * counts_.ticks + tick_ns / 2) { // nobody asks, and the world goes on
        advance();
        counts_.unread++;
    }
    if (out.frames.size() > LOCKSTEP_FRAMES) out.frames.resize(LOCKSTEP_FRAMES);
    counts_.frames_to += out.frames.size();
    out.head.lines = lines_;
    out.head.frames = static_cast<std::uint32_t>(out.frames.size());
    out.head.samples = static_cast<std::uint32_t>(out.samples.size());
    out.head.stop = over_ ? 1 : 0;
    return out;
}

} // namespace traction::emulate
