// gate.h - nothing is learnt from a log that fails the check: errors refuse it, and what is overridden is written down.
//
// Every verb that learns (diagnose, fit, add, compare, next, export) opens its logs through open_session, and so through here. The check
// (host_tools/check) is asked with what the model knows of the machine: units and scales are then told by their factor.
#pragma once

#include "host_tools/check/check.h"
#include "host_tools/lab/model/model.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace traction::lab {

// The log is not fit to learn from. what(): the file, every error with its mend, and how to override. Exit code 3.
struct Refused : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// What a model knows that a unit, a sign or a scale of a log can be judged by.
check::Machine machine_of(const Model &model);

// `despite`: ids of findings whose errors shall not stop it. Returns what was overridden and every warning, one sentence each, to be told
// with the result; `overridden` gets the ids that were needed. Throws Refused where an error is left, ModelError for an id that no finding
// has.
std::vector<std::string> pass_gate(const check::Report &report, const std::string &log_file, const std::vector<std::string> &despite,
                                   std::vector<std::string> &overridden);

} // namespace traction::lab
