// main.cpp - the command line: registers the verbs, runs one, turns what went wrong into one message and an exit code.
#include "parse.h"
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

#define X(name) Verb verb_##name();
#include "verb_list.inc"
#undef X

const std::vector<Verb> &all_verbs() {
    static const std::vector<Verb> verbs = {
#define X(name) verb_##name(),
#include "verb_list.inc"
#undef X
    };
    return verbs;
}

const std::vector<Group> &all_groups() {
    static const std::vector<Group> groups = {{"bench", "measure this build beside its peers"}};
    return groups;
}

namespace {

void write_json(const Outcome &outcome, const std::string &path) {
    const std::string temporary = path + ".part";
    std::ofstream file;
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file.open(temporary);
    file << outcome.json.dump(1) << '\n';
    file.close();
    std::filesystem::rename(temporary, path);
}

int fail(ExitCode code, const char *message) {
    std::fflush(stdout);
    std::fprintf(stderr, "traction: %s\n", message);
    return code;
}

int run(int argc, char **argv) {
    const Parsed parsed = parse(argc, argv);
    if (parsed.verb == nullptr) {
        std::fputs(parsed.text.c_str(), parsed.exit_code == exit_done ? stdout : stderr);
        return parsed.exit_code;
    }
    Outcome outcome;
    try {
        parsed.verb->run(outcome);
        if (!parsed.json_file.empty()) write_json(outcome, parsed.json_file);
    } catch (const UsageError &error) {
        return fail(exit_usage, (parsed.verb->name + ": " + error.what()).c_str());
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
