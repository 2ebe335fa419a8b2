// table.h - the text of a CSV file turned into columns of numbers: separators, quotes, line ends, bad cells, order of times.
//
// Shared by the log reader and the reader of foreign files. Everything it mends is a Repair; everything else is a LogError.
#pragma once

#include "read.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <map>

namespace traction::log {

// The bytes of a file, mapped where the system can and read where it cannot (a pipe).
class FileBytes {
  public:
    FileBytes(const std::string &path, std::size_t limit); // throws FileError, LogError
    ~FileBytes();
    FileBytes(const FileBytes &) = delete;
    FileBytes &operator=(const FileBytes &) = delete;
    std::string_view view() const { return {data_, size_}; }

  private:
    const char *data_ = nullptr;
    std::size_t size_ = 0;
    void *mapped_ = nullptr;
    std::string owned_;
};

// Keeps a row only when the number in `column` lies in [minimum, maximum].
struct RowFilter {
    std::string column;
    double minimum = -std::numeric_limits<double>::infinity();
    double maximum = std::numeric_limits<double>::infinity();
};

// How to read one kind of file.
struct Dialect {
    char separator = 0;              // 0: guess from the row of names
    std::size_t skip_rows = 0;       // lines before the row of names that mean nothing
    bool row_of_names = true;        // false: columns are called "1", "2", ...
    bool native = true;              // the `# key: value` header of our own format is expected
    std::string time_column = "t_s"; // empty: the time is the number of the row, from 0
    std::string fine_column;         // of what is added to it, fine_scale each; empty: nothing
    double fine_scale = 1;           // in the time column's unit
    std::vector<RowFilter> filters;
    std::function<bool(const std::string &)> wanted; // which columns to read; empty: all
};

// One column: samples in file order, and what was odd about them.
struct Column {
    Signal signal;
    std::size_t number = 0; // 1-based, in the file
    std::size_t not_finite = 0, not_finite_line = 0;
    std::size_t back_steps = 0, back_line = 0;
    std::vector<std::pair<std::size_t, std::size_t>> backs; // first back steps: index of the sample, line
};

struct Table {
    std::map<std::string, std::string> header;
    std::vector<Column> columns;    // wanted ones, without the time
    std::vector<double> row_time;   // of every row kept (filled for foreign files only)
    std::vector<std::string> names; // of all columns in the file
    bool has_format = false;
    std::size_t names_line = 0;
};

// Throws LogError.
Table read_table(std::string_view text, const std::string &file, const Dialect &dialect, const ReadLimits &limits,
                 std::vector<Repair> &repairs);

// Sorts, drops duplicates, states what it did. Afterwards t_s is strictly increasing. Throws ClockJump.
void put_in_order(Column &column, const std::string &file, std::vector<Repair> &repairs);

// Drops samples whose time or value left the range of numbers in a conversion, or whose times fell together. States what it did.
void keep_what_is_a_number(Signal &signal, std::vector<Repair> &repairs);

// Reads a whole number text; false when it is anything else. Accepts a leading '+', and a decimal comma when told.
bool parse_number(std::string_view text, bool decimal_comma, double &value);

std::string_view trim(std::string_view text);

} // namespace traction::log
