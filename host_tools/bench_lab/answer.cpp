#include "answer.h"

#include "host_tools/lab/decision/diagnose.h"
#include "host_tools/lab/forward/make_dataset.h"

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

json ask_lab(const std::string &log_file, const std::string &model_file) {
    using clock = std::chrono::steady_clock;
    const auto since = [](clock::time_point start) { return std::chrono::duration<double>(clock::now() - start).count(); };
    const auto start = clock::now();
    const lab::Model model = lab::read_model(model_file);
    const log::Log log = log::read_csv(log_file);
    const double read_s = since(start);
    const lab::Dataset data = lab::make_dataset(model, log);
    const lab::Diagnosis found = lab::diagnose(model, data, lab::DiagnoseOptions{});

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
    for (const auto &[effect, why] : found.not_excited) answer["not_excited"].push_back({{"effect", effect}, {"why", why}});
    return answer;
}

double floor_with_truth(const std::string &log_file, const std::string &model_file, const json &seal) {
    std::string text = lab::model_text(lab::read_model(model_file));
    for (const json &effect : seal.at("effects")) {
        if (effect.value("outside", false)) return 0;
        text += "\n[[effect]]\nname = \"" + effect.at("name").get<std::string>() + "\"\n";
        if (effect.at("wheel").get<int>() >= 0) text += "wheel = " + std::to_string(effect.at("wheel").get<int>()) + "\n";
        for (const auto &[key, value] : effect.at("parameters").items()) text += key + " = " + json(value.get<double>()).dump() + "\n";
    }
    lab::Model model = lab::parse_model(text, model_file);
    const lab::Dataset data = lab::make_dataset(model, log::read_csv(log_file));
    return lab::fit_model(model, data, "truth").train;
}

std::string campaign_model(const std::string &generator, const std::string &soil) {
    const std::string root = TRACTION_SOURCE_DIR;
    return generator == "plant" ? root + "/models/rover_" + soil + ".toml" : root + "/tests/lab/campaign/machine_" + soil + ".toml";
}

} // namespace traction::bench_lab
