#include "session.h"

#include "host_tools/lab/decision/diagnose.h"

#include <algorithm>
#include <cstdio>
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

std::string verdict_text(const Diagnosis &d) {
    char buffer[400];
    const double before = d.ladder.empty() ? 0 : d.ladder.front().heldout, after = d.ladder.empty() ? 0 : d.ladder.back().heldout;
    std::string names;
    for (const CandidateResult &a : d.accepted) names += (names.empty() ? "" : " and ") + a.candidate.label();
    if (d.kind == "nothing") {
        std::snprintf(buffer, sizeof buffer,
                      "Nothing found that the log supports; the error stands at %.2f x noise. %zu effects could not have been seen in it.",
                      before, d.not_excited.size());
        return buffer;
    }
    std::string text;
    if (!names.empty()) {
        std::snprintf(buffer, sizeof buffer, "The model lacks %s: held-out error %.3f -> %.3f x noise.", names.c_str(), before, after);
        text = buffer;
    }
    for (const ConfoundedClass &c : d.classes) {
        text += " This log cannot tell";
        for (std::size_t i = 0; i < c.members.size(); ++i)
            text += (i == 0 ? " " : i + 1 == c.members.size() ? " from " : ", ") + c.members[i];
        text += '.';
    }
    if (d.unknown) {
        if (!text.empty())
            text += " That explains it only partly:";
        else
            text += "Unknown: no effect of the catalogue explains it:";
        text += " what is left depends on " + d.unknown->variable + ": " + d.unknown->balance + '.';
        for (std::size_t i = 0; i < d.nearest.size(); ++i)
            text += (i == 0 ? " Nearest in the catalogue, not the cause: " : ", ") + d.nearest[i] + (i + 1 == d.nearest.size() ? "." : "");
    }
    return text;
}

} // namespace traction::lab
