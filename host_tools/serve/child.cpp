#include "child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace traction::serve {

namespace {

constexpr int progress_fd = 3;

// A pipe whose ends close by themselves.
struct Pipe {
    int read = -1, write = -1;
    Pipe() {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(std::string("no pipe can be made: ") + std::strerror(errno));
        read = ends[0], write = ends[1];
        for (int *end : {&read, &write}) // out of the way of 0 to 3, which the child gets
            if (*end <= progress_fd) {
                const int moved = fcntl(*end, F_DUPFD_CLOEXEC, progress_fd + 1);
                close(*end);
                *end = moved;
            }
    }
    ~Pipe() {
        end(read);
        end(write);
    }
    Pipe(const Pipe &) = delete;
    Pipe &operator=(const Pipe &) = delete;
    static void end(int &fd) {
        if (fd >= 0) close(fd);
        fd = -1;
    }
};

// After fork, in the child: nothing but system calls.
[[noreturn]] void become(const char *program, char *const *arguments, char *const *environment, int nothing, int out, int err, int told,
                         int last_fd, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(127);
    setpgid(0, 0); // Ctrl-C is for the server, which ends us as it sees fit
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    dup2(nothing, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    dup2(told, progress_fd);
    for (int fd = progress_fd + 1; fd < last_fd; ++fd) close(fd);
    execve(program, arguments, environment);
    _exit(127);
}

void keep_tail(std::string &text, std::size_t most) {
    if (text.size() > 2 * most) text.erase(0, text.size() - most);
}

// The whole lines of `text`, each handed on and taken away.
template <typename Each> void lines(std::string &text, const Each &each) {
    std::size_t from = 0;
    for (std::size_t end; (end = text.find('\n', from)) != std::string::npos; from = end + 1) each(text.substr(from, end - from));
    text.erase(0, from);
}

std::vector<char *> pointers(std::vector<std::string> &texts) {
    std::vector<char *> all;
    for (std::string &text : texts) all.push_back(text.data());
    all.push_back(nullptr);
    return all;
}

void tell_progress(const std::string &line, const Listening &listening) {
    char *end = nullptr;
    const long done = std::strtol(line.c_str(), &end, 10), total = std::strtol(end, &end, 10);
    if (listening.progress && total > 0) listening.progress(done, total, *end == ' ' ? end + 1 : end);
}

} // namespace

Finished run_child(const std::string &program, const std::vector<std::string> &arguments, const Listening &listening,
                   const std::atomic<int> &stop) {
    Pipe out, err, told;
    const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    std::vector<std::string> words{program}, settings{"TRACTION_PROGRESS_FD=" + std::to_string(progress_fd)};
    words.insert(words.end(), arguments.begin(), arguments.end());
    for (char **setting = environ; *setting != nullptr; ++setting)
        if (std::strncmp(*setting, "TRACTION_PROGRESS_FD=", 21) != 0) settings.emplace_back(*setting);
    std::vector<char *> argv = pointers(words), envp = pointers(settings);
    struct rlimit limit {};
    const int last_fd = getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < 65536 ? static_cast<int>(limit.rlim_cur) : 65536;
    const pid_t parent = getpid(), child = fork();
    if (child == 0) become(program.c_str(), argv.data(), envp.data(), nothing, out.write, err.write, told.write, last_fd, parent);
    if (nothing >= 0) close(nothing);
    if (child < 0) throw std::runtime_error(std::string("no program can be started: ") + std::strerror(errno));
    for (Pipe *pipe : {&out, &err, &told}) Pipe::end(pipe->write);

    Finished finished;
    std::string steps;
    using clock = std::chrono::steady_clock;
    clock::time_point asked{};
    bool killed = false;
    std::array<pollfd, 3> wait{{{out.read, POLLIN, 0}, {err.read, POLLIN, 0}, {told.read, POLLIN, 0}}};
    const std::array<std::string *, 3> into{&finished.out, &finished.trouble, &steps};
    while (wait[0].fd >= 0 || wait[1].fd >= 0 || wait[2].fd >= 0) {
        if (stop != 0 && asked == clock::time_point{}) {
            kill(child, stop);
            asked = clock::now();
        }
        if (!killed && asked != clock::time_point{} && clock::now() - asked > std::chrono::seconds(5)) killed = kill(child, SIGKILL) == 0;
        if (poll(wait.data(), wait.size(), 100) <= 0) continue;
        for (std::size_t i = 0; i < wait.size(); ++i) {
            if (wait[i].fd < 0 || wait[i].revents == 0) continue;
            std::array<char, 16384> bytes;
            const ssize_t got = read(wait[i].fd, bytes.data(), bytes.size());
            if (got > 0)
                into[i]->append(bytes.data(), static_cast<std::size_t>(got));
            else if (got == 0 || errno != EINTR)
                wait[i].fd = -1;
        }
        lines(steps, [&](const std::string &line) { tell_progress(line, listening); });
        if (listening.line) lines(finished.out, listening.line);
        keep_tail(finished.out, 200000);
        keep_tail(finished.trouble, 20000);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    finished.exit_code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return finished;
}

} // namespace traction::serve
