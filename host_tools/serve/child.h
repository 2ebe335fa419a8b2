// child.h - runs one verb as a program of its own: what it answers is what the command line answers, it can be ended at any time, and what
// goes wrong in it (memory, a bug) does not take the server along.
#pragma once

#include <atomic>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::serve {

struct Finished {
    int exit_code = 0;   // 128 + the signal where a signal ended it
    std::string out;     // its words, the last 200 kB
    std::string trouble; // what it said on stderr, the last 20 kB
};

struct Listening {
    std::function<void(long done, long total, const std::string &words)> progress = {};
    std::function<void(const std::string &line)> line = {}; // of its standard output, instead of Finished::out
};

// Runs `program` with these arguments until it ends. `stop`: once it holds a signal's number the program gets that signal, and SIGKILL
// when it has not ended 5 s later. It also ends when this process does. Throws std::runtime_error where it cannot be started.
Finished run_child(const std::string &program, const std::vector<std::string> &arguments, const Listening &listening,
                   const std::atomic<int> &stop);

} // namespace traction::serve
