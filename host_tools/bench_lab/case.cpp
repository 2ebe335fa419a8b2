#include "score.h"

namespace traction::bench_lab {

namespace {

// Size of the rover and how its sensors reach the log; nothing where the seal tells neither.
std::vector<std::string> groups_of(const nlohmann::json &seal) {
    std::vector<std::string> groups;
    if (seal.contains("size")) groups.push_back(seal["size"].get<std::string>());
    if (!seal.contains("chain")) return groups;
    const nlohmann::json &chain = seal["chain"];
    const bool plain = chain.value("accel_late_s", 0.0) == 0 && !chain.value("current_at_end", false) &&
                       !chain.value("angle_only", false) && chain.value("jitter_s", 0.0) == 0 && !chain.value("foreign", false);
    groups.push_back(plain ? "chain 1" : "chain 2");
    return groups;
}

} // namespace

Case case_of(const Judged &judged) {
    Case one;
    one.log = judged.log;
    one.soil = judged.seal.value("soil", std::string("?"));
    one.groups = groups_of(judged.seal);
    one.reading = read_case(judged.seal, judged.result);
    one.seed = judged.seal.value("seed", 0);
    one.hidden = judged.seal.value("effects", nlohmann::json::array());
    one.duration_s = judged.seal.value("duration_s", 120.0);
    one.seconds = judged.seconds;
    if (judged.result.contains("error")) one.error = judged.result["error"].get<std::string>();
    return one;
}

nlohmann::json case_json(const Case &one) {
    nlohmann::json entry = reading_json(one.reading);
    entry["log"] = one.log;
    entry["soil"] = one.soil;
    entry["groups"] = one.groups;
    entry["seed"] = one.seed;
    entry["duration_s"] = one.duration_s;
    entry["seconds"] = one.seconds;
    entry["hidden"] = one.hidden;
    if (!one.error.empty()) entry["error"] = one.error;
    return entry;
}

Case read_case_json(const nlohmann::json &entry) {
    Case one;
    one.reading = read_reading(entry);
    one.log = entry.at("log").get<std::string>();
    one.soil = entry.at("soil").get<std::string>();
    one.groups = entry.at("groups").get<std::vector<std::string>>();
    one.seed = entry.at("seed");
    one.duration_s = entry.at("duration_s").get<double>();
    one.seconds = entry.at("seconds").get<double>();
    one.hidden = entry.at("hidden");
    one.error = entry.value("error", std::string());
    return one;
}

} // namespace traction::bench_lab
