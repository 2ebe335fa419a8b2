#include "rover.h"

#include "read_parts.h"
#include "scenario.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <span>
#include <system_error>
#include <utility>

namespace traction::sim {

namespace {

// A number, or { value, unit, source } whose unit must be the key's.
void read_value(Keys &keys, const RoverKey &key, const toml::node &node, RoverValue &out) {
    const Range range{key.low, key.high};
    out.given = true;
    out.line = node.source().begin.line;
    const toml::table *table = node.as_table();
    if (table == nullptr) {
        out.value = keys.number_of(node, key.name, range);
        out.source.clear();
        return;
    }
    Keys inner(*table, keys.file(), keys.full_name(key.name));
    if (!inner.has("value"))
        inner.fail("value", "missing", "write { value = 1.0, unit = \"" + std::string(key.unit) + "\", source = \"...\" }");
    out.value = inner.number("value", 0, range);
    const std::string unit = inner.text("unit", key.unit);
    if (unit != key.unit) inner.fail("unit", "this key is in " + std::string(key.unit), "convert the value, or mend the unit");
    out.source = inner.text("source", "");
    inner.finish();
}

void read_wheels(const toml::array &list, const std::string &file, RoverDescription &rover) {
    for (std::size_t i = 0; i < list.size(); i++) {
        const std::string path = "wheel[" + std::to_string(i) + "]";
        Keys keys(*list[i].as_table(), file, path);
        if (i >= wheel_count) keys.fail_at(list[i], "", "a fifth wheel", "give four [[wheel]], or none where the wheels are equal");
        RoverWheel &wheel = rover.wheel[i];
        keys.text("name", "");
        if (keys.has("radius_m")) wheel.radius_m = keys.number("radius_m", 0, {0.02, 0.5});
        if (keys.has("encoder_sign")) wheel.encoder_sign = static_cast<double>(keys.integer("encoder_sign", 1, -1, 1));
        if (wheel.encoder_sign == 0) keys.fail("encoder_sign", "neither 1 nor -1", "give one of them");
        if (keys.has("current_offset_count"))
            wheel.current_offset_count = static_cast<double>(keys.integer("current_offset_count", 0, 0, 65535));
        keys.finish();
    }
    if (!list.empty() && list.size() < wheel_count)
        throw ScenarioError(
            file, list.source().begin.line, "wheel", "", "only " + std::to_string(list.size()) + " of four wheels",
            "give four [[wheel]] (0 rear left, 1 rear right, 2 front left, 3 front right), or none where the wheels are equal");
}

// A radar of table II brings carrier and beam with it; any other must state them.
void check_own_radar(Keys &keys, const RoverDescription &rover) {
    for (const char *name : {"carrier_Hz", "vertical_deg", "horizontal_deg"}) {
        const bool given = rover.value("radar", name).given;
        if (given && rover.radar != "own") keys.fail(name, "is that of table II for this model", "leave it out, or write model = \"own\"");
        if (!given && rover.radar == "own")
            keys.fail(name, "missing", "a radar of your own states carrier_Hz, vertical_deg and horizontal_deg");
    }
}

// layout.drives = [0, 1]: the wheels with a motor, one a side, in any order.
void read_drives(Keys &layout, RoverDescription &rover) {
    const toml::node *node = layout.node("drives");
    if (node == nullptr) return;
    const char *mend = "give the wheel whose motor turns the left side (0 or 2) and the one of the right (1 or 3), such as [0, 1]";
    const toml::array *list = node->as_array();
    if (list == nullptr || list->size() != 2) layout.fail_at(*node, "drives", "not a list of two wheels", mend);
    std::array<int, 2> drives{-1, -1};
    for (const toml::node &item : *list) {
        const auto slot = item.is_integer() ? item.value<std::int64_t>() : std::nullopt;
        if (!slot || *slot < 0 || *slot >= wheel_count) layout.fail_at(item, "drives", "holds what is no wheel of 0 to 3", mend);
        int &side = drives[static_cast<std::size_t>(*slot % 2)];
        if (side >= 0) layout.fail_at(item, "drives", "has two motors on one side and none on the other: its wheels have no drive", mend);
        side = static_cast<int>(*slot);
    }
    rover.drives = drives;
    rover.drives_line = node->source().begin.line;
}

// The sections over what `rover` has; with `whole` every key that is no choice must be there.
void read_sections(Keys &top, RoverDescription &rover, bool whole) {
    std::map<std::string, std::unique_ptr<Keys>, std::less<>> sections;
    for (std::size_t i = 0; i < rover_keys().size(); i++) {
        const RoverKey &key = rover_keys()[i];
        auto found = sections.find(key.section);
        if (found == sections.end()) {
            const toml::table *table = top.table(key.section);
            found = sections
                        .emplace(key.section,
                                 table != nullptr ? std::make_unique<Keys>(*table, top.file(), top.full_name(key.section)) : nullptr)
                        .first;
            if (table == nullptr && whole && !key.choice)
                top.fail(key.section, "missing",
                         "add the section [" + std::string(key.section) + "]; rovers/lhomme_desages.toml has them all");
        }
        Keys *keys = found->second.get();
        if (keys == nullptr) continue;
        if (const toml::node *node = keys->node(key.name))
            read_value(*keys, key, *node, rover.values[i]);
        else if (whole && !key.choice)
            keys->fail(key.name, "missing", "add it in " + std::string(key.unit) + "; rovers/lhomme_desages.toml has it");
    }
    if (Keys *radar = sections.at("radar").get(); radar != nullptr && (whole || radar->has("model"))) {
        static const auto models = radar_models();
        std::array<std::string_view, models.size() + 1> names;
        std::transform(models.begin(), models.end(), names.begin(), [](const RadarModel &model) { return model.name; });
        names.back() = "own";
        rover.radar = names[radar->word("model", "", names)];
        rover.radar_line = radar->node("model")->source().begin.line;
    }
    if (Keys *radar = sections.at("radar").get(); radar != nullptr) check_own_radar(*radar, rover);
    if (Keys *layout = sections.at("layout").get(); layout != nullptr) read_drives(*layout, rover);
    for (const auto &[name, keys] : sections)
        if (keys) keys->finish();
    if (const toml::array *wheels = top.tables("wheel")) read_wheels(*wheels, top.file(), rover);
}

// Keys that [rover] of a scenario has beside a description's sections: the same numbers, flat.
struct FlatKey {
    std::string_view flat, section, name;
};
constexpr FlatKey flat_keys[] = {
    {"mass_kg", "body", "mass_kg"},
    {"half_wheelbase_m", "body", "half_wheelbase_m"},
    {"half_track_m", "body", "half_track_m"},
    {"wheel_radius_m", "wheels", "radius_m"},
    {"wheel_mass_kg", "wheels", "mass_kg"},
    {"centre_height_m", "body", "centre_height_m"},
    {"relaxation_length_m", "wheels", "relaxation_length_m"},
    {"torque_constant_Nm_A", "motor", "torque_constant_Nm_A"},
    {"resistance_ohm", "motor", "resistance_ohm"},
    {"inertia_kg_m2", "motor", "inertia_kg_m2"},
    {"viscous_Nms", "motor", "viscous_Nms"},
    {"coulomb_Nm", "motor", "coulomb_Nm"},
    {"battery_resistance_ohm", "battery", "resistance_ohm"},
};

} // namespace

RoverDescription parse_rover(const std::string &text, const std::string &file) {
    toml::table table;
    try {
        table = toml::parse(text, file);
    } catch (const toml::parse_error &error) {
        throw ScenarioError(file, error.source().begin.line, "", "", std::string(error.description()),
                            "mend the TOML there (docs/rover_format.md has an example)");
    }
    Keys top(table, file, "");
    constexpr std::array<std::string_view, 1> formats{"traction.rover/1"};
    (void)top.word("format", "", formats);
    RoverDescription rover;
    rover.file = file;
    rover.name = top.text("name", file);
    top.text("about", "");
    read_sections(top, rover, true);
    if (const toml::table *hardware = top.table("hardware")) rover.hardware_line = hardware->source().begin.line;
    top.finish();
    check_layout(rover);
    return rover;
}

RoverDescription read_rover_file(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file.is_open() || file.bad() || std::filesystem::is_directory(path))
        throw std::filesystem::filesystem_error("cannot read the rover", path, std::make_error_code(std::errc::no_such_file_or_directory));
    return parse_rover(text, path);
}

