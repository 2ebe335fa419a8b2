// score.h - judges a blind campaign: what was hidden (the opened seals) against what the lab said, in the figures of docs/evidence.md
// section 5.
#pragma once

#include "reading.h"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace traction::bench_lab {

// One log of the campaign, after the seals are open.
struct Judged {
    std::string log;
    nlohmann::json seal;   // traction.seal/1
    nlohmann::json result; // traction.lab/1 of diagnose; {"error": text} when the lab failed
    double seconds = 0;    // processor time of the lab on this log
};

// What the judge keeps of one log: it goes to JSON and back with the same table (non-finite numbers excepted: they come back as 0).
struct Case {
    std::string log, soil, error; // error: why there is no answer; empty where there is one
    std::vector<std::string> groups;
    Reading reading;
    nlohmann::json seed, hidden; // as the seal has them
    double duration_s = 120;     // of the log
    double seconds = 0;          // processor time of the lab on this log
};
Case case_of(const Judged &);
nlohmann::json case_json(const Case &);
// The reverse. Throws nlohmann::json::exception where the text is no case.
Case read_case_json(const nlohmann::json &);

// A share with its 95 % Wilson interval (Wilson 1927).
struct Share {
    int hits = 0, count = 0;
    void add(bool hit) { hits += hit ? 1 : 0, ++count; }
    double value() const { return count > 0 ? static_cast<double>(hits) / count : 0; }
    std::pair<double, double> interval() const;
};

// Linear between the two values beside it; 0 where there are none.
double quantile(std::vector<double> values, double q);

// One line of the table.
struct Line {
    std::string key, title, goal;
    double value = 0, low = 0, high = 0;
    int count = 0;
    bool is_share = true;
    bool met = false;
};

struct Score {
    std::vector<Line> lines;
    std::map<std::string, std::vector<Line>> by_soil, by_group;  // group: size of the rover, sensor chain, where the seals tell them
    std::map<std::string, std::map<std::string, int>> confusion; // hidden -> said -> how often, single effects
    nlohmann::json cases; // one entry per log (case_json): what was hidden, what was said, why it counts
    int failures = 0;     // logs on which the lab did not answer
};

Score judge(const std::vector<Judged> &judged);
Score score_of(const std::vector<Case> &cases); // the same from what was judged before, in any order but that of `cases`
std::string table_text(const Score &score);
nlohmann::json table_json(const Score &score);

} // namespace traction::bench_lab
