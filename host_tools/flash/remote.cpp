#include "remote.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

extern char **environ;

namespace traction::flash {

namespace {

constexpr int ssh_failed = 255, no_such_command = 127;

bool has(const std::string &text, const char *words) { return text.find(words) != std::string::npos; }

// What ssh said, in words with the mend.
NoConnection meaning(const Address &board, const std::string &said) {
    const std::string where = board.host + ":" + std::to_string(board.port);
    struct Row {
        std::vector<const char *> words;
        std::string happened, mend;
    };
    const std::vector<Row> rows = {
        {{"REMOTE HOST IDENTIFICATION HAS CHANGED"},
         "its host key is another than before: another machine answers, or its system was made anew",
         "if you know why: ssh-keygen -R " + board.host + ", then log in once by hand"},
        {{"Host key verification failed", "host key is known"},
         "its host key is not known here",
         "log in once by ssh, compare the fingerprint with the board's, and say yes"},
        {{"Permission denied", "Too many authentication failures"},
         "it refuses " + (board.identity.empty() ? "every key that ssh has" : "the key " + board.identity) + " for " + board.user,
         "put its public half into ~/.ssh/authorized_keys of " + board.user + " on the board, or give another --identity"},
        {{"Could not resolve hostname"}, "no host of this name is known", "give its address"},
        {{"UNPROTECTED PRIVATE KEY", "bad permissions"}, board.identity + " may be read by others", "chmod 600 " + board.identity},
        {{"Connection refused"}, "nothing listens there", "start the board's ssh server, or give its --port"},
        {{"timed out", "No route to host", "unreachable"}, "no answer", "is the board on, and on this network?"},
    };
    for (const Row &row : rows)
        for (const char *words : row.words)
            if (has(said, words)) return {where, row.happened, row.mend};
    const std::string first = said.substr(0, said.find('\n'));
    return {where, "the connection ended" + (first.empty() ? std::string() : ": " + first), "try ssh by hand"};
}

struct Pipe {
    Pipe() {
        if (::pipe2(end.data(), O_CLOEXEC) != 0) throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
    }
    ~Pipe() {
        shut(0);
        shut(1);
    }
    Pipe(const Pipe &) = delete;
    Pipe &operator=(const Pipe &) = delete;
    void shut(std::size_t which) {
        if (end[which] >= 0) ::close(end[which]);
        end[which] = -1;
    }
    std::array<int, 2> end{-1, -1};
};

std::vector<std::string> command_of(const Address &board, const std::vector<std::string> &words) {
    std::vector<std::string> all = {board.program, "-T",
                                    "-o",          "BatchMode=yes",
                                    "-o",          "StrictHostKeyChecking=yes",
                                    "-o",          "ConnectTimeout=" + std::to_string(board.patience_s),
                                    "-o",          "ServerAliveInterval=5",
                                    "-o",          "ServerAliveCountMax=3",
                                    "-p",          std::to_string(board.port),
                                    "-l",          board.user};
    if (!board.identity.empty()) all.insert(all.end(), {"-o", "IdentitiesOnly=yes", "-i", board.identity});
    if (!board.known_hosts.empty())
        all.insert(all.end(), {"-o", "GlobalKnownHostsFile=/dev/null", "-o", "UserKnownHostsFile=" + board.known_hosts});
    all.insert(all.end(), {"--", board.host});
    all.insert(all.end(), words.begin(), words.end());
    return all;
}

pid_t spawn(const std::vector<std::string> &words, const Pipe &in, const Pipe &out, const Pipe &error) {
    std::vector<char *> argument;
    for (const std::string &word : words) argument.push_back(const_cast<char *>(word.c_str()));
    argument.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in.end[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out.end[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, error.end[1], STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t ordinary;
    sigemptyset(&ordinary);
    sigaddset(&ordinary, SIGPIPE); // ignored here
    posix_spawnattr_setsigdefault(&attributes, &ordinary);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    std::vector<char *> environment; // ssh's words in the language that is understood here
    for (char **one = environ; *one != nullptr; one++)
        if (std::strncmp(*one, "LC_", 3) != 0 && std::strncmp(*one, "LANG", 4) != 0) environment.push_back(*one);
    environment.push_back(nullptr);
    pid_t pid = -1;
    const int failed = posix_spawnp(&pid, argument[0], &actions, &attributes, argument.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failed != 0)
        throw std::runtime_error(words[0] + ": cannot be started: " + std::strerror(failed) +
                                 "; install openssh-client (apt), or give --ssh");
    return pid;
}

// Moves bytes until both outputs are closed.
void carry(Pipe &in, Pipe &out, Pipe &error, const std::string &input, Answer &answer,
           const std::function<void(const std::string &)> &each) {
    std::size_t sent = 0;
    std::string line;
    fcntl(in.end[1], F_SETFL, O_NONBLOCK);
    if (input.empty()) in.shut(1);
    while (out.end[0] >= 0 || error.end[0] >= 0) {
        std::array<pollfd, 3> wait = {pollfd{out.end[0], POLLIN, 0}, pollfd{error.end[0], POLLIN, 0}, pollfd{in.end[1], POLLOUT, 0}};
        if (::poll(wait.data(), wait.size(), -1) < 0 && errno != EINTR) break;
        char part[4096];
        for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
            if (wait[i].revents == 0) continue;
            Pipe &from = i == 0 ? out : error;
            const ssize_t got = ::read(from.end[0], part, sizeof part);
            if (got <= 0 && errno != EINTR) from.shut(0);
            for (ssize_t k = 0; k < got; k++) {
                if (i == 1) {
                    if (answer.error.size() < 20000) answer.error += part[k];
                } else if (part[k] != '\n') {
                    if (line.size() < 2000) line += static_cast<unsigned char>(part[k]) < ' ' ? '?' : part[k]; // nothing for the terminal
                } else {
                    answer.lines.push_back(line);
                    if (each) each(line);
                    line.clear();
                }
            }
        }
        if (wait[2].revents != 0) {
            const ssize_t went = ::write(in.end[1], input.data() + sent, std::min<std::size_t>(input.size() - sent, 32768));
            sent += went > 0 ? static_cast<std::size_t>(went) : 0;
            if ((went < 0 && errno != EAGAIN && errno != EINTR) || sent == input.size()) in.shut(1); // it may refuse before it has all
        }
    }
}

} // namespace

std::string plain_word(const std::string &option, const std::string &word) {
    static const std::string known = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-/:@%";
    if (word.empty() || word[0] == '-' || word.find_first_not_of(known) != std::string::npos)
        throw std::runtime_error(option + " " + word + ": only letters, digits and . _ - / : are taken here");
    return word;
}

Answer run_on(const Address &board, const std::vector<std::string> &words, const std::string &input,
              const std::function<void(const std::string &)> &each) {
    Pipe in, out, error;
    Answer answer;
    const pid_t pid = spawn(command_of(board, words), in, out, error);
    in.shut(0);
    out.shut(1);
    error.shut(1);
    carry(in, out, error, input, answer, each);
    int status = 0;
    while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    for (char &c : answer.error)
        if (static_cast<unsigned char>(c) < ' ' && c != '\n') c = '?';
    answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (answer.status == ssh_failed || (!WIFEXITED(status))) throw meaning(board, answer.error);
    if (has(answer.error, "command not found") || has(answer.error, ": not found")) answer.status = no_such_command;
    return answer;
}

} // namespace traction::flash
