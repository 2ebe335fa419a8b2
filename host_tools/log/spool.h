// spool.h - a log that is being made: it waits on the disk (scratch.h), so that memory does not grow with the run, and under a name,
// LOG.part, so that a run which is killed leaves what it had (recover.h).
//
// A CSV is kept in rows (row_spool.h); a ULog in columns, because its topics and types are known only at the end.
#pragma once

#include "log.h"
#include "row_spool.h"
#include "scratch.h"

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace traction::log {

class Spool {
  public:
    static constexpr std::size_t block =
        2048; // samples of a column that are kept in memory, 32 kB; where nobody says that an instant is over, twice that

    // path: where the log will be written; empty: everything stays in memory, for take.
    explicit Spool(std::string path = "", Scratch::Name name = Scratch::Name::part);
    void begin(const std::map<std::string, std::string> &header); // before the first sample: what is known of the log already, for the part
    // A new column; its number. absent_is_zero: left out where it never held anything but 0. reserve: samples that are expected.
    // unit: of its put_whole.
    std::size_t add(const std::string &name, bool absent_is_zero = false, std::size_t reserve = 0, Unit unit = Unit::millionth);
    // These columns, at most RowSpool::bound_most, come together from now on, by put_together alone: less is done for each. A number for
    // them.
    std::size_t bind(const std::vector<std::size_t> &columns);
    // A sample. Times of a column go up. Throws FileError.
    void put(std::size_t column, double t_s, double value) {
        if (rows_)
            rows_->put(column, t_s, value);
        else
            put_in_column(column, t_s, value);
    }
    // The same of a whole number of the column's unit.
    void put_whole(std::size_t column, double t_s, std::int32_t whole) {
        if (rows_)
            rows_->put_whole(column, t_s, whole);
        else
            put_in_column(column, t_s, value_of(columns_[column].unit, whole));
    }
    // A sample of each bound column, whole numbers of their units, but for others; bit i of absent: none of the i-th.
    void put_together(std::size_t bound, double t_s, const std::int32_t *whole, const Absent &absent, std::span<const Other> others) {
        if (rows_)
            rows_->put_together(bound, t_s, whole, absent, others);
        else
            put_in_columns(bound, t_s, whole, absent, others);
    }
    // Samples first, first + 1 and so on of a clock that has rate_Hz, whole numbers of the column's unit: as put_whole of each at its
    // number/rate_Hz, for less.
    void put_by_clock(std::size_t column, std::uint32_t first, double rate_Hz, std::span<const std::int32_t> whole) {
        if (rows_)
            rows_->put_by_clock(column, first, rate_Hz, whole);
        else
            for (const std::int32_t one : whole)
                put_in_column(column, static_cast<double>(first++) / rate_Hz, value_of(columns_[column].unit, one));
    }

    // All that is of one instant is there: the part may end here, and what is made of it. Throws FileError.
    void instant_is_over() {
        if (rows_)
            rows_->instant_is_over();
        else if (full_)
            put_by();
    }
    // What there is goes to the part now, where a log grows slowly. Nothing without a path. Throws FileError.
    void put_by();

    // The part's name; empty before something went to it, and without a path.
    const std::string &part() const { return rows_ ? rows_->part() : scratch_.part(); }

    // The columns that hold something, as a log in memory; the spool is empty after it. Only without a path.
    Log take();
    // The columns that hold something, as a log under the path: CSV (write_csv's bytes), or ULog (write_ulog's) where it ends in .ulg.
    // Then its part goes; it stays where the log cannot be written. Throws LogError.
    void write(const std::map<std::string, std::string> &header);

  private:
    struct Block { // on the disk: times, then as many values
        std::uint64_t place;
        std::size_t count;
    };
    struct Column {
        Signal signal; // what is not on the disk
        std::vector<Block> blocks;
        bool absent_is_zero = false, all_zero = true;
        Unit unit = Unit::millionth;
        bool left_out() const { return (blocks.empty() && signal.value.empty()) || (absent_is_zero && all_zero); }
    };
    class Reader;
    class Again;
    void write_log(const std::map<std::string, std::string> &header);
    void put_in_column(std::size_t column, double t_s, double value);
    void put_in_columns(std::size_t bound, double t_s, const std::int32_t *whole, const Absent &absent, std::span<const Other> others);
    void keep_blocks();
    void load(const Column &column, std::size_t number, std::vector<double> &into) const; // times, then values

    std::string path_;
    std::unique_ptr<RowSpool> rows_; // CSV
    std::vector<Column> columns_;    // everything else
    std::vector<std::vector<std::size_t>> bound_;
    std::map<std::string, std::string> header_;
    std::size_t told_columns_ = 0;
    bool full_ = false; // a column has a block
    Scratch scratch_;
};

} // namespace traction::log
