#include "session.h"

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

} // namespace

Session open_session(const Request &request) {
    Session session;
    session.model = read_model(request.model);
    log::Log log = log::read_csv(request.log, request.map);
    cut_part(log, request.from_s, request.to_s);
    for (const auto &[key, value] : log.header) // a map that says so makes the model's currents magnitudes
        if (key.find("unsigned.wheel") == 0 && key.find("current") != std::string::npos && value == "1")
            session.model.unsigned_current = true;
    if (request.repeat.empty()) {
        session.data = make_dataset(session.model, log);
    } else {
        log::Log repeat = log::read_csv(request.repeat, request.map);
        cut_part(repeat, request.from_s, request.to_s);
        session.data = make_dataset(session.model, log, &repeat);
    }
    for (const std::string &repair : log.repairs) session.data.messages.push_back(repair);
    return session;
}

} // namespace traction::lab
