// trial.h - lends the lab the simulated rover: a scenario's text in, the log that such a drive would give out.
#pragma once

#include "host_tools/log/log.h"

#include <functional>
#include <string>

namespace traction {

// A lab::DriveScenario (host_tools/lab/next/next.h). What it returns throws sim::ScenarioError.
std::function<log::Log(const std::string &scenario_toml)> simulated_rover();

} // namespace traction
