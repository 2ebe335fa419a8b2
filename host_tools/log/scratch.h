// scratch.h - the file in which a log waits while it is being made: "LOG.part" beside it (part.h), which outlives its program, or one
// without a name, gone with the process whatever ends it.
//
// LOG.part is created anew (O_EXCL, O_NOFOLLOW) and locked (flock); where one stands already it is LOG.2.part, and so on: what another run
// has left is never written to. It lies beside what LOG leads to. No part: for devices, FIFOs and "-", and where the name gets too long.
#pragma once

#include "part.h"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace traction::log {

class Scratch {
  public:
    enum class Name { part, none };
    // Blocks that end where a stretch of this size does are written, read and removed for two thirds of the time: pages come together.
    static constexpr std::size_t stretch = 65536, filled_most = 4096;
    static constexpr std::chrono::seconds sync_every{5}; // of the wall clock, while something is appended: a power cut costs no more

    Scratch(std::string path, Name name); // path: of the log; nothing is opened before open or the first append
    ~Scratch();                           // a part stays
    Scratch(const Scratch &) = delete;
    Scratch &operator=(const Scratch &) = delete;

    void open(); // now, where it is not; throws FileError
    // A block, its payload in pieces; the place of the payload. What little is left of the stretch behind it is filled. Throws FileError.
    std::uint64_t append(part::Kind kind, std::span<const std::string_view> pieces);
    std::size_t left_of_stretch() const { return stretch - end_ % stretch; }
    std::uint64_t append(part::Kind kind, std::string_view payload) { return append(kind, {&payload, 1}); }
    void read(std::uint64_t at, void *bytes, std::size_t size) const;
    bool lasts() const { return !part_.empty(); }     // it is open, and has a name
    const std::string &part() const { return part_; } // that name
    void remove();                                    // the part: the log stands
    const std::string &path() const { return path_; }

  private:
    [[noreturn]] void fail() const; // errno
    bool open_part();
    void put(std::vector<std::string_view> pieces);
    std::string path_, part_;
    Name name_;
    int fd_ = -1;
    std::uint64_t end_ = 0;
    std::chrono::steady_clock::time_point synced_{};
};

} // namespace traction::log
