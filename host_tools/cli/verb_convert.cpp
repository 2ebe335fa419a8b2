// traction convert IN.csv --map MAP.toml --out OUT.csv: a foreign file becomes a log of our own format.
#include "verbs.h"

#include "host_tools/log/log.h"

#include <cstdio>
#include <memory>

namespace traction::cli {

namespace {

struct ConvertOptions {
    std::string in, map, out;
};

} // namespace

void add_convert(CLI::App &app, Outcome &outcome) {
    const auto options = std::make_shared<ConvertOptions>();
    CLI::App *verb = app.add_subcommand("convert", "rewrite a foreign CSV, read through a map, as a log of traction's own format");
    verb->add_option("in", options->in, "the file to read")->required()->type_name("IN.csv");
    verb->add_option("--map", options->map, "which column is which signal (docs/log_format.md); without it, IN is mended and rewritten")
        ->type_name("MAP.toml");
    verb->add_option("--out", options->out, "the log to write")->required()->type_name("OUT.csv");
    add_json_option(verb, outcome);
    verb->callback([options, &outcome] {
        const log::Log log = log::read_csv(options->in, options->map);
        log::write_csv(log, options->out);
        for (const std::string &repair : log.repairs) std::printf("mended: %s\n", repair.c_str());
        std::size_t samples = 0;
        nlohmann::json signals = nlohmann::json::array();
        for (const log::Signal &signal : log.signals) {
            samples += signal.value.size();
            signals.push_back(signal.name);
        }
        std::printf("%s: %zu signals, %zu samples, %.6g s\n", options->out.c_str(), log.signals.size(), samples, log.duration_s());
        outcome.json = {{"schema", "traction.convert/1"},
                        {"in", options->in},
                        {"map", options->map},
                        {"out", options->out},
                        {"signals", signals},
                        {"samples", samples},
                        {"duration_s", log.duration_s()},
                        {"repairs", log.repairs}};
    });
}

} // namespace traction::cli
