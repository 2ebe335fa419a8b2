// spool.h - a log that is being made: what is older than a block waits on the disk, so that memory does not grow with the run.
//
// The disk's part is a file without a name in the folder of the log (or in that of temporaries), gone with the process whatever ends it.
#pragma once

#include "log.h"

#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

namespace traction::log {

class Spool {
  public:
    static constexpr std::size_t block = 2048; // samples of a column that are kept in memory; 32 kB

    // path: where the log will be written; empty: everything stays in memory, for take. Throws FileError.
    explicit Spool(std::string path = "");
    ~Spool();
    Spool(const Spool &) = delete;
    Spool &operator=(const Spool &) = delete;

    // A new column; its number. absent_is_zero: left out where it never held anything but 0. reserve: samples that are expected.
    std::size_t add(const std::string &name, bool absent_is_zero = false, std::size_t reserve = 0);
    // A sample. Times of a column go up. Throws FileError.
    void put(std::size_t column, double t_s, double value);

    // The columns that hold something, as a log in memory; the spool is empty after it. Only without a path.
    Log take();
    // The columns that hold something, as a log under the path: CSV (write_csv's bytes), or ULog (write_ulog's) where it ends in .ulg.
    // Throws LogError.
    void write(const std::map<std::string, std::string> &header);

  private:
    struct Column {
        Signal signal;                     // what is not on the disk
        std::vector<std::uint64_t> blocks; // places on the disk, each of `block` times and as many values
        bool absent_is_zero = false, all_zero = true;
        bool left_out() const { return (blocks.empty() && signal.value.empty()) || (absent_is_zero && all_zero); }
    };
    class Reader;
    class Again;
    class Rows;
    void write_as_csv(const std::map<std::string, std::string> &header);
    void keep_block(Column &column);
    void load(const Column &column, std::size_t number, std::vector<double> &into) const; // times, then values
    [[noreturn]] void fail() const;                                                       // errno

    std::string path_;
    std::vector<Column> columns_;
    int fd_ = -1;
    std::uint64_t end_ = 0; // of the file
};

} // namespace traction::log
