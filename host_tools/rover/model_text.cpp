#include "rover.h"

#include "sim/physics/soil.h"

#include <cstdio>
#include <stdexcept>

namespace traction {

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

std::string quoted(const std::string &text) {
    std::string out = "\"";
    for (const char c : text)
        if (c >= ' ') out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return out + "\"";
}

// key = { value, unit, prior, source } of a description's key; share: prior over value.
std::string from_key(const sim::RoverDescription &rover, std::string_view key, std::string_view section, std::string_view name,
                     double share) {
    const sim::RoverValue &value = rover.value(section, name);
    std::string_view unit;
    for (const sim::RoverKey &k : sim::rover_keys())
        if (k.section == section && k.name == name) unit = k.unit;
    return std::string(key) + " = { value = " + number(value.value) + ", unit = \"" + std::string(unit) + "\"" +
           (share > 0 ? ", prior = " + number(share * value.value) : "") +
           ", source = " + quoted(value.source.empty() ? "the rover's description" : value.source) + " }\n";
}

std::string wheel_table(const sim::RoverDescription &rover, std::size_t i) {
    static constexpr const char *names[] = {"rear left", "rear right", "front left", "front right"};
    const double x = rover.at("body", "half_wheelbase_m"), y = rover.at("body", "half_track_m");
    std::string text = "\n[[wheel]]\nname = \"" + std::string(names[i]) + "\"\nx_m = " + number(i < 2 ? -x : x) +
                       "\ny_m = " + number(i % 2 == 0 ? y : -y) + "\n";
    if (rover.wheel[i].radius_m) text += "radius_m = { value = " + number(*rover.wheel[i].radius_m) + ", unit = \"m\" }\n";
    return text;
}

// Two driven wheels, and a ball that rolls freely any way: its bearing beside the ground's resistance.
std::string wheel_tables_with_caster(const sim::RoverDescription &rover, const sim::LayoutParameters &layout, double ground_rolling) {
    const double y = rover.at("body", "half_track_m");
    std::string text;
    for (std::size_t i = 0; i < 2; ++i) {
        text += "\n[[wheel]]\nname = \"" + std::string(i == 0 ? "left" : "right") + "\"\nx_m = " + number(layout.axle_m) +
                "\ny_m = " + number(i == 0 ? y : -y) + "\n";
        if (rover.wheel[i].radius_m) text += "radius_m = { value = " + number(*rover.wheel[i].radius_m) + ", unit = \"m\" }\n";
    }
    return text + "\n[[wheel]]\nname = \"caster\"\ndriven = false\ngrips_sideways = false\nx_m = " + number(layout.caster_m) +
           "\ny_m = 0\nradius_m = " + number(layout.caster_radius_m) +
           "\n[wheel.soil]\nrolling_coefficient = { value = " + number(ground_rolling + layout.caster_rolling) +
           ", unit = \"1\", prior = 0.01, source = \"the ground's and its bearing's\" }\n";
}

std::string soil_tables(const sim::RoverDescription &rover, const sim::Soil &soil) {
    const std::string source = "soil library: " + soil.name;
    const auto line = [&](const char *key, double value, const char *unit, const std::string &more) {
        return std::string(key) + " = { value = " + number(value) + ", unit = \"" + unit + "\"" + more + ", source = " + quoted(source) +
               " }\n";
    };
    std::string text = std::string("\n[soil]\nlaw = \"") + (soil.law == sim::TractionLaw::janosi ? "janosi" : "burckhardt") + "\"\n";
    text += line("mu", soil.fm_per_fn, "1", ", prior = " + number(0.15 * soil.fm_per_fn));
    text += line("adhesion_N", soil.adhesion_N, "N", "");
    text += line("shear_slip", soil.shear_slip, "1", ", prior = " + number(0.1 * soil.shear_slip));
    text += line("rolling_coefficient", soil.rolling_coefficient, "1", ", prior = 0.004");
    const double relaxation = rover.at("wheels", "relaxation_length_m");
    text += "relaxation_length_m = { value = " + number(relaxation) +
            ", unit = \"m\", min = 0, max = 0.3, prior = " + number(0.6 * relaxation) +
            ", source = " + quoted(rover.value("wheels", "relaxation_length_m").source) + " }\n";
    text += "lateral_grip = { value = 0.5, unit = \"1\", min = 0, max = 1.2, prior = 0.5, source = \"assumed: the data decide\" }\n";
    return text;
}

} // namespace

