#include "bench_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace traction::cli {

namespace {

std::filesystem::filesystem_error cannot(const std::string &what, const std::filesystem::path &file, int error) {
    return {what, file, std::error_code(error, std::generic_category())};
}

} // namespace

int run_program(const std::string &program, std::vector<std::string> &arguments) {
    std::vector<char *> argv;
    for (std::string &argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child < 0) throw cannot("cannot start", program, errno);
    if (child == 0) {
        execv(program.c_str(), argv.data());
        _exit(127);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return exit_internal;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127) throw cannot("cannot run", program, EACCES);
    return WIFEXITED(status) ? WEXITSTATUS(status) : exit_internal;
}

std::string own_program() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

void run_bench(const std::string &name, std::vector<std::string> arguments, Outcome &outcome) {
    const std::filesystem::path program = std::filesystem::path(own_program()).parent_path() / ".." / ".." / "tests" / "bench" / name;
    if (!std::filesystem::exists(program))
        throw cannot("not built (ninja " + name + " in the build folder, or ./traction bench)", program, ENOENT);
    const std::filesystem::path json =
        std::filesystem::temp_directory_path() / ("traction_" + name + "_" + std::to_string(getpid()) + ".json");
    arguments.insert(arguments.begin(), program.string());
    arguments.insert(arguments.end(), {"--json", json.string()});
    outcome.exit_code = run_program(program.string(), arguments);
    std::ifstream file(json);
    if (file) outcome.json = nlohmann::json::parse(file);
    file.close();
    std::filesystem::remove(json);
}

} // namespace traction::cli
