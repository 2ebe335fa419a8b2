#include "session.h"

#include "gate.h"

#include "host_tools/lab/forward/make_dataset.h"

#include <algorithm>
#include <limits>

namespace traction::lab {

namespace {

void cut_part(log::Log &log, double from_s, double to_s) {
    if (!(from_s > 0) && !(to_s > 0)) return;
    if (!(to_s > 0)) to_s = std::numeric_limits<double>::infinity();
    for (log::Signal &s : log.signals) {
        log::Signal part;
        part.name = s.name;
        for (std::size_t i = 0; i < s.t_s.size(); ++i)
            if (s.t_s[i] >= from_s && s.t_s[i] <= to_s) part.t_s.push_back(s.t_s[i]), part.value.push_back(s.value[i]);
        s = std::move(part);
    }
}

// One log, the part that is asked for, through the gate.
log::Log checked_log(const Request &request, const std::string &file, const Model &model, std::vector<std::string> &told,
                     std::vector<std::string> &despite) {
    std::vector<log::Repair> repairs;
    log::Log log = log::read_csv(file, request.map, repairs);
    cut_part(log, request.from_s, request.to_s);
    for (std::string &sentence : pass_gate(check::check(log, repairs, machine_of(model)), file, request.despite, despite))
        told.push_back(std::move(sentence));
    return log;
}

} // namespace

Session open_session(const Request &request) {
    Session session;
    session.model = read_model(request.model);
    std::vector<std::string> told, despite;
    const log::Log log = checked_log(request, request.log, session.model, told, despite);
    for (const auto &[key, value] : log.header) // a map that says so makes the model's currents magnitudes
        if (key.find("unsigned.wheel") == 0 && key.find("current") != std::string::npos && value == "1")
            session.model.unsigned_current = true;
    if (request.repeat.empty()) {
        session.data = make_dataset(session.model, log);
    } else {
        const log::Log repeat = checked_log(request, request.repeat, session.model, told, despite);
        session.data = make_dataset(session.model, log, &repeat);
    }
    for (const std::string &repair : log.repairs) session.data.messages.push_back(repair);
    session.data.messages.insert(session.data.messages.end(), told.begin(), told.end());
    session.data.despite = despite;
    return session;
}

} // namespace traction::lab
