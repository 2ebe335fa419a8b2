// log_figure.h - a figure of any log: chosen signals over time, one panel per unit.
#pragma once

#include "svg.h"

#include "host_tools/log/log.h"

#include <limits>
#include <string>
#include <vector>

namespace traction::report {

struct LogFigureOptions {
    std::vector<std::string> signals; // names; * stands for any text, "wheel*.current_A". Empty: every signal
    double from_s = -std::numeric_limits<double>::infinity();
    double to_s = std::numeric_limits<double>::infinity();
};

// Signals of one unit share a panel (at most eight of them); counts and plain numbers share one per quantity. Throws log::LogError
// when a name matches nothing, with the names that come close.
Figure log_figure(const log::Log &log, const LogFigureOptions &options);

// "rad/s" for "wheel0.speed_rad_s", "" for a plain number as "wheel0.slip".
std::string unit_of(const std::string &signal);

} // namespace traction::report
