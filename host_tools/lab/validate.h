// validate.h - a model judged on runs that it was not fitted to: logs given with --validate, or each run of several left out in turn.
//
// What belongs to a run is its own there too: the offsets of accelerometer and gyro, and the ground that the model's file states for it,
// may move within their priors. Nothing else does.
#pragma once

#include "session.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace traction::lab {

struct Validation {
    std::string log;                           // file name without folder
    double stated = 0, fitted = 0, result = 0; // error in units of noise: the model as given, fitted without effects, as the result has it
    bool left_out = false;                     // a run of the data set, left out of both fits; else given by --validate
};

// `result`: the model that a verb arrived at (its effects; for a left-out run its values are fitted again to the others).
std::vector<Validation> validate(const Session &session, const Request &request, const Model &result);

// There are runs that were left out, and none of them is predicted better by the result than by the model without effects (by
// 1 %: how two fits end differs by less).
bool predicts_no_run(const std::vector<Validation> &list);

std::string validation_text(const std::vector<Validation> &list); // empty for none
nlohmann::json validation_json(const std::vector<Validation> &list);

} // namespace traction::lab
