// verb_campaign.cpp - traction campaign FILE.toml: many drives into one table. The Python package does it (python/traction/campaigns):
// its samples are scipy's, its table is Parquet, and neither has a C++ library in Debian.
#include "bench_program.h"
#include "data_files.h"
#include "stop_signal.h"
#include "verbs.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>

#include <unistd.h>

namespace traction::cli {

namespace {

struct Request {
    std::string file, out, scheduler, plot;
    int workers = 0;
    bool status = false, dry_run = false, workers_given = false;
};

constexpr int no_package = 69; // EX_UNAVAILABLE

// Says so with its own exit code where the package, or what campaigns need beside it, is not there.
constexpr const char *script = R"(import sys
try:
    import pyarrow, scipy
    from traction.campaigns.__main__ import main
except ImportError as error:
    print(f"traction: campaign: {sys.executable}: {error}", file=sys.stderr)
    sys.exit(69)
sys.exit(main(sys.argv[1:]))
)";

// $TRACTION_PYTHON, the .venv beside scenarios/, or the system's.
std::string interpreter() {
    if (const char *given = std::getenv("TRACTION_PYTHON"); given != nullptr && *given != '\0') return given;
    const std::filesystem::path own = data_root() / ".venv" / "bin" / "python";
    return std::filesystem::exists(own) ? own.string() : "/usr/bin/python3";
}

std::string check_ending(const std::string &path) {
    const std::string ending = std::filesystem::path(path).extension().string();
    return ending == ".svg" || ending == ".png" ? "" : "must end in .svg or .png";
}

void run(const Request &request, Outcome &outcome) {
    if (request.file.empty() && !request.status && request.plot.empty()) throw UsageError("FILE is missing");
    if (request.out.empty() && !request.dry_run) throw UsageError("--out is missing: the folder where results go");
    const std::filesystem::path json = std::filesystem::temp_directory_path() / ("traction_campaign_" + std::to_string(getpid()) + ".json");
    std::vector<std::string> arguments = {interpreter(), "-c", script, "--json", json.string()};
    if (!request.file.empty()) arguments.push_back(request.file);
    if (!request.out.empty()) arguments.insert(arguments.end(), {"--out", request.out});
    if (request.workers_given) arguments.insert(arguments.end(), {"--workers", std::to_string(request.workers)});
    if (!request.scheduler.empty()) arguments.insert(arguments.end(), {"--scheduler", request.scheduler});
    if (!request.plot.empty()) arguments.insert(arguments.end(), {"--plot", request.plot});
    if (request.status) arguments.push_back("--status");
    if (request.dry_run) arguments.push_back("--dry-run");
    std::fflush(stdout);
    {
        const StopSignal stop; // Ctrl-C is the campaign's, which ends in order
        const std::string program = arguments.front();
        outcome.exit_code = run_program(program, arguments);
    }
    if (std::ifstream file(json); file) outcome.json = nlohmann::json::parse(file, nullptr, false);
    std::filesystem::remove(json);
    if (outcome.exit_code != no_package) return;
    std::fprintf(stderr, "traction: campaign: is the Python package's; to mend: python3 -m venv .venv && .venv/bin/pip install "
                         "'./python[campaign]' in Traction's folder, or name an interpreter that has it in $TRACTION_PYTHON\n");
    outcome.exit_code = exit_io;
}

} // namespace

Verb verb_campaign() {
    const auto request = std::make_shared<Request>();
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
                         .check = check_ending},
                        {.name = "--status",
                         .into = &request->status,
                         .help = "how far the campaign in FOLDER is; drives nothing",
                         .excludes = {"--plot"}},
                        {.name = "--dry-run",
                         .into = &request->dry_run,
                         .help = "how many drives, and the first rows; drives nothing",
                         .excludes = {"--plot"}}},
            .run = [request](Outcome &outcome) { run(*request, outcome); }};
}

} // namespace traction::cli
