#include "join_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace traction::lab {

namespace {

bool accumulates(const std::string &name) {
    for (const char *tail : {".encoder_count", ".angle_rad", "camera.x_m", "camera.y_m", "camera.yaw_rad", "carriage.x_m"}) {
        const std::string end = tail;
        if (name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0) return true;
    }
    return false;
}

double first_time(const log::Log &log) {
    double first = std::numeric_limits<double>::infinity();
    for (const log::Signal &s : log.signals)
        if (!s.t_s.empty()) first = std::min(first, s.t_s.front());
    return std::isfinite(first) ? first : 0;
}

} // namespace

JoinedRuns join_runs(const std::vector<log::Log> &runs) {
    JoinedRuns out;
    if (runs.empty()) return out;
    out.log = runs.front();
    out.start_s = {first_time(runs.front())};
    double end = out.start_s[0] + runs.front().duration_s();
    for (std::size_t i = 1; i < runs.size(); ++i) {
        const log::Log &run = runs[i];
        const double start = out.start_s[0] + 10 * std::ceil((end - out.start_s[0] + 5) / 10), shift = start - first_time(run);
        out.start_s.push_back(start);
        end = start + run.duration_s();
        out.log.header.insert(run.header.begin(), run.header.end());
        out.log.repairs.insert(out.log.repairs.end(), run.repairs.begin(), run.repairs.end());
        out.log.source += " + " + run.source.substr(run.source.find_last_of('/') + 1);
        for (const log::Signal &s : run.signals) {
            auto whole =
                std::find_if(out.log.signals.begin(), out.log.signals.end(), [&](const log::Signal &o) { return o.name == s.name; });
            if (whole == out.log.signals.end()) whole = out.log.signals.insert(out.log.signals.end(), log::Signal{s.name, {}, {}});
            if (s.value.empty()) continue;
            const double step = accumulates(s.name) && !whole->value.empty() ? whole->value.back() - s.value.front() : 0;
            for (std::size_t k = 0; k < s.t_s.size(); ++k) {
                whole->t_s.push_back(s.t_s[k] + shift);
                whole->value.push_back(s.value[k] + step);
            }
        }
    }
    return out;
}

} // namespace traction::lab
