// verbs.h - how a verb of the CLI declares itself: a table row with its words, its options and where their values go.
//
// One file = one verb: verb_<name>.cpp defines `Verb verb_<name>()`. The tables feed the parser (parse.cpp, the only file that
// knows CLI11), --help, the shell completion and the manual pages, so none of them can say something else than the others.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace traction::cli {

// Exit codes of every verb (docs: README, `traction --help`).
enum ExitCode {
    exit_done = 0,      // it did what was asked
    exit_negative = 1,  // it ran, and the answer is no: a gate or check failed, nothing was found
    exit_usage = 2,     // the command line is wrong
    exit_bad_input = 3, // a log, model, map or scenario is wrong: the message says where and how to mend it
    exit_io = 4,        // a file, or standard output, cannot be read or written
    exit_internal = 70, // a bug in traction
};

// What a verb hands back to main: its exit code and, for programs, its result.
struct Outcome {
    int exit_code = exit_done;
    nlohmann::json json;
};

// The command line cannot be meant: what is wrong with it, found by a verb. Exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Where a value goes; a flag sets a bool.
using Target =
    std::variant<std::monostate, bool *, int *, std::int64_t *, std::uint64_t *, double *, std::string *, std::vector<std::string> *>;

// What a value is: tells the shell what to complete, and main which files will be written.
enum class Kind { text, input, output, folder, scenario, model, rover, log, effect, verb };

struct Range {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

struct Option {
    std::string name = {};     // "--out"; empty for what is given by its place alone
    std::string argument = {}; // "LOG": may be given by its place, in the order of the table; empty when only by name
    Target into = {};
    std::string help = {};
    std::string value = {}; // the placeholder: "FILE"; the argument's when left out
    Kind kind = Kind::text;
    bool required = false, shows_default = false;
    std::optional<Range> range = {};                     // of a number, both ends allowed
    std::vector<std::string> one_of = {};                // the only values allowed
    std::vector<std::string> needs = {}, excludes = {};  // other options of this verb by name
    std::string (*check)(const std::string &) = nullptr; // empty: good; otherwise what is wrong
    char delimiter = '\0';                               // a list may also stand in one word: A,B
    int at_most = 0;       // a list of 0 to this many values; 1: one value each use, any number of uses; 0: each use adds one or more
    bool *given = nullptr; // told whether the user wrote it
};

struct Verb {
    std::string name;    // "simulate"; "bench lab" stands in the group "bench"
    std::string summary; // one line for the list of verbs
    std::vector<Option> options;
    std::function<void(Outcome &)> run;
    std::string details = {}; // paragraphs for the manual page and the end of --help
};

// Every verb, in the order of `traction --help`.
const std::vector<Verb> &all_verbs();

// A group of verbs ("bench") and its one line.
struct Group {
    std::string name, summary;
};
const std::vector<Group> &all_groups();

} // namespace traction::cli
