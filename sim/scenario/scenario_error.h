// scenario_error.h - a mistake in a scenario, told once: file, line, key, value, what is wrong, and the mend.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace traction::sim {

struct ScenarioError : std::runtime_error {
    ScenarioError(const std::string &file, std::size_t line, const std::string &key, const std::string &value,
                  const std::string &what_is_wrong, const std::string &mend);
    std::string file;
    std::size_t line; // 1-based; 0 when the whole file or the command line is meant
    std::string key;
    std::string value; // as written; empty when the key is missing
    std::string mend;
};

} // namespace traction::sim
