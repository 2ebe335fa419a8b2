// verb_replay.cpp - traction replay LOG: runs this build's control_step on a log's frames and compares the traces.
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

} // namespace

void add_replay(CLI::App &app, Outcome &outcome) {
    struct Request {
        std::string log, frames;
    };
    auto request = std::make_shared<Request>();
    CLI::App *verb = app.add_subcommand("replay", "run this build's firmware on a log's frames: are the traces the same?");
    verb->add_option("LOG", request->log, "log with raw counts and commands (CSV)")->required();
    verb->add_option("--frames", request->frames, "write the frames as text that tractiond --hal replay runs")->type_name("FILE");
    add_json_option(verb, outcome);
    verb->callback([request, &outcome] { replay(request->log, request->frames, outcome); });
}

} // namespace traction::cli
