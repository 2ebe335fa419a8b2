// traction convert IN --out OUT.csv|mcap|ulg [--map MAP.toml] [--rover ROVER]: a foreign CSV, the rover's own ULog, or CAN frames
// with a DBC become a log of our own format, MCAP or ULog.
#include "rows.h"
#include "verbs.h"

#include "host_tools/board/board_log.h"
#include "host_tools/board/candump.h"
#include "host_tools/log/log.h"
#include "host_tools/log/ulog.h"
#include "host_tools/log/write_mcap.h"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace traction::cli {

namespace {

struct ConvertOptions {
    std::string in, map, out, rover, dbc;
};

// The on-board log's header is the description of the rover that wrote it.
log::Log from_board(const ConvertOptions &options) {
    if (!options.map.empty()) throw UsageError("--map is for a foreign CSV; the rover's log has its own names");
    const board::BoardLog board = board::read_board_log(options.in);
    for (const std::string &text : board.text) std::printf("rover: %s\n", text.c_str());
    return board::to_log(board, options.rover.empty() ? sim::RoverDescription() : sim::read_rover_file(options.rover));
}

log::Log read(const ConvertOptions &options) {
    if (board::is_ulog(options.in) && !log::is_own_ulog(options.in)) return from_board(options);
    const bool frames = board::is_candump(options.in);
    if (frames && options.dbc.empty())
        throw UsageError(options.in +
                         " holds CAN frames: which signals lie in them says --dbc FILE (hal/can/traction.dbc for Traction's bus)");
    if (!options.dbc.empty() && !options.map.empty()) throw UsageError("--map is for the CSV that --dbc makes: convert in two steps");
    return options.dbc.empty() ? log::read_csv(options.in, options.map) : board::read_candump(options.in, options.dbc);
}

void convert(const ConvertOptions &options, Outcome &outcome) {
    const log::Log log = read(options);
    if (std::filesystem::path(options.out).extension() == ".mcap")
        log::write_mcap(log, options.out);
    else if (log::names_a_ulog(options.out))
        log::write_ulog(log, options.out);
    else
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
        .summary =
            "rewrite a foreign CSV, the rover's on-board ULog or recorded CAN frames as a log of traction's own format, as MCAP or as ULog",
        .options = {log_row(options->in, "the file to read"),
                    {.name = "--map",
                     .into = &options->map,
                     .help = "which column is which signal (docs/log_format.md); without it, LOG is mended and rewritten",
                     .value = "FILE",
                     .kind = Kind::input},
                    {.name = "--dbc",
                     .into = &options->dbc,
                     .help = "of CAN frames as candump -L writes them: which signals lie in them",
                     .value = "FILE",
                     .kind = Kind::input},
                    {.name = "--rover",
                     .into = &options->rover,
                     .help = "of an on-board log: the rover that wrote it (rovers/*.toml); without it the reference rover",
                     .value = "ROVER",
                     .kind = Kind::rover},
                    {.name = "--out",
                     .into = &options->out,
                     .help = "the log to write; MCAP where it ends in .mcap, ULog in .ulg (docs/log_format.md)",
                     .value = "FILE",
                     .kind = Kind::output,
                     .required = true}},
        .run = [options](Outcome &outcome) { convert(*options, outcome); }};
}

} // namespace traction::cli
