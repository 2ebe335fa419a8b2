// read_parts.h - the parts of a scenario file, each read and checked on its own.
#pragma once

#include "drive_plan.h"
#include "hidden.h"
#include "keys.h"

#include "sim/physics/effects/catalogue.h"
#include "sim/sensors/fault.h"
#include "sim/sensors/sensors.h"

#include <string>
#include <vector>

namespace traction::sim {

struct Scenario;

std::vector<DriveSegment> read_drive(const toml::array &list, const std::string &file);               // [[drive]]
ActiveEffect read_effect(const toml::table &table, const std::string &file, const std::string &path); // [[effect]]
HiddenDraw read_hidden(const toml::table &table, const std::string &file);                            // [hidden]
void read_sensors(const toml::table &table, const std::string &file, SensorConfig &config);           // [sensors]
void read_radar(const toml::table &table, const std::string &file, Scenario &scenario);               // [radar]
void read_ground(const toml::table &table, const std::string &file, Scenario &scenario);              // [ground]
void read_rover(const toml::node &node, const std::string &file, Scenario &scenario);                 // rover = "FILE", [rover]
void read_faults(const toml::array &list, const std::string &file, Scenario &scenario);               // [[fault]]

} // namespace traction::sim
