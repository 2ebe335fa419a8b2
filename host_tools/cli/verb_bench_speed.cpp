// verb_bench_speed.cpp - traction bench speed: ground speed by the paper's method and by ours, table by profile. Runs
// tests/bench/speed_bench, whose radar signals come from the tests' own generator and from the simulator.
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
    return own.parent_path() / ".." / ".." / "tests" / "bench" / "speed_bench";
}

int run_program(const std::string &program, int seeds, const std::string &json) {
    const std::string count = std::to_string(seeds);
    const pid_t child = fork();
    if (child < 0) throw std::filesystem::filesystem_error("cannot start", program, std::error_code(errno, std::generic_category()));
    if (child == 0) {
        execl(program.c_str(), program.c_str(), "--seeds", count.c_str(), "--json", json.c_str(), static_cast<char *>(nullptr));
        _exit(127);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return exit_internal;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        throw std::filesystem::filesystem_error("cannot run; build it with ninja speed_bench", program,
                                                std::error_code(ENOENT, std::generic_category()));
    return WIFEXITED(status) ? WEXITSTATUS(status) : exit_internal;
}

} // namespace

Verb verb_bench_speed() {
    const auto seeds = std::make_shared<int>(12);
    return {.name = "bench speed",
            .summary = "ground speed from the radar: the paper's method and ours, by profile; exit 1 when a goal is missed",
            .options = {{.name = "--seeds",
                         .into = seeds.get(),
                         .help = "radar tracks of each profile; a third of them for the misfits",
                         .shows_default = true,
                         .range = Range{1, 1000}}},
            .run = [seeds](Outcome &outcome) {
                const std::filesystem::path json =
                    std::filesystem::temp_directory_path() / ("traction_bench_speed_" + std::to_string(getpid()) + ".json");
                outcome.exit_code = run_program(bench_program().string(), *seeds, json.string());
                std::ifstream file(json);
                if (file) outcome.json = nlohmann::json::parse(file);
                file.close();
                std::filesystem::remove(json);
            }};
}

} // namespace traction::cli
