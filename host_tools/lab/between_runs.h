// between_runs.h - how far the estimates of single runs lie apart, beside what their intervals allow.
//
//   times = sqrt(sum over runs of ((x - m) / s)^2 / (n - 1))                                                                      (1)
// x: of a run fitted by itself, s: its 95 % interval's half width over 1.96, m: the mean by weights 1/s^2, n: runs (the ratio of external
// to internal error, Birge 1932). Near 1 where the intervals are true; below it what the model's prior holds; far above it the number is
// no constant of the machine, or what the model lacks bends it otherwise in every drive.
#pragma once

#include "session.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace traction::lab {

// What a fit has given a value and an interval, by the names that results have: "motor.resistance_ohm on wheel 2". What belongs to a run
// is told as "soil.mu in gravel.csv".
struct FittedValue {
    std::string name;
    Parameter parameter;
    bool of_run = false;
};
std::vector<FittedValue> fitted_values(const Model &model);

struct BetweenRuns {
    std::string parameter, unit;
    std::vector<double> value, half_width; // per run
    double times = 0;                      // (1)
    bool differs = false;                  // beyond chance, at 0.05 for all parameters together
};

// The numbers of the machine that every run tells; none with one run. A run in which too little moves is left out.
std::vector<BetweenRuns> between_runs(const Session &session);
std::string between_runs_text(const std::vector<BetweenRuns> &list); // 80 columns
nlohmann::json between_runs_json(const std::vector<BetweenRuns> &list);

} // namespace traction::lab
