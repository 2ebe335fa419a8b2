#include "scenario.h"

#include "read_parts.h"
#include "scenario_table.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace traction::sim {

namespace {

std::string name_of(const std::string &file) {
    const std::size_t slash = file.find_last_of('/');
    std::string name = slash == std::string::npos ? file : file.substr(slash + 1);
    if (name.size() > 5 && name.ends_with(".toml")) name.resize(name.size() - 5);
    return name;
}

toml::table parse_toml(const std::string &text, const std::string &file) {
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error &error) {
        throw ScenarioError(file, error.source().begin.line, "", "", std::string(error.description()),
                            "mend the TOML there (docs/scenario_format.md has examples)");
    }
}

void read_firmware(const toml::table &table, const std::string &file, FirmwareChoice &choice) {
    constexpr std::array<std::string_view, 2> configs{"default", "paper"};
    Keys keys(table, file, "firmware");
    choice.config = configs[keys.word("config", choice.config, configs)];
    choice.doppler_scale = keys.number("doppler_scale", 0, {0, 3});
    const std::string believes = keys.text("believes", "");
    if (!believes.empty()) choice.believes = read_rover_file(find_rover_file(believes, file));
    keys.finish();
}

void read_all(Keys &top, const std::string &file, Scenario &scenario) {
    scenario.title = top.text("title", scenario.name);
    top.text("about", "");
    scenario.duration_s = top.need_number("duration_s", {0.01, 36000});
    scenario.seed = static_cast<std::uint64_t>(top.integer("seed", 1, 0, INT64_MAX));
    constexpr std::array<std::string_view, 2> buses{"direct", "can"};
    scenario.can_bus = top.word("bus", "direct", buses) == 1;
    if (const toml::table *table = top.table("ground")) read_ground(*table, file, scenario);
    if (const toml::node *node = top.node("rover")) read_rover(*node, file, scenario);
    if (const toml::table *table = top.table("sensors")) read_sensors(*table, file, scenario.sensors);
    if (const toml::table *table = top.table("radar")) read_radar(*table, file, scenario);
    if (const toml::table *table = top.table("firmware")) read_firmware(*table, file, scenario.firmware);
    if (const toml::table *table = top.table("hidden")) scenario.hidden = read_hidden(*table, file);
    if (const toml::array *list = top.tables("drive")) scenario.drive = read_drive(*list, file);
    if (const toml::array *list = top.tables("fault")) read_faults(*list, file, scenario);
    if (const toml::array *list = top.tables("effect"))
        for (std::size_t i = 0; i < list->size(); i++)
            scenario.effects.push_back(read_effect(*(*list)[i].as_table(), file, "effect[" + std::to_string(i) + "]"));
    top.finish();
    if (scenario.drive.empty()) top.fail("drive", "missing", "add at least one [[drive]] with for_s and mode");
    check_wheels(scenario);
}

} // namespace

Scenario parse_scenario(const std::string &text, const std::string &file) { return scenario_of_table(parse_toml(text, file), text, file); }

toml::table scenario_table(const std::string &text, const std::string &file) { return parse_toml(text, file); }

Scenario scenario_of_table(const toml::table &table, const std::string &text, const std::string &file) {
    Scenario scenario;
    scenario.name = name_of(file);
    scenario.file = file;
    scenario.text = text;
    Keys top(table, file, "");
    read_all(top, file, scenario);
    return scenario;
}

Scenario read_scenario(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file.is_open() || file.bad() || std::filesystem::is_directory(path))
        throw std::filesystem::filesystem_error("cannot read the scenario", path,
                                                std::make_error_code(std::errc::no_such_file_or_directory));
    return parse_scenario(text, path);
}

} // namespace traction::sim
