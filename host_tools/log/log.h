// log.h - the interchange log in memory: named signals, each with its own sample times, and a header of key-value pairs.
//
// The file format, the vocabulary of names and the list of repairs are in docs/log_format.md.
#pragma once

#include <cstddef>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace traction::log {

// One quantity, sampled at its own times. t_s is strictly increasing; both vectors have the same length; no NaN in either.
struct Signal {
    std::string name; // "<object>.<quantity>_<unit>"
    std::vector<double> t_s;
    std::vector<double> value;
};

struct Log {
    std::map<std::string, std::string> header; // the "# key: value" lines
    std::vector<Signal> signals;               // in column order
    std::vector<std::string> repairs;          // what the reader mended, one sentence each, with line and column
    std::string source;                        // file it came from, for messages

    const Signal *find(std::string_view name) const; // nullptr when absent
    double duration_s() const;                       // last time minus first time over all signals; 0 when empty
};

// Bad input, told once: where, what, and the mend.
struct LogError : std::runtime_error {
    LogError(std::string file, std::size_t line, std::size_t column, const std::string &what_is_wrong, const std::string &mend);
    std::string file;
    std::size_t line;   // 1-based; 0 when the whole file is meant
    std::size_t column; // 1-based field number; 0 when the whole line is meant
    std::string mend;
};

// The file itself cannot be opened, read or written.
struct FileError : LogError {
    using LogError::LogError;
};

// Reads a CSV log. With map_path, a foreign CSV is read through that TOML map. Throws LogError.
Log read_csv(const std::string &path, const std::string &map_path = "");

// Writes a log as CSV (write_file.h: whole or not at all). Times of all signals are merged into rows; an empty cell means "no sample then".
// Numbers are the shortest text that reads back to the same double. Throws LogError.
void write_csv(const Log &log, const std::string &path);

} // namespace traction::log
