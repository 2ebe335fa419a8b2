// verb_next.cpp - traction next: the drive that answers what a log left open, with the predicted d' of every question.
#include "rows.h"
#include "terminal.h"
#include "trial.h"
#include "verbs.h"

#include "host_tools/lab/result/next_result.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/session.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>
#include <optional>

namespace traction::cli {

namespace {

struct NextRequest {
    lab::Request input;
    std::string out;
    std::vector<std::string> effects;
    bool all = false, details = false;
};

void next(const NextRequest &request, Outcome &outcome) {
    if (request.input.log.empty() && request.effects.empty()) throw UsageError("give --log LOG, or --effects NAME..., or both");
    for (const std::string &name : request.effects) need_effect("--effects", name, ":");
    std::optional<lab::Session> session;
    if (!request.input.log.empty()) session = lab::open_session(request.input);
    lab::NextExperiment answer;
    if (request.effects.empty()) {
        answer = lab::next_experiment(lab::diagnose(session->model, session->data, {}), session->model, session->data, request.all,
                                      simulated_rover());
    } else {
        const lab::Model model = session ? session->model : lab::read_model(request.input.model);
        answer = lab::next_experiment(request.effects, model, session ? &session->data : nullptr, simulated_rover());
    }
    if (session)
        outcome.json = lab::head_json("next", session->model, session->data);
    else
        outcome.json = {{"schema", "traction.lab/1"}, {"verb", "next"}};
    outcome.json["next"] = lab::next_json(answer);
    print(lab::next_text(answer, request.details));
    bool stuck = false;
    for (const lab::Question &q : answer.questions) stuck = stuck || q.status == "never";
    if (answer.scenario_toml.empty()) {
        if (!request.out.empty()) std::printf("%s is not written: there is no drive to write\n", request.out.c_str());
        if (stuck || (!answer.questions.empty() && !answer.predicted)) outcome.exit_code = exit_negative;
        return;
    }
    if (request.out.empty())
        std::fputs(("\n" + answer.scenario_toml).c_str(), stdout);
    else
        report::write_text(answer.scenario_toml, request.out);
}

} // namespace

Verb verb_next() {
    const auto request = std::make_shared<NextRequest>();
    return {
        .name = "next",
        .summary = "the drive that answers what a log left open, by predicted difference",
        .options =
            {log_row(request->input.log, "log (CSV) that was not enough", false),
             model_row(request->input.model),
             {.name = "--map",
              .into = &request->input.map,
              .help = "map for a foreign CSV (TOML)",
              .value = "FILE",
              .kind = Kind::input,
              .needs = {"--log"}},
             despite_row(request->input.despite),
             {.name = "--effects",
              .into = &request->effects,
              .help = "tell these apart (or, one alone: show it), instead of what a diagnosis leaves open; NAME or NAME:WHEEL",
              .value = "NAME...",
              .kind = Kind::effect},
             {.name = "--all",
              .into = &request->all,
              .help = "also ask for every effect that the log could not have shown, beside classes",
              .needs = {"--log"},
              .excludes = {"--effects"}},
             details_row(request->details),
             {.name = "--out", .into = &request->out, .help = "write the scenario to this file", .value = "FILE", .kind = Kind::output}},
        .run = [request](Outcome &outcome) { next(*request, outcome); }};
}

} // namespace traction::cli
