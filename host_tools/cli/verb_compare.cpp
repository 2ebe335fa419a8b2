// verb_compare.cpp - traction compare: how far a model is from a log, balance by balance.
#include "drive_view.h"
#include "rows.h"
#include "terminal.h"
#include "verbs.h"

#include "host_tools/lab/answer.h"
#include "host_tools/report/report.h"

#include <cstdio>
#include <memory>
#include <utility>

namespace traction::cli {

namespace {

struct CompareRequest {
    lab::Request input;
    std::string report;
    bool fitted = false, details = false;
};

void compare(const CompareRequest &request, Outcome &outcome) {
    const lab::Session session = lab::open_session(request.input);
    lab::Answer answer = lab::compare_answer(session, request.fitted, request.details);
    print(answer.text);
    outcome.json = std::move(answer.json);
    if (!request.report.empty()) report::write_html(with_replay(outcome.json, session), request.report);
    if (answer.negative) outcome.exit_code = exit_negative;
}

} // namespace

Verb verb_compare() {
    const auto request = std::make_shared<CompareRequest>();
    return {.name = "compare",
            .summary = "how far a model is from a log, and where it is worst",
            .options = rows(
                lab_rows(request->input),
                {{.name = "--fitted", .into = &request->fitted, .help = "show the residual after the parameters moved within their priors"},
                 details_row(request->details),
                 report_row(request->report)}),
            .run = [request](Outcome &outcome) { compare(*request, outcome); }};
}

} // namespace traction::cli
