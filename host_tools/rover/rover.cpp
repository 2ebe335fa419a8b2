#include "rover.h"

#include "radar_geometry.h"

#include "sim/plant/steering.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace traction {

namespace {

void set(parameters_t &out, std::string_view key, double value, bool given) {
    const std::int32_t i = parameters_find(std::string(key).c_str());
    if (i < 0) throw std::logic_error("the firmware has no parameter " + std::string(key));
    if (!given) return;
    out.rover.value[i] = static_cast<float>(value);
    out.given[i] = true;
}

std::string digits(float value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
    return text;
}

// Which key of the description a firmware parameter comes from; null for those of a wheel.
const sim::RoverKey *source_of(const std::string &parameter) {
    const std::string key = parameter.starts_with("current_offset_count_") ? "current.offset_count" : parameter;
    for (const sim::RoverKey &k : sim::rover_keys())
        if (k.firmware == key || (key == "current.offset_count" && k.section == "current" && k.name == "offset_count")) return &k;
    return nullptr;
}

} // namespace

parameters_t firmware_parameters(const sim::RoverDescription &rover) {
    parameters_t out{};
    rover_parameters_reference(&out.rover);
    out.radar_given = true;
    out.rover.radar = -1;
    for (std::int32_t i = 0; i < ROVER_RADAR_COUNT; i++)
        if (rover.radar == rover_radar_name(i)) out.rover.radar = i;
    if (needs_own_template(rover)) out.rover.beam = template_of(radar_geometry_of(rover));
    for (std::size_t i = 0; i < rover.values.size(); i++) {
        const sim::RoverKey &key = sim::rover_keys()[i];
        if (!key.firmware.empty()) set(out, key.firmware, rover.values[i].value, !key.choice || rover.values[i].given);
    }
    set(out, "wheel_radius_m", rover.mean_radius_m(), true);
    set(out, "encoder_counts_per_turn", rover.encoder_counts_per_turn(), true);
    for (std::size_t i = 0; i < WHEEL_COUNT; i++) {
        set(out, "encoder_sign_" + std::to_string(i), rover.wheel[i].encoder_sign, true);
        set(out, "current_offset_count_" + std::to_string(i), rover.current_offset_count(i), true);
    }
    const sim::LayoutParameters layout = rover.layout();
    set(out, "wheel_mask", sim::firmware_wheels(layout), true);
    const double base_m = rover.at("body", "half_wheelbase_m"), track_m = rover.at("body", "half_track_m");
    const double pivot_m = sim::steering_pivot_m(layout, base_m);
    set(out, "steer_front_m", base_m - pivot_m, layout.steer_front);
    set(out, "steer_rear_m", -base_m - pivot_m, layout.steer_rear);
    set(out, "steer_limit_1_m", sim::steering_limit_1_m(layout, base_m, track_m), layout.steer_front || layout.steer_rear);
    // the firmware takes a quarter of its mass for a wheel's load; told so that this is the heaviest's
    if (!sim::is_plain(layout)) set(out, "mass_kg", 4 * rover.heaviest_kg(), true);
    rover_parameters_scale(&out.rover, out.given);
    return out;
}

control_config_t firmware_config(const sim::RoverDescription &rover) {
    const parameters_t parameters = firmware_parameters(rover);
    control_config_t config;
    control_config_build(&parameters.rover, &config);
    const control_refusal_t refusal = control_config_check(&parameters.rover, &config);
    if (refusal.key == nullptr) return config;
    const std::string key = refusal.key;
    const std::int32_t index = parameters_find(refusal.key);
    if (index < 0)
        throw sim::ScenarioError(rover.file, rover.radar_line, "radar.model", rover.radar, "the firmware cannot work", refusal.reason);
    const sim::RoverKey *source = source_of(key);
    const sim::RoverValue *value = source != nullptr ? &rover.value(source->section, source->name) : nullptr;
    const std::string full = source != nullptr ? std::string(source->section) + '.' + std::string(source->name) : key;
    const std::string made = parameters.given[index] ? "" : " (made from the rover's own numbers)";
    throw sim::ScenarioError(rover.file, value != nullptr ? value->line : 0, full, digits(parameters.rover.value[index]) + made,
                             "the firmware cannot work", refusal.reason);
}

const sim::RoverDescription &believed(const sim::Scenario &scenario) {
    return scenario.firmware.believes ? *scenario.firmware.believes : scenario.rover;
}

control_config_t firmware_of(const sim::Scenario &scenario, const std::string &instead) {
    control_config_t config = firmware_config(believed(scenario));
    if ((instead.empty() ? scenario.firmware.config : instead) == "paper") control_config_make_paper(&config);
    if (scenario.firmware.doppler_scale > 0) config.doppler.scale = static_cast<float>(scenario.firmware.doppler_scale);
    return config;
}

std::string firmware_text(const sim::RoverDescription &rover) {
    const parameters_t parameters = firmware_parameters(rover);
    std::string text(PARAMETERS_TEXT, '\0');
    text.resize(parameters_write(&parameters, ("the firmware's parameters, from the rover \"" + rover.name + "\"").c_str(), text.data()));
    return text;
}

std::map<std::string, std::string> parameter_lines(const parameters_t &parameters) {
    rover_parameters_t reference;
    rover_parameters_reference(&reference);
    std::map<std::string, std::string> lines;
    if (parameters.rover.beam != nullptr) lines = geometry_lines(parameters.rover.beam, "firmware.radar.");
    for (std::int32_t i = 0; i < ROVER_PARAMETER_COUNT; i++)
        if (parameters.rover.value[i] != reference.value[i])
            lines["firmware." + std::string(rover_parameter_name(i))] = digits(parameters.rover.value[i]);
    if (parameters.rover.radar != reference.radar) lines["firmware.radar"] = rover_radar_name(parameters.rover.radar);
    return lines;
}

parameters_t parameters_of_lines(const std::map<std::string, std::string> &header) {
    parameters_t out{};
    rover_parameters_reference(&out.rover);
    for (const auto &[line, value] : header) {
        if (!line.starts_with("firmware.")) continue;
        const std::string key = line.substr(9);
        if (key.starts_with("radar.")) {
            if (out.rover.beam == nullptr) out.rover.beam = template_of(geometry_of_lines(header, "firmware.radar."));
            continue;
        }
        if (key == "radar") {
            std::int32_t radar = -1;
            for (std::int32_t i = 0; i < ROVER_RADAR_COUNT; i++)
                if (value == rover_radar_name(i)) radar = i;
            if (radar < 0) throw std::invalid_argument(line + ": " + value + ": no template of this radar is linked");
            out.rover.radar = radar;
            continue;
        }
        const std::int32_t i = parameters_find(key.c_str());
        char *end = nullptr;
        const float number = std::strtof(value.c_str(), &end);
        if (i < 0 || end == value.c_str() || *end != '\0')
            throw std::invalid_argument(line + ": " + value + ": this firmware has no such parameter");
        out.rover.value[i] = number;
        out.given[i] = true;
    }
    return out; // complete: what is no line is the reference's, scaled numbers too
}

} // namespace traction
