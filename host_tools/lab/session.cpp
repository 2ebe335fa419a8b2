#include "session.h"

#include "creeps.h"
#include "gate.h"
#include "sideways.h"

#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/inputs/begin_runs.h"
#include "host_tools/lab/inputs/join_runs.h"
#include "host_tools/lab/inputs/long_log.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace traction::lab {

log::Log checked_log(const Request &request, const std::string &file, const std::string &map, const Model &model,
                     std::vector<std::string> &told, std::vector<std::string> &despite) {
    std::vector<log::Repair> repairs;
    log::Log log = request.read ? request.read(file, map, repairs) : log::read_csv(file, map, repairs);
    keep_part(log, request.from_s, request.to_s);
    for (std::string &sentence : pass_gate(check::check(log, repairs, machine_of(model)), file, request.despite, despite))
        told.push_back(std::move(sentence));
    if (!request.repeat.empty()) return log; // two runs are compared time by time
    const double runs = static_cast<double>(request.logs.size() + (request.log.empty() ? 0 : 1)), gap_s = 15; // join_runs.h
    const double share_s = runs > 1 ? std::max(60.0, longest_log_s / runs - gap_s) : longest_log_s;
    if (std::string sentence = keep_busiest(model, log, share_s); !sentence.empty()) told.push_back(std::move(sentence));
    return log;
}

Session open_session(const Request &request) { return open_session(request, read_model(request.model)); }

Session open_session(const Request &request, Model model) {
    Session session;
    session.model = std::move(model);
    std::vector<std::string> told, despite, files = request.logs, maps = request.maps;
    if (!request.log.empty()) files.insert(files.begin(), request.log);
    if (!request.map.empty()) maps.insert(maps.begin(), request.map);
    if (maps.size() > 1 && maps.size() != files.size())
        throw ModelError(request.model, 0, "--map",
                         "is given " + std::to_string(maps.size()) + " times for " + std::to_string(files.size()) + " logs",
                         "give one map for all logs, or one for each in the order of the logs");
    const auto map_of = [&](std::size_t i) { return maps.empty() ? std::string() : maps[maps.size() == 1 ? 0 : i]; };
    for (std::size_t i = 0; i < files.size(); ++i)
        session.runs.push_back(checked_log(request, files[i], map_of(i), session.model, told, despite)),
            session.runs.back().source = files[i];
    const JoinedRuns joined = join_runs(session.runs);
    const log::Log &log = joined.log;
    begin_runs(session.model, session.runs, joined.start_s);
    for (const auto &[key, value] : log.header) // a map that says so makes the model's currents magnitudes
        if (key.find("unsigned.wheel") == 0 && key.find("current") != std::string::npos && value == "1")
            session.model.unsigned_current = true;
    std::optional<log::Log> repeat;
    if (!request.repeat.empty()) repeat = checked_log(request, request.repeat, map_of(0), session.model, told, despite);
    const auto data = [&] { return make_dataset(session.model, log, repeat ? &*repeat : nullptr); };
    session.data = data();
    if (drifts_sideways(session.model, session.data)) {
        session.model.motion = BodyMotion::planar;
        session.data = data();
        told.push_back(followed_sideways);
    }
    if (creeps(session.model, session.data)) {
        ask_for_reversal(session.model);
        session.data = data();
        told.push_back(reversal_is_asked);
    }
    if (session.runs.size() > 1) {
        session.data.run_start_s = joined.start_s;
        session.data.duration_s = 0;
        for (const log::Log &run : session.runs) session.data.duration_s += run.duration_s();
        session.data.log_file.clear();
        for (const std::string &file : files)
            session.data.log_file += (session.data.log_file.empty() ? "" : " + ") + file.substr(file.find_last_of('/') + 1);
    }
    for (const std::string &repair : log.repairs) session.data.messages.push_back(repair);
    session.data.messages.insert(session.data.messages.end(), told.begin(), told.end());
    session.data.despite = despite;
    return session;
}

} // namespace traction::lab
