#include "write_file.h"

#include "replaced_by.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <random>
#include <utility>

namespace traction::log {

namespace {

std::atomic<int> standard_output{STDOUT_FILENO};

[[noreturn]] void refuse(const std::string &path, int error) {
    throw FileError(path, 0, 0, std::string("cannot be written: ") + std::strerror(error),
                    error == ENOSPC || error == EDQUOT || error == EFBIG ? "make room, then again"
                    : error == EPIPE                                     ? "its reader has gone"
                    : error == EISDIR                                    ? "name a file in it"
                                                                         : "check that the folder exists and may be written to");
}

// Names to be removed when a signal ends the program. Fixed room, because a handler may not allocate; a name that finds none is
// removed on every other way out.
struct Name {
    std::atomic<bool> taken{false}, set{false};
    std::array<char, PATH_MAX> text{};
};
std::array<Name, 64> names;

void remember(const std::string &file) {
    if (file.size() >= PATH_MAX) return;
    for (Name &name : names) {
        if (name.taken.exchange(true)) continue;
        std::memcpy(name.text.data(), file.c_str(), file.size() + 1);
        name.set = true;
        return;
    }
}

void forget(const std::string &file) {
    for (Name &name : names) {
        if (!name.set || file != name.text.data()) continue;
        name.set = false;
        name.taken = false;
        return;
    }
}

bool same_file(const struct stat &a, int fd) {
    struct stat b {};
    return ::fstat(fd, &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

} // namespace

bool is_standard_output(const std::string &path) {
    struct stat info {};
    if (path == "-" || path == "/dev/stdout") return true;
    return ::stat(path.c_str(), &info) == 0 && !S_ISCHR(info.st_mode) && same_file(info, standard_output);
}

std::string replaced_by(const std::string &path) {
    namespace fs = std::filesystem;
    if (is_standard_output(path)) return "";
    struct stat info {};
    if (::stat(path.c_str(), &info) == 0) {
        if (S_ISDIR(info.st_mode)) refuse(path, EISDIR);
        if (!S_ISREG(info.st_mode) || is_standard_output(path)) return "";
        std::array<char, PATH_MAX> real{};
        if (::realpath(path.c_str(), real.data()) == nullptr) refuse(path, errno);
        return real.data();
    }
    if (errno != ENOENT) refuse(path, errno);
    fs::path target = path; // free, or a link to what is not there yet
    std::error_code none;
    for (int hops = 0; fs::is_symlink(fs::symlink_status(target, none)); ++hops) {
        if (hops == 40) refuse(path, ELOOP);
        const fs::path next = fs::read_symlink(target, none);
        target = next.is_absolute() ? next : target.parent_path() / next;
    }
    const fs::path name = target.filename(); // one spelling for one file: `x` and `./x`
    if (name.empty()) refuse(path, EISDIR);
    const fs::path folder = fs::canonical(target.has_parent_path() ? target.parent_path() : fs::path("."), none);
    if (none) refuse(path, none.value());
    return (folder / name).string();
}

namespace {

// "<folder>/.<name>" with an ending, the name cut where a file system allows 255 bytes.
std::string beside(const std::string &target, const std::string &ending) {
    const std::filesystem::path p(target);
    std::string name = p.filename().string();
    if (name.size() > 200) name = name.substr(0, 180) + std::to_string(std::hash<std::string>{}(name));
    return (p.parent_path() / ('.' + name + ending)).string();
}

std::string random_ending() {
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
    std::random_device source;
    std::string ending = ".";
    for (int i = 0; i < 10; ++i) ending += letters[source() % 36];
    return ending + ".part";
}

int open_temporary(const std::string &target, const std::string &path, std::string &temporary) {
    for (int attempt = 0; attempt < 100; ++attempt) {
        temporary = beside(target, random_ending());
        const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd >= 0) {
            struct stat old {};
            if (::stat(target.c_str(), &old) == 0 && ::fchmod(fd, old.st_mode & 0777) != 0) errno = 0; // a file system without modes
            remember(temporary);
            return fd;
        }
        if (errno != EEXIST) break;
    }
    const int error = errno;
    temporary.clear();
    refuse(path, error);
}

int open_in_place(const std::string &path) {
    if (is_standard_output(path)) {
        std::fflush(stdout); // what was said before comes before
        const int fd = ::fcntl(standard_output, F_DUPFD_CLOEXEC, 3);
        if (fd < 0) refuse("standard output", errno);
        return fd;
    }
    const int fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (fd < 0) refuse(path, errno);
    return fd;
}

} // namespace

// One locked file "<folder>/.<name>.lock"; gone when the last owner is. A lock file that a killed program left is taken over.
class Lock {
  public:
    Lock(const std::string &target, const std::string &path) : file_(beside(target, ".lock")) {
        for (;;) {
            fd_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
            if (fd_ < 0) refuse(path, errno);
            if (::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
                ::close(fd_);
                throw FileError(path, 0, 0, "is being written by another run", "wait for it, or give another name");
            } // a file system without locks: unique temporaries alone keep runs apart
            struct stat info {};
            if (::lstat(file_.c_str(), &info) == 0 && same_file(info, fd_)) break;
            ::close(fd_); // its owner removed it between open and lock
        }
        remember(file_);
    }
    ~Lock() {
        ::unlink(file_.c_str()); // still locked: nobody else can own this name now
        ::close(fd_);
        forget(file_);
    }
    Lock(const Lock &) = delete;
    Lock &operator=(const Lock &) = delete;

