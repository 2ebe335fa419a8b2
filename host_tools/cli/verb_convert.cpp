// traction convert IN.csv --map MAP.toml --out OUT.csv: a foreign file becomes a log of our own format.
#include "rows.h"
#include "verbs.h"

#include "host_tools/log/log.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct ConvertOptions {
    std::string in, map, out;
};

void convert(const ConvertOptions &options, Outcome &outcome) {
    const log::Log log = log::read_csv(options.in, options.map);
    log::write_csv(log, options.out);
    for (const std::string &repair : log.repairs) std::printf("mended: %s\n", repair.c_str());
    std::size_t samples = 0;
    nlohmann::json signals = nlohmann::json::array();
    for (const log::Signal &signal : log.signals) {
        samples += signal.value.size();
        signals.push_back(signal.name);
    }
    std::printf("%s: %zu signals, %zu samples, %.6g s\n", options.out.c_str(), log.signals.size(), samples, log.duration_s());
    outcome.json = {{"schema", "traction.convert/1"},
                    {"in", options.in},
                    {"map", options.map},
                    {"out", options.out},
                    {"signals", signals},
                    {"samples", samples},
                    {"duration_s", log.duration_s()},
                    {"repairs", log.repairs}};
}

} // namespace

Verb verb_convert() {
    const auto options = std::make_shared<ConvertOptions>();
    return {
        .name = "convert",
        .summary = "rewrite a foreign CSV, read through a map, as a log of traction's own format",
        .options =
            {log_row(options->in, "the file to read"),
             {.name = "--map",
              .into = &options->map,
              .help = "which column is which signal (docs/log_format.md); without it, LOG is mended and rewritten",
              .value = "FILE",
              .kind = Kind::input},
             {.name = "--out", .into = &options->out, .help = "the log to write", .value = "FILE", .kind = Kind::output, .required = true}},
        .run = [options](Outcome &outcome) { convert(*options, outcome); }};
}

} // namespace traction::cli
