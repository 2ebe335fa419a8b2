#include "score.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace traction::bench_lab {

namespace {

// Counts of one group of logs.
struct Tally {
    Share right_first, right_first_visible, named_first_visible, silent_visible, right_when_naming, wheel_right, clean_silent, both, either,
        false_terms, flagged, right_variable;
    Share outside_misnamed, covered, beyond_floor;
    std::vector<double> error_over_floor, error_over_floor_lag, seconds;

    void add(const Case &one) {
        const Reading &r = one.reading;
        seconds.push_back(one.seconds * 120 / one.duration_s);
        for (const bool right : r.named_right) false_terms.add(!right);
        for (const bool inside : r.covered) covered.add(inside);
        if (r.category == "clean") clean_silent.add(r.named.empty() && !r.flagged_unknown);
        if (r.category == "one") {
            right_first.add(r.first_right);
            if (r.visible)
                right_first_visible.add(r.first_right), named_first_visible.add(r.first_named_right), silent_visible.add(r.silent);
            if (!r.named.empty()) right_when_naming.add(r.first_named_right);
            if (r.first_right && r.truth_wheel >= 0) wheel_right.add(r.wheel_right);
            if (r.first_named_right && r.error_over_floor > 0)
                (r.has_lag ? error_over_floor_lag : error_over_floor).push_back(r.error_over_floor);
        }
        if (r.category == "two") {
            both.add(r.truths_named == 2);
            either.add(r.truths_named >= 1);
        }
        if (r.category == "outside") {
            flagged.add(r.flagged_unknown);
            if (r.flagged_unknown) right_variable.add(r.variable_right);
            outside_misnamed.add(!r.named.empty() && !r.flagged_unknown);
        }
    }

    std::vector<Line> lines() const {
        std::vector<Line> list;
        const auto share = [&](const char *key, const char *title, const Share &s, const char *goal, double limit, bool at_least) {
            const auto [low, high] = s.interval();
            const bool met = s.count > 0 && (at_least ? s.value() >= limit : s.value() <= limit);
            list.push_back({key, title, goal, s.value(), low, high, s.count, true, met});
        };
        const auto number = [&](const char *key, const char *title, double value, std::size_t count, const char *goal, double limit) {
            list.push_back({key, title, goal, value, value, value, static_cast<int>(count), false, count > 0 && value <= limit});
        };
        share("named_first_detectable", "named first and right, where d' >= 2", named_first_visible, ">= 0.93", 0.93, true);
        share("silent_detectable", "  of these logs, silent", silent_visible, "", 0, true);
        share("right_first_detectable", "  rank 1 right, silent or not", right_first_visible, "", 0, true);
        share("right_first", "right effect first, all single effects", right_first, "", 0, true);
        share("right_when_naming", "right when it names one", right_when_naming, ">= 0.98", 0.98, true);
        share("wheel_right", "wheel index right", wheel_right, "", 0, true);
        Share clean = clean_silent;
        clean.hits = clean.count - clean.hits;
        share("clean_named", "clean logs named or flagged", clean, "<= 0.03", 0.03, false);
        share("false_discoveries", "false terms among all named", false_terms, "<= 0.05", 0.05, false);
        share("both_of_two", "two effects: both named", both, ">= 0.85", 0.85, true);
        share("one_of_two", "two effects: at least one", either, "", 0, true);
        share("outside_flagged", "outside the catalogue: flagged", flagged, ">= 0.90", 0.90, true);
        share("outside_variable", "  of these, the right variable", right_variable, "1.00", 1, true);
        share("outside_misnamed", "outside: misnamed and not flagged", outside_misnamed, "0", 0, false);
        share("coverage", "95 % intervals that hold the truth", covered, "0.92-0.98", 0.92, true);
        if (covered.count > 0 && covered.value() > 0.98) list.back().met = false; // an interval that always holds it is too wide
        number("error_median", "error after / floor, median", quantile(error_over_floor, 0.5), error_over_floor.size(), "<= 1.02", 1.02);
        number("error_p95", "error after / floor, 95th percentile", quantile(error_over_floor, 0.95), error_over_floor.size(), "<= 1.05",
               1.05);
        number("error_lag_p95", "  backlash and relaxation, 95th percentile", quantile(error_over_floor_lag, 0.95),
               error_over_floor_lag.size(), "<= 1.15", 1.15);
        number("seconds_median", "seconds per 120 s of log, median", quantile(seconds, 0.5), seconds.size(), "<= 1", 1.0);
        number("seconds_p95", "seconds per 120 s of log, 95th percentile", quantile(seconds, 0.95), seconds.size(), "", 1e9);
        return list;
    }
};

std::string part_text(const std::map<std::string, std::vector<Line>> &parts, std::size_t line) {
    std::string text;
    for (const auto &[name, lines] : parts) {
        char part[32] = "         -";
        if (lines[line].count > 0) std::snprintf(part, sizeof part, " %9.3f", lines[line].value);
        text += part;
    }
    return text;
}

nlohmann::json line_json(const Line &line) {
    nlohmann::json json = {{"key", line.key}, {"title", line.title}, {"value", line.value}, {"count", line.count}};
    if (line.is_share) json["low"] = line.low, json["high"] = line.high;
    if (!line.goal.empty()) json["goal"] = line.goal, json["met"] = line.met;
    return json;
}

} // namespace

