// traction report RESULT.json ... --out R.html: shows a result of the lab, or a set of figures, as one HTML file; several side by side.
#include "verbs.h"

#include "host_tools/report/report.h"

#include <algorithm>
#include <cerrno>
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
    std::string out;
};

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
    const nlohmann::json result = options.results.size() == 1 ? read_result(options.results.front()) : side_by_side(options.results);
    try {
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
        .summary = "show a result written by --json as one HTML page that opens without a network",
        .options =
            {{.argument = "RESULT",
              .into = &options->results,
              .help = "JSON result of compare, diagnose, add, fit, check or reproduce; several of the lab's: side by side",
              .kind = Kind::input,
              .required = true},
             {.name = "--out", .into = &options->out, .help = "the page", .value = "FILE.html", .kind = Kind::output, .required = true}},
        .run = [options](Outcome &outcome) { show(*options, outcome); }};
}

} // namespace traction::cli
