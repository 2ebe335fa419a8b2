// scenario_table.h - a scenario from its parsed TOML, for a caller that changes keys before it is read: what was not changed keeps its line
// in messages.
#pragma once

#include "scenario.h"

#include <toml++/toml.h>

#include <string>

namespace traction::sim {

// The TOML of a scenario's text. Throws ScenarioError with the line.
toml::table scenario_table(const std::string &text, const std::string &file);

// As parse_scenario. `text` is what the scenario's hash is taken of.
Scenario scenario_of_table(const toml::table &table, const std::string &text, const std::string &file);

} // namespace traction::sim
