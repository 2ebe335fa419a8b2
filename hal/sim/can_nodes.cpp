#include "can_nodes.h"

#include "hal/node/sensor_node.h"

#include <iterator>
#include <utility>

namespace traction::hal {

using sim::CanFaultKind;
using sim::CanNode;

namespace {
constexpr std::int64_t bus_tick_ms = TICK_US / 1000;
CanNode of_wheel(unsigned wheel) { return static_cast<CanNode>(wheel); }
} // namespace

CanNodes::CanNodes(BusConfig config) : config_(std::move(config)), random_(config_.seed, "can") {}

void CanNodes::step(std::int64_t now_ms) {
    now_ms_ = now_ms;
    while (!under_way_.empty() && under_way_.front().due_ms <= now_ms) {
        to_wheels(under_way_.front().frame, nullptr, nullptr);
        under_way_.pop_front();
    }
    for (wheel_node_state_t &node : wheel_) (void)wheel_node_output(&node, static_cast<std::uint32_t>(now_ms));
}

std::optional<BridgeOrder> CanNodes::bridge(int wheel) {
    const wheel_node_state_t &node = wheel_.at(static_cast<std::size_t>(wheel));
    if (!node.in_force && !node.released) return {};
    return BridgeOrder{node.drive, node.duty_q15};
}

CanNodes::Frames CanNodes::answers(std::int64_t now_ms, const can_frame_t &sync, const sensor_frame_t &devices) {
    now_ms_ = now_ms;
    Frames answers;
    if (!cut_off(CanNode::computer)) {
        Frames heard;
        send(CanNode::computer, sync, heard);
        for (const can_frame_t &said : heard) {
            to_wheels(said, &devices, &answers);
            to_sensors(said, devices, answers);
        }
        answers.insert(answers.end(), late_answers_.begin(), late_answers_.end());
    }
    late_answers_ = std::exchange(later_answers_, {});
    return answers;
}

void CanNodes::order(std::int64_t now_ms, const can_frame_t &frame) {
    now_ms_ = now_ms;
    if (cut_off(CanNode::computer)) return;
    Frames now;
    sending_order_ = true;
    send(CanNode::computer, frame, now);
    sending_order_ = false;
    for (const can_frame_t &heard : now) push({now_ms + config_.latency_ms, heard});
}

bool CanNodes::computer_cut_off(std::int64_t now_ms) {
    now_ms_ = now_ms;
    return cut_off(CanNode::computer);
}

bool CanNodes::computer_off(std::int64_t now_ms) {
    now_ms_ = now_ms;
    return off(CanNode::computer);
}

void CanNodes::push(const Order &order) {
    auto at = under_way_.end();
    while (at != under_way_.begin() && std::prev(at)->due_ms > order.due_ms) --at;
    under_way_.insert(at, order);
}

bool CanNodes::in_force(const sim::CanFault &fault, CanNode node) const {
    const double t_s = static_cast<double>(now_ms_) * 1e-3;
    return t_s >= fault.from_s && t_s < fault.to_s && (fault.node == CanNode::all || fault.node == node);
}

bool CanNodes::off(CanNode node) const {
    for (const sim::CanFault &fault : config_.faults)
        if (fault.kind == CanFaultKind::bus_off && in_force(fault, node)) return true;
    return false;
}

bool CanNodes::cut_off(CanNode node) const {
    for (const sim::CanFault &fault : config_.faults)
        if ((fault.kind == CanFaultKind::silent || fault.kind == CanFaultKind::bus_off) && in_force(fault, node)) return true;
    return false;
}

void CanNodes::spoil(can_frame_t &frame) {
    const int bits = frame.length * 8, first = random_.below(bits);
    for (int bit = first; bit < bits && bit < first + 8; bit++) {
        const bool flips = bit == first || random_.below(2) == 1;
        std::uint8_t &byte = frame.data[bit / 8];
        byte = static_cast<std::uint8_t>(byte ^ (flips ? 0x80u >> (static_cast<unsigned>(bit) % 8u) : 0u));
    }
}

// What of a frame comes out at the other end, now; what is late waits.
void CanNodes::send(CanNode from, can_frame_t frame, Frames &out) {
    bool lost = false, late = false;
    int copies = 1;
    for (const sim::CanFault &fault : config_.faults) {
        if (!in_force(fault, from) || random_.uniform() >= fault.share) continue;
        lost = lost || fault.kind == CanFaultKind::lost;
        late = late || fault.kind == CanFaultKind::late;
        copies += fault.kind == CanFaultKind::duplicated ? 1 : 0;
        if (fault.kind == CanFaultKind::corrupted) spoil(frame);
    }
    for (int i = 0; i < copies && !lost; i++) {
        if (!late)
            out.push_back(frame);
        else if (sending_order_)
            push({now_ms_ + config_.latency_ms + bus_tick_ms + 1, frame});
        else if (from != CanNode::computer) // a late SYNC has no answer worth anything: it is lost
            later_answers_.push_back(frame);
    }
}

// A frame as every wheel node hears it. Orders come without devices; they are not answered.
void CanNodes::to_wheels(const can_frame_t &frame, const sensor_frame_t *devices, Frames *answers) {
    for (unsigned i = 0; i < WHEEL_COUNT; i++) {
        if (cut_off(of_wheel(i))) continue;
        const wheel_node_config_t node{.wheel = static_cast<std::uint8_t>(i), .bus_off_count = 0};
        wheel_node_input_t input{};
        if (devices != nullptr) input = {devices->encoder_count[i], devices->current_count[i], devices->bridge_status[i]};
        can_frame_t answer[WHEEL_NODE_ANSWERS];
        const std::size_t count = wheel_node_receive(&node, &wheel_[i], static_cast<std::uint32_t>(now_ms_), &input, &frame, answer);
        for (std::size_t n = 0; n < count && answers != nullptr; n++) send(of_wheel(i), answer[n], *answers);
    }
}

void CanNodes::to_sensors(const can_frame_t &frame, const sensor_frame_t &devices, Frames &answers) {
    if (cut_off(CanNode::sensors)) return;
    can_frame_t answer[SENSOR_NODE_ANSWERS];
    const std::size_t count = sensor_node_receive(&devices, &frame, answer);
    for (std::size_t n = 0; n < count; n++) send(CanNode::sensors, answer[n], answers);
}

} // namespace traction::hal
