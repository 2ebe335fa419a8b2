// session.h - what every verb of the lab does first: read the model, the log (through its map) and the repeat run.
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/model/model.h"

#include <string>

namespace traction::lab {

struct Request {
    std::string model, log, map, repeat;
    double from_s = 0, to_s = 0; // part of the log; to_s 0: all
};

struct Session {
    Model model;
    Dataset data;
};

// Throws ModelError, log::LogError.
Session open_session(const Request &request);

} // namespace traction::lab
