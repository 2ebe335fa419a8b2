// ulog.h - a log of ours as PX4 ULog: what pyulog and PlotJuggler read, each rate with its own times, and what our own reader reads back
// as it was, every bit of every number.
//
// Signals that share their times are one topic, at_100_Hz, whose fields are their names with '_' for what C does not take in one; a column
// has the smallest of int8_t, int16_t, int32_t, float and double that holds all of its values exactly. A message's timestamp is in whole
// microseconds; where those do not give a topic's times back, it has them as a field besides: double t_s. A log that begins before 0 is
// moved to 0, which stands in its header as moved_s. The header's lines are the multi-information messages traction_header ("key: value"),
// the signals' names, in order, traction_signal ("topic field name").
#pragma once

#include "log.h"
#include "read.h"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace traction::log {

// A column, sample after sample, from its beginning as often as it is asked for: once for what its types must hold, once to be written.
class UlogColumn {
  public:
    UlogColumn() = default;
    UlogColumn(const UlogColumn &) = delete;
    UlogColumn &operator=(const UlogColumn &) = delete;
    virtual ~UlogColumn() = default;
    virtual const std::string &name() const = 0;
    virtual void rewind() = 0;
    virtual double t_s() const = 0; // infinite behind the last sample
    virtual double value() const = 0;
    virtual void next() = 0;
};

// Whole or not at all (write_file.h). Throws LogError; FileError when it cannot be written.
void write_ulog(const std::map<std::string, std::string> &header, const std::vector<std::unique_ptr<UlogColumn>> &columns,
                const std::string &path);
void write_ulog(const Log &log, const std::string &path);

bool names_a_ulog(const std::string &path); // it ends in .ulg
bool begins_as_ulog(std::string_view bytes);
bool is_own_ulog(const std::string &path); // one of write_ulog, and not the rover's

// The columns and the header of such a file. What was cut off, or lies behind bytes that are no message, is left out and told. Throws
// LogError for a ULog that is not ours, and for one with more samples than the limits allow.
Log read_ulog(std::string_view bytes, const std::string &path, const ReadLimits &limits, std::vector<Repair> &repairs);

} // namespace traction::log
