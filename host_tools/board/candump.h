// candump.h - frames as can-utils' candump writes them, through a DBC, as a log.
//
//   (1436509052.249713) can0 123#11223344        candump -L, -l: its own log files; 29-bit ids have eight digits, CAN FD "##" and a flag
//   (0.012345)  can0  123  [4]  11 22 33 44      candump -ta, -tz on a screen
//
// A signal is <message>.<signal> in the DBC's unit; time begins at the first frame. Remote and error frames carry nothing. What else is
// left out is counted and told: lines that are no frame, ids that the DBC does not know, frames that are too short, numbers that are not
// finite.
#pragma once

#include "dbc.h"

#include "host_tools/log/log.h"

#include <string>

namespace traction::board {

// Whether the file's first line that is not blank looks like candump's.
bool is_candump(const std::string &path);

// Throws log::FileError, or log::LogError where no frame is left.
log::Log read_candump(const std::string &path, const std::string &dbc_path);

} // namespace traction::board