std::string find_rover_file(const std::string &path, const std::string &from) {
    namespace fs = std::filesystem;
    const fs::path wanted(path), folder = fs::path(from).parent_path();
    if (wanted.is_absolute() || fs::exists(wanted)) return path;
    for (const fs::path &candidate : {folder / ".." / wanted, folder / wanted})
        if (fs::exists(candidate)) return candidate.lexically_normal().string();
    return path;
}

namespace {

RoverDescription read_named(const Keys &keys, const toml::node &node, std::string_view key) {
    const auto path = node.value<std::string>();
    if (!path) keys.fail_at(node, key, "not a text", "give the file of a rover, such as \"rovers/heavy.toml\"");
    const std::string found = find_rover_file(*path, keys.file());
    if (!std::filesystem::is_regular_file(found))
        keys.fail_at(node, key, "there is no such file", "give the file of a rover: as it is from here, or beside the scenario's folder");
    return read_rover_file(found);
}

} // namespace

void read_rover(const toml::node &node, const std::string &file, Scenario &scenario) {
    const toml::table *table = node.as_table();
    if (table == nullptr) {
        const toml::table holder; // for messages
        const Keys keys(holder, file, "");
        scenario.rover = read_named(keys, node, "rover");
    } else {
        Keys keys(*table, file, "rover");
        if (const toml::node *named = keys.node("file")) scenario.rover = read_named(keys, *named, "file");
        scenario.rover.file = file; // what is given here has its line there
        read_sections(keys, scenario.rover, false);
        for (const FlatKey &flat : flat_keys)
            if (const toml::node *value = keys.node(flat.flat)) {
                const auto all = rover_keys();
                const auto key = std::find_if(all.begin(), all.end(),
                                              [&](const RoverKey &k) { return k.section == flat.section && k.name == flat.name; });
                RoverKey renamed = *key;
                renamed.name = flat.flat;
                read_value(keys, renamed, *value, scenario.rover.values[static_cast<std::size_t>(key - all.begin())]);
            }
        check_layout(scenario.rover);
        put_in_plant(scenario.rover, scenario.plant.rover);
        // of this run, not of the rover: what is left in the battery, and where it starts
        scenario.plant.rover.battery_voltage_V = keys.number("battery_voltage_V", scenario.plant.rover.battery_voltage_V, {1, 60});
        scenario.plant.x_m = keys.number("x_m", scenario.plant.x_m, {-1000, 1000});
        scenario.plant.y_m = keys.number("y_m", scenario.plant.y_m, {-1000, 1000});
        scenario.plant.yaw_rad = keys.number("yaw_rad", scenario.plant.yaw_rad, {-10, 10});
        scenario.plant.speed_m_s = keys.number("speed_m_s", scenario.plant.speed_m_s, {-2, 2});
        keys.finish();
        scenario.sensors = sensors_of(scenario.rover);
        return;
    }
    set_rover(scenario, scenario.rover);
}

