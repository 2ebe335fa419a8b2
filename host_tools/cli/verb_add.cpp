// verb_add.cpp - traction add EFFECT: a new model file with that effect, fitted; the old file is untouched.
#include "verbs.h"

#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/session.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace traction::cli {

namespace {

struct AddRequest {
    lab::Request input;
    std::string effect, from_file, out, report;
    int wheel = -1;
};

void add_effect(const AddRequest &request, Outcome &outcome) {
    const lab::Session session = lab::open_session(request.input);
    if (std::filesystem::exists(request.out) && std::filesystem::equivalent(request.out, request.input.model))
        throw lab::ModelError(request.out, 0, "--out", "is the model that is read", "give another name: the old model stays as it is");
    const lab::Added added = lab::add_effect(session.model, session.data, request.effect, request.wheel, request.from_file);
    lab::write_model(added.model, request.out);
    std::fputs(lab::added_text(added).c_str(), stdout);
    std::printf("wrote %s\n", request.out.c_str());
    outcome.json = lab::head_json("add", added.model, session.data);
    lab::put_comparison(outcome.json, lab::compare(added.model, session.data, true));
    outcome.json["ladder"] = lab::ladder_json(added.ladder);
    outcome.json["verdict"] = {{"kind", added.helps ? "named" : "nothing"}, {"effects", {request.effect}}, {"text", added.text}};
    if (!request.report.empty()) report::write_html(outcome.json, request.report);
    if (!added.helps) outcome.exit_code = exit_negative;
}

} // namespace

void add_add(CLI::App &app, Outcome &outcome) {
    CLI::App *verb = app.add_subcommand("add", "add an effect to a model, fit it, write a new model file");
    auto request = std::make_shared<AddRequest>();
    verb->add_option("effect", request->effect, "name from `traction effects`, or of an [[effect]] in --effect-file")->required();
    verb->add_option("--model", request->input.model, "model file (TOML)")->required()->type_name("FILE");
    verb->add_option("--log", request->input.log, "log (CSV)")->required()->type_name("FILE");
    verb->add_option("--out", request->out, "the new model file")->required()->type_name("FILE");
    verb->add_option("--wheel", request->wheel, "only this wheel");
    verb->add_option("--effect-file", request->from_file, "TOML with an [[effect]] of your own")->type_name("FILE");
    verb->add_option("--map", request->input.map, "map for a foreign CSV (TOML)")->type_name("FILE");
    verb->add_option("--repeat", request->input.repeat, "a second run of the same drive")->type_name("FILE");
    verb->add_option("--from", request->input.from_s, "use the log from this time [s]");
    verb->add_option("--to", request->input.to_s, "use the log up to this time [s]");
    verb->add_option("--report", request->report, "write a report page (HTML)")->type_name("FILE");
    add_json_option(verb, outcome);
    verb->callback([=, &outcome] { add_effect(*request, outcome); });
}

} // namespace traction::cli
