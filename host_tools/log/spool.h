// spool.h - a log that is being made: what is older than a block waits on the disk (scratch.h), so that memory does not grow with the run.
//
// A CSV is kept in rows (row_spool.h); a ULog in columns, because its topics and types are known only at the end.
#pragma once

#include "log.h"
#include "row_spool.h"
#include "scratch.h"

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace traction::log {

class Spool {
  public:
    static constexpr std::size_t block = 2048; // samples of a column that are kept in memory; 32 kB

    // path: where the log will be written; empty: everything stays in memory, for take. Throws FileError.
    explicit Spool(std::string path = "");
    // A new column; its number. absent_is_zero: left out where it never held anything but 0. reserve: samples that are expected.
    std::size_t add(const std::string &name, bool absent_is_zero = false, std::size_t reserve = 0);
    // A sample. Times of a column go up. Throws FileError.
    void put(std::size_t column, double t_s, double value) {
        if (rows_)
            rows_->put(column, t_s, value);
        else
            put_in_column(column, t_s, value);
    }
    // The same of the value millionths/1e6.
    void put_millionths(std::size_t column, double t_s, std::int32_t millionths) {
        if (rows_)
            rows_->put_millionths(column, t_s, millionths);
        else
            put_in_column(column, t_s, millionths / 1e6);
    }

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
    void put_in_column(std::size_t column, double t_s, double value);
    void keep_block(Column &column);
    void load(const Column &column, std::size_t number, std::vector<double> &into) const; // times, then values

    std::string path_;
    std::unique_ptr<RowSpool> rows_; // CSV
    std::vector<Column> columns_;    // everything else
    Scratch scratch_;
};

} // namespace traction::log
