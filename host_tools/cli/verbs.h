// verbs.h - the verbs of the CLI: one add_<verb> each, and what a verb hands back.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <string>

namespace traction::cli {

// Exit codes of every verb (docs: README, `traction --help`).
enum ExitCode {
    exit_done = 0,      // it did what was asked
    exit_negative = 1,  // it ran, and the answer is no: a gate or check failed
    exit_usage = 2,     // the command line is wrong
    exit_bad_input = 3, // a log, model, map or scenario is wrong: the message says where and how to mend it
    exit_io = 4,        // a file cannot be read or written
    exit_internal = 70, // a bug in traction
};

// What a verb hands back to main: its exit code and, for programs, its result.
struct Outcome {
    int exit_code = exit_done;
    nlohmann::json json;
    std::string json_file; // --json FILE; empty when not asked for
};

// Gives a verb `--json FILE`: main writes outcome.json there (temporary, then rename).
void add_json_option(CLI::App *verb, Outcome &outcome);

// The group `traction bench`, made at the first call: verb_bench_<name>.cpp registers its subcommand there.
CLI::App *bench_group(CLI::App &app);

// verb_<name>.cpp defines `void add_<name>(CLI::App &app, Outcome &outcome)`: registers one subcommand whose callback does the
// work and fills the outcome. The build lists them (CMakeLists.txt) in verb_list.inc.

} // namespace traction::cli
