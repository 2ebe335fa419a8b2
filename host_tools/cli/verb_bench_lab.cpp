// verb_bench_lab.cpp - traction bench lab: a blind campaign of the lab on sealed logs, and its table.
#include "progress.h"
#include "verbs.h"

#include "host_tools/bench_lab/answer.h"
#include "host_tools/bench_lab/campaign.h"
#include "host_tools/bench_lab/peers.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>

namespace traction::cli {

namespace {

struct Request {
    bench_lab::CampaignOptions campaign;
    bool time = false, peers = false, keep = false;
};

std::string own_path() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

void run(Request &request, Outcome &outcome) {
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
    options.traction = own_path();
    options.scenario = TRACTION_SOURCE_DIR "/scenarios/identification.toml";
    Progress progress("blind campaign", 3L * options.logs);
    options.step = [&] { progress.step(); };
    std::vector<bench_lab::SealedLog> logs = bench_lab::make_logs(options);
    bench_lab::answer_all(logs, options, [&](const bench_lab::SealedLog &one) {
        return bench_lab::ask_lab(one.log, bench_lab::campaign_model(options.generator, one.soil));
    });
    nlohmann::json peers;
    if (request.peers) peers = bench_lab::run_peers(logs, options);
    std::vector<bench_lab::Judged> judged = bench_lab::open_seals(logs); // only now
    bench_lab::add_floors(judged, logs, options, [&](const bench_lab::SealedLog &one, const nlohmann::json &seal) {
        return bench_lab::floor_with_truth(one.log, bench_lab::campaign_model(options.generator, one.soil), seal);
    });
    const bench_lab::Score score = bench_lab::judge(judged);
    std::printf("%d sealed logs, generator: %s, %g s each, seeds %lu to %lu\n\n%s", options.logs, options.generator.c_str(),
                options.duration_s, static_cast<unsigned long>(options.seed),
                static_cast<unsigned long>(options.seed) + static_cast<unsigned long>(options.logs) - 1,
                bench_lab::table_text(score).c_str());
    outcome.json = bench_lab::table_json(score);
    outcome.json["generator"] = options.generator;
    if (request.peers) {
        outcome.json["peers"] = bench_lab::judge_peers(peers, judged);
        std::printf("\n%s", bench_lab::peers_text(outcome.json["peers"]).c_str());
    }
    if (temporary)
        std::filesystem::remove_all(options.folder);
    else
        std::printf("\nlogs, seals and answers: %s\n", options.folder.c_str());
    if (score.failures > 0) outcome.exit_code = exit_negative;
}

} // namespace

void add_bench_lab(CLI::App &app, Outcome &outcome) {
    const auto request = std::make_shared<Request>();
    CLI::App *verb =
        bench_group(app)->add_subcommand("lab", "a blind campaign: sealed logs, the lab's answers, the seals opened, the table");
    bench_lab::CampaignOptions &options = request->campaign;
    verb->add_option("--logs", options.logs, "how many")->check(CLI::Range(1, 100000))->capture_default_str();
    verb->add_option("--jobs", options.jobs, "side by side")->check(CLI::Range(1, 256))->capture_default_str();
    verb->add_option("--seed", options.seed, "of the first log")->capture_default_str();
    verb->add_option("--duration", options.duration_s, "seconds each")->check(CLI::Range(20.0, 3600.0))->capture_default_str();
    verb->add_option("--generator", options.generator, "whose rover: independent (shares no code with the lab) or plant (the ODE world)")
        ->check(CLI::IsMember({"independent", "plant"}))
        ->capture_default_str();
    verb->add_option("--keep", options.folder, "keep logs, seals and answers in this folder")->type_name("FOLDER");
    verb->add_flag("--time", request->time, "measure the time a log: one job");
    verb->add_flag("--peers", request->peers, "PySINDy and SysIdentPy on the same logs (a .venv with pinned packages)");
    add_json_option(verb, outcome);
    verb->callback([request, &outcome] { run(*request, outcome); });
}

} // namespace traction::cli