void set_rover(Scenario &scenario, RoverDescription rover) {
    scenario.rover = std::move(rover);
    put_in_plant(scenario.rover, scenario.plant.rover);
    scenario.sensors = sensors_of(scenario.rover);
    check_wheels(scenario);
}

void check_wheels(const Scenario &scenario, std::span<const ActiveEffect> effects) {
    const LayoutParameters parameters = scenario.rover.layout();
    const Layout layout = parameters.kind;
    if (is_plain(parameters)) return;
    const auto need = [&](const char *key, int wheel, bool motor = true) {
        if (wheel >= 0 && !has_wheel(layout, wheel))
            throw ScenarioError(scenario.file, 0, key, std::to_string(wheel), "the rover has no such wheel",
                                layout == Layout::carriage ? "a bench carriage has wheel 0"
                                                           : "a rover of two wheels has 0 (left) and 1 (right)");
        if (const int own = wheel < 0 ? wheel : motor_of(parameters, wheel); motor && own != wheel)
            throw ScenarioError(scenario.file, 0, key, std::to_string(wheel),
                                "this wheel has no motor: it turns with wheel " + std::to_string(own), "write " + std::to_string(own));
    };
    if (scenario.can_bus)
        throw ScenarioError(scenario.file, 0, "bus", "can",
                            "only a rover of four wheels on a plain chassis, none of them steered, has its wheels on a bus",
                            "leave bus out");
    if (scenario.hidden)
        throw ScenarioError(
            scenario.file, 0, "hidden", "",
            "effects are hidden in rovers of four wheels alone, on a plain chassis, with a motor each and fixed in their heading",
            "leave [hidden] out");
    for (const SensorFault &fault : scenario.sensor_faults) need("fault.wheel", fault.wheel);
    for (const WheelBlockSpan &span : scenario.wheel_blocks) need("fault.wheel", span.wheel, false);
    for (const WheelBlockSpan &span : scenario.open_motors) need("fault.wheel", span.wheel);
    for (const ActiveEffect &effect : scenario.effects) need("effect.wheel", effect.wheel, of_motor(*effect.effect));
    for (const ActiveEffect &effect : effects) need("effect.wheel", effect.wheel, of_motor(*effect.effect));
    for (const DriveSegment &segment : scenario.drive)
        for (int wheel = 0; wheel < wheel_count; wheel++)
            if (segment.slip_wheel[static_cast<std::size_t>(wheel)]) need("drive.slip_wheels", wheel);
}

} // namespace traction::sim
