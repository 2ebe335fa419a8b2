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

} // namespace

void add_report(CLI::App &app, Outcome &outcome) {
    const auto options = std::make_shared<ReportOptions>();
    CLI::App *verb = app.add_subcommand("report", "show a result written by --json as one HTML page that opens without a network");
    verb->add_option("result", options->result, "result of compare, diagnose, add, fit, check or reproduce")
        ->required()
        ->type_name("RESULT.json");
    verb->add_option("--out", options->out, "the page")->required()->type_name("FILE.html");
    add_json_option(verb, outcome);
    verb->callback([options, &outcome] {
        const nlohmann::json result = read_result(options->result);
        try {
            report::write_html(result, options->out);
        } catch (const report::ReportError &error) {
            throw report::ReportError(options->result + ": " + error.what());
        }
        std::printf("page: %s\n", options->out.c_str());
        outcome.json = {{"schema", "traction.report/1"}, {"page", options->out}, {"shows", result.at("schema")}};
    });
}

} // namespace traction::cli
