#include "answer.h"

#include "between_runs.h"
#include "validate.h"

#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/append.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/next_result.h"
#include "host_tools/lab/result/profile_result.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/result/story.h"

#include <cmath>
#include <limits>

namespace traction::lab {

namespace {

const std::string of_no_run =
    "no run that was left out is predicted better by what was named: it may stand for what the runs do not share, "
    "such as their grounds ([[run]] in the model file); traction fit tells which numbers differ between them";

std::vector<Validation> put_validation(Answer &answer, const Session &session, const Request &request, const Model &result) {
    std::vector<Validation> validation = validate(session, request, result);
    answer.text += validation_text(validation);
    answer.json["validation"] = validation_json(validation);
    return validation;
}

void append_table(std::string &text, const char *title, const Parameters &table) {
    for (const auto &[key, p] : table)
        if (std::isfinite(p.low))
            append(text, "%-8s %-24s %10.4g  [%.4g, %.4g]%s%s\n", title, key.c_str(), p.value, p.low, p.high, p.unit == "1" ? "" : " ",
                   p.unit == "1" ? "" : p.unit.c_str());
}

// Where a wheel's own tolerance took it elsewhere than the first.
void append_overrides(std::string &text, std::size_t wheel, const Parameters &table, const Parameters &first) {
    for (const auto &[key, p] : table)
        if (std::isfinite(p.low) && p.value != first.at(key).value)
            append(text, "wheel %-2zu %-24s %10.4g  [%.4g, %.4g]%s%s\n", wheel, key.c_str(), p.value, p.low, p.high,
                   p.unit == "1" ? "" : " ", p.unit == "1" ? "" : p.unit.c_str());
}

void append_parameters(std::string &text, const Model &model) {
    append_table(text, "rover", model.rover);
    append_table(text, "wheel", model.wheel.front().geometry);
    append_table(text, "motor", model.wheel.front().motor);
    append_table(text, "soil", model.wheel.front().soil);
    for (std::size_t i = 1; i < model.wheel.size(); ++i) {
        append_overrides(text, i, model.wheel[i].geometry, model.wheel.front().geometry);
        append_overrides(text, i, model.wheel[i].motor, model.wheel.front().motor);
        append_overrides(text, i, model.wheel[i].soil, model.wheel.front().soil);
    }
    append_table(text, "sensors", model.sensors);
    for (const RunSpec &run : model.runs)
        for (const Parameters *table : {&run.soil, &run.sensors})
            for (const auto &[key, p] : *table)
                if (std::isfinite(p.low))
                    append(text, "%-8s %-24s %10.4g  [%.4g, %.4g]%s%s in %s\n", table == &run.soil ? "soil" : "sensors", key.c_str(),
                           p.value, p.low, p.high, p.unit == "1" ? "" : " ", p.unit == "1" ? "" : p.unit.c_str(), run.log.c_str());
    for (const EffectUse &use : model.effects) append_table(text, use.name.c_str(), use.parameters);
}

nlohmann::json fitted_json(const Model &model) {
    nlohmann::json fitted = nlohmann::json::object();
    for (const auto &[name, p, of_run] : fitted_values(model))
        fitted[name] = {{"value", p.value}, {"unit", p.unit}, {"low", p.low}, {"high", p.high}};
    return fitted;
}

void append_whiteness(std::string &text, const Comparison &comparison) {
    for (const BalanceComparison &b : comparison.balances) {
        if (b.acf.value.size() < 2) continue;
        int outside = 0;
        for (std::size_t i = 1; i < b.acf.value.size(); ++i) outside += std::fabs(b.acf.value[i]) > b.acf.band;
        append(text, "whiteness  %-28s %d of %zu lags outside the 99 %% band\n", b.name.c_str(), outside, b.acf.value.size() - 1);
    }
}

// A ground that changes with the time of a joined log may be two grounds.
void tell_of_grounds(Diagnosis &diagnosis, const Session &session) {
    if (session.runs.size() < 2 || !diagnosis.unknown || diagnosis.unknown->variable != axis_name(Axis::time)) return;
    const std::string &target = diagnosis.unknown->target;
    if (target != target_name(TermTarget::soil_strength) && target != target_name(TermTarget::rolling)) return;
    diagnosis.messages.push_back(
        "the ground seems to change with time, over several runs: if they were driven on different grounds, state each "
        "run's in the model file ([[run]], docs/model_format.md); traction fit tells which numbers differ");
}

} // namespace

Answer compare_answer(const Session &session, bool fitted, bool details) {
    const Comparison comparison = compare(session.model, session.data, !fitted);
    Answer answer;
    answer.text = comparison_text(comparison, details);
    answer.json = head_json("compare", session.model, session.data);
    put_comparison(answer.json, comparison);
    answer.json["story"] = story_json(tell(comparison));
    answer.negative = comparison.balances.empty();
    return answer;
}

Answer diagnose_answer(const Session &opened, const Request &request, const AnswerOptions &options, bool apply) {
    DiagnoseOptions how;
    how.progress = options.progress;
    Diagnosed diagnosed = diagnose_session(opened, how);
    const Session &session = diagnosed.anew ? *diagnosed.anew : opened;
    Diagnosis diagnosis = std::move(diagnosed.diagnosis);
    Answer answer;
    Comparison comparison = compare(session.model, session.data, false, diagnosis.stated_fit.get());
    if (!diagnosis.accepted.empty()) show_after(comparison, diagnosis.model, session.data, diagnosis.model_fit.get());
    std::optional<NextExperiment> next; // what was not excited alone: `traction next --all`
    if (!diagnosis.classes.empty() && options.drive) next = next_experiment(diagnosis, session.model, session.data, false, options.drive);
    tell_of_grounds(diagnosis, session);
    const Story story = tell(comparison, diagnosis, next ? &*next : nullptr);
    answer.kind = diagnosis.kind;
    answer.text = story_text(story) + "\n" + diagnosis_text(diagnosis, options.details);
    answer.json = head_json("diagnose", session.model, session.data);
    put_comparison(answer.json, comparison);
    put_diagnosis(answer.json, diagnosis);
    answer.json["story"] = story_json(story);
    answer.json["next"] = nullptr;
    if (next) {
        answer.text += "\n" + next_text(*next, options.details);
        if (!next->scenario_toml.empty()) answer.text += "(traction next --model MODEL --log LOG --out next.toml writes the scenario)\n";
        answer.json["next"] = next_json(*next);
    }
    if (diagnosis.kind != "wrong_model") {
        const std::vector<Validation> validation = put_validation(answer, session, request, diagnosis.model);
        if (!diagnosis.accepted.empty() && predicts_no_run(validation)) {
            answer.text += messages_text({of_no_run});
            answer.json["messages"].push_back(of_no_run);
        }
    }
    answer.negative = diagnosis.kind == "nothing";
    if (!apply || diagnosis.accepted.empty()) return answer;
    answer.model = diagnosis.model;
    const LadderStep step =
        diagnosis.model_fit ? store_fit(*answer.model, *diagnosis.model_fit, "fitted") : fit_model(*answer.model, session.data, "fitted");
    append_lineage(*answer.model, session.data, diagnosis.ladder, step);
    return answer;
}

Answer add_answer(const Session &opened, const Request &request, const std::string &effect, int wheel, const std::string &effect_file) {
    Added added = add_effect(opened.model, opened.data, effect, wheel, effect_file);
    const std::optional<Session> anew = asked_anew(opened, added.model);
    const Session &session = anew ? *anew : opened;
    if (anew) added = add_effect(session.model, session.data, effect, wheel, effect_file);
    Answer answer;
    answer.kind = added.helps ? "named" : "nothing";
    answer.model = added.model;
    answer.text = added_text(added);
    answer.json = head_json("add", added.model, session.data);
    put_comparison(answer.json, compare(added.model, session.data, true));
    answer.json["ladder"] = ladder_json(added.ladder);
    answer.json["limits"] = limits_json(added.limits);
    answer.json["verdict"] = {{"kind", answer.kind}, {"effects", {effect}}, {"text", added.text}};
    put_validation(answer, session, request, added.model);
    answer.negative = !added.helps;
    return answer;
}

FitAnswer fit_answer(const Session &session, const Request &request, bool keep, const std::optional<std::vector<std::string>> &profile,
                     bool details) {
    Model model = session.model;
    FitAnswer answer;
    const Problem fitted_at = fitted_problem(model, session.data);
    const LadderStep step = store_fit(model, fitted_at, "fitted");
    append_parameters(answer.text, model);
    const Comparison comparison = compare(model, session.data, true);
    answer.text += comparison_text(comparison, details);
    if (details) append_whiteness(answer.text, comparison);
    const Identifiability told = identifiability(fitted_at);
    const std::vector<Resonance> peaks = resonances(fitted_at);
    const std::vector<Limit> limits = limits_of(fitted_at);
    answer.text += limits_text(limits) + identifiability_text(told, peaks);
    append(answer.text,
           "error %.3f x noise in the fit, %.3f on what was not fitted (5 s blocks, each\npredicted by a refit to the others)\n",
           step.train, step.heldout);
    answer.json = head_json("fit", model, session.data);
    put_comparison(answer.json, comparison);
    answer.json["ladder"] = ladder_json({step});
    answer.json["limits"] = limits_json(limits);
    answer.json["identifiability"] = identifiability_json(told, peaks);
    answer.json["fitted"] = fitted_json(model);
    const std::vector<BetweenRuns> apart = between_runs(session);
    answer.text += between_runs_text(apart);
    answer.json["between_runs"] = between_runs_json(apart);
    put_validation(answer, session, request, model);
    if (profile) {
        answer.profiles = profile_likelihood(session.model, session.data, *profile);
        answer.text += profile_text(answer.profiles);
        answer.json["profiles"] = profile_json(answer.profiles);
    }
    if (keep) append_lineage(model, session.data, {{"fitted", step.train, step.heldout, step.floor}}, step);
    answer.model = model;
    return answer;
}

NextAnswer next_answer(const Session *session, const Model &model, const std::vector<std::string> &effects, bool all,
                       const AnswerOptions &options) {
    NextAnswer answer;
    NextExperiment next;
    Diagnosed diagnosed;
    if (effects.empty() && session == nullptr)
        throw ModelError(model.file, 0, "effects", "are not given, and there is no log either", "give a log, or effects, or both");
    if (effects.empty()) {
        DiagnoseOptions how;
        how.progress = options.progress;
        diagnosed = diagnose_session(*session, how);
        if (diagnosed.anew) session = &*diagnosed.anew;
        next = next_experiment(diagnosed.diagnosis, session->model, session->data, all, options.drive);
    } else {
        next = next_experiment(effects, model, session != nullptr ? &session->data : nullptr, options.drive);
    }
    answer.json = session != nullptr ? head_json("next", session->model, session->data)
                                     : nlohmann::json{{"schema", "traction.lab/1"}, {"verb", "next"}};
    answer.json["next"] = next_json(next);
    answer.text = next_text(next, options.details);
    answer.scenario = next.scenario_toml;
    bool stuck = false;
    for (const Question &q : next.questions) stuck = stuck || q.status == "never";
    answer.negative = next.scenario_toml.empty() && (stuck || (!next.questions.empty() && !next.predicted));
    return answer;
}

Model without_effect(Model model, const std::string &effect, int wheel, std::size_t &dropped) {
    dropped = std::erase_if(model.effects, [&](const EffectUse &use) { return use.name == effect && (wheel < -1 || use.wheel == wheel); });
    if (dropped == 0)
        throw ModelError(model.file, 0, "effect", "there is no \"" + effect + "\" in it", "`traction history` lists what the model has");
    model.lineage.push_back({"- " + effect, "", "", {}, {}, {}});
    model.lineage.back().train = model.lineage.back().heldout = model.lineage.back().floor = std::numeric_limits<double>::quiet_NaN();
    return model;
}

} // namespace traction::lab
