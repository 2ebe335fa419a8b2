// effects_json.h - an effect of the catalogue as JSON (docs/json_schema.md, schema traction.effects/1).
#pragma once

#include "sim/physics/effects/catalogue.h"

#include <nlohmann/json.hpp>

namespace traction::lab {

const char *place_of(sim::ActsOn where); // "wheel torque"
nlohmann::json effect_json(const sim::Effect &effect);

} // namespace traction::lab