  private:
    std::string file_;
    int fd_;
};

namespace {

std::mutex owned_mutex;
std::map<std::string, std::weak_ptr<Lock>> owned; // the locks of this process, by target

std::shared_ptr<Lock> lock_of(const std::string &target, const std::string &path) {
    const std::lock_guard guard(owned_mutex);
    std::erase_if(owned, [](const auto &one) { return one.second.expired(); });
    std::weak_ptr<Lock> &known = owned[target];
    std::shared_ptr<Lock> lock = known.lock();
    if (lock == nullptr) known = lock = std::make_shared<Lock>(target, path);
    return lock;
}

} // namespace

Claim::Claim(const std::string &path) : target_(replaced_by(path)), lock_(target_.empty() ? nullptr : lock_of(target_, path)) {}

WholeFile::WholeFile(const std::string &path) : path_(path), claim_(path) {
    fd_ = claim_.target().empty() ? open_in_place(path) : open_temporary(claim_.target(), path, temporary_);
}

WholeFile::~WholeFile() {
    if (fd_ >= 0) ::close(fd_);
    if (temporary_.empty()) return;
    ::unlink(temporary_.c_str());
    forget(temporary_);
}

void WholeFile::fail(int error) { refuse(path_ == "-" ? "standard output" : path_, error); } // the destructor cleans up

void WholeFile::flush() {
    put_out(buffer_);
    buffer_.clear();
}

void WholeFile::put_out(std::string_view rest) {
    while (!rest.empty()) {
        const ssize_t count = ::write(fd_, rest.data(), rest.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) fail(errno);
        rest.remove_prefix(static_cast<std::size_t>(count));
    }
}

void WholeFile::write(std::string_view text) {
    if (text.size() >= std::size_t{1} << 16) { // not copied once more
        flush();
        put_out(text);
        return;
    }
    buffer_ += text;
    if (buffer_.size() > std::size_t{1} << 18) flush();
}

void WholeFile::keep() {
    flush();
    if (::fsync(fd_) != 0 && !temporary_.empty() && errno != EINVAL && errno != ENOTSUP) fail(errno);
    if (::close(std::exchange(fd_, -1)) != 0 && errno != EINTR) fail(errno);
    if (temporary_.empty()) return;
    if (std::rename(temporary_.c_str(), claim_.target().c_str()) != 0) fail(errno);
    forget(temporary_);
    temporary_.clear();
}

void write_file(std::string_view text, const std::string &path) {
    WholeFile file(path);
    file.write(text);
    file.keep();
}

void set_standard_output(int fd) { standard_output = fd; }

void remove_temporaries() noexcept {
    for (const Name &name : names)
        if (name.set) ::unlink(name.text.data());
}

} // namespace traction::log
