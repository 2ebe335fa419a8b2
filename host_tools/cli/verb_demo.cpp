// verb_demo.cpp - traction demo: hides an effect by seed, simulates, lets the lab find it, opens the seal.
//
// The lab gets what any user's lab gets: the log file and the baseline model file. The seal is written first and read last, here.
#include "data_files.h"
#include "drive_view.h"
#include "rows.h"
#include "terminal.h"
#include "verbs.h"

#include "host_tools/lab/result/addition.h"
#include "host_tools/lab/result/compare.h"
#include "host_tools/lab/result/next_result.h"
#include "host_tools/lab/result/result.h"
#include "host_tools/lab/result/story.h"
#include "host_tools/lab/result/words.h"
#include "host_tools/lab/session.h"
#include "host_tools/log/log.h"
#include "host_tools/report/report.h"
#include "host_tools/simulate/simulate.h"
#include "host_tools/simulate/trial.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <utility>

namespace traction::cli {

namespace {

namespace fs = std::filesystem;

struct DemoRequest {
    std::uint64_t seed = 1;
    std::string folder = "out/demo";
    bool details = false;
};

void seal(const std::vector<sim::ActiveEffect> &hidden, const std::string &scenario, std::uint64_t seed, const fs::path &path) {
    report::write_text(sim::seal_text(hidden, scenario, seed), path.string());
}

nlohmann::json open_seal(const fs::path &path) {
    std::ifstream file;
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file.open(path);
    return nlohmann::json::parse(file);
}

std::string described(const nlohmann::json &effect) {
    std::string text = effect.at("name");
    if (effect.value("wheel", -1) >= 0) text += " on wheel " + std::to_string(effect["wheel"].get<int>());
    for (const auto &[name, value] : effect.at("parameters").items()) {
        char number[40];
        std::snprintf(number, sizeof number, " = %.3g", value.at("value").get<double>());
        const std::string unit = value.value("unit", "1");
        text += (name == effect.at("parameters").begin().key() ? ": " : ", ") + name + number + (unit == "1" ? "" : " " + unit);
    }
    return text;
}

// What the seal says against what the lab said, in words; `right` is true only for the effect itself, or its class said as such.
std::string judged(const nlohmann::json &truth, const lab::Diagnosis &diagnosis, bool &right) {
    const std::string name = truth.at("effects").at(0).at("name");
    for (const lab::ConfoundedClass &group : diagnosis.classes)
        for (const std::string &member : group.members)
            if (member.rfind(name, 0) == 0) {
                right = true;
                return "the lab named a class that holds it, and said that this log cannot tell its members apart";
            }
    right = !diagnosis.effects.empty() && diagnosis.effects.front().rfind(name, 0) == 0;
    if (right) return "the lab was right";
    for (const auto &[effect, why] : diagnosis.not_excited)
        if (effect.rfind(name, 0) == 0) return "the lab said beforehand that this log cannot show it: " + why;
    if (diagnosis.kind == "nothing") return "the lab found nothing: the effect stayed below what this log can show";
    return "the lab was wrong";
}

void measured_run(const fs::path &root, Outcome &outcome) {
    const fs::path log = root / "../shared/data/robotino/one_gray_v0.1_dir060.csv";
    if (!fs::exists(log)) {
        std::printf("\nNo ../shared/data beside the project: the comparison with a measured Robotino run is left out.\n");
        return;
    }
    const lab::Session session = lab::open_session({.model = (root / "models/robotino_carpet.toml").string(),
                                                    .log = log.string(),
                                                    .map = (root / "models/maps/robotino.toml").string(),
                                                    .repeat = ""});
    const lab::Comparison comparison = lab::compare(session.model, session.data, false);
    print("\n" + lab::wrapped("A measured run of somebody else's machine (Robotino on gray carpet), against models/robotino_carpet.toml:") +
          lab::comparison_text(comparison));
    outcome.json["measured"] = {{"log", log.filename().string()}, {"error", comparison.error}, {"floor", comparison.floor}};
}

void demo(const DemoRequest &request, Outcome &outcome) {
    const fs::path root = need_data_root(), folder = request.folder;
    fs::create_directories(folder);
    const std::string log_file = (folder / "run.csv").string(), model_file = (root / "models/rover_sand.toml").string();
    const std::string better_file = (folder / "rover_better.toml").string(), report_file = (folder / "report.html").string();

    const sim::Scenario scenario = sim::read_scenario((root / "scenarios/demo_sand.toml").string());
    std::printf("1. Simulate %s with one effect hidden by seed %llu: firmware, plant and sensors in lockstep.\n", scenario.name.c_str(),
                static_cast<unsigned long long>(request.seed));
    std::fflush(stdout);
    SimulateOptions options;
    options.seed = request.seed;
    options.hide = sim::HiddenDraw{.seed = request.seed, .count = 1, .among = {}};
    options.truth = true; // for the picture of the drive, beside the opened seal
    nlohmann::json drive;
    {
        const SimulationResult run = simulate(scenario, options);
        drive = report::replay_of(run.log, &run.truth, shape_of(scenario.rover));
        seal(run.hidden, scenario.name, request.seed, folder / "sealed.json");
        log::write_csv(run.log, log_file);
    }
    std::printf("   log: %s; the truth is sealed in %s\n\n", log_file.c_str(), (folder / "sealed.json").string().c_str());

    std::printf("2. Compare the baseline model with the log.\n");
    const lab::Session opened = lab::open_session({.model = model_file, .log = log_file, .map = "", .repeat = ""});
    lab::Comparison comparison = lab::compare(opened.model, opened.data, false);
    print(lab::comparison_text(comparison, request.details) + "\n3. Diagnose: what is missing?\n");
    std::fflush(stdout);
    const lab::Diagnosed diagnosed = lab::diagnose_session(opened, {});
    const lab::Diagnosis &diagnosis = diagnosed.diagnosis;
    const lab::Session &session = diagnosed.anew ? *diagnosed.anew : opened;
    if (diagnosed.anew) comparison = lab::compare(session.model, session.data, false);
    if (!diagnosis.accepted.empty()) lab::show_after(comparison, diagnosis.model, session.data);
    std::optional<lab::NextExperiment> next;
    if (!diagnosis.classes.empty()) next = lab::next_experiment(diagnosis, session.model, session.data, false, simulated_rover());
    const lab::Story story = lab::tell(comparison, diagnosis, next ? &*next : nullptr);
    print(lab::diagnosis_text(diagnosis, request.details) + "\n");
    if (next) print("   What would tell them apart:\n" + lab::next_text(*next, request.details));

    std::printf(diagnosis.accepted.empty() ? "4. Nothing was named: nothing is added.\n"
                                           : "4. Add what was named, refit, and watch the error.\n");
    if (!diagnosis.accepted.empty()) {
        lab::Model better = diagnosis.model;
        const lab::LadderStep step = lab::fit_model(better, session.data, "fitted");
        lab::append_lineage(better, session.data, diagnosis.ladder, step);
        lab::write_model(better, better_file);
        std::printf("   the better model: %s\n", better_file.c_str());
    }
    print(lab::story_text(story));

    const nlohmann::json truth = open_seal(folder / "sealed.json");
    bool right = false;
    const std::string words = judged(truth, diagnosis, right);
    const std::string hidden = described(truth.at("effects").at(0));
    std::printf("\n5. The seal is opened.\n");
    print(lab::wrapped("The seal: " + hidden + ".", 3) + lab::wrapped("   " + words, 3));
    outcome.json = lab::head_json("diagnose", session.model, session.data);
    lab::put_comparison(outcome.json, comparison);
    lab::put_diagnosis(outcome.json, diagnosis);
    outcome.json["story"] = lab::story_json(story);
    outcome.json["next"] = next ? lab::next_json(*next) : nlohmann::json(nullptr);
    const lab::LadderStep &first = diagnosis.ladder.front(), &last = diagnosis.ladder.back();
    outcome.json["demo"] = {{"seed", request.seed},
                            {"hidden", truth.at("effects").at(0)},
                            {"hidden_text", hidden},
                            {"named", diagnosis.effects},
                            {"right", right},
                            {"judgement", words},
                            {"error_before", first.heldout},
                            {"error_after", last.heldout},
                            {"floor", last.floor}};
    nlohmann::json page = outcome.json;
    page["replay"] = std::move(drive);
    report::write_html(page, report_file);
    measured_run(root, outcome);
    std::printf("\nOpen the report: %s\n", report_file.c_str());
}

} // namespace

Verb verb_demo() {
    const auto request = std::make_shared<DemoRequest>();
    return {.name = "demo",
            .summary = "the whole loop: hide an effect, simulate, compare, diagnose, add, open the seal",
            .options = {{.name = "--seed",
                         .into = &request->seed,
                         .help = "draws the hidden effect, the ground and the noise",
                         .shows_default = true},
                        {.name = "--out",
                         .into = &request->folder,
                         .help = "folder for the log, the seal, the model and the report",
                         .value = "FOLDER",
                         .kind = Kind::folder,
                         .shows_default = true},
                        details_row(request->details)},
            .run = [request](Outcome &outcome) { demo(*request, outcome); }};
}

} // namespace traction::cli
