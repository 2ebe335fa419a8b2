#include "session.h"

#include "creeps.h"
#include "gate.h"
#include "sideways.h"

#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/inputs/begin_runs.h"
#include "host_tools/lab/inputs/join_runs.h"
#include "host_tools/lab/inputs/long_log.h"
#include "host_tools/lab/model/model_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace traction::lab {

namespace {

// The part that --from and --to ask for; a part that no log has is refused, for what comes next would complain of a log without columns.
void keep_asked(log::Log &log, const std::string &file, const Request &request) {
    const auto refuse = [&](const char *option, double value, const std::string &wrong, const std::string &mend) {
        throw ModelError(file, 0, option, number_text(value) + " s " + wrong, mend);
    };
    for (const auto &[option, value] : {std::pair("--from", request.from_s), std::pair("--to", request.to_s)})
        if (!(value >= 0 && std::isfinite(value))) refuse(option, value, "is no time", "give seconds of the log's own clock, 0 or more");
    if (request.to_s > 0 && !(request.from_s < request.to_s))
        refuse("--from", request.from_s, "is not before --to " + number_text(request.to_s), "give an earlier --from or a later --to");
    double first_s = std::numeric_limits<double>::infinity(), last_s = -first_s;
    for (const log::Signal &signal : log.signals)
        if (!signal.t_s.empty()) first_s = std::min(first_s, signal.t_s.front()), last_s = std::max(last_s, signal.t_s.back());
    const std::string span = "the log goes from " + number_text(first_s) + " to " + number_text(last_s) + " s";
    if (first_s <= last_s && request.from_s > last_s) refuse("--from", request.from_s, "is behind the log's end", span);
    if (first_s <= last_s && request.to_s > 0 && request.to_s < first_s) refuse("--to", request.to_s, "is before the log begins", span);
    keep_part(log, request.from_s, request.to_s);
}

// One drive given twice counts as two: intervals halve, and it is said to be judged by what it was fitted to.
void refuse_twice(const std::vector<log::Log> &runs, const log::Log &log, const std::string &file, const char *option) {
    for (const log::Log &run : runs)
        if (same_drive(run, log))
            throw ModelError(file, 0, option, "holds the same samples as " + run.source, "give another drive, or leave it out");
}

} // namespace

log::Log checked_log(const Request &request, const std::string &file, const std::string &map, const Model &model,
                     std::vector<std::string> &told, std::vector<std::string> &despite) {
    std::vector<log::Repair> repairs;
    log::Log log = request.read ? request.read(file, map, repairs) : log::read_csv(file, map, repairs);
    keep_asked(log, file, request);
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
    for (std::size_t i = 0; i < files.size(); ++i) {
        log::Log run = checked_log(request, files[i], map_of(i), session.model, told, despite);
        run.source = files[i];
        refuse_twice(session.runs, run, files[i], "--log");
        session.runs.push_back(std::move(run));
    }
    if (!request.validate.empty() && !files.empty()) {
        std::vector<std::string> again, anyway; // told where they are judged
        for (const std::string &file : request.validate)
            refuse_twice(session.runs, checked_log(request, file, request.map_of_validation(), session.model, again, anyway), file,
                         "--validate");
    }
    const JoinedRuns joined = join_runs(session.runs);
    const log::Log &log = joined.log;
    begin_runs(session.model, session.runs, joined.start_s);
    for (const auto &[key, value] : log.header) // a map that says so makes the model's currents magnitudes
        if (key.find("unsigned.wheel") == 0 && key.find("current") != std::string::npos && value == "1")
            session.model.unsigned_current = true;
    std::optional<log::Log> repeat;
    if (!request.repeat.empty()) {
        repeat = checked_log(request, request.repeat, map_of(0), session.model, told, despite);
        refuse_twice(session.runs, *repeat, request.repeat, "--repeat");
    }
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
