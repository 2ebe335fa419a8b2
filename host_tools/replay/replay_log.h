// replay_log.h - the frames and commands of a run, taken back out of its log, so that control_step can be run on them again.
//
// A log of `traction simulate` holds every raw count and every command (docs/log_format.md): replaying it gives the same traces,
// bit for bit, on any machine. A change of the firmware or of its configuration can so be tried on a drive that was recorded.
#pragma once

#include "firmware/core/control.h"
#include "host_tools/log/log.h"

#include <cstddef>
#include <string>
#include <vector>

namespace traction::replay {

struct LoggedTick {
    sensor_frame_t frame;
    command_t command;
};

// Every tick of the log, in order. Throws log::LogError when the log lacks the raw columns.
std::vector<LoggedTick> logged_ticks(const log::Log &log);

// The ticks as text (hal/replay/frames.h), for `tractiond --hal replay` on host and target alike.
std::string frames_text(const std::vector<LoggedTick> &ticks);

// The configuration that made the log, from its header: the reference rover's, with the lines `firmware.<key>` over it, the paper's where it
// says `firmware: paper`.
control_config_t logged_config(const log::Log &log);

struct Comparison {
    std::size_t ticks = 0, differing = 0;
    double first_s = 0;       // time of the first difference
    std::string first_signal; // its name
    double logged = 0, replayed = 0;
};

// Runs the rover's loop (daemon_run) over the ticks and compares what it makes of them with what the log recorded: speeds, slips, torques,
// tractions, duties, estimates. A log keeps six decimals: a difference is more than half of the last.
Comparison replay_log(const log::Log &log, const std::vector<LoggedTick> &ticks);

} // namespace traction::replay
