// verb_bench_lab.cpp - traction bench lab: a blind campaign of the lab on sealed logs, and its table (tests/bench/lab_bench).
#include "bench_program.h"
#include "campaign_program.h"
#include "host_tools/bench_lab/campaign.h"
#include "host_tools/log/write_file.h"
#include "verbs.h"

#include <cstdint>
#include <filesystem>
#include <memory>

#include <unistd.h>

namespace traction::cli {

namespace {

struct BenchRequest {
    int logs = 250, jobs = 2;
    std::uint64_t seed = 1000;
    double duration_s = 120;
    std::string generator = "independent", category, folder, out, scheduler;
    bool time = false, peers = false;
};

std::vector<std::string> arguments(const BenchRequest &request) {
    std::vector<std::string> out = {"--traction",  own_program(),
                                    "--logs",      std::to_string(request.logs),
                                    "--jobs",      std::to_string(request.jobs),
                                    "--seed",      std::to_string(request.seed),
                                    "--duration",  std::to_string(request.duration_s),
                                    "--generator", request.generator};
    if (!request.category.empty()) out.insert(out.end(), {"--category", request.category});
    if (!request.folder.empty()) out.insert(out.end(), {"--keep", request.folder});
    if (request.time) out.push_back("--time");
    if (request.peers) out.push_back("--peers");
    return out;
}

// The same logs as a campaign (docs/campaign.md): a row a log, which goes on where it was stopped.
void run_as_campaign(const BenchRequest &request, Outcome &outcome) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("traction_bench_lab_" + std::to_string(getpid()) + ".toml");
    std::string text = "title = \"bench lab, " + request.generator + "\"\nkind = \"lab_bench\"\ngenerator = \"" + request.generator +
                       "\"\nseed = " + std::to_string(request.seed) + "\nlogs = " + std::to_string(request.logs) +
                       "\nduration_s = " + std::to_string(request.duration_s) + "\n";
    if (!request.category.empty()) text += "category = \"" + request.category + "\"\n";
    log::write_file(text, file.string());
    std::vector<std::string> arguments = {file.string(), "--out", request.out};
    if (request.scheduler.empty())
        arguments.insert(arguments.end(), {"--workers", std::to_string(request.jobs)});
    else
        arguments.insert(arguments.end(), {"--scheduler", request.scheduler});
    run_campaign(std::move(arguments), "--table-json", outcome);
    std::filesystem::remove(file);
}

} // namespace

Verb verb_bench_lab() {
    const auto request = std::make_shared<BenchRequest>();
    return {
        .name = "bench lab",
        .summary = "a blind campaign: sealed logs, the lab's answers, the seals opened, the table",
        .options = {{.name = "--logs", .into = &request->logs, .help = "how many", .shows_default = true, .range = Range{1, 100000}},
                    {.name = "--jobs", .into = &request->jobs, .help = "side by side", .shows_default = true, .range = Range{1, 256}},
                    {.name = "--seed", .into = &request->seed, .help = "of the first log", .shows_default = true},
                    {.name = "--duration",
                     .into = &request->duration_s,
                     .help = "seconds each",
                     .value = "S",
                     .shows_default = true,
                     .range = Range{20, 3600}},
                    {.name = "--generator",
                     .into = &request->generator,
                     .help = "whose rover: independent (shares no code with the lab; its wheels are alike), apart (each wheel drawn for "
                             "itself), fleet (and sizes, soils, sensors, drives), strange (and loops, noise, what is logged), bent (the "
                             "fleet on grounds whose curve over slip no sheet names), plant (the ODE world)",
                     .shows_default = true,
                     .one_of = {"independent", "apart", "fleet", "strange", "bent", "plant"}},
                    {.name = "--category",
                     .into = &request->category,
                     .help = "hide this alone: clean, one, two or outside; not for the plant",
                     .one_of = {"clean", "one", "two", "outside"}},
                    {.name = "--keep",
                     .into = &request->folder,
                     .help = "keep logs, seals and answers in this folder",
                     .value = "FOLDER",
                     .kind = Kind::folder},
                    {.name = "--time", .into = &request->time, .help = "measure the time a log: one job"},
                    {.name = "--out",
                     .into = &request->out,
                     .help =
                         "as a campaign: a row a log into this folder, written as they come; the same command goes on where it was stopped",
                     .value = "FOLDER",
                     .kind = Kind::folder,
                     .excludes = {"--keep", "--time", "--peers"}},
                    {.name = "--scheduler",
                     .into = &request->scheduler,
                     .help = "of a campaign: a Dask scheduler, tcp://HOST:PORT, whose workers make and answer the logs",
                     .value = "ADDRESS",
                     .needs = {"--out"},
                     .excludes = {"--jobs", "--keep", "--time", "--peers"}},
                    {.name = "--peers",
                     .into = &request->peers,
                     .help = "PySINDy and SysIdentPy on the same logs (a .venv with pinned packages)"}},
        .run = [request](Outcome &outcome) {
            if (!request->category.empty() && request->generator == "plant")
                throw UsageError("--category is not for the plant, which hides by seed; to mend: leave it out, or take --generator apart");
            if (request->peers && bench_lab::draws_its_own(request->generator))
                throw UsageError("--peers read no maps, which these logs need; to mend: take --generator independent or apart");
            if (!request->out.empty())
                run_as_campaign(*request, outcome);
            else
                run_bench("lab_bench", arguments(*request), outcome);
        }};
}

} // namespace traction::cli
