#include "scratch.h"

#include "log.h"
#include "replaced_by.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
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

// The head of a block, its checks made.
part::BlockHead block_head(part::Kind kind, std::span<const std::string_view> pieces) {
    part::BlockHead head{static_cast<std::uint32_t>(kind), 0, 0, 0, 0};
    for (const std::string_view piece : pieces) {
        head.size += static_cast<std::uint32_t>(piece.size());
        head.payload_check = part::crc_after(head.payload_check, piece.data(), piece.size());
    }
    head.check = part::head_check(head);
    return head;
}
std::string_view bytes_of(const part::BlockHead &head) { return {reinterpret_cast<const char *>(&head), sizeof head}; }

constexpr std::array<char, Scratch::filled_most> nothing{};

} // namespace

Scratch::Scratch(std::string path, Name name) : path_(std::move(path)), name_(name) {}

Scratch::~Scratch() {
    if (fd_ >= 0) close(fd_);
}

void Scratch::fail() const {
    const std::string left = part_.empty() ? "" : "; what was recorded until now: traction recover " + part_;
    throw FileError(path_, 0, 0, std::string("cannot be written: ") + std::strerror(errno),
                    "give a path that can be, with space for the log twice" + left);
}

// False: it cannot be created (errno).
bool Scratch::open_part() {
    const std::string target = replaced_by(path_);
    if (target.empty()) return true;
    for (int number = 1; number < 1000; ++number) {
        const std::string part = target + (number == 1 ? "" : '.' + std::to_string(number)) + ".part";
        fd_ = ::open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd_ < 0 && errno == EEXIST) continue;
        if (fd_ < 0) return errno == ENAMETOOLONG;
        struct stat old {};
        if (::stat(target.c_str(), &old) == 0) (void)::fchmod(fd_, old.st_mode & 0777); // as the log will have them
        (void)::flock(fd_, LOCK_EX | LOCK_NB);                                          // its writer goes on: recover waits
        part_ = part;
        synced_ = std::chrono::steady_clock::now();
        put({std::string_view(part::magic)});
        return true;
    }
    return false;
}

void Scratch::open() {
    if (fd_ >= 0) return;
    if (name_ == Name::part && !open_part()) fail();
    if (fd_ < 0) fd_ = unnamed_file(folder_of(path_));
    if (fd_ < 0) fail();
}

// In one call where it is one: many small ones cost the kernel twice as much.
void Scratch::put(std::vector<std::string_view> pieces) {
    std::erase_if(pieces, [](std::string_view piece) { return piece.empty(); });
    std::vector<iovec> next;
    for (auto first = pieces.begin(); first != pieces.end();) {
        next.clear();
        for (auto one = first; one != pieces.end() && next.size() < IOV_MAX; ++one)
            next.push_back({const_cast<char *>(one->data()), one->size()});
        const ssize_t done = pwritev(fd_, next.data(), static_cast<int>(next.size()), static_cast<off_t>(end_));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) fail();
        end_ += static_cast<std::uint64_t>(done);
        auto rest = static_cast<std::size_t>(done);
        for (; first != pieces.end() && rest >= first->size(); ++first) rest -= first->size();
        if (first != pieces.end()) first->remove_prefix(rest);
    }
}

std::uint64_t Scratch::append(part::Kind kind, std::span<const std::string_view> pieces) {
    open();
    const part::BlockHead head = block_head(kind, pieces);
    const std::uint64_t place = end_ + sizeof head;
    std::vector<std::string_view> whole{bytes_of(head)};
    whole.insert(whole.end(), pieces.begin(), pieces.end());
    const std::size_t left = stretch - (place + head.size) % stretch;
    part::BlockHead filling{};
    if (left >= sizeof filling && left <= filled_most) {
        const std::string_view zeros(nothing.data(), left - sizeof filling);
        filling = block_head(part::Kind::filling, {&zeros, 1});
        whole.insert(whole.end(), {bytes_of(filling), zeros});
    }
    put(std::move(whole));
    if (!lasts()) return place;
    if (const auto now = std::chrono::steady_clock::now(); now - synced_ >= sync_every) {
        synced_ = now;
        if (::fdatasync(fd_) != 0 && errno != EINVAL && errno != ENOTSUP && errno != EINTR) fail();
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

void Scratch::remove() {
    struct stat named {
    }, ours{};
    if (part_.empty() || ::lstat(part_.c_str(), &named) != 0 || ::fstat(fd_, &ours) != 0) return;
    if (named.st_dev == ours.st_dev && named.st_ino == ours.st_ino) ::unlink(part_.c_str());
    part_.clear();
}

} // namespace traction::log
