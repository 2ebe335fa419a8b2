// main.cpp - the command line: registers the verbs, runs one, turns what went wrong into one message and an exit code.
#include "verbs.h"

#include "host_tools/log/log.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <ios>
#include <system_error>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace traction::cli {

#define X(name) void add_##name(CLI::App &app, Outcome &outcome);
#include "verb_list.inc"
#undef X

void add_json_option(CLI::App *verb, Outcome &outcome) {
    verb->add_option("--json", outcome.json_file, "write the result as JSON to this file")->type_name("FILE");
}

CLI::App *bench_group(CLI::App &app) {
    const auto made = app.get_subcommands([](const CLI::App *verb) { return verb->get_name() == "bench"; });
    if (!made.empty()) return made.front();
    CLI::App *group = app.add_subcommand("bench", "measure this build beside its peers");
    group->require_subcommand(1);
    return group;
}

namespace {

void write_json(const Outcome &outcome) {
    const std::string temporary = outcome.json_file + ".part";
    std::ofstream file;
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file.open(temporary);
    file << outcome.json.dump(1) << '\n';
    file.close();
    std::filesystem::rename(temporary, outcome.json_file);
}

int fail(ExitCode code, const char *message) {
    std::fflush(stdout);
    std::fprintf(stderr, "traction: %s\n", message);
    return code;
}

int run(int argc, char **argv) {
    CLI::App app{"Traction: ground speed, slip and traction of a small wheeled rover; its simulator; and the lab that finds\n"
                 "the physics its model lacks."};
    app.name("traction");
    app.set_version_flag("--version", TRACTION_VERSION);
    app.require_subcommand(1);
    app.footer("Exit codes: 0 done, 1 the answer is negative, 2 wrong command line, 3 bad input, 4 file error, 70 a bug.\n"
               "./traction also knows: test (build and run every test), build, prove, fuzz, mutate, help.");
    Outcome outcome;
#define X(name) add_##name(app, outcome);
#include "verb_list.inc"
#undef X
    try {
        app.parse(argc, argv);
        if (!outcome.json_file.empty()) write_json(outcome);
    } catch (const CLI::ParseError &error) {
        if (error.get_exit_code() == 0) return app.exit(error); // --help, --version
        app.exit(error);
        return exit_usage;
    } catch (const log::FileError &error) {
        return fail(exit_io, error.what());
    } catch (const log::LogError &error) {
        return fail(exit_bad_input, error.what());
    } catch (const std::filesystem::filesystem_error &error) {
        return fail(exit_io, error.what());
    } catch (const std::ios_base::failure &error) {
        return fail(exit_io, ("cannot read or write a file: " + error.code().message()).c_str());
    } catch (const std::logic_error &error) {
        return fail(exit_internal, (std::string("internal error, please report it: ") + error.what()).c_str());
    } catch (const std::runtime_error &error) { // ScenarioError, ModelError: the message is complete
        return fail(exit_bad_input, error.what());
    }
    return outcome.exit_code;
}

} // namespace
} // namespace traction::cli

int main(int argc, char **argv) {
#if defined(__GLIBC__) // the lab's matrices, megabytes each, come and go: given back, each would be paged in anew
    mallopt(M_MMAP_THRESHOLD, 64 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
    try {
        return traction::cli::run(argc, argv);
    } catch (const std::exception &error) {
        return traction::cli::fail(traction::cli::exit_internal, error.what());
    }
}
