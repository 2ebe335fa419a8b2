// traction report RESULT.json|LOG.csv ... --out R.html: shows a result of the lab, a set of figures or the drive of a log as one HTML file;
// several results side by side.
#include "drive_view.h"
#include "rows.h"
#include "verbs.h"

#include "host_tools/lab/model/model.h"
#include "host_tools/report/report.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace traction::cli {

namespace {

struct ReportOptions {
    std::vector<std::string> results;
    std::string out, log, truth, map, rover, model;
};

// A result is JSON: it is called so, or begins as an object does. Anything else is a log.
bool is_log(const std::string &path) {
    if (std::filesystem::path(path).extension() == ".json") return false;
    std::ifstream file(path);
    char first = '{'; // what cannot be read is refused as a result
    while (file.get(first) && std::isspace(static_cast<unsigned char>(first)) != 0) {
    }
    return first != '{';
}

// The same wheels, to a twentieth of a radius: as a fit may have moved them.
bool alike(const report::RoverShape &a, const report::RoverShape &b) {
    return std::equal(a.wheel.begin(), a.wheel.end(), b.wheel.begin(), b.wheel.end(), [](const auto &one, const auto &other) {
        const double most = 0.05 * other.radius_m;
        return std::fabs(one.x_m - other.x_m) < most && std::fabs(one.y_m - other.y_m) < most &&
               std::fabs(one.radius_m - other.radius_m) < most;
    });
}

// What is drawn: the described rover; else the model's wheels, and where these are the reference's, or no model was given, the reference.
report::RoverShape drawn(const ReportOptions &options) {
    if (!options.rover.empty()) return shape_of(sim::read_rover_file(options.rover));
    const report::RoverShape reference = shape_of(sim::RoverDescription());
    if (options.model.empty()) return reference;
    const lab::Model model = lab::read_model(options.model);
    const report::RoverShape shape = shape_of(model);
    const auto round = [](const report::RoverShape::Wheel &wheel) { return wheel.radius_m > 0; };
    if (shape.wheel.empty() || !std::all_of(shape.wheel.begin(), shape.wheel.end(), round))
        throw lab::ModelError(options.model, 0, "wheels", "no rover can be drawn from these wheels",
                              "give the model of a rover, or --rover FILE");
    return alike(shape, reference) ? reference : shape;
}

// The drive of a log, with what really happened where that is known. Throws log::LogError where the log has no pose.
nlohmann::json drive_of(const ReportOptions &options, const std::string &path) {
    const log::Log log = log::read_csv(path, options.map);
    const log::Log truth = options.truth.empty() ? log::Log{} : log::read_csv(options.truth);
    nlohmann::json replay = report::replay_of(log, options.truth.empty() ? nullptr : &truth, drawn(options));
    if (replay.is_null())
        throw log::LogError(path, 0, 0, "this log says nowhere where the rover was",
                            "a page of a drive needs camera.x_m and camera.y_m, or --truth; `traction plot` draws any log");
    return replay;
}

nlohmann::json page_of_log(const ReportOptions &options) {
    const std::string &path = options.results.front();
    nlohmann::json replay = drive_of(options, path);
    const double duration_s = (replay["rows"].get<double>() - 1) * replay["dt_s"].get<double>();
    return {{"schema", "traction.look/1"},
            {"title", "drive: " + std::filesystem::path(path).filename().string()},
            {"log", {{"file", std::filesystem::path(path).filename().string()}, {"duration_s", duration_s}}},
            {"replay", std::move(replay)}};
}

nlohmann::json read_result(const std::string &path) {
    errno = 0;
    std::ifstream file(path);
    if (!file) throw std::filesystem::filesystem_error("cannot read", path, std::error_code(errno, std::generic_category()));
    try {
        return nlohmann::json::parse(file);
    } catch (const nlohmann::json::parse_error &error) {
        throw report::ReportError(path + ": byte " + std::to_string(error.byte) +
                                  ": this is no JSON; give the file that --json of another verb wrote");
    }
}

// Several results of the lab as one, each under its file's name; of two files of one name the folder stands before it.
nlohmann::json side_by_side(const std::vector<std::string> &paths) {
    nlohmann::json results = nlohmann::json::array();
    for (const std::string &path : paths) {
        nlohmann::json one = read_result(path);
        const auto schema = one.is_object() ? one.find("schema") : one.end();
        if (!one.is_object() || schema == one.end() || *schema != "traction.lab/1")
            throw report::ReportError(path + ": schema: " + (one.is_object() ? one.value("schema", nlohmann::json()).dump() : "no object") +
                                      ": cannot stand beside others; give results of compare, diagnose, add or fit (traction.lab/1), or "
                                      "this one alone");
        const auto same = [&](const std::string &other) {
            return std::filesystem::path(other).filename() == std::filesystem::path(path).filename();
        };
        const bool alone = std::count_if(paths.begin(), paths.end(), same) == 1;
        one["name"] = alone ? std::filesystem::path(path).stem().string() : path;
        results.push_back(std::move(one));
    }
    return {{"schema", "traction.compared/1"}, {"title", std::to_string(paths.size()) + " results side by side"}, {"results", results}};
}

void show(const ReportOptions &options, Outcome &outcome) {
    const bool one = options.results.size() == 1, log = one && is_log(options.results.front());
    if (log && !options.log.empty()) throw UsageError("--log: adds a drive to a result; here the log itself is shown");
    if (!one && !options.log.empty()) throw UsageError("--log: takes one result, not several");
    if (!log && options.log.empty() && !(options.truth + options.map + options.rover + options.model).empty())
        throw UsageError("--truth, --map, --rover, --model: are for the drive of a log; give the log, or --log beside a result");
    nlohmann::json result = log ? page_of_log(options) : one ? read_result(options.results.front()) : side_by_side(options.results);
    if (!options.log.empty() && result.is_object()) result["replay"] = drive_of(options, options.log);
    const bool data = std::filesystem::path(options.out).extension() == ".json";
    if (data && !log) throw UsageError("--out " + options.out + ": the data of a page is written for the drive of a log; give FILE.html");
    try {
        if (data)
            report::write_text(result.dump() + '\n', options.out);
        else
            report::write_html(result, options.out);
    } catch (const report::ReportError &error) {
        throw report::ReportError(options.results.front() + ": " + error.what());
    }
    std::printf("page: %s\n", options.out.c_str());
    outcome.json = {{"schema", "traction.report/1"}, {"page", options.out}, {"shows", result.at("schema")}};
}

} // namespace

