// board_log.h - the log that tractiond wrote on the rover (ULog, firmware/app/ulog.h), read back, and as a log of ours.
//
// Fields are found by the file's own definitions, so a log of a later firmware with more of them is read too. What was cut off by a power
// cut, or lies behind bytes that are no message, is left out and told.
#pragma once

#include "firmware/core/signals.h"
#include "host_tools/log/log.h"
#include "sim/scenario/rover.h"

#include <cstddef>
#include <string>
#include <vector>

namespace traction::board {

struct BoardTick {
    sensor_frame_t frame{};
    command_t command{};
    trace_t trace{};
};

struct BoardLog {
    std::vector<BoardTick> ticks;    // in order, each whole
    std::vector<std::string> text;   // what the firmware said, "12.340 s: fault ..."
    std::vector<std::string> mended; // what was left out, one sentence each
    std::string version;             // of the program that wrote it; "" if it does not say
};

// Whether the file begins as ULog does.
bool is_ulog(const std::string &path);

// Throws log::FileError, or log::LogError where it is no ULog of tractiond or holds no whole tick.
BoardLog read_board_log(const std::string &path);

// The ticks as the columns of docs/log_format.md, as `traction simulate` records them; the header is that of the rover's description.
log::Log to_log(const BoardLog &board, const sim::RoverDescription &rover);

} // namespace traction::board
