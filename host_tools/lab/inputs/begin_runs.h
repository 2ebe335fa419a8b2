// begin_runs.h - which run of a model each log of a data set is, when it begins, and what it has of its own.
//
// An offset belongs to a run: an accelerometer or a gyro has another each time that it is switched on, so several logs have one each, with
// the deviation that is stated (or that the log's header states). A ground belongs to a run where the model's file says so ([[run]]).
#pragma once

#include "host_tools/lab/model/model.h"
#include "host_tools/log/log.h"

#include <vector>

namespace traction::lab {

// `start_s`: of each run, in the data set's time (join_runs.h). Runs of the model that no log here is of are left as they are, out of it. A
// run's file is told from another's by as much of its path as that needs; a file that is given twice is one run. Throws ModelError where a
// name in the model's file is that of two logs.
void begin_runs(Model &model, const std::vector<log::Log> &runs, const std::vector<double> &start_s);

} // namespace traction::lab
