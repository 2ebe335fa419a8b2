// verb_diagnose.cpp - traction diagnose: which physics the model lacks, how sure that is, and what this log cannot say.
#include "progress.h"
#include "trial.h"
#include "verbs.h"

#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/next_result.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/session.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct DiagnoseRequest {
    lab::Request input;
    std::string report, out;
    bool apply = false;
};

void diagnose(const DiagnoseRequest &request, Outcome &outcome) {
    const lab::Session session = lab::open_session(request.input);
    lab::DiagnoseOptions options;
    Progress progress("diagnose", 400);
    options.progress = [&](int, int) { progress.step(); };
    lab::Diagnosis diagnosis = lab::diagnose(session.model, session.data, options);
    std::fputs(lab::diagnosis_text(diagnosis).c_str(), stdout);
    outcome.json = lab::head_json("diagnose", session.model, session.data);
    lab::put_comparison(outcome.json, lab::compare(session.model, session.data, false));
    lab::put_diagnosis(outcome.json, diagnosis);
    outcome.json["next"] = nullptr;
    if (!diagnosis.classes.empty()) { // what was not excited alone: `traction next --log`
        const lab::NextExperiment next = lab::next_experiment(diagnosis, session.model, session.data, false, simulated_rover());
        std::printf("\n%s", lab::next_text(next).c_str());
        if (!next.scenario_toml.empty()) std::printf("(traction next --model MODEL --log LOG --out next.toml writes the scenario)\n");
        outcome.json["next"] = lab::next_json(next);
    }
    if (!request.report.empty()) report::write_html(outcome.json, request.report);
    if (!request.apply) return;
    if (diagnosis.accepted.empty()) {
        std::printf("nothing to add: no model is written\n");
        outcome.exit_code = exit_negative;
        return;
    }
    lab::Model model = diagnosis.model;
    const lab::LadderStep step = lab::fit_model(model, session.data, "fitted");
    lab::append_lineage(model, session.data, diagnosis.ladder, step);
    lab::write_model(model, request.out);
    std::printf("wrote %s\n", request.out.c_str());
}

} // namespace

void add_diagnose(CLI::App &app, Outcome &outcome) {
    CLI::App *verb = app.add_subcommand("diagnose", "which physics the model lacks, by held-out error");
    auto request = std::make_shared<DiagnoseRequest>();
    verb->add_option("--model", request->input.model, "model file (TOML)")->required()->type_name("FILE");
    verb->add_option("--log", request->input.log, "log (CSV)")->required()->type_name("FILE");
    verb->add_option("--map", request->input.map, "map for a foreign CSV (TOML)")->type_name("FILE");
    verb->add_option("--repeat", request->input.repeat, "a second run of the same drive: its difference is the noise")->type_name("FILE");
    verb->add_option("--from", request->input.from_s, "use the log from this time [s]");
    verb->add_option("--to", request->input.to_s, "use the log up to this time [s]");
    verb->add_option("--report", request->report, "write a report page (HTML)")->type_name("FILE");
    CLI::Option *apply = verb->add_flag("--apply", request->apply, "add what was named, refit, and write the new model to --out");
    CLI::Option *out = verb->add_option("--out", request->out, "the new model file")->type_name("FILE");
    apply->needs(out);
    out->needs(apply);
    add_json_option(verb, outcome);
    verb->callback([=, &outcome] { diagnose(*request, outcome); });
}

} // namespace traction::cli
