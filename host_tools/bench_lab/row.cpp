#include "row.h"

#include "answer.h"

#include <istream>

namespace traction::bench_lab {

namespace {

using nlohmann::json;

json or_null(const json &from, const char *key) { return from.contains(key) ? from.at(key) : json(nullptr); }
json or_empty(const json &from, const char *key) { return from.contains(key) ? from.at(key) : json::array(); }

json intervals(const json &answer) {
    json list = json::array();
    for (const json &one : or_empty(answer, "accepted"))
        list.push_back({{"effect", one.at("effect")}, {"wheel", one.at("wheel")}, {"parameters", one.at("parameters")}});
    return list;
}

} // namespace

std::vector<Judged> run_blind(const CampaignOptions &options, const std::function<void(const std::vector<SealedLog> &)> &before_seals) {
    std::vector<SealedLog> logs = make_logs(options);
    answer_all(logs, options, [](const SealedLog &one) { return ask_lab(one.log, one.model, one.map); });
    if (before_seals) before_seals(logs);
    std::vector<Judged> judged = open_seals(logs); // only now
    add_floors(judged, logs, options, [](const SealedLog &one, const json &seal) {
        try {
            return fit_with_truth(one, seal);
        } catch (const std::exception &) { // no floor for this log; its answer counts all the same
            return TruthFit{};
        }
    });
    return judged;
}

json row_json(const Judged &one) {
    json judged = case_json(case_of(one));
    judged.erase("seconds");
    const json verdict = one.result.value("verdict", json::object()), ladder = or_empty(one.result, "ladder");
    return {{"soil", judged["soil"]},
            {"hidden_category", judged["category"]},
            {"hidden", judged["hidden"]},
            {"verdict", or_null(verdict, "kind")},
            {"text", or_null(verdict, "text")},
            {"named", or_empty(verdict, "effects")},
            {"classes", or_empty(one.result, "classes")},
            {"intervals", intervals(one.result)},
            {"error_before", ladder.empty() ? json(nullptr) : ladder.front().at("heldout")},
            {"error_after", ladder.empty() ? json(nullptr) : ladder.back().at("heldout")},
            {"floor", or_null(one.result, "floor_with_truth")},
            {"detectability", or_null(one.result, "detectability_with_truth")},
            {"judged", judged},
            {"seconds", one.seconds},
            {"error", or_null(one.result, "error")}};
}

std::vector<Case> read_rows(std::istream &lines) {
    std::vector<Case> cases;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        try {
            const json row = json::parse(line);
            json judged = row.at("judged");
            judged["seconds"] = row.at("seconds");
            cases.push_back(read_case_json(judged));
        } catch (const json::exception &error) {
            throw std::runtime_error("line " + std::to_string(number) + " is no row of this bench (" + error.what() +
                                     "); to mend: give what --row wrote");
        }
    }
    return cases;
}

} // namespace traction::bench_lab
