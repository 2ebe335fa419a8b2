#include "peers.h"

#include "answer.h"
#include "reading.h"

#include "host_tools/log/write_file.h"

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

// One program's answers to all logs, counted.
struct Row {
    Share first, exact, clean_named;
    double terms = 0;
    std::vector<double> seconds;

    void add(const std::string &category, bool first_right, bool is_exact, std::size_t named, bool flagged, double second) {
        terms += static_cast<double>(named);
        seconds.push_back(second);
        if (category == "clean") clean_named.add(named > 0 || flagged);
        if (category != "one") return;
        first.add(first_right);
        exact.add(is_exact);
    }
    nlohmann::json json() const {
        const auto line = [](const Share &s) {
            return nlohmann::json{{"value", s.value()}, {"count", s.count}, {"low", s.interval().first}, {"high", s.interval().second}};
        };
        const double logs = std::max(1.0, static_cast<double>(seconds.size()));
        return {{"right_first", line(first)},
                {"exact_model", line(exact)},
                {"clean_named", line(clean_named)},
                {"terms_a_log", terms / logs},
                {"seconds_median", quantile(seconds, 0.5)},
                {"seconds_p95", quantile(seconds, 0.95)}};
    }
};

} // namespace

nlohmann::json run_peers(const std::vector<SealedLog> &logs, const CampaignOptions &options) {
    const std::string root = TRACTION_SOURCE_DIR, script = root + "/tests/bench/lab/run_peers.sh", &folder = options.folder;
    if (!std::filesystem::exists(script)) return {{"skipped", "tests/bench/lab is not there (an installed program has no peers)"}};
    const std::string list = folder + "/logs.json", answer = folder + "/peers.json", said = folder + "/peers.txt";
    nlohmann::json files = nlohmann::json::array();
    for (const SealedLog &one : logs) files.push_back({{"log", one.log}, {"model", one.model}});
    log::write_file(files.dump(1) + '\n', list);
    std::filesystem::remove(answer);
    const std::string command = "sh " + quoted(script) + " " + quoted(list) + " " + quoted(answer) + " " + quoted(options.traction) +
                                " > " + quoted(said) + " 2>&1";
    const int status = std::system(command.c_str());
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

nlohmann::json judge_peers(const nlohmann::json &answers, const std::vector<Judged> &judged) {
    if (answers.contains("skipped")) return answers;
    nlohmann::json rows;
    for (const auto &[name, peer] : answers.at("peers").items()) {
        Row row;
        for (std::size_t i = 0; i < judged.size(); ++i) {
            const nlohmann::json &said = peer.at("answers").at(i), &hidden = judged[i].seal.at("effects"); // effect names, strongest first
            const bool right = !said.empty() && !hidden.empty() && said.at(0) == hidden.at(0).at("name");
            row.add(judged[i].seal.at("category"), right, right && said.size() == 1, said.size(), false, peer.at("seconds").at(i));
        }
        rows[name] = row.json();
        rows[name]["use"] = peer.at("use");
    }
    Row lab;
    for (const Judged &one : judged) {
        const Reading r = read_case(one.seal, one.result);
        const bool exact = r.named_right.size() == 1 && r.named_right.front() && !r.flagged_unknown;
        lab.add(r.category, r.first_right, exact, r.named_right.size(), r.flagged_unknown, one.seconds);
    }
    rows["lab"] = lab.json();
    return rows;
}

std::string peers_text(const nlohmann::json &rows) {
    if (rows.contains("skipped")) return "peers skipped: " + rows.at("skipped").get<std::string>() + "\n";
    std::string text = "on the same logs              right first   exact model   named on clean   terms a log   s a log   (95 %)\n";
    char row[160];
    for (const auto &[name, one] : rows.items()) {
        std::snprintf(row, sizeof row, "%-28s %12.2f %13.2f %16.2f %13.1f %9.2f %8.2f\n", name.c_str(),
                      one.at("right_first").at("value").get<double>(), one.at("exact_model").at("value").get<double>(),
                      one.at("clean_named").at("value").get<double>(), one.at("terms_a_log").get<double>(),
                      one.at("seconds_median").get<double>(), one.at("seconds_p95").get<double>());
        text += row;
    }
    return text;
}

} // namespace traction::bench_lab
