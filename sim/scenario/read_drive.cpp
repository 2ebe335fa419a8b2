#include "read_parts.h"

#include <algorithm>
#include <array>

namespace traction::sim {

namespace {

// A number, [from, to] for a ramp, or { mean, amplitude, period_s } for a wave.
Reference read_reference(const Keys &keys, const toml::node &node, std::string_view key, Range range) {
    Reference reference;
    if (const toml::array *list = node.as_array()) {
        if (list->size() != 2) keys.fail_at(node, key, "a ramp has two ends", "write [from, to]");
        reference.start = keys.number_of((*list)[0], key, range);
        reference.end = keys.number_of((*list)[1], key, range);
    } else if (const toml::table *wave = node.as_table()) {
        Keys inner(*wave, keys.file(), keys.full_name(key));
        reference.start = reference.end = inner.number("mean", 0, range);
        reference.amplitude = inner.need_number("amplitude", range);
        reference.period_s = inner.need_number("period_s", {0.05, 1000});
        inner.finish();
    } else {
        reference.start = reference.end = keys.number_of(node, key, range);
    }
    return reference;
}

Reference read_reference(Keys &keys, std::string_view key, Range range) {
    const toml::node *node = keys.node(key);
    return node != nullptr ? read_reference(keys, *node, key, range) : Reference{};
}

// One reference for all wheels, or a list of four.
std::array<Reference, wheel_count> read_references(Keys &keys, std::string_view key, Range range) {
    std::array<Reference, wheel_count> all{};
    const toml::node *node = keys.node(key);
    if (node == nullptr) return all;
    const toml::array *list = node->as_array();
    if (list != nullptr && list->size() == wheel_count) {
        for (std::size_t i = 0; i < wheel_count; i++) all[i] = read_reference(keys, (*list)[i], key, range);
    } else {
        all.fill(read_reference(keys, *node, key, range));
    }
    return all;
}

// What each mode needs and may have; anything else in the table is a mistake.
void read_mode(Keys &keys, DriveSegment &segment) {
    const auto need = [&](std::string_view key, const char *mend) {
        if (!keys.has(key)) keys.fail(key, "missing in this mode", mend);
    };
    const auto speed = [&] {
        need("speed_m_s", "give a speed, or [from, to]");
        segment.speed_m_s = read_reference(keys, "speed_m_s", {-2, 2});
    };
    switch (segment.mode) {
    case DriveMode::stop:
        break;
    case DriveMode::open_loop:
        need("duty", "give one number or four, -1 to 1");
        segment.duty = read_references(keys, "duty", {-1, 1});
        break;
    case DriveMode::wheel_speed:
        need("wheel_speed_rad_s", "give one number or four");
        segment.wheel_speed_rad_s = read_references(keys, "wheel_speed_rad_s", {-40, 40});
        break;
    case DriveMode::slip: {
        need("slip", "give a slip, -1 to 1");
        segment.slip = read_reference(keys, "slip", {-1, 1});
        need("slip_wheels", "give a list such as [1]");
        for (const toml::node &item : *keys.array("slip_wheels")) {
            const double wheel = keys.number_of(item, "slip_wheels", {0, wheel_count - 1});
            if (!item.is_integer()) keys.fail_at(item, "slip_wheels", "not a whole number", "give wheels 0 to 3");
            segment.slip_wheel[static_cast<std::size_t>(wheel)] = true;
        }
        speed();
        break;
    }
    case DriveMode::platform_speed:
        speed();
        break;
    case DriveMode::soil_sweep:
        speed();
        break;
    }
    if (segment.mode == DriveMode::platform_speed || segment.mode == DriveMode::slip)
        segment.yaw_rate_rad_s = read_reference(keys, "yaw_rate_rad_s", {-4, 4});
}

} // namespace

std::vector<DriveSegment> read_drive(const toml::array &list, const std::string &file) {
    std::vector<DriveSegment> plan;
    double now_s = 0;
    for (std::size_t i = 0; i < list.size(); i++) {
        Keys keys(*list[i].as_table(), file, "drive[" + std::to_string(i) + "]");
        DriveSegment segment;
        segment.from_s = keys.number("from_s", now_s, {0, 36000});
        if (segment.from_s < now_s) keys.fail("from_s", "begins before the segment above ends", "give at least " + std::to_string(now_s));
        segment.to_s = segment.from_s + keys.need_number("for_s", {0.01, 36000});
        segment.mode = static_cast<DriveMode>(keys.word("mode", "", drive_mode_names));
        read_mode(keys, segment);
        keys.finish();
        now_s = segment.to_s;
        plan.push_back(segment);
    }
    return plan;
}

} // namespace traction::sim
