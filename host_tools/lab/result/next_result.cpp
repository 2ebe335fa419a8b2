#include "next_result.h"

#include "append.h"
#include "host_tools/lab/next/manoeuvre.h"
#include "words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace traction::lab {

namespace {

std::string either_of(const std::vector<std::string> &members) {
    std::string text;
    for (const std::string &m : members) text += (text.empty() ? "" : " or ") + m;
    return members.size() == 1 ? text + ", is it there" : text;
}

const char *status_words(const Question &q) {
    const std::string &status = q.status;
    if (status == "told") return q.members.size() > 1 ? "this log tells: traction diagnose" : "this log can show it: traction diagnose";
    if (status == "answered") return "answered by this drive";
    if (status == "never") return "not by driving";
    return "by another drive";
}

} // namespace

nlohmann::json next_json(const NextExperiment &next) {
    if (next.questions.empty()) return nullptr;
    using nlohmann::json;
    json questions = json::array(), tried = json::array();
    std::set<std::string> separates;
    for (const Question &q : next.questions) {
        json one = {{"members", q.members}, {"kind", q.members.size() > 1 ? "which" : "whether"}, {"status", q.status}};
        if (next.predicted) one["d_before"] = q.before, one["d_after"] = q.after, one["d_best_single"] = q.best;
        if (!q.measure.empty()) one["measure"] = q.measure;
        questions.push_back(one);
        if (q.status == "answered" || !next.predicted) separates.insert(q.members.begin(), q.members.end());
    }
    for (const Tried &t : next.tried) {
        json one = {{"title", t.title}};
        if (next.predicted) one["duration_s"] = t.duration_s, one["d_least"] = t.least, one["answered"] = t.answered;
        tried.push_back(one);
    }
    json out = {{"version", 2},           {"predicted", next.predicted}, {"title", next.title}, {"separates", separates},
                {"questions", questions}, {"manoeuvres", tried},         {"notes", next.notes}};
    out["scenario_toml"] = next.scenario_toml.empty() ? json(nullptr) : json(next.scenario_toml);
    if (!next.why_not.empty()) out["why_not"] = next.why_not;
    if (!next.scenario_toml.empty()) out["duration_s"] = next.duration_s;
    return out;
}

namespace {

// Every manoeuvre alone, and what each question's d' was and becomes.
std::string next_statistics(const NextExperiment &next) {
    std::string text;
    std::vector<Tried> order = next.tried;
    std::stable_sort(order.begin(), order.end(), [](const Tried &a, const Tried &b) {
        return a.answered != b.answered ? a.answered > b.answered : a.least / a.duration_s > b.least / b.duration_s;
    });
    if (!order.empty()) append(text, "%-66s %7s %9s %9s\n", "manoeuvre alone", "s", "answers", "least d'");
    for (std::size_t i = 0; i < std::min<std::size_t>(5, order.size()); ++i)
        append(text, "%-66s %7.0f %9d %9.2f\n", order[i].title.c_str(), order[i].duration_s, order[i].answered, order[i].least);
    append(text, "%-58s %9s %9s\n", "question", "d' before", "d' after");
    for (const Question &q : next.questions) append(text, "%-58s %9.2f %9.2f\n", either_of(q.members).c_str(), q.before, q.after);
    return text;
}

} // namespace

std::string next_text(const NextExperiment &next, bool details) {
    std::string text;
    if (next.questions.empty()) return "nothing is left open: no manoeuvre is needed\n";
    for (const std::string &n : next.notes) text += wrapped("note: " + n, 6);
    if (!next.predicted) {
        text += wrapped("no numbers: the simulated rover cannot stand in for this machine (" + next.why_not + ").");
        for (const Question &q : next.questions) text += wrapped("open: " + either_of(q.members), 6);
        text += next.tried.empty() ? "no manoeuvre of the library is known for these\n" : "manoeuvres known to help:\n";
        for (const Tried &t : next.tried) text += wrapped("  " + t.title, 4);
        return text;
    }
    text += "what this log leaves open:\n";
    for (const Question &q : next.questions) {
        const std::string question = "  " + padded(either_of(q.members), 52) + " ", words = status_words(q);
        text += question.size() + words.size() <= terminal_columns ? question + words + "\n"
                                                                   : wrapped("  " + either_of(q.members) + ": " + words, 4);
    }
    for (const Question &q : next.questions)
        if (q.status == "never") {
            std::string spread;
            append(spread, "%s: cannot be separated by driving (d' stays %.2f); %s", either_of(q.members).c_str(),
                   std::max(q.best, q.after), q.measure.c_str());
            text += wrapped(spread, 2);
        }
    if (details) text += next_statistics(next);
    if (next.scenario_toml.empty()) return text + "no drive is proposed\n";
    std::string drive;
    append(drive, "next: %s (%.0f s)", next.title.c_str(), next.duration_s);
    return text + wrapped(drive, 6);
}

} // namespace traction::lab
