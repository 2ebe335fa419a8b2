// lab_bench - a blind campaign of the lab on sealed logs: made, answered, the seals opened, the table. Run by `traction bench lab`.
//
// Usage: lab_bench --traction PROGRAM [--logs N] [--jobs N] [--seed N] [--duration S] [--generator
// independent|apart|fleet|strange|bent|plant]
//                  [--category clean|one|two|outside] [--keep FOLDER] [--time] [--peers] [--json FILE]
//        lab_bench --traction PROGRAM --row [--seed N ...]: one log, its row (host_tools/bench_lab/row.h) as a line on standard output
//        lab_bench --judge FILE [--logs N --seed N ...] [--json FILE]: the table of such rows, a line each; the options are the campaign's
// Exit 1 when a log could not be answered.
#include "host_tools/bench_lab/peers.h"
#include "host_tools/bench_lab/row.h"
#include "host_tools/cli/progress.h"
#include "host_tools/log/write_file.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include <sys/prctl.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <system_error>

using namespace traction;

namespace {

struct Request {
    bench_lab::CampaignOptions campaign;
    bool time = false, peers = false, row = false;
    std::string json, judge;
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
        {"--judge", [&](const std::string &word) { request.judge = word; }},
    };
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const auto one = valued.find(word);
        if (word == "--time") {
            request.time = true;
        } else if (word == "--peers") {
            request.peers = true;
        } else if (word == "--row") {
            request.row = true;
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
    if (!options.traction.empty() || !request.judge.empty()) return true;
    std::fputs("lab_bench: --traction PROGRAM is missing (traction bench lab gives it)\n", stderr);
    return false;
}

// A folder of its own where none is to be kept; false: the user's.
bool make_folder(bench_lab::CampaignOptions &options) {
    if (!options.folder.empty()) return false;
    std::string pattern = (std::filesystem::temp_directory_path() / "traction_bench_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
        throw std::filesystem::filesystem_error("cannot make a folder for the campaign", pattern,
                                                std::error_code(errno, std::generic_category()));
    options.folder = pattern;
    return true;
}

// `logs`: how many the table has, of options.logs.
void print_table(const bench_lab::CampaignOptions &options, std::size_t logs, const bench_lab::Score &score) {
    char length[32] = "60 to 300"; // these draw their own
    if (!bench_lab::draws_its_own(options.generator)) std::snprintf(length, sizeof length, "%g", options.duration_s);
    const std::string of = logs == static_cast<std::size_t>(options.logs) ? "" : " of " + std::to_string(options.logs);
    std::printf("%zu%s sealed logs, generator: %s%s%s, %s s each, seeds %lu to %lu\n\n%s", logs, of.c_str(), options.generator.c_str(),
                options.category.empty() ? "" : ", category: ", options.category.c_str(), length, static_cast<unsigned long>(options.seed),
                static_cast<unsigned long>(options.seed) + static_cast<unsigned long>(options.logs) - 1,
                bench_lab::table_text(score).c_str());
}

int run(Request &request) {
    bench_lab::CampaignOptions &options = request.campaign;
    if (request.time) options.jobs = 1; // one core, nothing beside it
    const bool temporary = make_folder(options);
    cli::Progress progress("blind campaign", 3L * options.logs);
    options.step = [&] { progress.step(); };
    nlohmann::json peers;
    const std::vector<bench_lab::Judged> judged = bench_lab::run_blind(options, [&](const std::vector<bench_lab::SealedLog> &logs) {
        if (request.peers) peers = bench_lab::run_peers(logs, options);
    });
    const bench_lab::Score score = bench_lab::judge(judged);
    print_table(options, judged.size(), score);
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

// One log, in a folder of its own that is removed. A log that the lab cannot answer is a row too, and exit 0: the campaign counts it.
int run_row(bench_lab::CampaignOptions &options) {
    prctl(PR_SET_PDEATHSIG, SIGKILL); // whoever asked is gone: nobody would read the answer
    options.logs = options.jobs = 1;
    const bool temporary = make_folder(options);
    std::string row;
    try {
        row = bench_lab::row_json(bench_lab::run_blind(options).front()).dump();
    } catch (...) {
        if (temporary) std::filesystem::remove_all(options.folder);
        throw;
    }
    if (temporary) std::filesystem::remove_all(options.folder);
    std::printf("%s\n", row.c_str());
    return 0;
}

int judge_rows(const Request &request) {
    std::ifstream lines(request.judge);
    if (!lines) throw std::filesystem::filesystem_error("cannot read", request.judge, std::error_code(errno, std::generic_category()));
    const std::vector<bench_lab::Case> cases = bench_lab::read_rows(lines);
    const bench_lab::Score score = bench_lab::score_of(cases);
    print_table(request.campaign, cases.size(), score);
    nlohmann::json json = bench_lab::table_json(score);
    json["generator"] = request.campaign.generator;
    if (!request.json.empty()) log::write_file(json.dump(1) + "\n", request.json);
    return score.failures > 0 ? 1 : 0;
}

} // namespace

int main(int argc, char **argv) {
    Request request;
    if (!read_request(argc, argv, request)) return 2;
    try {
        request.campaign.lab_generate = TRACTION_LAB_GENERATE;
        request.campaign.scenario = TRACTION_SOURCE_DIR "/scenarios/identification.toml";
        if (!request.judge.empty()) return judge_rows(request);
        return request.row ? run_row(request.campaign) : run(request);
    } catch (const std::filesystem::filesystem_error &error) {
        std::fprintf(stderr, "lab_bench: %s\n", error.what());
        return 4;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "lab_bench: %s\n", error.what());
        return 3;
    }
}
