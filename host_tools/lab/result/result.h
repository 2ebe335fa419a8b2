// result.h - results as JSON for programs (schema traction.lab/1, docs/json_schema.md) and as text for people.
#pragma once

#include "compare.h"
#include "host_tools/lab/decision/diagnose.h"

#include <nlohmann/json.hpp>

#include <string>

namespace traction::lab {

nlohmann::json head_json(const std::string &verb, const Model &model, const Dataset &data);
void put_comparison(nlohmann::json &json, const Comparison &comparison);
void put_diagnosis(nlohmann::json &json, const Diagnosis &diagnosis);
nlohmann::json identifiability_json(const Identifiability &told, const std::vector<Resonance> &peaks);
std::string identifiability_text(const Identifiability &told, const std::vector<Resonance> &peaks);
nlohmann::json limits_json(const std::vector<Limit> &limits);
std::string limits_text(const std::vector<Limit> &limits);
nlohmann::json ladder_json(const std::vector<LadderStep> &ladder);

std::string comparison_text(const Comparison &comparison);
std::string diagnosis_text(const Diagnosis &diagnosis);
std::string ladder_text(const std::vector<LadderStep> &ladder);

} // namespace traction::lab
