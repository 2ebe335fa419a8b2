// verb_diagnose.cpp - traction diagnose: which physics the model lacks, how sure that is, and what this log cannot say.
#include "progress.h"
#include "rows.h"
#include "terminal.h"
#include "trial.h"
#include "verbs.h"

#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/next_result.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/result/story.h"
#include "host_tools/lab/session.h"
#include "host_tools/lab/validate.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>
#include <optional>

namespace traction::cli {

namespace {

struct DiagnoseRequest {
    lab::Request input;
    std::string report, out;
    bool apply = false, details = false;
};

void diagnose(const DiagnoseRequest &request, Outcome &outcome) {
    const lab::Session session = lab::open_session(request.input);
    lab::DiagnoseOptions options;
    Progress progress("diagnose", 500);
    options.progress = [&](int, int) { progress.step(); };
    lab::Diagnosis diagnosis = lab::diagnose(session.model, session.data, options);
    lab::Comparison comparison = lab::compare(session.model, session.data, false);
    if (!diagnosis.accepted.empty()) lab::show_after(comparison, diagnosis.model, session.data);
    std::optional<lab::NextExperiment> next; // what was not excited alone: `traction next --all`
    if (!diagnosis.classes.empty()) next = lab::next_experiment(diagnosis, session.model, session.data, false, simulated_rover());
    const lab::Story story = lab::tell(comparison, diagnosis, next ? &*next : nullptr);
    print(lab::story_text(story) + "\n" + lab::diagnosis_text(diagnosis, request.details));
    outcome.json = lab::head_json("diagnose", session.model, session.data);
    lab::put_comparison(outcome.json, comparison);
    lab::put_diagnosis(outcome.json, diagnosis);
    outcome.json["story"] = lab::story_json(story);
    outcome.json["next"] = nullptr;
    if (next) {
        print("\n" + lab::next_text(*next, request.details));
        if (!next->scenario_toml.empty()) print("(traction next --model MODEL --log LOG --out next.toml writes the scenario)\n");
        outcome.json["next"] = lab::next_json(*next);
    }
    if (diagnosis.kind != "wrong_model") {
        const std::vector<lab::Validation> validation = lab::validate(session, request.input, diagnosis.model);
        std::fputs(lab::validation_text(validation).c_str(), stdout);
        outcome.json["validation"] = lab::validation_json(validation);
    }
    if (!request.report.empty()) report::write_html(outcome.json, request.report);
    if (diagnosis.kind == "nothing") outcome.exit_code = exit_negative;
    if (diagnosis.kind == "wrong_model") outcome.exit_code = exit_bad_input;
    if (!request.apply) return;
    if (diagnosis.accepted.empty()) {
        std::printf("nothing to add: no model is written\n");
        if (diagnosis.kind != "wrong_model") outcome.exit_code = exit_negative;
        return;
    }
    lab::Model model = diagnosis.model;
    const lab::LadderStep step = lab::fit_model(model, session.data, "fitted");
    lab::append_lineage(model, session.data, diagnosis.ladder, step);
    lab::write_model(model, request.out);
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
