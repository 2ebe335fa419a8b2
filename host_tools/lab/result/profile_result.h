// profile_result.h - profile likelihoods as text and JSON (docs/json_schema.md, key `profiles`).
#pragma once

#include "host_tools/lab/fit/profile.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace traction::lab {

std::string profile_text(const std::vector<Profile> &profiles);
nlohmann::json profile_json(const std::vector<Profile> &profiles);

} // namespace traction::lab
