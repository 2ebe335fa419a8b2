#include "peers.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace traction::bench_lab {

namespace {

std::string quoted(const std::string &text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

} // namespace

nlohmann::json run_peers(const std::vector<SealedLog> &logs, const std::string &folder) {
    const std::string root = TRACTION_SOURCE_DIR, script = root + "/tests/bench/lab/run_peers.sh";
    if (!std::filesystem::exists(script)) return {{"skipped", "tests/bench/lab is not there (an installed program has no peers)"}};
    const std::string list = folder + "/logs.json", answer = folder + "/peers.json", said = folder + "/peers.txt";
    nlohmann::json files = nlohmann::json::array();
    for (const SealedLog &one : logs) files.push_back({{"log", one.log}, {"soil", one.soil}});
    std::ofstream(list) << files.dump(1) << '\n';
    std::filesystem::remove(answer);
    const int status = std::system(("sh " + quoted(script) + " " + quoted(list) + " " + quoted(answer) + " > " + quoted(said) + " 2>&1").c_str());
    std::ifstream file(answer);
    if (status != 0 || !file.is_open()) {
        std::ifstream text(said);
        std::string line, last = "no reason given";
        while (std::getline(text, line))
            if (!line.empty()) last = line;
        return {{"skipped", last}};
    }
    return nlohmann::json::parse(file);
}

nlohmann::json judge_peers(const nlohmann::json &answers, const std::vector<SealedLog> &logs) {
    if (answers.contains("skipped")) return answers;
    const std::vector<Judged> opened = open_seals(logs);
    nlohmann::json judged;
    for (const auto &[name, peer] : answers.at("peers").items()) {
        Share first, exact, clean_named;
        double terms = 0;
        for (std::size_t i = 0; i < opened.size(); ++i) {
            const nlohmann::json &said = peer.at("answers").at(i); // effect names, strongest first
            const std::string category = opened[i].seal.at("category");
            terms += static_cast<double>(said.size()) / static_cast<double>(opened.size());
            if (category == "clean") clean_named.add(!said.empty());
            if (category != "one") continue;
            const std::string truth = opened[i].seal.at("effects").at(0).at("name");
            first.add(!said.empty() && said.at(0) == truth);
            exact.add(said.size() == 1 && said.at(0) == truth);
        }
        const auto line = [](const Share &s) {
            return nlohmann::json{{"value", s.value()}, {"count", s.count}, {"low", s.interval().first}, {"high", s.interval().second}};
        };
        judged[name] = {{"right_first", line(first)}, {"exact_model", line(exact)}, {"clean_named", line(clean_named)}, {"terms_a_log", terms},
                        {"seconds_a_log", peer.at("seconds_a_log")}, {"use", peer.at("use")}};
    }
    return judged;
}

std::string peers_text(const nlohmann::json &judged) {
    if (judged.contains("skipped")) return "peers skipped: " + judged.at("skipped").get<std::string>() + "\n";
    std::string text = "peers on the same logs        right first   exact model   named on clean   terms a log   s a log\n";
    char row[160];
    for (const auto &[name, one] : judged.items()) {
        std::snprintf(row, sizeof row, "%-28s %12.2f %13.2f %16.2f %13.1f %9.2f\n", name.c_str(), one.at("right_first").at("value").get<double>(),
                      one.at("exact_model").at("value").get<double>(), one.at("clean_named").at("value").get<double>(),
                      one.at("terms_a_log").get<double>(), one.at("seconds_a_log").get<double>());
        text += row;
    }
    return text;
}

} // namespace traction::bench_lab
