// verb_serve.cpp - traction serve: the page of the lab, live, over a folder of logs and models.
#include "verbs.h"

#if TRACTION_WITH_SERVE
#include "data_files.h"
#include "stop_signal.h"

#if TRACTION_WITH_LINK
#include "host_tools/drive/operator.h"
#endif
#include "host_tools/serve/http.h"
#include "host_tools/serve/token.h"

#include <fcntl.h>
#include <spawn.h>
#include <stdexcept>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <thread>
#endif

#include <memory>
#include <string>

namespace traction::cli {

namespace {

struct ServeOptions {
    std::string folder = ".", host, key;
    int port = 8471, system = 1;
    bool open = false;
};

#if TRACTION_WITH_SERVE

// Asks the desktop for a browser; it goes its own way.
void open_browser(const std::string &address) {
    std::string program = "xdg-open", url = address;
    std::array<char *, 3> arguments{program.data(), url.data(), nullptr};
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) posix_spawn_file_actions_addopen(&files, fd, "/dev/null", O_RDWR, 0);
    pid_t child = 0;
    if (const int error = posix_spawnp(&child, program.c_str(), &files, nullptr, arguments.data(), environ); error != 0)
        std::printf("no browser is opened (xdg-open: %s): open the address yourself\n", std::strerror(error));
    posix_spawn_file_actions_destroy(&files);
}

// The rover to be watched, its address and key judged before anything is served.
std::optional<serve::Rover> rover_of(const ServeOptions &options) {
    if (options.host.empty()) {
        if (!options.key.empty()) throw UsageError("--key: is a rover's; give its --host ADDR too");
        return std::nullopt;
    }
#if TRACTION_WITH_LINK
    const drive::Operator tried(options.host, options.key, options.system);
    const std::string key = options.key.empty() ? "" : std::filesystem::absolute(options.key).string();
    return serve::Rover{.host = options.host, .key = key, .system = options.system};
#else
    throw UsageError("--host: not in this build: there was no pymavlink when it was configured; ./traction build brings it (python3-venv)");
#endif
}

void serve_folder(const ServeOptions &options, Outcome &outcome) {
    std::error_code none;
    const std::string program = std::filesystem::read_symlink("/proc/self/exe", none).string();
    if (program.empty()) throw std::runtime_error("/proc is not mounted: this program cannot find itself to run the verbs");
    serve::Workshop workshop(options.folder, data_root(), program, rover_of(options));
    const std::filesystem::path own = std::filesystem::canonical(options.folder) / "traction_serve";
    serve::Server server(workshop, options.port, serve::keep_token((own / "token").string()));
    std::printf("serving %s\nopen    %s\nend     Ctrl-C\n", own.parent_path().c_str(), server.address().c_str());
    std::fflush(stdout);
    if (options.open) open_browser(server.address());
    const StopSignal signals("\ntraction: ending; what runs is stopped. Once more ends it without\n");
    std::jthread watcher([&server](const std::stop_token &ended) {
        while (StopSignal::asked() == 0 && !ended.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
        server.stop();
    });
    server.listen();
    watcher.request_stop();
    watcher.join();
    outcome.json = {{"schema", "traction.serve/1"}, {"runs", workshop.history()}};
    if (StopSignal::asked() == 0) throw std::runtime_error("the port was lost: the server cannot go on");
}

#else

void serve_folder(const ServeOptions &, Outcome &) {
    throw UsageError("is not in this build: install libcpp-httplib-dev, configure and build again");
}

#endif

} // namespace

Verb verb_serve() {
    const auto options = std::make_shared<ServeOptions>();
    return {.name = "serve",
            .summary = "the page, live: watches a folder, runs the lab, drives the simulated rover, plays the game",
            .options = {{.argument = "FOLDER",
                         .into = &options->folder,
                         .help = "the folder of logs and models; nothing outside it is written",
                         .kind = Kind::folder,
                         .shows_default = true},
                        {.name = "--port",
                         .into = &options->port,
                         .help = "on 127.0.0.1; 0: one that is free",
                         .shows_default = true,
                         .range = Range{0, 65535}},
                        {.name = "--host",
                         .into = &options->host,
                         .help = "a rover whose telemetry is shown and kept: where its tractiond --link listens",
                         .value = "ADDR"},
                        {.name = "--key",
                         .into = &options->key,
                         .help = "the rover's key: what is not signed with it is not believed",
                         .value = "FILE",
                         .kind = Kind::input},
                        {.name = "--system",
                         .into = &options->system,
                         .help = "the rover's MAVLink number",
                         .value = "N",
                         .shows_default = true,
                         .range = Range{1, 250}},
                        {.name = "--open", .into = &options->open, .help = "open the page in this desktop's browser"}},
            .run = [options](Outcome &outcome) { serve_folder(*options, outcome); },
            .details =
                "The address that is printed carries a token; who has it may use the page. Only this machine can reach it: for another one "
                "make a tunnel (ssh -L 8471:127.0.0.1:8471 HOST) and open the same address there."};
}

} // namespace traction::cli
