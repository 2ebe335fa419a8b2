// lab_bench - a blind campaign of the lab on sealed logs: made, answered, the seals opened, the table. Run by `traction bench lab`.
//
// Usage: lab_bench --traction PROGRAM [--logs N] [--jobs N] [--seed N] [--duration S] [--generator independent|apart|fleet|strange|plant]
//                  [--category clean|one|two|outside] [--keep FOLDER] [--time] [--peers] [--json FILE]. Exit 1 when a log could not be
//                  answered.
#include "host_tools/bench_lab/answer.h"
#include "host_tools/bench_lab/campaign.h"
#include "host_tools/bench_lab/peers.h"
#include "host_tools/cli/progress.h"
#include "host_tools/log/write_file.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <system_error>

using namespace traction;

namespace {

struct Request {
    bench_lab::CampaignOptions campaign;
    bool time = false, peers = false;
    std::string json;
};

// False, and said, where the command line cannot be meant.
bool read_request(int argc, char **argv, Request &request) {
    bench_lab::CampaignOptions &options = request.campaign;
    const std::map<std::string, std::function<void(const std::string &)>> valued = {
        {"--traction", [&](const std::string &word) { options.traction = word; }},
        {"--logs", [&](const std::string &word) { options.logs = std::stoi(word); }},
        {"--jobs", [&](const std::string &word) { options.jobs = std::stoi(word); }},
        {"--seed", [&](const std::string &word) { options.seed = std::stoull(word); }},
        {"--duration", [&](const std::string &word) { options.duration_s = std::stod(word); }},
        {"--generator", [&](const std::string &word) { options.generator = word; }},
        {"--category", [&](const std::string &word) { options.category = word; }},
        {"--keep", [&](const std::string &word) { options.folder = word; }},
        {"--json", [&](const std::string &word) { request.json = word; }},
    };
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const auto one = valued.find(word);
        if (word == "--time") {
            request.time = true;
        } else if (word == "--peers") {
            request.peers = true;
        } else if (one != valued.end() && i + 1 < argc) {
            try {
                one->second(argv[++i]);
            } catch (const std::logic_error &) { // what std::stoi and its like say of a word that is no number
                std::fprintf(stderr, "lab_bench: %s wants a number, not '%s'\n", word.c_str(), argv[i]);
                return false;
            }
        } else {
            std::fprintf(stderr, "lab_bench: %s is not known or lacks its value; traction bench lab --help tells the options\n", argv[i]);
            return false;
        }
    }
    if (!options.traction.empty()) return true;
    std::fputs("lab_bench: --traction PROGRAM is missing (traction bench lab gives it)\n", stderr);
    return false;
}

int run(Request &request) {
    bench_lab::CampaignOptions &options = request.campaign;
    if (request.time) options.jobs = 1; // one core, nothing beside it
    const bool temporary = options.folder.empty();
    if (temporary) {
        std::string pattern = (std::filesystem::temp_directory_path() / "traction_bench_XXXXXX").string();
        if (mkdtemp(pattern.data()) == nullptr)
            throw std::filesystem::filesystem_error("cannot make a folder for the campaign", pattern,
                                                    std::error_code(errno, std::generic_category()));
        options.folder = pattern;
    }
    options.lab_generate = TRACTION_LAB_GENERATE;
    options.scenario = TRACTION_SOURCE_DIR "/scenarios/identification.toml";
    cli::Progress progress("blind campaign", 3L * options.logs);
    options.step = [&] { progress.step(); };
    std::vector<bench_lab::SealedLog> logs = bench_lab::make_logs(options);
    bench_lab::answer_all(logs, options, [](const bench_lab::SealedLog &one) { return bench_lab::ask_lab(one.log, one.model, one.map); });
    nlohmann::json peers;
    if (request.peers) peers = bench_lab::run_peers(logs, options);
    std::vector<bench_lab::Judged> judged = bench_lab::open_seals(logs); // only now
    bench_lab::add_floors(judged, logs, options, [](const bench_lab::SealedLog &one, const nlohmann::json &seal) {
        try {
            return bench_lab::fit_with_truth(one, seal);
        } catch (const std::exception &) { // no floor for this log; its answer counts all the same
            return bench_lab::TruthFit{};
        }
    });
    const bench_lab::Score score = bench_lab::judge(judged);
    char length[32] = "60 to 300"; // these draw their own
    if (options.generator != "fleet" && options.generator != "strange") std::snprintf(length, sizeof length, "%g", options.duration_s);
    std::printf("%d sealed logs, generator: %s%s%s, %s s each, seeds %lu to %lu\n\n%s", options.logs, options.generator.c_str(),
                options.category.empty() ? "" : ", category: ", options.category.c_str(), length, static_cast<unsigned long>(options.seed),
                static_cast<unsigned long>(options.seed) + static_cast<unsigned long>(options.logs) - 1,
                bench_lab::table_text(score).c_str());
    nlohmann::json json = bench_lab::table_json(score);
    json["generator"] = options.generator;
    if (request.peers) {
        json["peers"] = bench_lab::judge_peers(peers, judged);
        std::printf("\n%s", bench_lab::peers_text(json["peers"]).c_str());
    }
    if (temporary)
        std::filesystem::remove_all(options.folder);
    else
        std::printf("\nlogs, seals and answers: %s\n", options.folder.c_str());
    if (!request.json.empty()) log::write_file(json.dump(1) + "\n", request.json);
    return score.failures > 0 ? 1 : 0;
}

} // namespace

int main(int argc, char **argv) {
    Request request;
    if (!read_request(argc, argv, request)) return 2;
    try {
        return run(request);
    } catch (const std::filesystem::filesystem_error &error) {
        std::fprintf(stderr, "lab_bench: %s\n", error.what());
        return 4;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "lab_bench: %s\n", error.what());
        return 3;
    }
}