double quantile(std::vector<double> values, double q) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const double at = q * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

std::pair<double, double> Share::interval() const {
    if (count == 0) return {0, 1};
    constexpr double z = 1.959964; // 95 %
    const double n = count, p = value(), middle = p + z * z / (2 * n), spread = z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
    return {std::max(0.0, (middle - spread) / (1 + z * z / n)), std::min(1.0, (middle + spread) / (1 + z * z / n))};
}

Score judge(const std::vector<Judged> &judged) {
    std::vector<Case> cases;
    for (const Judged &one : judged) cases.push_back(case_of(one));
    return score_of(cases);
}

Score score_of(const std::vector<Case> &cases) {
    Score score;
    Tally all;
    std::map<std::string, Tally> soils, groups;
    score.cases = nlohmann::json::array();
    for (const Case &one : cases) {
        if (!one.error.empty()) ++score.failures;
        all.add(one);
        soils[one.soil].add(one);
        for (const std::string &group : one.groups) groups[group].add(one);
        const Reading &reading = one.reading;
        if (reading.category == "one" || reading.category == "clean")
            ++score.confusion[reading.truth.empty() ? "(clean)" : reading.truth][reading.said];
        score.cases.push_back(case_json(one));
    }
    score.lines = all.lines();
    for (const auto &[soil, tally] : soils) score.by_soil[soil] = tally.lines();
    for (const auto &[group, tally] : groups) score.by_group[group] = tally.lines();
    return score;
}

std::string table_text(const Score &score) {
    std::string text;
    char row[256];
    std::snprintf(row, sizeof row, "%-44s %7s  %-15s %5s  %-13s", "", "all", "95 % interval", "n", "goal");
    text += row;
    for (const auto *parts : {&score.by_soil, &score.by_group})
        for (const auto &[name, lines] : *parts) {
            std::snprintf(row, sizeof row, " %9s", name.c_str());
            text += row;
        }
    text += '\n';
    for (std::size_t i = 0; i < score.lines.size(); ++i) {
        const Line &line = score.lines[i];
        char interval[32] = "";
        if (line.is_share && line.count > 0) std::snprintf(interval, sizeof interval, "%.3f to %.3f", line.low, line.high);
        char value[16] = "-";
        if (line.count > 0) std::snprintf(value, sizeof value, "%.3f", line.value);
        const char *mark = line.goal.empty() || line.count == 0 ? "" : line.met ? " met" : " NOT";
        std::snprintf(row, sizeof row, "%-44s %7s  %-15s %5d  %-13s", line.title.c_str(), value, interval, line.count,
                      (line.goal + mark).c_str());
        text += row;
        text += part_text(score.by_soil, i) + part_text(score.by_group, i);
        text += '\n';
    }
    text += "\nhidden -> said (single effects and clean logs; only where they differ)\n";
    for (const auto &[hidden, said] : score.confusion)
        for (const auto &[what, count] : said)
            if (hidden != what) text += "  " + hidden + " -> " + what + ": " + std::to_string(count) + "\n";
    if (score.failures > 0) text += "the lab gave no answer on " + std::to_string(score.failures) + " logs\n";
    return text;
}

nlohmann::json table_json(const Score &score) {
    nlohmann::json json = {{"schema", "traction.bench_lab/1"},
                           {"lines", nlohmann::json::array()},
                           {"confusion", score.confusion},
                           {"cases", score.cases},
                           {"failures", score.failures}};
    for (const Line &line : score.lines) json["lines"].push_back(line_json(line));
    for (const auto &[soil, lines] : score.by_soil)
        for (const Line &line : lines) json["by_soil"][soil].push_back(line_json(line));
    for (const auto &[group, lines] : score.by_group)
        for (const Line &line : lines) json["by_group"][group].push_back(line_json(line));
    return json;
}

} // namespace traction::bench_lab
