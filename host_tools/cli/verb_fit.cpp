// verb_fit.cpp - traction fit: a model's parameters from a log, with intervals, whiteness and held-out error.
#include "drive_view.h"
#include "rows.h"
#include "terminal.h"
#include "verbs.h"

#include "host_tools/lab/answer.h"
#include "host_tools/report/report.h"
#include "host_tools/report/svg.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

namespace traction::cli {

namespace {

struct FitRequest {
    lab::Request input;
    std::string out, report, figure;
    bool profiled = false, details = false;
    std::vector<std::string> profile;
};

// One panel per parameter, over the parameter in its unit.
report::Figure profile_figure(const std::vector<lab::Profile> &profiles) {
    report::Figure figure{.title = "Profile likelihood: how much worse the fit becomes"};
    for (const lab::Profile &p : profiles) {
        report::Series curve{.name = "profile", .x = p.x, .y = p.rise}, parabola{.name = "Wald", .x = {}, .y = {}};
        for (const double x : p.x) {
            const double z = (x - p.value) / p.standard_error;
            if (std::fabs(z) < 3) parabola.x.push_back(x), parabola.y.push_back(z * z);
        }
        figure.panels.push_back({.title = p.parameter + ": " + p.verdict,
                                 .y_label = "rise [1]",
                                 .x_label = p.parameter + " [" + (p.unit.empty() ? "1" : p.unit) + "]",
                                 .series = {curve, parabola},
                                 .rules = {{.value = 3.84, .name = "95 %"}, {.value = p.value, .name = "best", .vertical = true}},
                                 .from_zero = true});
    }
    return figure;
}

void fit(const FitRequest &request, Outcome &outcome) {
    const lab::Session session = lab::open_session(request.input);
    lab::FitAnswer answer = lab::fit_answer(session, request.input, !request.out.empty(),
                                            request.profiled ? std::optional(request.profile) : std::nullopt, request.details);
    print(answer.text);
    outcome.json = std::move(answer.json);
    if (!request.figure.empty()) report::write_text(report::to_svg(profile_figure(answer.profiles)), request.figure);
    if (!request.report.empty()) report::write_html(with_replay(outcome.json, session), request.report);
    if (request.out.empty()) return;
    lab::write_model(*answer.model, request.out);
    std::printf("wrote %s\n", request.out.c_str());
}

} // namespace

Verb verb_fit() {
    const auto request = std::make_shared<FitRequest>();
    return {
        .name = "fit",
        .summary = "fit a model's parameters to a log, with intervals",
        .options = rows(
            lab_rows(request->input),
            {{.name = "--out", .into = &request->out, .help = "write the fitted model to this file", .value = "FILE", .kind = Kind::output},
             report_row(request->report),
             details_row(request->details),
             validate_row(request->input.validate),
             {.name = "--profile",
              .into = &request->profile,
              .help = "profile likelihood of these, such as motor.resistance_ohm; of every effect's strength when none is named",
              .value = "PARAM...",
              .at_most = 100,
              .given = &request->profiled},
             {.name = "--profile-figure",
              .into = &request->figure,
              .help = "draw the profiles (SVG)",
              .value = "FILE",
              .kind = Kind::output,
              .needs = {"--profile"}}}),
        .run = [request](Outcome &outcome) { fit(*request, outcome); }};
}

} // namespace traction::cli
