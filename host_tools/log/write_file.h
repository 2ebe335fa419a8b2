// write_file.h - the one way in which these tools write a file: it appears under its name when it is whole, or not at all.
//
// Where `path` leads decides what happens:
//   a name that is free, a file       a temporary of unique name beside it (O_EXCL, O_NOFOLLOW), fsync, rename; mode bits are kept
//   a symbolic link                   what it points at is replaced, the link stays
//   a device, a FIFO, a socket        is written to and never replaced
//   "-", or the file that standard    standard output is written to
//   output is
// While a file is being written, "<folder>/.<name>.lock" is locked (flock) and a second writer is refused. Every failure is a
// FileError with the path, the system's words and the mend; neither temporary nor lock stays behind, not even after SIGINT.
#pragma once

#include "log.h"

#include <memory>
#include <string>
#include <string_view>

namespace traction::log {

class Lock;

// Keeps others from writing a file from now on, before the work whose result it will hold; this process may write it. Tells at
// once that the folder does not exist or may not be written to. Does nothing for devices, FIFOs and "-".
class Claim {
  public:
    explicit Claim(const std::string &path);              // throws FileError
    const std::string &target() const { return target_; } // what will be replaced, links followed; empty: written to in place

  private:
    std::string target_;
    std::shared_ptr<Lock> lock_;
};

// A file written piece by piece.
class WholeFile {
  public:
    explicit WholeFile(const std::string &path); // throws FileError
    ~WholeFile();                                // not kept: the old file, if any, is as it was
    WholeFile(const WholeFile &) = delete;
    WholeFile &operator=(const WholeFile &) = delete;

    void write(std::string_view text); // throws FileError
    void keep();                       // everything is on the disk, then the file gets its name; throws FileError

  private:
    void flush();
    void put_out(std::string_view text);
    [[noreturn]] void fail(int error);
    std::string path_, temporary_, buffer_; // temporary_ empty: written in place
    Claim claim_;
    int fd_ = -1;
};

// A whole file at once. Throws FileError.
void write_file(std::string_view text, const std::string &path);

// "-" is written to this descriptor from now on, instead of 1: a program moves its own words elsewhere when a result goes there.
void set_standard_output(int fd);

// Writing to `path` would write to standard output.
bool is_standard_output(const std::string &path);

// Removes every temporary and lock of this process. Async-signal-safe: for the handler of a signal that ends the program.
void remove_temporaries() noexcept;

} // namespace traction::log
