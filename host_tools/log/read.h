// read.h - reading a log with every detail: what was mended as data (for `traction check`), and the limits of size.
//
// The repairs and refusals are listed in docs/log_format.md.
#pragma once

#include "log.h"

#include <map>
#include <string>
#include <vector>

namespace traction::log {

// One thing the reader mended.
struct Repair {
    std::string id;        // "not_finite", "unsorted", "duplicate_time", "cut_last_line", "unit_converted", ...
    std::string signal;    // column it concerns; empty when the whole file is meant
    std::size_t count = 0; // how many cells or rows
    std::size_t line = 0;  // first line concerned; 0 when the whole file is meant
    std::string text;      // the sentence in Log::repairs
};

// A log beyond these is refused with a message, before memory runs out.
struct ReadLimits {
    std::size_t bytes = std::size_t{4} << 30;     // size of the file [1]
    std::size_t samples = std::size_t{200000000}; // non-empty cells; 16 bytes each in memory
};

// The time stamps of a signal run back over times already recorded: the clock was set while the log was written.
struct ClockJump : LogError {
    using LogError::LogError;
};

// As read_csv of log.h, and the repairs as data.
Log read_csv(const std::string &path, const std::string &map_path, std::vector<Repair> &repairs, const ReadLimits &limits = {});

// A log from columns in memory, mended as a file's would be: NaN is "no sample", infinities are dropped and told, times are put in order, a
// known quantity in another unit is converted. `name` stands for the file in messages. Throws LogError where a column's lengths differ or
// its clock was set back (ClockJump).
Log log_of_columns(std::vector<Signal> columns, const std::map<std::string, std::string> &header, const std::string &name,
                   std::vector<Repair> &repairs);

} // namespace traction::log
