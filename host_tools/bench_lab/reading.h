// reading.h - one case of a campaign: what the seal says beside what the lab's result says, in plain terms.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace traction::bench_lab {

struct Reading {
    std::string category; // clean, one, two, outside
    std::string truth;    // name of the first hidden effect, or empty
    int truth_wheel = -1;
    double detectability = 0;       // d' of the hidden size: it / its standard error in the fit that is given the truth; 0 unknown
    bool visible = false;           // d' >= 2
    std::string said;               // first effect named, "(unknown: X)", or "(nothing)"
    std::vector<std::string> named; // every effect in the verdict
    std::vector<bool> named_right;  // each of them: hidden, or in one class with a hidden one
    std::vector<bool> covered;      // per strength parameter of rightly named effects: interval holds the truth
    bool silent = false;            // neither named nor flagged
    bool first_right = false;       // the first candidate of the ranking is the hidden one, or shares a class with it
    bool first_named_right = false;
    bool wheel_right = false;
    int truths_named = 0;
    bool flagged_unknown = false; // "depends on X", alone, beside named effects or instead of one
    bool variable_right = false;
    bool has_lag = false;        // backlash or relaxation length hidden
    double error_over_floor = 0; // error of the lab's last model / error of the fit that holds every true effect; 0 unknown
};

Reading read_case(const nlohmann::json &seal, const nlohmann::json &result);
nlohmann::json reading_json(const Reading &reading);
Reading read_reading(const nlohmann::json &); // the reverse; a null number is 0

} // namespace traction::bench_lab
