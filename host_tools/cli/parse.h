// parse.h - the command line: words to values, by the verbs' tables.
#pragma once

#include "verbs.h"

#include <string>

namespace traction::cli {

// What the command line asks for. Without a verb, `text` is to be shown (on stderr when the exit code is not 0) and `exit_code`
// is the program's.
struct Parsed {
    const Verb *verb = nullptr;
    std::string json_file; // --json FILE; empty when not asked for
    bool quiet = false;
    int exit_code = exit_done;
    std::string text;
};

// Puts the values of `argv` where the chosen verb's table says.
Parsed parse(int argc, const char *const *argv);

} // namespace traction::cli
