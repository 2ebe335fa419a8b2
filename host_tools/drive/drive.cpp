#include "drive.h"

#include "firmware/core/safety.h"
#include "firmware/core/signals.h"
#include "host_tools/log/log.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace traction::drive {

namespace {

constexpr double period_s = 0.02, first_words_s = 3, stop_s = 1;
constexpr double status_age_s = 0.2; // below what the rover takes for stale (firmware/link/supervisor.h), so that silence is told as such

std::uint32_t ending(std::uint32_t faults) { return faults & ~static_cast<std::uint32_t>(SAFETY_LIMITING); }

// Stop, until what was latched is gone; what then is there is a cause, not a memory.
void begin(Operator &link) {
    const double until_s = link.now_s() + stop_s;
    do {
        link.send({.mode = MODE_STOP});
        link.listen(period_s);
    } while (link.now_s() < until_s && (link.status().mode != MODE_STOP || ending(link.status().faults) != 0));
}

} // namespace

std::string line_of(const Operator &link) {
    const Status &s = link.status();
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "%7.3f m/s +-%.3f of %6.3f | %-14s | %5.2f V | slip", s.speed_m_s, s.speed_std_m_s,
                  s.set_speed_m_s, mode_words(s.mode), s.battery_V);
    std::string line = text.data();
    for (const double slip : s.slip) {
        std::snprintf(text.data(), text.size(), std::isnan(slip) ? "     -" : " %5.2f", slip);
        line += text.data();
    }
    line += " | A";
    for (const double current : s.current_A) {
        std::snprintf(text.data(), text.size(), " %5.2f", current);
        line += text.data();
    }
    return line + " | faults: " + fault_words(s.faults);
}

namespace {

bool enough(const Operator &link, bool to_command) { return link.heard() && (!to_command || link.counted()); }

} // namespace

void must_be_heard(const Operator &link, bool to_command) {
    const std::string host = "--host " + link.address();
    if (link.other_key())
        throw log::FileError(host, 0, 0, "signs with another key than --key", "copy the rover's key file to this machine");
    if (link.counted() && !link.counts().keyed && (to_command || !link.heard()))
        throw log::FileError(host, 0, 0, "has no key: it tells, and obeys nobody",
                             "start its tractiond with --link-key FILE, or watch without --key");
    if (!enough(link, to_command))
        throw log::FileError(host, 0, 0, "no rover answers",
                             "tractiond --link ADDRESS --link-key FILE must run there, --system be its number, and UDP be let through");
}

void meet(Operator &link, bool to_command) {
    const double until_s = link.now_s() + first_words_s;
    while (!enough(link, to_command) && link.now_s() < until_s) link.listen(period_s);
    must_be_heard(link, to_command);
}

bool stop(Operator &link) {
    const double until_s = link.now_s() + stop_s;
    std::size_t before = link.statuses();
    bool done = false;
    do { // three at least: one may be lost
        link.send({.mode = MODE_STOP});
        link.listen(period_s);
        done = link.statuses() >= before + 3 && link.status().mode == MODE_STOP;
    } while (!done && link.now_s() < until_s);
    return done;
}

Drive drive_for(Operator &link, const Order &order, double seconds, const std::function<void()> &told,
                const std::function<bool()> &stopped) {
    Drive out;
    begin(link);
    if (ending(link.status().faults) != 0) {
        out.faults = link.status().faults;
        out.trouble = "the rover does not drive: " + fault_words(out.faults);
        out.stopped = stop(link);
        return out;
    }
    const double began_s = link.now_s();
    const LinkCounts before = link.counts();
    double sum = 0;
    std::size_t seen = link.statuses(), first = seen, summed = 0;
    while (link.now_s() - began_s < seconds && !stopped() && out.trouble.empty()) {
        link.send(order);
        link.listen(period_s);
        const double at_s = link.now_s() - began_s;
        if (link.silence_s() > status_age_s) {
            if (link.silence_s() > 1) out.trouble = "the rover is silent";
            continue;
        }
        if (link.statuses() == seen) continue;
        seen = link.statuses();
        const Status &now = link.status();
        out.faults |= now.faults;
        if (out.first_motion_s < 0 && now.in_command && now.mode == order.mode) out.first_motion_s = at_s;
        if (at_s > seconds / 2) {
            sum += now.speed_m_s;
            summed++;
        }
        if (ending(now.faults) != 0) out.trouble = "the rover has stopped: " + fault_words(now.faults);
        if (out.first_motion_s < 0 && at_s > 1)
            out.trouble =
                link.counts().refused_other > before.refused_other
                    ? "the rover refuses the command: out of its range (--parameters tells LINK_SPEED_MAX, LINK_YAW_MAX), or another drives"
                    : "the rover does not take the command: too late, or not believed";
        told();
    }
    out.seconds = link.now_s() - began_s;
    out.statuses = link.statuses() - first;
    out.mean_speed_m_s = summed > 0 ? sum / static_cast<double>(summed) : 0;
    out.stopped = stop(link);
    return out;
}

void watch(Operator &link, double seconds, double every_s, const std::function<void()> &told, const std::function<bool()> &stopped) {
    const double until_s = link.now_s() + seconds;
    for (double due_s = link.now_s(); link.now_s() < until_s && !stopped();) {
        link.listen(period_s);
        if (link.now_s() < due_s) continue;
        told();
        due_s += every_s;
    }
}

} // namespace traction::drive
