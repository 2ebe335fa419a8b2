// recover.h - a whole log from the part (part.h) that a run left which was killed, or whose machine lost its power, before it wrote one.
//
// It is the log that the run would have written at the last block that stands, whole, and says so: header `ended: interrupted`. A block
// that was being written when the run ended is left out. A damaged one ends the log, for rows go on from those before; what lies behind it
// is lost, and told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace traction::log {

struct Recovered {
    std::uint64_t samples = 0;
    double last_s = 0;            // the log's last time
    std::uint64_t lost_bytes = 0; // at the part's end
    std::uint64_t lost_at = 0;    // the first of them
    std::string damage = {};      // what is wrong there; empty: nothing, the run ended while it wrote them
};

// The log under `out`, CSV or ULog; the part is not touched. Throws FileError where a file cannot be read or written or the run that writes
// the part goes on, LogError where it is no part, or has no row.
Recovered recover(const std::string &part, const std::string &out);

} // namespace traction::log
