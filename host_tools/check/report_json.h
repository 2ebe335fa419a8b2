// report_json.h - the check's report as JSON, schema traction.check/1 (docs/json_schema.md).
#pragma once

#include "check.h"

#include <nlohmann/json.hpp>

#include <string>

namespace traction::check {

// `log`, `map`, `model`: files by name, as they were given; empty where none was.
nlohmann::json report_json(const Report &report, const std::string &log, const std::string &map, const std::string &model);

} // namespace traction::check
