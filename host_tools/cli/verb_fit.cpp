// verb_fit.cpp - traction fit: a model's parameters from a log, with intervals, whiteness and held-out error.
#include "rows.h"
#include "terminal.h"
#include "verbs.h"

#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/profile_result.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/session.h"
#include "host_tools/lab/validate.h"
#include "host_tools/report/report.h"
#include "host_tools/report/svg.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <tuple>

namespace traction::cli {

namespace {

void print_table(const char *title, const lab::Parameters &table) {
    for (const auto &[key, p] : table)
        if (std::isfinite(p.low))
            std::printf("%-8s %-24s %10.4g  [%.4g, %.4g]%s%s\n", title, key.c_str(), p.value, p.low, p.high, p.unit == "1" ? "" : " ",
                        p.unit == "1" ? "" : p.unit.c_str());
}

// Where a wheel's own tolerance took it elsewhere than the first.
void print_overrides(std::size_t wheel, const lab::Parameters &table, const lab::Parameters &first) {
    for (const auto &[key, p] : table)
        if (std::isfinite(p.low) && p.value != first.at(key).value)
            std::printf("wheel %-2zu %-24s %10.4g  [%.4g, %.4g]%s%s\n", wheel, key.c_str(), p.value, p.low, p.high,
                        p.unit == "1" ? "" : " ", p.unit == "1" ? "" : p.unit.c_str());
}

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

void print_profiles(const FitRequest &request, const lab::Session &session, Outcome &outcome) {
    const std::vector<lab::Profile> profiles = lab::profile_likelihood(session.model, session.data, request.profile);
    std::fputs(lab::profile_text(profiles).c_str(), stdout);
    outcome.json["profiles"] = lab::profile_json(profiles);
    if (!request.figure.empty()) report::write_text(report::to_svg(profile_figure(profiles)), request.figure);
}

void fit(const FitRequest &request, Outcome &outcome) {
    const lab::Session session = lab::open_session(request.input);
    lab::Model model = session.model;
    const lab::Problem fitted_at = lab::fitted_problem(model, session.data);
    const lab::LadderStep step = lab::store_fit(model, fitted_at, "fitted");
    print_table("rover", model.rover);
    print_table("wheel", model.wheel.front().geometry);
    print_table("motor", model.wheel.front().motor);
    print_table("soil", model.wheel.front().soil);
    for (std::size_t i = 1; i < model.wheel.size(); ++i) {
        print_overrides(i, model.wheel[i].geometry, model.wheel.front().geometry);
        print_overrides(i, model.wheel[i].motor, model.wheel.front().motor);
        print_overrides(i, model.wheel[i].soil, model.wheel.front().soil);
    }
    print_table("sensors", model.sensors);
    for (const lab::EffectUse &use : model.effects) print_table(use.name.c_str(), use.parameters);
    const lab::Comparison comparison = lab::compare(model, session.data, true);
    print(lab::comparison_text(comparison, request.details));
    for (const lab::BalanceComparison &b : comparison.balances) {
        if (b.acf.value.size() < 2 || !request.details) continue;
        int outside = 0;
        for (std::size_t i = 1; i < b.acf.value.size(); ++i) outside += std::fabs(b.acf.value[i]) > b.acf.band;
        std::printf("whiteness  %-28s %d of %zu lags outside the 99 %% band\n", b.name.c_str(), outside, b.acf.value.size() - 1);
    }
    const lab::Identifiability told = lab::identifiability(fitted_at);
    const std::vector<lab::Resonance> peaks = lab::resonances(fitted_at);
    const std::vector<lab::Limit> limits = lab::limits_of(fitted_at);
    std::fputs(lab::limits_text(limits).c_str(), stdout);
    std::fputs(lab::identifiability_text(told, peaks).c_str(), stdout);
    std::printf("error %.3f x noise in the fit, %.3f on what was not fitted (5 s blocks, each\npredicted by a refit to the others)\n",
                step.train, step.heldout);
    outcome.json = lab::head_json("fit", model, session.data);
    lab::put_comparison(outcome.json, comparison);
    outcome.json["ladder"] = lab::ladder_json({step});
    nlohmann::json fitted = nlohmann::json::object();
    const auto put = [&](const std::string &name, const lab::Parameters &table) {
        for (const auto &[key, p] : table)
            if (std::isfinite(p.low)) fitted[name + "." + key] = {{"value", p.value}, {"unit", p.unit}, {"low", p.low}, {"high", p.high}};
    };
    put("rover", model.rover), put("wheel", model.wheel.front().geometry), put("motor", model.wheel.front().motor);
    put("soil", model.wheel.front().soil), put("sensors", model.sensors);
    for (std::size_t i = 1; i < model.wheel.size(); ++i) {
        const std::string on = " on wheel " + std::to_string(i);
        for (const auto &[name, table, shared] : {std::tuple{"wheel.", &model.wheel[i].geometry, &model.wheel.front().geometry},
                                                  std::tuple{"motor.", &model.wheel[i].motor, &model.wheel.front().motor},
                                                  std::tuple{"soil.", &model.wheel[i].soil, &model.wheel.front().soil}})
            for (const auto &[key, p] : *table)
                if (std::isfinite(p.low) && p.value != shared->at(key).value)
                    fitted[name + key + on] = {{"value", p.value}, {"unit", p.unit}, {"low", p.low}, {"high", p.high}};
    }
    outcome.json["limits"] = lab::limits_json(limits);
    outcome.json["identifiability"] = lab::identifiability_json(told, peaks);
    outcome.json["fitted"] = fitted;
    const std::vector<lab::Validation> validation = lab::validate(session, request.input, model);
    std::fputs(lab::validation_text(validation).c_str(), stdout);
    outcome.json["validation"] = lab::validation_json(validation);
    if (request.profiled) print_profiles(request, session, outcome);
    if (!request.report.empty()) report::write_html(outcome.json, request.report);
    if (request.out.empty()) return;
    lab::append_lineage(model, session.data, {{"fitted", step.train, step.heldout, step.floor}}, step);
    lab::write_model(model, request.out);
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
