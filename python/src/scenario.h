// scenario.h - scenarios and rovers as Python holds them.
#pragma once

#include "bind.h"

#include "sim/scenario/scenario.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace traction::python {

struct ScenarioData {
    sim::Scenario scenario;
};

struct RoverData {
    sim::RoverDescription rover;
};

} // namespace traction::python
