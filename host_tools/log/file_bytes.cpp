#include "table.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace traction::log {

FileBytes::FileBytes(const std::string &path, std::size_t limit) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        throw FileError(path, 0, 0, std::string("cannot be opened: ") + std::strerror(errno), "check the path and its permissions");
    }
    struct stat info {};
    if (::fstat(fd, &info) != 0 || S_ISDIR(info.st_mode)) {
        ::close(fd);
        throw FileError(path, 0, 0, "is a folder, not a log", "name a CSV file in it");
    }
    const auto too_large = [&](std::size_t bytes) {
        ::close(fd);
        throw LogError(path, 0, 0,
                       "is too large: " + std::to_string(bytes >> 20) + " MiB, the limit is " + std::to_string(limit >> 20) + " MiB",
                       "cut it into parts, or leave out the fastest columns");
    };
    if (S_ISREG(info.st_mode)) {
        size_ = static_cast<std::size_t>(info.st_size);
        if (size_ > limit) too_large(size_);
        if (size_ != 0) {
            mapped_ = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, fd, 0);
            if (mapped_ == MAP_FAILED) {
                mapped_ = nullptr;
                ::close(fd);
                throw FileError(path, 0, 0, std::string("cannot be read: ") + std::strerror(errno), "check the disk");
            }
            data_ = static_cast<const char *>(mapped_);
        }
    } else {
        char buffer[65536];
        for (;;) {
            const ssize_t got = ::read(fd, buffer, sizeof buffer);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) break;
            owned_.append(buffer, static_cast<std::size_t>(got));
            if (owned_.size() > limit) too_large(owned_.size());
        }
        data_ = owned_.data();
        size_ = owned_.size();
    }
    ::close(fd);
}

FileBytes::~FileBytes() {
    if (mapped_ != nullptr) ::munmap(mapped_, size_);
}

} // namespace traction::log
