// measure.h - small readings of a log that the experiments share.
#pragma once

#include "host_tools/log/log.h"
#include "host_tools/report/svg.h"

#include <string>
#include <utility>
#include <vector>

namespace traction {

struct Spread {
    double mean = 0, deviation = 0; // over the values given
};
Spread spread(const std::vector<double> &values);

// Values of a signal with from_s <= t < to_s; empty when the log lacks it.
std::vector<double> values_between(const log::Log &log, const std::string &name, double from_s, double to_s);

// A signal as a line, thinned by the drawing.
report::Series line(const log::Log &log, const std::string &name, const std::string &label);

// "0.302 +- 0.004"
std::string number(double value, int digits = 3);
std::string with_spread(const Spread &s, int digits = 3);

} // namespace traction
