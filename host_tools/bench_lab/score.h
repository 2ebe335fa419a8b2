// score.h - judges a blind campaign: what was hidden (the opened seals) against what the lab said, in the figures of docs/evidence.md
// section 5.
#pragma once

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
    nlohmann::json cases;                                        // one entry per log: what was hidden, what was said, why it counts
    int failures = 0;                                            // logs on which the lab did not answer
};

Score judge(const std::vector<Judged> &judged);
std::string table_text(const Score &score);
nlohmann::json table_json(const Score &score);

} // namespace traction::bench_lab
