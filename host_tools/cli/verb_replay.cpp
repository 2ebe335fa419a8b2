// verb_replay.cpp - traction replay LOG: runs this build's control_step on a log's frames and compares the traces.
#include "rows.h"
#include "verbs.h"

#include "host_tools/replay/replay_log.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>
#include <utility>

namespace traction::cli {

namespace {

// With the samples that were kept apart (simulate --radar).
log::Log read_log(const std::string &path, const std::string &radar) {
    log::Log log = log::read_csv(path);
    if (radar.empty()) return log;
    const log::Log apart = log::read_csv(radar);
    const log::Signal *samples = apart.find("radar.adc_count");
    if (samples == nullptr)
        throw log::LogError(radar, 0, 0, "there is no column radar.adc_count", "give what `traction simulate --radar` wrote");
    if (log.find("radar.adc_count") != nullptr) throw log::LogError(path, 0, 0, "it has radar.adc_count itself", "leave --radar out");
    for (const char *key : {"scenario", "seed", "config_hash"}) {
        const auto ours = std::as_const(log).header.find(key), theirs = apart.header.find(key);
        if (ours != log.header.end() && theirs != apart.header.end() && ours->second != theirs->second)
            throw log::LogError(radar, 0, 0, std::string(key) + " is " + theirs->second + ", of the log " + ours->second,
                                "give the samples of the same run");
    }
    log.signals.push_back(*samples);
    return log;
}

void replay(const std::string &path, const std::string &radar, const std::string &frames, Outcome &outcome) {
    const log::Log log = read_log(path, radar);
    const std::vector<replay::LoggedTick> ticks = replay::logged_ticks(log);
    if (!frames.empty()) report::write_text(replay::frames_text(ticks), frames);
    const replay::Comparison comparison = replay::replay_log(log, ticks);
    outcome.json = {{"schema", "traction.replay/1"}, {"ticks", comparison.ticks}, {"differing", comparison.differing}};
    if (comparison.differing == 0) {
        std::printf("%zu ticks replayed: every trace equals the log's\n", comparison.ticks);
        return;
    }
    std::printf("%zu of %zu ticks differ; first at %.2f s: %s is %.9g in the log, %.9g now\n", comparison.differing, comparison.ticks,
                comparison.first_s, comparison.first_signal.c_str(), comparison.logged, comparison.replayed);
    outcome.json["first"] = {
        {"t_s", comparison.first_s}, {"signal", comparison.first_signal}, {"logged", comparison.logged}, {"replayed", comparison.replayed}};
    outcome.exit_code = exit_negative;
}

struct ReplayRequest {
    std::string log, radar, frames;
};

} // namespace

Verb verb_replay() {
    const auto request = std::make_shared<ReplayRequest>();
    return {.name = "replay",
            .summary = "run this build's firmware on a log's frames: are the traces the same?",
            .options = {log_row(request->log, "log with raw counts and commands (CSV)"),
                        {.name = "--radar",
                         .into = &request->radar,
                         .help = "the radar's samples, where the log has them not (simulate --radar)",
                         .value = "FILE",
                         .kind = Kind::log},
                        {.name = "--frames",
                         .into = &request->frames,
                         .help = "write the frames as text that tractiond --hal replay runs",
                         .value = "FILE",
                         .kind = Kind::output}},
            .run = [request](Outcome &outcome) { replay(request->log, request->radar, request->frames, outcome); }};
}

} // namespace traction::cli
