// long_log.h - of a log that is longer than a search can take whole, the part that tells the most.
//
// Ten minutes at the grid's own 20 ms, not an hour at 120 ms: coarse steps cut off the corners of every start and stop, and what they cost
// is read as physics (an hour without any effect: voltage_gain -10 %).
#pragma once

#include "host_tools/lab/model/model.h"

#include "host_tools/log/log.h"

#include <string>

namespace traction::lab {

inline constexpr double longest_log_s = 600; // 30000 steps of 20 ms

// Cuts the log to the stretch of most_s in which the wheels change their speeds the most; times stay those of the log. Returns a sentence
// that says so, empty where nothing was cut: a log that is short enough, a table of trials, no wheel that moves.
std::string keep_busiest(const Model &model, log::Log &log, double most_s = longest_log_s);

// Samples from from_s to to_s; to_s 0: to the end.
void keep_part(log::Log &log, double from_s, double to_s);

} // namespace traction::lab
