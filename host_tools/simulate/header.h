// header.h - the "# key: value" lines of a simulated log: where it came from and what its sensors are specified to.
//
// What a user of the rover would know, and nothing of what is hidden in the run.
#pragma once

#include "host_tools/log/log.h"
#include "sim/scenario/scenario.h"

#include <cstdint>

namespace traction {

void write_header(const sim::Scenario &scenario, std::uint64_t seed, log::Log &log);

} // namespace traction
