#include "result.h"

#include "append.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traction::lab {

using nlohmann::json;

namespace {

json finite(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json series(const std::vector<double> &values, std::size_t every = 1) {
    json out = json::array();
    for (std::size_t i = 0; i < values.size(); i += every) out.push_back(finite(values[i]));
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
                {"gain_low", finite(r.gain_low)},
                {"gain_high", finite(r.gain_high)},
                {"p_value", finite(r.p_value)},
                {"parameters", parameters},
                {"verdict", r.verdict},
                {"class", r.class_index ? json(*r.class_index) : json(nullptr)},
                {"detectability", finite(r.detectability)},
                {"evidence", evidence},
                {"explains", r.explains}};
    out["wheel"] = r.candidate.wheel >= 0 ? json(r.candidate.wheel) : json(nullptr);
    return out;
}

std::string strengths_text(const CandidateResult &r) {
    std::string text;
    for (std::size_t j = 0; j < r.value.size(); ++j) {
        append(text, "%s%s = %.4g [%.4g, %.4g] %s", j > 0 ? ", " : "", r.candidate.strengths[j].key.c_str(), r.value[j], r.low[j],
               r.high[j], r.candidate.strengths[j].unit == "1" ? "" : r.candidate.strengths[j].unit.c_str());
    }
    for (const auto &[key, value] : r.candidate.variant) {
        const auto refined = std::find_if(r.shapes.begin(), r.shapes.end(), [&](const ShapeEstimate &s) { return s.key == key; });
        if (refined == r.shapes.end())
            append(text, ", %s = %g", key.c_str(), value);
        else
            append(text, ", %s = %.4g [%.4g, %.4g] %s", key.c_str(), value, refined->low, refined->high, refined->unit.c_str());
    }
    return text;
}

} // namespace

// The verdict of a candidate for people.
static std::string verdict_words(const CandidateResult &r, const Diagnosis &d) {
    std::string names;
    for (const std::string &name : d.effects) names += (names.empty() ? "" : ", ") + name;
    if (r.verdict == "not_needed" && !names.empty()) return "not needed beside " + names;
    if (r.verdict == "not_needed" && d.unknown) return "not needed beside " + d.unknown->balance;
    if (r.verdict == "not_held_out") return "predicts blocks left out no better";
    std::string words = r.verdict;
    std::replace(words.begin(), words.end(), '_', ' ');
    return words;
}

json head_json(const std::string &verb, const Model &model, const Dataset &data) {
    json effects = json::array();
    for (const EffectUse &use : model.effects) effects.push_back(effect_json(use));
    return {
        {"schema", "traction.lab/1"},
        {"verb", verb},
        {"title", verb + ": " + model.name + " against " + data.log_file},
        {"log", {{"file", data.log_file}, {"scenario", data.scenario}, {"duration_s", finite(data.duration_s)}, {"despite", data.despite}}},
        {"model", {{"file", model.file.substr(model.file.find_last_of('/') + 1)}, {"name", model.name}, {"effects", effects}}}};
}

void put_comparison(json &out, const Comparison &c) {
    out["score"] = {{"error", finite(c.error)},
                    {"adjusted", finite(c.adjusted)},
                    {"floor", finite(c.floor)},
                    {"ratio", finite(c.error / c.floor)},
                    {"verdict", c.verdict}};
    json balances = json::array();
    for (const BalanceComparison &b : c.balances) {
        const std::size_t every = b.t_s.size() / 3000 + 1;
        json worst = json::array(), ccf = json::array();
        for (const Worst &w : b.worst) worst.push_back({{"t0_s", finite(w.t0_s)}, {"t1_s", finite(w.t1_s)}, {"rmse", finite(w.rmse)}});
        for (const Correlation &k : b.ccf) ccf.push_back(correlation_json(k));
        balances.push_back({{"name", b.name},
                            {"title", b.title},
                            {"unit", b.unit},
                            {"sigma", finite(b.noise)},
                            {"sigma_source", b.noise_source},
                            {"t_s", series(b.t_s, every)},
                            {"measured", series(b.measured, every)},
                            {"model", series(b.model, every)},
                            {"rmse", finite(b.rmse)},
                            {"nrmse", finite(b.nrmse)},
                            {"bias", finite(b.bias)},
                            {"r2", finite(b.r2)},
                            {"worst", worst},
                            {"acf", correlation_json(b.acf)},
                            {"ccf", ccf}});
    }
    out["balances"] = balances;
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
    const auto list = [&](const char *words, const std::vector<std::string> &names) {
        for (std::size_t i = 0; i < names.size(); ++i) append(text, "%s%s", i == 0 ? words : ", ", names[i].c_str());
        if (!names.empty()) text += "\n";
    };
    list("this log cannot move: ", told.dead);
    list("hardly held by this log: ", told.flat);
    list("decided by the prior alone: ", told.prior_alone);
    for (const Identifiability::Pair &p : told.correlated)
        append(text, "go together (correlation %.3f): %s and %s\n", p.correlation, p.a.c_str(), p.b.c_str());
    append(text, "condition number %.3g\n", told.condition);
    for (const Resonance &r : peaks)
        append(text,
               "resonance: the residual of %s has a peak at %.2f Hz, %.0f times its surroundings: nothing in the model swings there\n",
               r.balance.c_str(), r.frequency_Hz, r.times);
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
    for (const Limit &l : limits) append(text, "at its limit: %s\n", limit_text(l).c_str());
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
    for (const CandidateResult &r : d.ranking) candidates.push_back(candidate_json(r, ++rank));
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
    }
    out["verdict"] = {{"kind", d.kind}, {"effects", d.effects}, {"nearest", d.nearest}, {"text", d.text}};
    out["ladder"] = ladder_json(d.ladder);
    out["limits"] = limits_json(d.limits);
    out["messages"] = d.messages;
}

