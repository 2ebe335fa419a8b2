// main.cpp - the command line: runs one verb, turns what went wrong into one message and an exit code.
#include "data_files.h"
#include "parse.h"
#include "progress.h"
#include "verbs.h"

#include "host_tools/log/log.h"
#include "host_tools/log/write_file.h"

#include <cstdlib>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
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

int fail(ExitCode code, const std::string &message) {
    std::fflush(stdout);
    std::fprintf(stderr, "traction: %s\n", message.c_str());
    return code;
}

void end_by_signal(int signal) {
    log::remove_temporaries();
    std::signal(signal, SIG_DFL);
    std::raise(signal);
}

// Descriptors 0 to 2 are open, so that no file gets the number of standard output; a reader that goes away is an error, not a signal;
// a signal that ends the program leaves no temporary behind.
void prepare() {
    for (int fd = 0; fd <= 2; ++fd)
        if (fcntl(fd, F_GETFD) < 0 && open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY) != fd) std::abort(); // using it fails
    std::signal(SIGPIPE, SIG_IGN);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old {};
        if (sigaction(signal, nullptr, &old) == 0 && old.sa_handler != SIG_IGN) std::signal(signal, end_by_signal); // nohup stays
    }
}

// Where the verb's own words go: to standard output, to stderr when a result goes to standard output, nowhere with --quiet.
void place_words(bool quiet, bool result_on_stdout) {
    if (!quiet && !result_on_stdout) return;
    if (result_on_stdout) {
        const int result = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
        if (result >= 0) log::set_standard_output(result);
    }
    const int nowhere = quiet ? open("/dev/null", O_WRONLY | O_CLOEXEC) : -1;
    dup2(quiet ? nowhere : STDERR_FILENO, STDOUT_FILENO);
    if (nowhere >= 0) close(nowhere);
}

// The files that a verb reads, each with how it was given.
std::vector<std::pair<std::string, std::string>> files_read(const Verb &verb) {
    std::vector<std::pair<std::string, std::string>> files;
    for (const Option &option : verb.options) {
        if (option.kind != Kind::input && option.kind != Kind::scenario && option.kind != Kind::model && option.kind != Kind::rover &&
            option.kind != Kind::log)
            continue;
        const std::string given_as = option.argument.empty() ? option.name : option.argument;
        if (std::vector<std::string> *const *paths = std::get_if<std::vector<std::string> *>(&option.into))
            for (const std::string &one : **paths) files.emplace_back(one, given_as);
        if (std::string *const *path = std::get_if<std::string *>(&option.into)) files.emplace_back(**path, given_as);
    }
    return files;
}

// The files of a verb's output options: they can be written, are all different, none is a file that is read, whatever name or link leads
// there, and nobody else writes them while the verb works.
std::vector<log::Claim> claim_outputs(const Parsed &parsed) {
    std::vector<log::Claim> claims;
    std::vector<std::pair<std::string, std::string>> targets = {}; // file, option
    const std::vector<std::pair<std::string, std::string>> read = files_read(*parsed.verb);
    const auto claim = [&](const std::string &option, const std::string &path) {
        if (path.empty()) return;
        const log::Claim &made = claims.emplace_back(path);
        const std::string target = log::is_standard_output(path) ? "-" : made.target();
        for (const auto &[other, name] : targets)
            if (!target.empty() && other == target) throw UsageError(option + " and " + name + " name the same file, " + path);
        targets.emplace_back(target, option);
        std::error_code none; // what is not there is no file that is read
        for (const auto &[file, given_as] : read)
            if (!target.empty() && std::filesystem::equivalent(target, file, none))
                throw UsageError(option + " names a file that is read, " + path + " (" + given_as +
                                 "): give another name, and that one stays as it is");
    };
    for (const Option &option : parsed.verb->options)
        if (option.kind == Kind::output) claim(option.name, *std::get<std::string *>(option.into));
    claim("--json", parsed.json_file);
    return claims;
}

