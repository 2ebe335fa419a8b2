#include "trial.h"

#include "host_tools/simulate/simulate.h"

namespace traction::cli {

lab::DriveScenario simulated_rover() {
    return [](const std::string &scenario_toml) { return simulate(sim::parse_scenario(scenario_toml, "the lab's manoeuvre")).log; };
}

} // namespace traction::cli
