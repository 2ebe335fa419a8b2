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

std::string log_length(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", seconds);
    return text;
}

std::string own_path() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

void run(Request &request, Outcome &outcome) {
    bench_lab::CampaignOptions &options = request.campaign;
    if (!options.category.empty() && options.generator == "plant")
        throw UsageError("--category is not for the plant: it hides by seed; to mend: leave it out, or --generator apart");
    if (request.peers && options.generator == "fleet")
        throw UsageError("--peers: they read no maps, which the fleet's logs need; to mend: --generator independent or apart");
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
    bench_lab::answer_all(logs, options, [&](const bench_lab::SealedLog &one) { return bench_lab::ask_lab(one.log, one.model, one.map); });
    nlohmann::json peers;
    if (request.peers) peers = bench_lab::run_peers(logs, options);
    std::vector<bench_lab::Judged> judged = bench_lab::open_seals(logs); // only now
    bench_lab::add_floors(judged, logs, options, [&](const bench_lab::SealedLog &one, const nlohmann::json &seal) {
        try {
            return bench_lab::fit_with_truth(one, seal);
        } catch (const std::exception &) { // no floor for this log; its answer counts all the same
            return bench_lab::TruthFit{};
        }
    });
    const bench_lab::Score score = bench_lab::judge(judged);
    const std::string length = options.generator == "fleet" ? "60 to 300" : log_length(options.duration_s);
    std::printf(
        "%d sealed logs, generator: %s%s%s, %s s each, seeds %lu to %lu\n\n%s", options.logs, options.generator.c_str(),
        options.category.empty() ? "" : ", category: ", options.category.c_str(), length.c_str(), static_cast<unsigned long>(options.seed),
        static_cast<unsigned long>(options.seed) + static_cast<unsigned long>(options.logs) - 1, bench_lab::table_text(score).c_str());
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

Verb verb_bench_lab() {
    const auto request = std::make_shared<Request>();
    bench_lab::CampaignOptions &options = request->campaign;
    return {
        .name = "bench lab",
        .summary = "a blind campaign: sealed logs, the lab's answers, the seals opened, the table",
        .options = {{.name = "--logs", .into = &options.logs, .help = "how many", .shows_default = true, .range = Range{1, 100000}},
                    {.name = "--jobs", .into = &options.jobs, .help = "side by side", .shows_default = true, .range = Range{1, 256}},
                    {.name = "--seed", .into = &options.seed, .help = "of the first log", .shows_default = true},
                    {.name = "--duration",
                     .into = &options.duration_s,
                     .help = "seconds each",
                     .value = "S",
                     .shows_default = true,
                     .range = Range{20, 3600}},
                    {.name = "--generator",
                     .into = &options.generator,
                     .help = "whose rover: independent (shares no code with the lab; its wheels are alike), apart (each wheel drawn for "
                             "itself), fleet (and sizes, soils, sensors, drives), plant (the ODE world)",
                     .shows_default = true,
                     .one_of = {"independent", "apart", "fleet", "plant"}},
                    {.name = "--category",
                     .into = &options.category,
                     .help = "hide this alone: clean, one, two or outside; not for the plant",
                     .one_of = {"clean", "one", "two", "outside"}},
                    {.name = "--keep",
                     .into = &options.folder,
                     .help = "keep logs, seals and answers in this folder",
                     .value = "FOLDER",
                     .kind = Kind::folder},
                    {.name = "--time", .into = &request->time, .help = "measure the time a log: one job"},
                    {.name = "--peers",
                     .into = &request->peers,
                     .help = "PySINDy and SysIdentPy on the same logs (a .venv with pinned packages)"}},
        .run = [request](Outcome &outcome) { run(*request, outcome); }};
}

} // namespace traction::cli