// Whether a result goes to standard output. Every name of it ("/dev/stdout") becomes "-", because the words move away from there.
bool takes_standard_output(Parsed &parsed) {
    bool taken = false;
    const auto take = [&](std::string &path) {
        if (!log::is_standard_output(path)) return;
        path = "-";
        taken = true;
    };
    take(parsed.json_file);
    for (const Option &option : parsed.verb->options)
        if (option.kind == Kind::output) take(*std::get<std::string *>(option.into));
    return taken;
}

// The folder in which files of a kind lie; empty for what lies nowhere in particular.
std::string folder_of(Kind kind) {
    if (kind == Kind::scenario) return "scenarios";
    if (kind == Kind::model) return "models";
    if (kind == Kind::rover) return "rovers";
    return kind == Kind::input ? "models/maps" : "";
}

// Scenarios, models and rovers are found from any folder.
void find_data(const Verb &verb) {
    for (const Option &option : verb.options) {
        const std::string folder = folder_of(option.kind);
        if (std::vector<std::string> *const *paths = std::get_if<std::vector<std::string> *>(&option.into); !folder.empty() && paths)
            for (std::string &one : **paths) one = data_file(one, folder);
        std::string *const *path = std::get_if<std::string *>(&option.into);
        if (!folder.empty() && path != nullptr) **path = data_file(**path, folder);
    }
}

int run(Parsed parsed) {
    const Verb &verb = *parsed.verb;
    Outcome outcome;
    if (parsed.quiet) Progress::silence();
    try {
        find_data(verb);
        const std::vector<log::Claim> claims = claim_outputs(parsed);
        place_words(parsed.quiet, takes_standard_output(parsed));
        verb.run(outcome);
        // a verb that ends without an answer (exit code) writes none
        if (!parsed.json_file.empty() && !outcome.json.is_null()) log::write_file(outcome.json.dump(1) + '\n', parsed.json_file);
    } catch (const UsageError &error) {
        return fail(exit_usage, verb.name + ": " + error.what());
    } catch (const log::FileError &error) {
        return fail(exit_io, error.what());
    } catch (const log::LogError &error) {
        return fail(exit_bad_input, error.what());
    } catch (const std::filesystem::filesystem_error &error) {
        return fail(exit_io, error.path1().string() + ": cannot be read: " + error.code().message());
    } catch (const std::ios_base::failure &error) {
        return fail(exit_io, "cannot read or write a file: " + error.code().message());
    } catch (const std::logic_error &error) {
        return fail(exit_internal, std::string("internal error, please report it: ") + error.what());
    } catch (const std::runtime_error &error) { // ScenarioError, ModelError: the message is complete
        return fail(exit_bad_input, error.what());
    }
    return outcome.exit_code;
}

// Words that could not be written are an error, whatever the verb answered: `traction effects > /dev/full` is no success.
int close_stdout(int code) {
    errno = 0;
    const bool bad = std::ferror(stdout) != 0;
    int error = 0;
    if (bad) { // the system's reason is forgotten where more was printed since: asked again
        std::clearerr(stdout);
        if (std::fputc('\n', stdout) == EOF || std::fflush(stdout) != 0) error = errno;
    }
    if (std::fclose(stdout) == 0 && !bad) return code;
    if (error == 0) error = errno;
    if (error != EPIPE) // `| head` has what it wanted
        std::fprintf(stderr, "traction: standard output: cannot be written: %s\n",
                     error != 0 ? std::strerror(error) : "an earlier write failed");
    return code == exit_done || code == exit_negative ? static_cast<int>(exit_io) : code;
}

int run(int argc, char **argv) {
    const Parsed parsed = parse(argc, argv);
    if (parsed.verb != nullptr) return run(parsed);
    std::fputs(parsed.text.c_str(), parsed.exit_code == exit_done ? stdout : stderr);
    return parsed.exit_code;
}

} // namespace
} // namespace traction::cli

int main(int argc, char **argv) {
    using namespace traction::cli;
#if defined(__GLIBC__) // the lab's matrices, megabytes each, come and go: given back, each would be paged in anew
    mallopt(M_MMAP_THRESHOLD, 64 << 20);
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
    prepare();
    int code = exit_internal;
    try {
        code = run(argc, argv);
    } catch (const std::exception &error) {
        code = fail(exit_internal, error.what());
    }
    return close_stdout(code);
}
