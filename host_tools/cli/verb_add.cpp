// verb_add.cpp - traction add EFFECT: a new model file with that effect, fitted; the old file is untouched.
#include "drive_view.h"
#include "rows.h"
#include "verbs.h"

#include "host_tools/lab/answer.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>
#include <utility>

namespace traction::cli {

namespace {

struct AddRequest {
    lab::Request input;
    std::string effect, from_file, out, report;
    int wheel = -1;
};

void add_effect(const AddRequest &request, Outcome &outcome) {
    if (request.from_file.empty()) need_effect("EFFECT", request.effect, ":");
    const lab::Session session = lab::open_session(request.input);
    lab::Answer answer = lab::add_answer(session, request.input, request.effect, request.wheel, request.from_file);
    lab::write_model(*answer.model, request.out);
    std::fputs(answer.text.c_str(), stdout);
    std::printf("wrote %s\n", request.out.c_str());
    outcome.json = std::move(answer.json);
    if (!request.report.empty()) report::write_html(with_replay(outcome.json, session), request.report);
    if (answer.negative) outcome.exit_code = exit_negative;
}

} // namespace

Verb verb_add() {
    const auto request = std::make_shared<AddRequest>();
    return {.name = "add",
            .summary = "add an effect to a model, fit it, write a new model file",
            .options = rows({{.argument = "EFFECT",
                              .into = &request->effect,
                              .help = "name from `traction effects`, or of an [[effect]] in --effect-file",
                              .kind = Kind::effect,
                              .required = true}},
                            rows(lab_rows(request->input), {{.name = "--out",
                                                             .into = &request->out,
                                                             .help = "the new model file",
                                                             .value = "FILE",
                                                             .kind = Kind::output,
                                                             .required = true},
                                                            {.name = "--wheel", .into = &request->wheel, .help = "only this wheel"},
                                                            {.name = "--effect-file",
                                                             .into = &request->from_file,
                                                             .help = "TOML with an [[effect]] of your own",
                                                             .value = "FILE",
                                                             .kind = Kind::input},
                                                            validate_row(request->input.validate),
                                                            report_row(request->report)})),
            .run = [request](Outcome &outcome) { add_effect(*request, outcome); }};
}

} // namespace traction::cli