std::string model_text(const sim::RoverDescription &rover, const std::string &soil_name) {
    const sim::Soil *soil = sim::find_soil(soil_name);
    if (soil == nullptr) {
        std::string names;
        for (const sim::Soil &known : sim::soil_library()) names += (names.empty() ? "" : ", ") + known.name;
        throw std::invalid_argument("--soil = " + soil_name + ": no such soil; use one of: " + names);
    }
    const sim::LayoutParameters layout = rover.layout();
    const bool caster = layout.kind == sim::Layout::caster;
    if (layout.kind != sim::Layout::four && !caster)
        throw std::invalid_argument("--model: the lab's models have four wheels on two axles, or two and a caster; " + rover.name +
                                    " has not; leave --model out");
    if (!sim::steered_axles(layout).empty())
        throw std::invalid_argument("--model: the wheels of \"" + rover.name +
                                    "\" steer, and the lab's models have wheels that keep the body's heading; leave --model out");
    const double mass = rover.at("body", "mass_kg"), length = rover.at("body", "length_m"), width = rover.at("body", "width_m");
    std::string text = "# Made by traction rover from " + rover.name +
                       ".\nformat = \"traction.model/1\"\nname = " + quoted(rover.name + " on " + soil_name) +
                       "\n\n[rover]\nmotion = \"longitudinal\"\n";
    if (!caster && !layout.rigid && !layout.rocker) text += "halves = true # left and right turn against each other\n";
    if (rover.drives[0] >= 0) text += "drives = [" + std::to_string(rover.drives[0]) + ", " + std::to_string(rover.drives[1]) + "]\n";
    text += from_key(rover, "mass_kg", "body", "mass_kg", 0);
    text += "yaw_inertia_kg_m2 = { value = " + number(mass / 12 * (length * length + width * width)) +
            ", unit = \"kg m^2\", source = \"a plate of length and width\" }\n";
    text += from_key(rover, "battery_voltage_V", "battery", "voltage_V", 0);
    text += "\n[motor] # at the wheel\n";
    text += from_key(rover, "torque_constant_Nm_A", "motor", "torque_constant_Nm_A", 0.02);
    text += from_key(rover, "resistance_ohm", "motor", "resistance_ohm", 0.03);
    text += from_key(rover, "inertia_kg_m2", "motor", "inertia_kg_m2", 0.05);
    text += from_key(rover, "viscous_Nms", "motor", "viscous_Nms", 0.075);
    text += from_key(rover, "coulomb_Nm", "motor", "coulomb_Nm", 0.07);
    text += soil_tables(rover, *soil);
    text += "\n[wheels]\n" + from_key(rover, "radius_m", "wheels", "radius_m", 0.005) + from_key(rover, "width_m", "wheels", "width_m", 0);
    if (caster)
        text += wheel_tables_with_caster(rover, layout, soil->rolling_coefficient);
    else
        for (std::size_t i = 0; i < sim::wheel_count; i++) text += wheel_table(rover, i);
    text += "\n[sensors.encoder]\ncounts_per_turn = " + number(rover.encoder_counts_per_turn()) +
            "\n\n[sensors.radar]\nwindow_s = " + number(rover.at("radar", "window_samples") / rover.at("radar", "rate_Hz")) +
            "\n\n[sensors.camera]\nnoise_m = 1e-3\n";
    return text;
}

} // namespace traction
