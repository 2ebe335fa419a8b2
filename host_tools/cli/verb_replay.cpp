// verb_replay.cpp - traction replay LOG: runs this build's control_step on a log's frames and compares the traces.
#include "rows.h"
#include "verbs.h"

#include "host_tools/replay/replay_log.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

void replay(const std::string &path, const std::string &frames, Outcome &outcome) {
    const log::Log log = log::read_csv(path);
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
    std::string log, frames;
};

} // namespace

Verb verb_replay() {
    const auto request = std::make_shared<ReplayRequest>();
    return {.name = "replay",
            .summary = "run this build's firmware on a log's frames: are the traces the same?",
            .options = {log_row(request->log, "log with raw counts and commands (CSV)"),
                        {.name = "--frames",
                         .into = &request->frames,
                         .help = "write the frames as text that tractiond --hal replay runs",
                         .value = "FILE",
                         .kind = Kind::output}},
            .run = [request](Outcome &outcome) { replay(request->log, request->frames, outcome); }};
}

} // namespace traction::cli
