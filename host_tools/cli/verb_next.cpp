// verb_next.cpp - traction next: the drive that answers what a log left open, with the predicted d' of every question.
#include "rows.h"
#include "terminal.h"
#include "verbs.h"

#include "host_tools/lab/answer.h"
#include "host_tools/report/report.h"
#include "host_tools/simulate/trial.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

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
    const lab::Model model = session ? session->model : lab::read_model(request.input.model);
    lab::NextAnswer answer = lab::next_answer(session ? &*session : nullptr, model, request.effects, request.all,
                                              {.progress = {}, .drive = simulated_rover(), .details = request.details});
    outcome.json = std::move(answer.json);
    print(answer.text);
    if (answer.negative) outcome.exit_code = exit_negative;
    if (answer.scenario.empty()) {
        if (!request.out.empty()) std::printf("%s is not written: there is no drive to write\n", request.out.c_str());
        return;
    }
    if (request.out.empty())
        std::fputs(("\n" + answer.scenario).c_str(), stdout);
    else
        report::write_text(answer.scenario, request.out);
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
