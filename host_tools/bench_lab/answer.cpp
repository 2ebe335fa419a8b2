#include "answer.h"

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/forward/make_dataset.h"
#include "host_tools/lab/session.h"
#include "sim/physics/effects/catalogue.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace traction::bench_lab {

namespace {

using nlohmann::json;

json finite(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json candidate_json(const lab::CandidateResult &result) {
    json parameters = json::object();
    for (std::size_t i = 0; i < result.candidate.strengths.size() && i < result.value.size(); ++i) {
        json &p = parameters[result.candidate.strengths[i].key];
        p["value"] = finite(result.value[i]);
        if (i < result.low.size()) p["low"] = finite(result.low[i]);
        if (i < result.high.size()) p["high"] = finite(result.high[i]);
    }
    for (const lab::ShapeEstimate &shape : result.shapes)
        parameters[shape.key] = {{"value", finite(shape.value)}, {"low", finite(shape.low)}, {"high", finite(shape.high)}};
    json variant = json::object();
    for (const auto &[key, value] : result.candidate.variant) variant[key] = value;
    return {{"effect", result.candidate.effect},
            {"wheel", result.candidate.wheel},
            {"variant", variant},
            {"parameters", parameters},
            {"verdict", result.verdict},
            {"heldout_gain", finite(result.heldout_gain)},
            {"p_value", finite(result.p_value)},
            {"detectability", finite(result.detectability)}};
}

} // namespace

json ask_lab(const std::string &log_file, const std::string &model_file, const std::string &map_file) {
    using clock = std::chrono::steady_clock;
    const auto since = [](clock::time_point start) { return std::chrono::duration<double>(clock::now() - start).count(); };
    const auto start = clock::now();
    lab::Session session; // as open_session has it, but for the gate
    session.model = lab::read_model(model_file);
    session.runs = {log::read_csv(log_file, map_file)};
    const double read_s = since(start);
    lab::ask_the_log(session);
    const lab::Diagnosed diagnosed = lab::diagnose_session(session, lab::DiagnoseOptions{});
    const lab::Diagnosis &found = diagnosed.diagnosis;

    json answer = {{"schema", "traction.lab/1"}, {"verb", "diagnose"},      {"candidates", json::array()},
                   {"classes", json::array()},   {"ladder", json::array()}, {"messages", found.messages}};
    answer["verdict"] = {{"kind", found.kind}, {"effects", found.effects}, {"nearest", found.nearest}, {"text", found.text}};
    answer["seconds"] = {{"read", read_s}, {"diagnose", since(start) - read_s}};
    for (const lab::CandidateResult &one : found.ranking) answer["candidates"].push_back(candidate_json(one));
    for (const lab::CandidateResult &one : found.accepted) answer["accepted"].push_back(candidate_json(one));
    for (const lab::ConfoundedClass &one : found.classes)
        answer["classes"].push_back({{"members", one.members}, {"separate_by", one.separate_by}});
    for (const lab::LadderStep &step : found.ladder)
        answer["ladder"].push_back(
            {{"label", step.label}, {"train", finite(step.train)}, {"heldout", finite(step.heldout)}, {"floor", finite(step.floor)}});
    if (found.unknown)
        answer["unknown"] = {{"variable", found.unknown->variable},
                             {"balance", found.unknown->balance},
                             {"gain", finite(found.unknown->gain)},
                             {"expression", found.unknown->expression}};
    if (found.unknown && !found.unknown->instead_of.empty()) answer["unknown"]["instead_of"] = found.unknown->instead_of;
    for (const auto &[effect, why] : found.not_excited) answer["not_excited"].push_back({{"effect", effect}, {"why", why}});
    return answer;
}

TruthFit fit_with_truth(const SealedLog &one, const json &seal) {
    lab::Model model = lab::read_model(one.model);
    for (const json &effect : seal.at("effects")) {
        const sim::Effect *known = sim::find_effect(effect.at("name").get<std::string>());
        if (known == nullptr) return {};
        lab::EffectUse use;
        use.name = known->name;
        use.wheel = effect.at("wheel").get<int>();
        for (const sim::EffectParameter &spec : known->parameters) {
            const std::string key(spec.name);
            lab::Parameter p;
            p.value = effect.at("parameters").value(key, spec.typical);
            p.fixed = !spec.strength;
            p.unit = spec.unit;
            p.maximum = 4 * std::max(std::fabs(p.value), std::fabs(spec.maximum)); // wide: the truth's own error is asked for
            p.minimum = spec.minimum < 0 ? -p.maximum : 0;
            use.parameters[key] = p;
        }
        model.effects.push_back(std::move(use));
    }
    const std::size_t first = model.effects.size() - seal.at("effects").size();
    const lab::Dataset data = lab::make_dataset(model, log::read_csv(one.log, one.map));
    TruthFit fit;
    fit.floor = lab::fit_model(model, data, "truth").train;
    for (const auto &[key, p] : model.effects[first].parameters) {
        if (p.fixed || !(p.high > p.low)) continue;
        const double truth = seal.at("effects")[0].at("parameters").value(key, 0.0);
        fit.detectability = std::max(fit.detectability, std::fabs(truth) / ((p.high - p.low) / (2 * 1.96)));
    }
    return fit;
}

std::string campaign_model(const std::string &generator, const std::string &soil) {
    const std::string root = TRACTION_SOURCE_DIR;
    return generator == "plant" ? root + "/models/rover_" + soil + ".toml" : root + "/tests/lab/campaign/machine_" + soil + ".toml";
}

} // namespace traction::bench_lab