Verb verb_report() {
    const auto options = std::make_shared<ReportOptions>();
    return {
        .name = "report",
        .summary = "show a result written by --json, or the drive of a log, as one HTML page that opens without a network",
        .options =
            {{.argument = "RESULT",
              .into = &options->results,
              .help =
                  "JSON result of compare, diagnose, add, fit, check or reproduce; several of the lab's: side by side. Or a log: its drive",
              .kind = Kind::input,
              .required = true},
             {.name = "--log",
              .into = &options->log,
              .help = "the log of the result: its drive is shown too",
              .value = "LOG",
              .kind = Kind::log},
             {.name = "--truth",
              .into = &options->truth,
              .help = "what really happened (simulate --truth): pose, height, forces",
              .value = "FILE",
              .kind = Kind::log},
             map_row(options->map),
             {.name = "--rover",
              .into = &options->rover,
              .help = "the rover that is drawn (rovers/*.toml); else the reference",
              .value = "FILE",
              .kind = Kind::rover},
             {.name = "--model",
              .into = &options->model,
              .help = "a model whose wheels are drawn, where the rover is not described",
              .value = "FILE",
              .kind = Kind::model,
              .excludes = {"--rover"}},
             {.name = "--out",
              .into = &options->out,
              .help = "the page; of a log also FILE.json: what its page shows (traction.look/1)",
              .value = "FILE.html",
              .kind = Kind::output,
              .required = true}},
        .run = [options](Outcome &outcome) { show(*options, outcome); }};
}

} // namespace traction::cli
