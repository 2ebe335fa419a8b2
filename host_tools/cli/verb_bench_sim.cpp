// verb_bench_sim.cpp - traction bench sim: how fast the simulator is, beside its peers. Runs tests/bench/sim_bench, which links
// them, so that the CLI itself needs none.
#include "verbs.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>

namespace traction::cli {

namespace {

// Beside this program in the build folder.
std::filesystem::path bench_program() {
    const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe");
    return own.parent_path() / ".." / ".." / "tests" / "bench" / "sim_bench";
}

int run_program(const std::string &program, int rounds, const std::string &json) {
    const std::string count = std::to_string(rounds);
    const pid_t child = fork();
    if (child < 0) throw std::filesystem::filesystem_error("cannot start", program, std::error_code(errno, std::generic_category()));
    if (child == 0) {
        execl(program.c_str(), program.c_str(), "--rounds", count.c_str(), "--json", json.c_str(), static_cast<char *>(nullptr));
        _exit(127);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return exit_internal;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        throw std::filesystem::filesystem_error("cannot run; build it with ninja sim_bench", program,
                                                std::error_code(ENOENT, std::generic_category()));
    return WIFEXITED(status) ? WEXITSTATUS(status) : exit_internal;
}

} // namespace

Verb verb_bench_sim() {
    const auto rounds = std::make_shared<int>(5);
    return {.name = "bench sim",
            .summary = "simulated seconds per CPU second, beside ODE contacts and MuJoCo",
            .options = {{.name = "--rounds",
                         .into = rounds.get(),
                         .help = "interleaved rounds; the median is shown",
                         .shows_default = true,
                         .range = Range{1, 1000}}},
            .run = [rounds](Outcome &outcome) {
                const std::filesystem::path json =
                    std::filesystem::temp_directory_path() / ("traction_bench_sim_" + std::to_string(getpid()) + ".json");
                outcome.exit_code = run_program(bench_program().string(), *rounds, json.string());
                std::ifstream file(json);
                if (file) outcome.json = nlohmann::json::parse(file);
                file.close();
                std::filesystem::remove(json);
            }};
}

} // namespace traction::cli
