#include "scratch.h"

#include "log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace traction::log {

namespace {

// The folder in which the log will stand, when it will be a file there.
std::string folder_of(const std::string &path) {
    struct stat there {};
    const bool in_place = path == "-" || (stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode));
    if (in_place) return std::filesystem::temp_directory_path().string();
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

int unnamed_file(const std::string &folder) {
    const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (fd >= 0) return fd;
    std::string name = folder + "/.spool.XXXXXX"; // a file system without O_TMPFILE
    const int named = mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0) unlink(name.c_str());
    return named;
}

} // namespace

Scratch::Scratch(std::string path) : path_(std::move(path)) {}

Scratch::~Scratch() {
    if (fd_ >= 0) close(fd_);
}

void Scratch::fail() const {
    throw FileError(path_, 0, 0, std::string("cannot be written: ") + std::strerror(errno),
                    "give a path that can be, with space for the log twice");
}

void Scratch::open() {
    if (fd_ < 0) fd_ = unnamed_file(folder_of(path_));
    if (fd_ < 0) fail();
}

std::uint64_t Scratch::append(const void *bytes, std::size_t size) {
    open();
    const std::uint64_t place = end_;
    const char *from = static_cast<const char *>(bytes);
    while (size > 0) {
        const ssize_t done = pwrite(fd_, from, size, static_cast<off_t>(end_));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) fail();
        from += done, size -= static_cast<std::size_t>(done), end_ += static_cast<std::uint64_t>(done);
    }
    return place;
}

void Scratch::read(std::uint64_t at, void *bytes, std::size_t size) const {
    char *to = static_cast<char *>(bytes);
    while (size > 0) {
        const ssize_t done = pread(fd_, to, size, static_cast<off_t>(at));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) fail();
        to += done, size -= static_cast<std::size_t>(done), at += static_cast<std::uint64_t>(done);
    }
}

} // namespace traction::log
