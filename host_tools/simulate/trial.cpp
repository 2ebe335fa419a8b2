#include "trial.h"

#include "simulate.h"

namespace traction {

std::function<log::Log(const std::string &scenario_toml)> simulated_rover() {
    return [](const std::string &scenario_toml) {
        sim::Scenario scenario = sim::parse_scenario(scenario_toml, "the lab's manoeuvre");
        scenario.firmware.believes = sim::RoverDescription(); // what the lab has learnt of the rover has not reached its firmware
        return simulate(scenario).log;
    };
}

} // namespace traction
