// scratch.h - a file without a name, in the folder of the log that is being made (or in that of temporaries): gone with the process
// whatever ends it. What does not fit in memory waits there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace traction::log {

class Scratch {
  public:
    explicit Scratch(std::string path); // of the log; nothing is opened before open or the first append
    ~Scratch();
    Scratch(const Scratch &) = delete;
    Scratch &operator=(const Scratch &) = delete;

    void open();                                               // now, where it is not; throws FileError
    std::uint64_t append(const void *bytes, std::size_t size); // its place; throws FileError
    void read(std::uint64_t at, void *bytes, std::size_t size) const;
    const std::string &path() const { return path_; }

  private:
    [[noreturn]] void fail() const; // errno
    std::string path_;
    int fd_ = -1;
    std::uint64_t end_ = 0;
};

} // namespace traction::log
