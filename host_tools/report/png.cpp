#include "report.h"
#include "svg.h"

#include "host_tools/log/write_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
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

// A folder of its own for what rsvg-convert reads and writes.
struct Workshop {
    Workshop() : path((std::filesystem::temp_directory_path() / "traction_png_XXXXXX").string()) {
        if (mkdtemp(path.data()) == nullptr)
            throw log::FileError(path, 0, 0, std::string("cannot be made: ") + std::strerror(errno), "set TMPDIR to a folder with room");
    }
    ~Workshop() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    Workshop(const Workshop &) = delete;
    Workshop &operator=(const Workshop &) = delete;
    std::string path;
};

} // namespace

void write_png(const std::string &svg, const std::string &path, double zoom) {
    namespace fs = std::filesystem;
    const Workshop workshop;
    const std::string drawing = workshop.path + "/drawing.svg", pixels = workshop.path + "/drawing.png";
    log::write_file(svg, drawing);
    const int status = run({"rsvg-convert", "--unlimited", "--format=png", "--zoom=" + std::to_string(std::clamp(zoom, 0.1, 10.0)),
                            "--output=" + pixels, drawing, "", ""},
                           workshop.path + "/complaints");
    if (status == 127)
        throw ReportError(path + ": a PNG needs the program rsvg-convert; install the package librsvg2-bin, or ask for .svg");
    if (status != 0 || !fs::exists(pixels))
        throw ReportError(path + ": rsvg-convert refused the drawing (status " + std::to_string(status) + "); ask for .svg instead");
    std::ifstream file(pixels, std::ios::binary);
    log::write_file(std::string(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()), path);
}

} // namespace traction::report
