#include "machine.h"

#include <cstdint>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

extern char **environ;

namespace traction::emulate {

namespace {

constexpr std::uintmax_t flash_size = 64 << 20; // of -M versatilepb
constexpr const char *program = "qemu-system-arm";

// What a command says on standard output.
std::string output_of(const char *command) {
    std::string text;
    std::FILE *pipe = ::popen(command, "r");
    char part[4096];
    for (std::size_t got = 0; pipe != nullptr && (got = std::fread(part, 1, sizeof part, pipe)) > 0;) text.append(part, got);
    if (pipe != nullptr) ::pclose(pipe);
    return text;
}

void need_file(const std::string &path) {
    if (!std::filesystem::exists(path)) throw std::runtime_error(path + ": no such file; `./traction emulate` builds the emulated board");
}

void need_flash(const std::string &path) {
    need_file(path);
    if (std::filesystem::file_size(path) != flash_size)
        throw std::runtime_error(path + ": " + std::to_string(std::filesystem::file_size(path)) + " bytes; the board's NOR flash has " +
                                 std::to_string(flash_size) + ": emulate/flash_board.sh makes one");
}

// QEMU's options are separated by commas; a comma of a name is written twice.
std::string quoted(const std::string &name) {
    std::string text;
    for (const char c : name) text += c == ',' ? std::string(",,") : std::string(1, c);
    return text;
}

std::vector<std::string> arguments(const std::string &board, const std::string &flash) {
    const std::string machine = output_of("qemu-system-arm -M versatilepb,help 2>&1");
    if (machine.empty() || machine.find("not found") != std::string::npos)
        throw std::runtime_error("no qemu-system-arm here; `./traction emulate` installs it (package qemu-system-arm)");
    const bool names_audio = machine.find("audiodev") != std::string::npos; // from QEMU 9 on the machine has to be told
    std::vector<std::string> words = {program,
                                      "-M",
                                      names_audio ? "versatilepb,audiodev=none" : "versatilepb",
                                      "-audiodev",
                                      "none,id=none",
                                      "-m",
                                      "64",
                                      "-nodefaults",
                                      "-display",
                                      "none",
                                      "-serial",
                                      "file:console.txt",
                                      "-no-reboot",
                                      "-accel",
                                      "tcg",
                                      "-icount",
                                      "shift=" + std::to_string(icount_shift) + ",sleep=off",
                                      "-rtc",
                                      "base=2024-01-01,clock=vm",
                                      "-seed",
                                      "1",
                                      "-semihosting-config",
                                      "enable=on,target=native,userspace=on",
                                      "-kernel",
                                      board + "/zImage",
                                      "-dtb",
                                      board + "/versatile-pb.dtb",
                                      "-initrd",
                                      board + "/initramfs",
                                      "-append",
                                      "console=ttyAMA0 panic=-1 quiet norandmaps rdinit=/init"};
    if (!flash.empty()) words.insert(words.end(), {"-drive", "if=pflash,format=raw,file=" + quoted(flash)});
    return words;
}

pid_t start(const std::string &board, const std::string &folder, const std::string &flash) {
    std::vector<std::string> words = arguments(board, flash);
    std::vector<char *> argv;
    for (std::string &word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, "qemu.txt", O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::posix_spawn_file_actions_adddup2(&actions, 1, 2);
    posix_spawnattr_t own_group; // a Ctrl-C is ours to answer: the board is stopped as its operator would stop it
    ::posix_spawnattr_init(&own_group);
    ::posix_spawnattr_setflags(&own_group, POSIX_SPAWN_SETPGROUP);
    pid_t pid = -1;
    const int error = ::posix_spawnp(&pid, program, &actions, &own_group, argv.data(), environ);
    ::posix_spawnattr_destroy(&own_group);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error(std::string(program) + ": cannot be started: " + std::strerror(error));
    return pid;
}

int make_fifo(const std::string &path, int flags) {
    std::filesystem::remove(path);
    const int fd = ::mkfifo(path.c_str(), 0600) == 0 ? ::open(path.c_str(), flags | O_CLOEXEC) : -1;
    if (fd < 0) throw std::runtime_error(path + ": no FIFO can be made there: " + std::strerror(errno));
    return fd;
}

// The last lines of a file, for a message.
std::string end_of(const std::string &path) {
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    return text.size() > 600 ? text.substr(text.size() - 600) : text;
}

} // namespace

Machine::Machine(const std::string &board, const std::string &folder, const std::string &flash) : folder_(folder) {
    const std::string from = std::filesystem::absolute(board).string();
    const std::string nor = flash.empty() ? flash : std::filesystem::absolute(flash).string();
    for (const char *file : {"zImage", "versatile-pb.dtb", "initramfs"}) need_file(from + '/' + file);
    in_ = make_fifo(folder + "/to_world", O_RDONLY | O_NONBLOCK);
    out_ = make_fifo(folder + "/to_board", O_RDWR); // also ours to read, so that opening and writing never fail for want of a reader
    records_ = ::open((folder + "/records").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (records_ < 0) throw std::runtime_error(folder + "/records: cannot be written: " + std::strerror(errno));
    if (!nor.empty()) need_flash(nor);
    qemu_ = start(from, folder, nor);
}

Machine::~Machine() {
    if (!ended()) {
        (void)::kill(qemu_, SIGKILL);
        (void)::waitpid(qemu_, nullptr, 0);
    }
    for (const int fd : {in_, out_, records_})
        if (fd >= 0) ::close(fd);
}

bool Machine::ended() {
    if (qemu_ > 0 && ::waitpid(qemu_, &status_, WNOHANG) == qemu_) qemu_ = -1;
    return qemu_ <= 0;
}

void Machine::fail(const std::string &what) const {
    throw std::runtime_error("the emulated board " + what + "\n" + end_of(folder_ + "/qemu.txt") + end_of(folder_ + "/console.txt"));
}

void Machine::record(const void *data, std::size_t length) {
    if (::write(records_, data, length) != static_cast<ssize_t>(length))
        throw std::runtime_error(folder_ + "/records: cannot be written: " + std::strerror(errno));
}

void Machine::read(void *data, std::size_t length) {
    using Clock = std::chrono::steady_clock;
    auto *at = static_cast<char *>(data);
    auto heard = Clock::now();
    for (std::size_t left = length; left > 0;) {
        pollfd wait{.fd = in_, .events = POLLIN, .revents = 0};
        (void)::poll(&wait, 1, 200);
        const ssize_t got = ::read(in_, at, left);
        if (got > 0) {
            at += got;
            left -= static_cast<std::size_t>(got);
            heard = Clock::now();
            continue;
        }
        if (ended()) fail("ended before its run did");
        if (got == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5)); // nobody has opened it yet
        if (std::chrono::duration<double>(Clock::now() - heard).count() > patience_s) fail("says nothing any more");
    }
    record(data, length);
}

void Machine::write(const void *data, std::size_t length) {
    const auto *at = static_cast<const char *>(data);
    for (std::size_t left = length; left > 0;) {
        const ssize_t put = ::write(out_, at, left);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) fail(std::string("cannot be written to: ") + std::strerror(errno));
        at += put;
        left -= static_cast<std::size_t>(put);
    }
    record(data, length);
}

BoardSays Machine::hear() {
    BoardSays board;
    read(&board.head, sizeof board.head);
    if (board.head.version != LOCKSTEP_VERSION || board.head.frames > LOCKSTEP_FRAMES) fail("is of another version: build it again");
    board.frames.resize(board.head.frames);
    if (!board.frames.empty()) read(board.frames.data(), board.frames.size() * sizeof board.frames[0]);
    return board;
}

// In one piece: the board is not woken between.
void Machine::say(const WorldSays &world) {
    std::vector<char> bytes(sizeof world.head);
    std::memcpy(bytes.data(), &world.head, sizeof world.head);
    const auto add = [&bytes](const void *data, std::size_t length) {
        const auto *from = static_cast<const char *>(data);
        bytes.insert(bytes.end(), from, from + length);
    };
    add(world.frames.data(), world.frames.size() * sizeof(lockstep_frame_t));
    add(world.samples.data(), world.samples.size() * sizeof(std::int32_t));
    write(bytes.data(), bytes.size());
}

void Machine::finish() {
    using Clock = std::chrono::steady_clock;
    for (const auto from = Clock::now(); !ended();) {
        if (std::chrono::duration<double>(Clock::now() - from).count() > patience_s) fail("does not end");
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) fail("could not hand out its files");
}

} // namespace traction::emulate
