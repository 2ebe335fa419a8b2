// next_result.h - the next experiment as text and JSON (docs/json_schema.md, key `next`).
#pragma once

#include "host_tools/lab/next/next.h"

#include <nlohmann/json.hpp>

#include <string>

namespace traction::lab {

nlohmann::json next_json(const NextExperiment &next);                    // null when there is no question
std::string next_text(const NextExperiment &next, bool details = false); // details: d' of every question

} // namespace traction::lab