std::string comparison_text(const Comparison &c) {
    std::string text;
    for (const std::string &m : c.messages) append(text, "note: %s\n", m.c_str());
    append(text, "%-28s %10s %10s %8s %9s %7s  %s\n", "balance", "rmse", "noise", "x noise", "bias", "R2", "worst 5 s window");
    for (const BalanceComparison &b : c.balances) {
        append(text, "%-28s %10.4g %10.4g %8.2f %9.3g %7.4f", b.name.c_str(), b.rmse, b.noise, b.nrmse, b.bias, b.r2);
        if (!b.worst.empty()) append(text, "  %.1f to %.1f s", b.worst[0].t0_s, b.worst[0].t1_s);
        append(text, " %s\n", b.unit.c_str());
    }
    text += limits_text(c.limits);
    append(text, "%s\n", c.verdict.c_str());
    return text;
}

std::string ladder_text(const std::vector<LadderStep> &ladder) {
    std::string text;
    append(text, "%-36s %10s %10s   (in units of noise)\n", "ladder", "training", "held out");
    for (const LadderStep &r : ladder) append(text, "%-36s %10.3f %10.3f\n", r.label.c_str(), r.train, r.heldout);
    append(text, "%-36s %10.3f %10.3f\n", "noise floor", ladder.empty() ? 1.0 : ladder.back().floor,
           ladder.empty() ? 1.0 : ladder.back().floor);
    return text;
}

std::string diagnosis_text(const Diagnosis &d) {
    std::string text;
    for (const std::string &m : d.messages) append(text, "note: %s\n", m.c_str());
    append(text, "%-34s %9s %19s %9s  %s\n", "candidate", "explains", "95 %", "p", "verdict, size [95 %]");
    int shown = 0;
    for (const CandidateResult &r : d.ranking) {
        if (++shown > 8) break;
        append(text, "%-34s %7.1f %% %8.1f to %5.1f %% %9.1e  %s, %s\n", r.candidate.label().c_str(), 100 * r.heldout_gain,
               100 * r.gain_low, 100 * r.gain_high, r.p_value, verdict_words(r, d).c_str(), strengths_text(r).c_str());
    }
    for (const ConfoundedClass &c : d.classes) {
        append(text, "cannot be told apart in this log:");
        for (const std::string &m : c.members) append(text, " %s", m.c_str());
        append(text, "\n  to separate them: %s\n", c.separate_by.c_str());
    }
    if (d.unknown)
        append(text, "unexplained: %s depends on %s (explains %.1f %%): %s\n", d.unknown->target.c_str(), d.unknown->variable.c_str(),
               100 * d.unknown->gain, d.unknown->expression.c_str());
    if (!d.not_excited.empty()) {
        append(text, "this log cannot show:");
        for (const auto &[effect, why] : d.not_excited) append(text, " %s", effect.c_str());
        append(text, "\n");
    }
    for (const CandidateResult &r : d.accepted) append(text, "found: %s: %s\n", r.candidate.label().c_str(), strengths_text(r).c_str());
    text += limits_text(d.limits);
    text += ladder_text(d.ladder);
    append(text, "%s\n", d.text.c_str());
    return text;
}

} // namespace traction::lab
