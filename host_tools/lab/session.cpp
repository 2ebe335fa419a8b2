#include "session.h"

#include "bends.h"
#include "creeps.h"
#include "gate.h"
#include "sideways.h"

#include "host_tools/lab/decision/shape_rules.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/inputs/begin_runs.h"
#include "host_tools/lab/inputs/inputs.h"
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

// What a motor's losses and inertia would be is told as an effect where the model has none of them.
std::string taken_as_zero(const Model &model) {
    std::string keys;
    for (const char *key : {"inertia_kg_m2", "viscous_Nms", "coulomb_Nm"}) {
        const auto states_it = [&](const WheelSpec &w) {
            const auto stated = w.motor.find(key);
            return stated != w.motor.end() && (stated->second.given || stated->second.value != 0);
        };
        if (std::none_of(model.wheel.begin(), model.wheel.end(), states_it))
            keys += (keys.empty() ? "motor." : ", motor.") + std::string(key);
    }
    const bool has_motors = std::any_of(model.wheel.begin(), model.wheel.end(),
                                        [](const WheelSpec &w) { return w.driven && parameter(w.motor, "torque_constant_Nm_A") > 0; });
    return keys.empty() || !has_motors
               ? ""
               : "the model does not state " + keys + ": taken as 0 and not fitted, what they do would be told as an effect";
}

// Of all runs, with what was told of them.
Dataset data_of(const Session &session, const JoinedRuns &joined) {
    Dataset data = make_dataset(session.model, joined.log, session.repeat ? &*session.repeat : nullptr);
    if (session.runs.size() > 1) {
        data.run_start_s = joined.start_s;
        data.duration_s = 0;
        data.log_file.clear();
        for (const log::Log &run : session.runs) {
            data.duration_s += run.duration_s();
            data.log_file += (data.log_file.empty() ? "" : " + ") + run.source.substr(run.source.find_last_of('/') + 1);
        }
    }
    data.messages.insert(data.messages.end(), session.told.begin(), session.told.end());
    data.despite = session.despite;
    return data;
}

void tell(Session &session, const std::string &sentence) {
    session.told.push_back(sentence);
    session.data.messages.push_back(sentence);
}

void follow_sideways(Session &session, const JoinedRuns &joined) {
    session.model.motion = BodyMotion::planar;
    session.told.push_back(followed_sideways);
    session.data = data_of(session, joined);
}

void bend(Session &session) { // no row of the data depends on it
    ask_for_curve(session.model);
    tell(session, curve_is_asked);
}

} // namespace

void ask_the_log(Session &session) {
    const JoinedRuns joined = join_runs(session.runs);
    session.told.insert(session.told.begin(), joined.log.repairs.begin(), joined.log.repairs.end());
    session.data = data_of(session, joined);
    if (drifts_sideways(session.model, session.data)) follow_sideways(session, joined);
    if (creeps(session.model, session.data)) {
        ask_for_reversal(session.model);
        session.told.push_back(reversal_is_asked);
        session.data = data_of(session, joined);
    }
    if (bends_otherwise(session.model, session.data)) bend(session);
}

std::optional<Session> asked_anew(const Session &session, const Model &found, double shape_over_slip) {
    const bool drifts = drifts_sideways(found, session.data);
    Session anew = session;
    Model with = found;
    if (drifts) {
        follow_sideways(anew, join_runs(anew.runs));
        with.motion = BodyMotion::planar;
    }
    const bool bends = bends_otherwise(with, anew.data, shape_over_slip);
    if (bends) bend(anew);
    return drifts || bends ? std::optional<Session>(std::move(anew)) : std::nullopt;
}

Diagnosed diagnose_session(const Session &session, const DiagnoseOptions &how) {
    Diagnosed out;
    out.diagnosis = diagnose(session.model, session.data, how);
    const std::optional<UnknownShape> &shape = out.diagnosis.unknown;
    const bool over_slip = shape && shape->variable == axis_name(Axis::slip) && shape->score && !shape->score->candidate.some_wheels;
    if (out.diagnosis.accepted.empty() && !over_slip) return out; // the session was asked with as much
    std::optional<Session> anew = asked_anew(session, out.diagnosis.model, over_slip ? shape->gain : 0);
    if (anew) out.anew = std::make_unique<const Session>(std::move(*anew));
    if (out.anew) out.diagnosis = diagnose(out.anew->model, out.anew->data, how);
    return out;
}

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
    std::vector<std::string> told, files = request.logs, maps = request.maps;
    if (!request.log.empty()) files.insert(files.begin(), request.log);
    if (!request.map.empty()) maps.insert(maps.begin(), request.map);
    if (maps.size() > 1 && maps.size() != files.size())
        throw ModelError(request.model, 0, "--map",
                         "is given " + std::to_string(maps.size()) + " times for " + std::to_string(files.size()) + " logs",
                         "give one map for all logs, or one for each in the order of the logs");
    const auto map_of = [&](std::size_t i) { return maps.empty() ? std::string() : maps[maps.size() == 1 ? 0 : i]; };
    for (std::size_t i = 0; i < files.size(); ++i) {
        log::Log run = checked_log(request, files[i], map_of(i), session.model, told, session.despite);
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
    begin_runs(session.model, session.runs, join_runs(session.runs).start_s);
    for (const log::Log &run : session.runs)
        for (const auto &[key, value] : run.header) // a map that says so makes the model's currents magnitudes
            if (key.find("unsigned.wheel") == 0 && key.find("current") != std::string::npos && value == "1")
                session.model.unsigned_current = true;
    if (!request.repeat.empty()) {
        session.repeat = checked_log(request, request.repeat, map_of(0), session.model, told, session.despite);
        refuse_twice(session.runs, *session.repeat, request.repeat, "--repeat");
    }
    if (const std::string zero = taken_as_zero(session.model); !zero.empty()) told.push_back(zero);
    session.told = std::move(told);
    ask_the_log(session);
    return session;
}

} // namespace traction::lab
