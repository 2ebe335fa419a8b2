// radar_geometry.h - the template of any radar on the host: made once for each geometry and kept as long as the process.
#pragma once

#include "firmware/template/radar_template.h"
#include "sim/scenario/rover.h"

#include <map>
#include <stdexcept>
#include <string>

namespace traction {

// The radar of a description: table II's, or its own numbers. Throws sim::ScenarioError with file, line and key where
// radar_geometry_check refuses.
radar_geometry_t radar_geometry_of(const sim::RoverDescription &rover);

// True where no linked template holds: another radar, another rate than 512 Hz, or a depression beyond what a scale mends.
bool needs_own_template(const sim::RoverDescription &rover);

// Requires that radar_geometry_check refuses nothing. The pointer holds until the process ends; safe from several threads.
const doppler_template_t *template_of(const radar_geometry_t &geometry);

// Lines "<prefix>carrier_Hz" = ... of the geometry that template_of made `beam` from; none for any other. And back; throws
// std::invalid_argument for a line that is missing, no number or refused.
std::map<std::string, std::string> geometry_lines(const doppler_template_t *beam, const std::string &prefix);
radar_geometry_t geometry_of_lines(const std::map<std::string, std::string> &lines, const std::string &prefix);

} // namespace traction
