// trial.h - lends the lab the simulated rover: a scenario's text in, the log that such a drive would give out.
#pragma once

#include "host_tools/lab/next/next.h"

namespace traction::cli {

lab::DriveScenario simulated_rover();

} // namespace traction::cli
