// verb_campaign.cpp - traction campaign FILE.toml: many drives into one table.
#include "campaign_program.h"
#include "verbs.h"

#include <filesystem>
#include <memory>
#include <utility>

namespace traction::cli {

namespace {

struct CampaignRequest {
    std::string file, out, scheduler, plot;
    int workers = 0;
    bool status = false, dry_run = false, workers_given = false;
};

std::string figure_ending(const std::string &path) {
    const std::string ending = std::filesystem::path(path).extension().string();
    return ending == ".svg" || ending == ".png" ? "" : "must end in .svg or .png";
}

void run_campaign(const CampaignRequest &request, Outcome &outcome) {
    if (request.file.empty() && !request.status && request.plot.empty()) throw UsageError("FILE is missing");
    if (request.out.empty() && !request.dry_run) throw UsageError("--out is missing: the folder where results go");
    std::vector<std::string> arguments;
    if (!request.file.empty()) arguments.push_back(request.file);
    if (!request.out.empty()) arguments.insert(arguments.end(), {"--out", request.out});
    if (request.workers_given) arguments.insert(arguments.end(), {"--workers", std::to_string(request.workers)});
    if (!request.scheduler.empty()) arguments.insert(arguments.end(), {"--scheduler", request.scheduler});
    if (!request.plot.empty()) arguments.insert(arguments.end(), {"--plot", request.plot});
    if (request.status) arguments.push_back("--status");
    if (request.dry_run) arguments.push_back("--dry-run");
    run_campaign(std::move(arguments), "--json", outcome);
}

} // namespace

Verb verb_campaign() {
    const auto request = std::make_shared<CampaignRequest>();
    return {.name = "campaign",
            .summary = "many drives from one file - grids, samples, lists - into one table of Parquet; goes on where it was stopped",
            .options = {{.argument = "FILE",
                         .into = &request->file,
                         .help = "what varies, and what is kept of each drive (docs/campaign.md)",
                         .kind = Kind::text},
                        {.name = "--out",
                         .into = &request->out,
                         .help = "where results go; one campaign a folder",
                         .value = "FOLDER",
                         .kind = Kind::folder},
                        {.name = "--workers",
                         .into = &request->workers,
                         .help = "processes (one a core); 0: one alone, which drives itself",
                         .value = "N",
                         .range = Range{0, 1024},
                         .given = &request->workers_given},
                        {.name = "--scheduler",
                         .into = &request->scheduler,
                         .help = "a Dask scheduler, tcp://HOST:PORT, whose workers drive",
                         .value = "ADDRESS",
                         .excludes = {"--workers"}},
                        {.name = "--plot",
                         .into = &request->plot,
                         .help = "a picture of the drives that are done: parallel coordinates, each figure over each factor, Sobol "
                                 "indices; without FILE it drives nothing",
                         .value = "FILE.svg|png",
                         .kind = Kind::output,
                         .check = figure_ending},
                        {.name = "--status",
                         .into = &request->status,
                         .help = "how far the campaign in FOLDER is; drives nothing",
                         .excludes = {"--plot"}},
                        {.name = "--dry-run",
                         .into = &request->dry_run,
                         .help = "how many drives, and the first rows; drives nothing",
                         .excludes = {"--plot"}}},
            .run = [request](Outcome &outcome) { run_campaign(*request, outcome); }};
}

} // namespace traction::cli
