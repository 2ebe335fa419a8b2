#include "result.h"

#include "append.h"
#include "series.h"
#include "words.h"

#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traction::lab {

using nlohmann::json;

namespace {

json finite(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json series(const std::vector<double> &values) {
    json out = json::array();
    for (const double value : values) out.push_back(finite(value));
    return out;
}

json effect_json(const EffectUse &use) {
    json parameters = json::object();
    for (const auto &[key, p] : use.parameters)
        parameters[key] = {{"value", finite(p.value)}, {"unit", p.unit}, {"low", finite(p.low)}, {"high", finite(p.high)}};
    json out = {{"name", use.name}, {"parameters", parameters}};
    if (use.wheel >= 0) out["wheel"] = use.wheel;
    if (!use.expression.empty()) out["expression"] = use.expression, out["acts_on"] = use.acts_on;
    return out;
}

json correlation_json(const Correlation &c) {
    return {{"with", c.with}, {"lag_s", series(c.lag_s)}, {"value", series(c.value)}, {"band", finite(c.band)}};
}

constexpr double sure_p = 0.003; // DiagnoseOptions::p_limit

// Where the evidence is sure and the gain is not worth a name, "not significant" would be false.
std::string verdict_word(const CandidateResult &r) {
    return r.verdict == "not_significant" && r.p_value < sure_p ? "too_little" : r.verdict;
}

json candidate_json(const CandidateResult &r, int rank) {
    json variant = json::object(), parameters = json::object(), evidence = json::array();
    for (const auto &[key, value] : r.candidate.variant) variant[key] = finite(value);
    for (std::size_t j = 0; j < r.value.size(); ++j)
        parameters[r.candidate.strengths[j].key] = {
            {"value", finite(r.value[j])}, {"unit", r.candidate.strengths[j].unit}, {"low", finite(r.low[j])}, {"high", finite(r.high[j])}};
    for (const ShapeEstimate &shape : r.shapes)
        parameters[shape.key] = {
            {"value", finite(shape.value)}, {"unit", shape.unit}, {"low", finite(shape.low)}, {"high", finite(shape.high)}};
    for (const auto &[window, share] : r.evidence)
        evidence.push_back({{"t0_s", finite(window.first)}, {"t1_s", finite(window.second)}, {"share", finite(share)}});
    json out = {{"rank", rank},
                {"effect", r.candidate.effect},
                {"variant", variant},
                {"heldout_gain", finite(r.heldout_gain)},
                {"gain_low", finite(std::max(-1.0, r.gain_low))}, // none can gain more than all there is
                {"gain_high", finite(std::min(1.0, r.gain_high))},
                {"p_value", finite(r.p_value)},
                {"parameters", parameters},
                {"verdict", verdict_word(r)},
                {"class", r.class_index ? json(*r.class_index) : json(nullptr)},
                {"detectability", finite(r.detectability)},
                {"evidence", evidence},
                {"explains", r.explains}};
    out["wheel"] = r.candidate.wheel >= 0 ? json(r.candidate.wheel) : json(nullptr);
    if (const sim::Effect *effect = sim::find_effect(r.candidate.effect); effect != nullptr)
        out["title"] = effect->title, out["equation"] = effect->equation, out["signature"] = effect->signature;
    return out;
}

} // namespace

std::string candidate_words(const CandidateResult &r, const Diagnosis &d) {
    const std::string verdict = verdict_word(r);
    std::string names;
    for (const std::string &name : d.effects) names += (names.empty() ? "" : ", ") + name;
    if (verdict == "not_needed" && !names.empty()) return "not needed beside " + names;
    if (verdict == "not_needed" && d.unknown) return "not needed beside " + d.unknown->balance;
    static const std::pair<const char *, const char *> words[] = {
        {"named", "found"},
        {"class", "possible: this log cannot tell it from the others marked so"},
        {"nearest", "comes near, and is not named"},
        {"not_needed", "not needed beside what was found"},
        {"not_held_out", "predicts the rest of the log no better"},
        {"strains_sheet", "takes the model's numbers farther from their data sheet"},
        {"not_significant", "no sure help"},
        {"too_little", "there, but helps too little to matter"},
        {"too_small", "there, but not surely large enough to matter"},
        {"beyond_range", "helps only at a size that is not plausible"},
        {"conflict", "not to be believed of a drive of one manner"},
        {"wrong_sign", "helps only with a sign that is not physical"},
        {"not_excited", "this log cannot show it"},
        {"wrong_model", "not judged: the model's numbers come first"}};
    for (const auto &[word, said] : words)
        if (verdict == word) return said;
    return verdict;
}

json head_json(const std::string &verb, const Model &model, const Dataset &data) {
    json effects = json::array();
    for (const EffectUse &use : model.effects) effects.push_back(effect_json(use));
    json out = {{"schema", "traction.lab/1"},
                {"verb", verb},
                {"title", verb + ": " + model.name + (data.log_file.empty() ? "" : " against " + data.log_file)},
                {"model", {{"file", model.file.substr(model.file.find_last_of('/') + 1)}, {"name", model.name}, {"effects", effects}}}};
    if (!data.log_file.empty())
        out["log"] = {
            {"file", data.log_file}, {"scenario", data.scenario}, {"duration_s", finite(data.duration_s)}, {"despite", data.despite}};
    return out;
}

static json remainder_json(const Remainder &left) {
    static constexpr const char *names[] = {"sensors",   "ground",      "encoders",   "steep_soil",
                                            "vibration", "mixed_speed", "everywhere", "outliers"};
    json parts = json::array();
    for (std::size_t c = 0; c < left_by_count; ++c)
        parts.push_back({{"cause", names[c]}, {"error", finite(left.part[c])}, {"text", words_of(static_cast<LeftBy>(c))}});
    return {{"error", finite(left.error)}, {"parts", parts}};
}

void put_comparison(json &out, const Comparison &c) {
    out["score"] = {{"error", finite(c.error)},
                    {"adjusted", finite(c.adjusted)},
                    {"floor", finite(c.floor)},
                    {"ratio", finite(c.error / c.floor)},
                    {"verdict", c.verdict}};
    json balances = json::array();
    for (const BalanceComparison &b : c.balances) {
        const SeriesRows rows = rows_to_show(b);
        json worst = json::array(), ccf = json::array(), gaps = json::array();
        for (const Worst &w : b.worst) worst.push_back({{"t0_s", finite(w.t0_s)}, {"t1_s", finite(w.t1_s)}, {"rmse", finite(w.rmse)}});
        for (const Correlation &k : b.ccf) ccf.push_back(correlation_json(k));
        for (const Gap &g : b.gaps) gaps.push_back({{"t0_s", finite(g.t0_s)}, {"t1_s", finite(g.t1_s)}, {"rows", g.rows}});
        balances.push_back({{"name", b.name},
                            {"title", b.title},
                            {"unit", b.unit},
                            {"sigma", finite(b.noise)},
                            {"sigma_source", b.noise_source},
                            {"rows", b.t_s.size()},
                            {"t_s", series(rows.t_s)},
                            {"measured", series(rows.measured)},
                            {"model", series(rows.model)},
                            {"gaps", gaps},
                            {"strip", series(b.strip)},
                            {"rmse", finite(b.rmse)},
                            {"nrmse", finite(b.nrmse)},
                            {"bias", finite(b.bias)},
                            {"r2", finite(b.r2)},
                            {"worst", worst},
                            {"acf", correlation_json(b.acf)},
                            {"ccf", ccf}});
        if (b.after.empty()) continue;
        balances.back()["after"] = series(rows.after);
        balances.back()["rmse_after"] = finite(b.rmse_after);
        balances.back()["nrmse_after"] = finite(b.nrmse_after);
    }
    out["balances"] = balances;
    out["left"] = {{"before", remainder_json(c.left)}};
    if (c.left_after.error > 0) out["left"]["after"] = remainder_json(c.left_after);
    json regimes = json::array();
    for (const Regime &r : c.regimes) {
        json value = json::array(), count = json::array();
        for (const auto &row : r.value) value.push_back(series(row));
        for (const auto &row : r.count) count.push_back(series(row));
        regimes.push_back({{"title", r.title},
                           {"x_label", r.x_label},
                           {"x_edges", series(r.x_edges)},
                           {"y_labels", r.y_labels},
                           {"value", value},
                           {"count", count}});
    }
    out["regimes"] = regimes;
    out["limits"] = limits_json(c.limits);
    out["messages"] = c.messages;
}

json identifiability_json(const Identifiability &told, const std::vector<Resonance> &peaks) {
    json pairs = json::array(), resonances = json::array();
    for (const Identifiability::Pair &p : told.correlated)
        pairs.push_back({{"a", p.a}, {"b", p.b}, {"correlation", finite(p.correlation)}});
    for (const Resonance &r : peaks)
        resonances.push_back({{"balance", r.balance}, {"frequency_Hz", finite(r.frequency_Hz)}, {"times", finite(r.times)}});
    return {{"dead", told.dead},
            {"flat", told.flat},
            {"prior_alone", told.prior_alone},
            {"correlated", pairs},
            {"condition", finite(told.condition)},
            {"resonances", resonances}};
}

std::string identifiability_text(const Identifiability &told, const std::vector<Resonance> &peaks) {
    std::string text;
    const auto list = [&](const std::string &words, const std::vector<std::string> &names) {
        std::string line;
        for (const std::string &name : names) line += (line.empty() ? "" : ", ") + name;
        if (!names.empty()) text += wrapped(words + line, 2);
    };
    list("this log cannot move: ", told.dead);
    list("hardly held by this log: ", told.flat);
    list("decided by the prior alone: ", told.prior_alone);
    for (const Identifiability::Pair &p : told.correlated) {
        std::string line;
        append(line, "go together (correlation %.3f): %s and %s", p.correlation, p.a.c_str(), p.b.c_str());
        text += wrapped(line, 2);
    }
    append(text, "condition number %.3g\n", told.condition);
    for (const Resonance &r : peaks) {
        std::string line;
        append(line, "resonance: the residual of %s has a peak at %.2f Hz, %.0f times its surroundings: nothing in the model swings there",
               r.balance.c_str(), r.frequency_Hz, r.times);
        text += wrapped(line, 2);
    }
    return text;
}

json limits_json(const std::vector<Limit> &limits) {
    json out = json::array();
    for (const Limit &l : limits)
        out.push_back({{"parameter", l.parameter},
                       {"value", finite(l.value)},
                       {"unit", l.unit},
                       {"of", l.of_prior ? "prior" : "range"},
                       {"text", limit_text(l)}});
    return out;
}

std::string limits_text(const std::vector<Limit> &limits) {
    std::string text;
    for (const Limit &l : limits) text += wrapped("at its limit: " + limit_text(l), 2);
    return text;
}

json ladder_json(const std::vector<LadderStep> &ladder) {
    json out = json::array();
    for (const LadderStep &r : ladder)
        out.push_back({{"label", r.label}, {"train", finite(r.train)}, {"heldout", finite(r.heldout)}, {"floor", finite(r.floor)}});
    return out;
}

void put_diagnosis(json &out, const Diagnosis &d) {
    json candidates = json::array(), classes = json::array(), not_excited = json::array(), accepted = json::array();
    int rank = 0;
    for (const CandidateResult &r : d.ranking) {
        candidates.push_back(candidate_json(r, ++rank));
        candidates.back()["words"] = candidate_words(r, d);
    }
    rank = 0;
    for (const CandidateResult &r : d.accepted) accepted.push_back(candidate_json(r, ++rank));
    for (const ConfoundedClass &c : d.classes) classes.push_back({{"members", c.members}, {"separate_by", c.separate_by}});
    for (const auto &[effect, why] : d.not_excited) not_excited.push_back({{"effect", effect}, {"why", why}});
    out["candidates"] = candidates;
    out["accepted"] = accepted;
    out["classes"] = classes;
    out["not_excited"] = not_excited;
    out["unknown"] = nullptr;
    if (d.unknown) {
        const UnknownShape &u = *d.unknown;
        out["unknown"] = {{"variable", u.variable}, {"balance", u.balance}, {"acts_on", u.target},       {"gain", finite(u.gain)},
                          {"x", series(u.x)},       {"y", series(u.y)},     {"low", series(u.low)},      {"high", series(u.high)},
                          {"unit_x", u.unit_x},     {"unit_y", u.unit_y},   {"expression", u.expression}};
        if (u.at_a_guess) out["unknown"]["at_a_guess"] = true;
        if (!u.instead_of.empty()) out["unknown"]["instead_of"] = u.instead_of;
    }
    out["verdict"] = {{"kind", d.kind}, {"effects", d.effects}, {"nearest", d.nearest}, {"text", d.text}};
    out["heldout_fall"] = finite(fall_percent(d.ladder) / 100);
    out["ladder"] = ladder_json(d.ladder);
    out["limits"] = limits_json(d.limits);
    out["messages"] = d.messages;
}

} // namespace traction::lab
