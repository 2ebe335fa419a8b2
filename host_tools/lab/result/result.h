// result.h - results as JSON for programs (schema traction.lab/1, docs/json_schema.md) and as text for people.
#pragma once

#include "compare.h"
#include "host_tools/lab/decision/diagnose.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace traction::lab {

nlohmann::json head_json(const std::string &verb, const Model &model, const Dataset &data);
void put_comparison(nlohmann::json &json, const Comparison &comparison);
void put_diagnosis(nlohmann::json &json, const Diagnosis &diagnosis);
nlohmann::json identifiability_json(const Identifiability &told, const std::vector<Resonance> &peaks);
std::string identifiability_text(const Identifiability &told, const std::vector<Resonance> &peaks);
nlohmann::json limits_json(const std::vector<Limit> &limits);
std::string limits_text(const std::vector<Limit> &limits);
nlohmann::json ladder_json(const std::vector<LadderStep> &ladder);

// Why a candidate was or was not named, for people.
std::string candidate_words(const CandidateResult &candidate, const Diagnosis &diagnosis);

// Tables for a terminal of 80 columns (text.cpp). `details`: the statistics too (bias, R2, p, d'), in wider lines.
std::string comparison_text(const Comparison &comparison, bool details = false);
std::string diagnosis_text(const Diagnosis &diagnosis, bool details = false); // without the five answers: story.h
std::string ladder_text(const std::vector<LadderStep> &ladder);
std::string messages_text(const std::vector<std::string> &messages);

} // namespace traction::lab
