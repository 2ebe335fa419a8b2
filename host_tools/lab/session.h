// session.h - what every verb of the lab does first: read the model, the logs (each through its map) and the repeat run, through the gate.
#pragma once

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/inputs/dataset.h"
#include "host_tools/lab/model/model.h"
#include "host_tools/log/read.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace traction::lab {

struct Request {
    std::string model, log, map, repeat;
    double from_s = 0, to_s = 0;            // part of each log; to_s 0: all
    std::vector<std::string> despite = {};  // errors of the check that shall not stop it (gate.h)
    std::vector<std::string> logs = {};     // runs of one machine, beside `log`
    std::vector<std::string> maps = {};     // one for all logs, or one for each; beside `map`
    std::vector<std::string> validate = {}; // logs that the result is judged on, never fitted
    // How a log is read; empty: from its file (log::read_csv). For a caller that holds logs in memory under names of its own.
    std::function<log::Log(const std::string &file, const std::string &map, std::vector<log::Repair> &repairs)> read = {};
    std::string map_of_validation() const { return maps.empty() ? map : maps.front(); }
};

struct Session {
    Model model;
    Dataset data;                           // of all runs, one after the other (join_runs.h)
    std::vector<log::Log> runs;             // as read, through map and gate
    std::optional<log::Log> repeat;         // a second run of the same drive
    std::vector<std::string> told, despite; // of reading and opening, which the data's messages end with; errors overridden
};

// Every log has passed the gate, or was let through despite an error: data.despite and data.messages say so. Throws ModelError,
// log::LogError, Refused (gate.h).
Session open_session(const Request &request);

// The same with a model that was read already; request.model is for messages.
Session open_session(const Request &request, Model model);

// Makes the data of the session's runs, and asks them what the model need not say: whether the machine is followed sideways (sideways.h),
// over which speed resistance reverses (creeps.h), whether the ground is of the law's curve (bends.h).
void ask_the_log(Session &session);

// The same asked again with what was found, `found`: before an effect is known that turns the machine in its bends, as mass off its middle
// does, or that hides the ground's curve, the log may not tell. Nothing where it is answered as before.
// shape_over_slip: as bends_otherwise() has it.
std::optional<Session> asked_anew(const Session &session, const Model &found, double shape_over_slip = 0);

// What a session's log shows, and the session that it was found by in the end, where that was asked anew.
struct Diagnosed {
    std::unique_ptr<const Session> anew; // stays where it is
    Diagnosis diagnosis;                 // refers to that session's data
};
Diagnosed diagnose_session(const Session &session, const DiagnoseOptions &how);

// One log, the part that is asked for, through the gate. `told`: warnings and what was overridden; `despite`: ids overridden.
log::Log checked_log(const Request &request, const std::string &file, const std::string &map, const Model &model,
                     std::vector<std::string> &told, std::vector<std::string> &despite);

} // namespace traction::lab
