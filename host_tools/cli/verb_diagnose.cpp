// verb_diagnose.cpp - traction diagnose: which physics the model lacks, how sure that is, and what this log cannot say.
#include "drive_view.h"
#include "progress.h"
#include "rows.h"
#include "terminal.h"
#include "verbs.h"

#include "host_tools/lab/answer.h"
#include "host_tools/report/report.h"
#include "host_tools/simulate/trial.h"

#include <cstdio>
#include <memory>
#include <utility>

namespace traction::cli {

namespace {

struct DiagnoseRequest {
    lab::Request input;
    std::string report, out;
    bool apply = false, details = false;
};

void diagnose(const DiagnoseRequest &request, Outcome &outcome) {
    const lab::Session session = lab::open_session(request.input);
    Progress progress("diagnose", 500);
    lab::Answer answer = lab::diagnose_answer(
        session, request.input, {.progress = [&](int, int) { progress.step(); }, .drive = simulated_rover(), .details = request.details},
        request.apply);
    print(answer.text);
    outcome.json = std::move(answer.json);
    if (!request.report.empty()) report::write_html(with_replay(outcome.json, session), request.report);
    if (answer.kind == "nothing") outcome.exit_code = exit_negative;
    if (answer.kind == "wrong_model") outcome.exit_code = exit_bad_input;
    if (!request.apply) return;
    if (!answer.model) {
        std::printf("nothing to add: no model is written\n");
        if (answer.kind != "wrong_model") outcome.exit_code = exit_negative;
        return;
    }
    lab::write_model(*answer.model, request.out);
    std::printf("wrote %s\n", request.out.c_str());
}

} // namespace

Verb verb_diagnose() {
    const auto request = std::make_shared<DiagnoseRequest>();
    return {.name = "diagnose",
            .summary = "which physics the model lacks, by held-out error",
            .options = rows(lab_rows(request->input), {report_row(request->report),
                                                       details_row(request->details),
                                                       validate_row(request->input.validate),
                                                       {.name = "--apply",
                                                        .into = &request->apply,
                                                        .help = "add what was named, refit, and write the new model to --out",
                                                        .needs = {"--out"}},
                                                       {.name = "--out",
                                                        .into = &request->out,
                                                        .help = "the new model file",
                                                        .value = "FILE",
                                                        .kind = Kind::output,
                                                        .needs = {"--apply"}}}),
            .run = [request](Outcome &outcome) { diagnose(*request, outcome); }};
}

} // namespace traction::cli
