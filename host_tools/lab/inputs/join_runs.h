// join_runs.h - several runs of one machine as one log: one after the other in time, with a gap in which nothing is learnt.
//
// Each run begins at a multiple of 10 s at least 5 s after the last one's end: blocks of 5 s and of 2.5 s (docs/lab_method.md) never hold
// two runs. Counts, angles and poses go on where the last run ended, so that nothing jumps: a camera's
// path is moved and turned as a whole, by its heading. Header: the first run's, with what all
// others add to it.
#pragma once

#include "host_tools/log/log.h"

#include <vector>

namespace traction::lab {

struct JoinedRuns {
    log::Log log;
    std::vector<double> start_s; // of each run, in the joined log's time
};

double first_time(const log::Log &log); // of its samples [s]; 0 where there is none

// They hold the same samples, whatever their files are called: one drive, given twice.
bool same_drive(const log::Log &one, const log::Log &other);

// Signals that only some runs have stay empty in the others. One run is returned as it is.
JoinedRuns join_runs(const std::vector<log::Log> &runs);

} // namespace traction::lab
