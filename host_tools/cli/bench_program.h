// bench_program.h - the benchmarks are programs of tests/bench, which link peers and generators; the command line runs them, so that
// who only drives and diagnoses builds none of it.
#pragma once

#include "verbs.h"

#include <string>
#include <vector>

namespace traction::cli {

// Runs the program `name` of the build folder's tests/bench with these arguments and `--json FILE`; its table goes to standard output,
// its JSON and its exit code to the outcome. Throws std::filesystem::filesystem_error where it was not built or cannot be run.
void run_bench(const std::string &name, std::vector<std::string> arguments, Outcome &outcome);

// Runs a program and waits for it. Its exit code; being ended by a signal counts as an internal error. Throws as run_bench.
int run_program(const std::string &program, std::vector<std::string> &arguments);

// This program's own file.
std::string own_program();

} // namespace traction::cli
