// verb_reproduce.cpp - traction reproduce: makes the paper's experiments and says where we differ.
#include "data_files.h"
#include "progress.h"
#include "verbs.h"

#include "host_tools/report/report.h"
#include "host_tools/reproduce/reproduce.h"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace traction::cli {

namespace {

struct ReproduceArguments {
    std::string out, data;
    ReproduceSettings settings;
};

void run_reproduce(ReproduceArguments arguments, Outcome &outcome) {
    if (arguments.settings.scenarios.empty()) arguments.settings.scenarios = (need_data_root() / "scenarios").string();
    if (arguments.data.empty()) arguments.data = (need_data_root() / "../shared/data").string();
    const std::filesystem::path bench = std::filesystem::path(arguments.data) / "cmu_single_wheel/cmu_wheel_smooth_steady_state.csv";
    if (std::filesystem::exists(bench)) arguments.settings.bench_data = bench.string();
    Progress progress("reproduce", 19 + 6L * arguments.settings.seeds); // drives: 5 calibrations, 2 + 2 + 2 + 6, and table III
    arguments.settings.after_run = [&progress] { progress.step(); };
    outcome.json = reproduce(arguments.settings);
    for (const auto &figure : outcome.json["figures"]) {
        const auto text = [&figure](const char *key) { return figure[key].get<std::string>(); };
        std::printf("%-14s %-20s paper:               %s\n", text("verdict").c_str(), text("id").c_str(), text("paper").c_str());
        if (!text("paper_here").empty()) std::printf("%-35s paper's method here: %s\n", "", text("paper_here").c_str());
        std::printf("%-35s ours:                %s\n", "", text("ours").c_str());
    }
    for (const auto &check : outcome.json["checks"])
        if (!check["pass"])
            std::printf("outside its bound: %s, %s: %.4g, not in %.4g to %.4g\n", check["id"].get<std::string>().c_str(),
                        check["what"].get<std::string>().c_str(), check["value"].get<double>(), check["low"].get<double>(),
                        check["high"].get<double>());
    if (arguments.settings.bench_data.empty()) std::printf("left out: the measured bench (no data in %s)\n", arguments.data.c_str());
    if (!arguments.out.empty()) {
        report::write_html(outcome.json, arguments.out);
        std::printf("report: %s\n", arguments.out.c_str());
    }
    if (!outcome.json["pass"]) outcome.exit_code = exit_negative;
}

} // namespace

Verb verb_reproduce() {
    const auto arguments = std::make_shared<ReproduceArguments>();
    arguments->settings.scenarios.clear();
    return {
        .name = "reproduce",
        .summary = "make the paper's experiments again, figure by figure, with its numbers beside ours",
        .options =
            {{.name = "--out", .into = &arguments->out, .help = "report with every figure, HTML", .value = "FILE", .kind = Kind::output},
             {.name = "--scenarios",
              .into = &arguments->settings.scenarios,
              .help = "folder of the scenario gallery; ours when left out",
              .value = "FOLDER",
              .kind = Kind::folder},
             {.name = "--data",
              .into = &arguments->data,
              .help = "folder with measured data; where it is absent, its experiment is left out",
              .value = "FOLDER",
              .kind = Kind::folder},
             {.name = "--seeds", .into = &arguments->settings.seeds, .help = "runs per ground for table III", .range = Range{2, 1000}},
             {.name = "--jobs", .into = &arguments->settings.jobs, .help = "runs side by side", .range = Range{1, 256}}},
        .run = [arguments](Outcome &outcome) { run_reproduce(*arguments, outcome); }};
}

} // namespace traction::cli
