#include "report.h"
#include "svg.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <string>

extern char **environ;

namespace traction::report {

namespace {

// Runs a program found in PATH, its stderr into a file; returns its exit status, 127 when it cannot be started.
int run(std::array<std::string, 8> words, const std::string &complaints) {
    std::array<char *, 9> argv{};
    std::size_t count = 0;
    for (std::string &word : words)
        if (!word.empty()) argv[count++] = word.data();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, complaints.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    pid_t child = 0;
    const int started = posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (started != 0) return 127;
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR) return 127;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

} // namespace

void write_png(const std::string &svg, const std::string &path, double zoom) {
    namespace fs = std::filesystem;
    const std::string drawing = path + ".svg.part", part = path + ".part", complaints = path + ".err.part";
    write_text(svg, drawing);
    const int status = run({"rsvg-convert", "--unlimited", "--format=png", "--zoom=" + std::to_string(std::clamp(zoom, 0.1, 10.0)),
                            "--output=" + part, drawing, "", ""},
                           complaints);
    std::error_code ignored;
    fs::remove(drawing, ignored);
    fs::remove(complaints, ignored);
    if (status == 127)
        throw ReportError(path + ": a PNG needs the program rsvg-convert; install the package librsvg2-bin, or ask for .svg");
    if (status != 0 || !fs::exists(part)) {
        fs::remove(part, ignored);
        throw ReportError(path + ": rsvg-convert refused the drawing (status " + std::to_string(status) + "); ask for .svg instead");
    }
    fs::rename(part, path);
}

} // namespace traction::report
