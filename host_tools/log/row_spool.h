// row_spool.h - a log that is being made for CSV, kept in the rows in which it comes in.
//
// Samples of one time are one row: its time once, which columns it has (a pattern, of which a run has a few), and the values that are not
// what their column held before; most are whole numbers of 32 bits (Unit) and kept as such, from which their digits come. What is kept, and
// read back, goes on from where it was: it stays in the processor's cache, where a block of every column does not. Samples whose time lies
// before the row that their column's lane is at go to another lane; the lanes are merged when the log is written. What is kept goes to a
// part too, as it is (part.h), when a lane has a chunk full and an instant is over.
#pragma once

#include "csv_text.h"
#include "scratch.h"

#include <array>
#include <bit>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace traction::log {

// Of columns that come together: the value of the index-th, where it is no whole number of 32 bits.
struct Other {
    std::size_t index;
    double value;
};
using Absent = std::array<std::uint64_t, 2>;
inline bool is_absent(const Absent &absent, std::size_t i) { return (absent[i / 64] >> (i % 64) & 1u) != 0; }

class RowSpool {
    using RowHead = part::RowHead;

  public:
    // Of all lanes, filled in memory, half more where the part's stretch asks for it; of one where nobody says that an instant is over,
    // twice.
    static constexpr std::size_t chunk_bytes = Scratch::stretch;

    RowSpool(std::string path, Scratch::Name name) : scratch_(std::move(path), name) {}

    std::size_t add(const std::string &name, bool absent_is_zero, Unit unit); // Spool's
    std::size_t bind(const std::vector<std::size_t> &columns);                // Spool's
    static constexpr std::size_t bound_most = 128;
    // A sample, t_s in s. Times of a column go up; the first that does not, or is no number, is refused by write. Throws FileError.
    void put(std::size_t column, double t_s, double value) {
        Column &to = columns_[column];
        if (Lane &lane = *to.lane; t_s == lane.now_s && t_s > to.last_s)
            add_number(to, lane, column, t_s, value);
        else
            put_in_new_row(column, t_s, value);
    }
    // The same of a whole number of the column's unit.
    void put_whole(std::size_t column, double t_s, std::int32_t whole) {
        Column &to = columns_[column];
        if (Lane &lane = *to.lane; t_s == lane.now_s && t_s > to.last_s)
            add_whole(to, lane, column, t_s, whole);
        else
            put_whole_in_new_row(column, t_s, whole);
    }
    void put_together(std::size_t bound, double t_s, const std::int32_t *whole, const Absent &absent,
                      std::span<const Other> others);                                                                // Spool's
    void put_by_clock(std::size_t column, std::uint32_t first, double rate_Hz, std::span<const std::int32_t> whole); // Spool's
    void begin(const std::map<std::string, std::string> &header) { header_ = header; } // before the first sample: for the part
    const std::string &part() const { return scratch_.part(); }
    void instant_is_over() { // all that is of one instant is there: a good place for a block's end. Throws FileError.
        if (full_) put_by();
    }
    void put_by(); // what is there goes to the part. Throws FileError.
    // The log, whole or not at all, in the order of write_csv; then the part goes. Throws LogError of what was refused, FileError.
    void write(const std::map<std::string, std::string> &header);

