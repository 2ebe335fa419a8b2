// traction report RESULT.json --out R.html: shows a result of the lab, or a set of figures, as one HTML file.
#include "verbs.h"

#include "host_tools/report/report.h"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

namespace traction::cli {

namespace {

struct ReportOptions {
    std::string result, out;
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

void show(const ReportOptions &options, Outcome &outcome) {
    const nlohmann::json result = read_result(options.result);
    try {
        report::write_html(result, options.out);
    } catch (const report::ReportError &error) {
        throw report::ReportError(options.result + ": " + error.what());
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
              .into = &options->result,
              .help = "JSON result of compare, diagnose, add, fit, check or reproduce",
              .kind = Kind::input,
              .required = true},
             {.name = "--out", .into = &options->out, .help = "the page", .value = "FILE.html", .kind = Kind::output, .required = true}},
        .run = [options](Outcome &outcome) { show(*options, outcome); }};
}

} // namespace traction::cli
