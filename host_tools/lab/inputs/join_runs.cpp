#include "join_runs.h"

#include "smooth.h"

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

// A run's camera frame is turned so that its heading goes on where the last run ended; its path is turned with it, as a rigid body. Without
// this a path would be looked at from another run's heading. Needs a heading in both; the camera's frame is else taken to be the same.
void turn_path(const log::Log &whole, log::Log &run) {
    const log::Signal *before = whole.find("camera.yaw_rad"), *yaw = run.find("camera.yaw_rad");
    const auto path = [&](const char *name) {
        const auto found = std::find_if(run.signals.begin(), run.signals.end(), [&](const log::Signal &s) { return s.name == name; });
        return found == run.signals.end() || found->value.empty() ? nullptr : &*found;
    };
    log::Signal *x = path("camera.x_m"), *y = path("camera.y_m");
    if (before == nullptr || yaw == nullptr || before->value.empty() || yaw->value.empty() || x == nullptr || y == nullptr) return;
    const double turn = before->value.back() - yaw->value.front(), c = std::cos(turn), s = std::sin(turn);
    const log::Signal old_x = *x, old_y = *y;
    for (std::size_t k = 0; k < x->value.size(); ++k)
        x->value[k] = c * old_x.value[k] - s * interpolate(old_y.t_s, old_y.value, old_x.t_s[k]);
    for (std::size_t k = 0; k < y->value.size(); ++k)
        y->value[k] = s * interpolate(old_x.t_s, old_x.value, old_y.t_s[k]) + c * old_y.value[k];
}

} // namespace

double first_time(const log::Log &log) {
    double first = std::numeric_limits<double>::infinity();
    for (const log::Signal &s : log.signals)
        if (!s.t_s.empty()) first = std::min(first, s.t_s.front());
    return std::isfinite(first) ? first : 0;
}

bool same_drive(const log::Log &one, const log::Log &other) {
    return std::equal(one.signals.begin(), one.signals.end(), other.signals.begin(), other.signals.end(),
                      [](const log::Signal &x, const log::Signal &y) { return x.name == y.name && x.t_s == y.t_s && x.value == y.value; });
}

JoinedRuns join_runs(const std::vector<log::Log> &runs) {
    JoinedRuns out;
    if (runs.empty()) return out;
    out.log = runs.front();
    out.start_s = {first_time(runs.front())};
    double end = out.start_s[0] + runs.front().duration_s();
    for (std::size_t i = 1; i < runs.size(); ++i) {
        log::Log run = runs[i];
        turn_path(out.log, run);
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
