// session.h - what every verb of the lab does first: read the model, the log (through its map) and the repeat run.
#pragma once

#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/model/model.h"

#include <string>
#include <vector>

namespace traction::lab {

struct Request {
    std::string model, log, map, repeat;
    double from_s = 0, to_s = 0;           // part of the log; to_s 0: all
    std::vector<std::string> despite = {}; // errors of the check that shall not stop it (gate.h)
};

struct Session {
    Model model;
    Dataset data;
};

// The log has passed the gate, or was let through despite an error: data.despite and data.messages say so. Throws ModelError,
// log::LogError, Refused (gate.h).
Session open_session(const Request &request);

} // namespace traction::lab
