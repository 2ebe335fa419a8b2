// rover.h - what follows from a rover's description (sim/scenario/rover.h) on the other side of the seam: the firmware's
// parameters and configuration, and a model for the lab.
#pragma once

#include "firmware/app/parameters.h"
#include "sim/scenario/rover.h"
#include "sim/scenario/scenario.h"

#include <map>
#include <stdexcept>
#include <string>

namespace traction {

// The primary numbers for the firmware: what the description gives is given, the rest follows (rover_parameters_scale).
// A radar that no linked template holds gets its own. Throws sim::ScenarioError where its numbers give none.
parameters_t firmware_parameters(const sim::RoverDescription &rover);

// Built and checked. Throws sim::ScenarioError with the description's file, line, key and the reason of control_config_check.
control_config_t firmware_config(const sim::RoverDescription &rover);

// The rover that a scenario's firmware takes itself for.
const sim::RoverDescription &believed(const sim::Scenario &scenario);

// The firmware of a scenario: the believed rover, its config ("default" or "paper") and its calibration. `instead` replaces the config.
control_config_t firmware_of(const sim::Scenario &scenario, const std::string &instead = "");

// The text of the firmware's parameter file; read again it gives the same configuration bit for bit.
std::string firmware_text(const sim::RoverDescription &rover);

// The text of a lab's model (docs/model_format.md) of this rover on a soil of the library; sources are the description's, priors those of
// the shipped models. Throws std::invalid_argument for an unknown soil.
std::string model_text(const sim::RoverDescription &rover, const std::string &soil);

// Header lines of a log that was driven by a firmware whose parameters are not the reference's: "firmware.<key>" = value; none for the
// reference. And the parameters that such lines state. Throws std::invalid_argument for a line that no firmware here knows.
std::map<std::string, std::string> parameter_lines(const parameters_t &parameters);
parameters_t parameters_of_lines(const std::map<std::string, std::string> &header);

} // namespace traction