  private:
    static constexpr std::size_t copied = 16;         // bytes at a time, of a short row
    static constexpr std::size_t by_clock_most = 128; // values of a clock, at a time
    static constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
    struct Lane;
    struct Place { // where samples come in
        double last_s = -std::numeric_limits<double>::infinity();
        std::size_t count = 0;
        Lane *lane = nullptr;
    };
    struct Column : Place {                                            // asked at every sample: one line of the processor's cache
        std::uint64_t bits = 0;                                        // of the last value
        std::int64_t whole = std::numeric_limits<std::int64_t>::max(); // or, where it came as such, it; none: it did not
        bool absent_is_zero = false, all_zero = true;
        Unit unit = Unit::millionth;
        std::array<char, 64 - 5 * sizeof(std::uint64_t) - 3> unused{}; // an index is a shift
        bool left_out() const { return count == 0 || (absent_is_zero && all_zero); }
    };
    struct Bound : Place { // columns that come together; last_s and count of theirs are not kept while they do
        std::vector<std::uint16_t> columns;
        std::vector<std::int32_t> last, ever; // the last values; the bits that any had, of those in zeros
        std::vector<std::uint8_t> zeros;      // which may be left out where they are always 0
        Absent never{}, unknown{};            // by column: no sample yet; last is not what it holds
    };
    struct Chunk { // on the disk
        std::uint64_t place;
        std::size_t size;
    };
    struct Lane {
        double now_s = -std::numeric_limits<double>::infinity(); // of the row that is open
        std::size_t size = 0, whole = 0, changed = 0;            // of it
        std::vector<std::uint32_t> columns;                      // or what is bound, as they came; room for all, and `copied`
        std::vector<std::uint16_t> whole_columns, changed_columns;
        std::vector<std::int32_t> whole_values;
        std::vector<std::uint64_t> changed_bits;
        std::uint32_t pattern = 0;     // of the row before
        std::unique_ptr<char[]> bytes; // two chunks, a row, and `copied`
        std::size_t used = 0;          // of them
        std::vector<Chunk> chunks;     // full ones
    };
    struct Refused { // the first sample that cannot stand in a log
        std::size_t column, index;
        double before_s, t_s, value;
    };
    class Reader;
    class Rows;
    static constexpr std::uint32_t bound_bit = 1u << 31u; // of what is bound, its number; then what is absent of it
    static void add(Place &to, Lane &lane, std::size_t number, double t_s) {
        to.last_s = t_s;
        ++to.count;
        lane.columns[lane.size++] = static_cast<std::uint32_t>(number);
    }
    void add_number(Column &to, Lane &lane, std::size_t column, double t_s, double value) {
        add(to, lane, column, t_s);
        const auto bits = std::bit_cast<std::uint64_t>(value);
        if (bits != to.bits || to.whole != none) change(to, lane, column, bits);
    }
    static void add_whole(Column &to, Lane &lane, std::size_t column, double t_s, std::int32_t whole) {
        add(to, lane, column, t_s);
        if (whole == to.whole) return;
        to.whole = whole;
        to.all_zero = to.all_zero && whole == 0;
        lane.whole_columns[lane.whole] = static_cast<std::uint16_t>(column);
        lane.whole_values[lane.whole++] = whole;
    }
    void put_in_new_row(std::size_t column, double t_s, double value); // not in the same row of its lane as what came before
    void put_whole_in_new_row(std::size_t column, double t_s, std::int32_t whole);
    void put_rows_of(const part::Clock &clock, std::size_t column, std::span<const std::int32_t> whole);
    Lane *new_row(Place &to, std::size_t column, double t_s, double value);
    void change(const Place &by, Lane &lane, std::size_t column, std::uint64_t bits);
    void close_row(Lane &lane);
    void has_grown(Lane &lane, std::size_t by) {
        lane.used += by, used_ += by;
        full_ = used_ >= enough_;
    }
    std::uint32_t pattern_of(const Lane &lane);
    void start_lane();
    void tell_new_names();
    void make_room(Lane &lane) const;
    void refuse(const Place &at, std::size_t column, double t_s, double value);
    std::vector<std::uint32_t> columns_of(const Lane &lane) const; // of its row, what is bound as its columns
    void tell_counts();

    Scratch scratch_;
    std::map<std::string, std::string> header_;
    std::size_t told_columns_ = 0, told_patterns_ = 0;
    std::size_t used_ = 0, enough_ = chunk_bytes; // of all lanes; of a block
    bool full_ = false;                           // there is enough
    std::vector<Column> columns_;
    std::vector<Bound> bound_;
    std::vector<std::string> names_;
    std::deque<Lane> lanes_;                                            // columns point at them
    std::vector<std::vector<std::uint32_t>> patterns_, shown_patterns_; // as rows came; in columns
    std::vector<Refused> refused_;                                      // one at most
};

} // namespace traction::log
