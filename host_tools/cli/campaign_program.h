// campaign_program.h - campaigns are the Python package's (python/traction/campaigns): their samples are scipy's, their table is Parquet,
// and neither has a C++ library in Debian. The command line runs them there.
#pragma once

#include "verbs.h"

#include <string>
#include <vector>

namespace traction::cli {

// Runs `python -m traction.campaigns` with these arguments and `json_option FILE`; what it writes to FILE and its exit code go to the
// outcome. Where the package, or what campaigns need beside it, is not there, says so with the mend; then the exit code is exit_io.
void run_campaign(std::vector<std::string> arguments, const std::string &json_option, Outcome &outcome);

} // namespace traction::cli
