// verb_rover.cpp - traction rover FILE: checks a rover's description and writes what follows from it: the firmware's parameters, a model.
#include "verbs.h"

#include "hal/linux/hardware.h"
#include "host_tools/report/report.h"
#include "host_tools/rover/rover.h"

#include <cstdio>
#include <memory>
#include <stdexcept>

namespace traction::cli {

namespace {

struct RoverOptions {
    std::string rover, firmware, model, soil = "sand";
};

nlohmann::json parameters_json(const parameters_t &parameters) {
    nlohmann::json out = nlohmann::json::object();
    for (int32_t i = 0; i < ROVER_PARAMETER_COUNT; i++)
        out[rover_parameter_name(i)] = {{"value", parameters.rover.value[i]}, {"given", parameters.given[i] || !rover_parameter_scaled(i)}};
    return out;
}

// [hardware], where the file has it, by the rover's own reader; the devices themselves are opened on the rover alone.
void check_hardware(const sim::RoverDescription &rover) {
    hardware_t hardware;
    char message[HARDWARE_MESSAGE];
    if (rover.hardware_line == 0) return;
    if (!hardware_read(rover.file.c_str(), &hardware, message)) throw std::runtime_error(message); // complete: file, line, key, value, mend
    std::printf("hardware: wheels by %s, sensors by %s\n", hardware.key[HARDWARE_wheels].text, hardware.key[HARDWARE_sensors].text);
}

void run_rover(const RoverOptions &options, Outcome &outcome) {
    const sim::RoverDescription rover = sim::read_rover_file(options.rover);
    check_hardware(rover);
    const control_config_t config = firmware_config(rover); // refuses what cannot work
    const parameters_t parameters = firmware_parameters(rover);
    std::printf("%s: %.3g kg on wheels of %.4g m, radar %s; the firmware accepts it\n", rover.name.c_str(), rover.at("body", "mass_kg"),
                rover.mean_radius_m(), rover.radar.c_str());
    std::printf("up to %.3g m/s; a wheel up to %.3g rad/s, %.3g A for good; wheel loop Kp %.4g, Ki %.4g 1/s\n",
                static_cast<double>(config.speed_control.speed_max_m_s), static_cast<double>(config.speed_control.wheel_max_rad_s),
                static_cast<double>(config.safety.current_continuous_A), static_cast<double>(config.wheel_pid.kp_s),
                static_cast<double>(parameters.rover.value[ROVER_wheel_ki_1]));
    outcome.json = {
        {"schema", "traction.rover/1"}, {"name", rover.name}, {"radar", rover.radar}, {"firmware", parameters_json(parameters)}};
    if (!options.firmware.empty()) {
        report::write_text(firmware_text(rover), options.firmware);
        std::printf("wrote %s\n", options.firmware.c_str());
    }
    if (!options.model.empty()) {
        try {
            report::write_text(model_text(rover, options.soil), options.model);
        } catch (const std::invalid_argument &error) {
            throw UsageError(error.what());
        }
        std::printf("wrote %s\n", options.model.c_str());
    }
}

} // namespace

Verb verb_rover() {
    const auto options = std::make_shared<RoverOptions>();
    return {
        .name = "rover",
        .summary = "check a rover's description; write the firmware's parameters and a model of it",
        .options =
            {{.argument = "ROVER", .into = &options->rover, .help = "description (rovers/*.toml)", .kind = Kind::rover, .required = true},
             {.name = "--firmware",
              .into = &options->firmware,
              .help = "write the firmware's parameters to this file",
              .value = "FILE",
              .kind = Kind::output},
             {.name = "--model",
              .into = &options->model,
              .help = "write a model with priors for the lab to this file (TOML)",
              .value = "FILE",
              .kind = Kind::output},
             {.name = "--soil", .into = &options->soil, .help = "soil of the model", .value = "SOIL", .shows_default = true}},
        .run = [options](Outcome &outcome) { run_rover(*options, outcome); }};
}

} // namespace traction::cli
