// map.h - a foreign CSV read as a log: a TOML map says which column becomes which signal, and how. Keys: docs/log_format.md.
#pragma once

#include "read.h"
#include "table.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace traction::log {

// How one signal comes out of a column: value = sign * scale * (column) + offset, time = row time - delay_s.
struct MapSignal {
    std::string name;
    std::string column;                  // empty for a constant, an expression and a quaternion
    std::vector<std::string> quaternion; // the columns of w, x, y, z: the column is the heading about z that they tell [rad], continuous
    std::string expression;              // of columns, by the names that `columns` gives them (muparser)
    std::vector<std::pair<std::string, std::string>> columns; // its variables: name, column
    std::optional<double> value;                              // a constant, e.g. the battery of a machine that does not log it
    double scale = 1;
    double offset = 0;
    double delay_s = 0;            // how long before its row's time the sample was true
    bool is_unsigned = false;      // magnitude only: header key `unsigned.<signal>: 1`
    bool unwrap = false;           // an angle that jumps by a turn becomes continuous
    double period = 0;             // the turn, in the signal's unit
    bool differentiate = false;    // the signal is the rate of change of the column
    double window_s = 0;           // span of the line fitted for it
    bool drop_repeats = false;     // keep a sample only when it differs from the one before (sample and hold of a slower sensor)
    std::optional<double> noise;   // standard deviation: header key `noise.<signal>`
    std::optional<double> quantum; // step of the sensor: header key `quantum.<signal>`
    std::vector<double> missing;   // numbers in the column that mean "no sample"
    std::size_t line = 0;          // in the map
};

// A second file of the same drive: its name is the log's with one part replaced; it has a map of its own.
struct MapJoin {
    std::string replace, with; // in the file's name, without folder
    std::string map;           // beside this map
    double offset_s = 0;       // its clock's zero in the first file's time
    std::string common;        // a signal that both maps name: the offset is where the two agree best; "a, b": two that see one motion
    double widest_s = 5;       // how far the offset is searched
    std::size_t line = 0;      // in the map; 0: no second file
};

struct Map {
    std::string path;
    MapJoin join;
    Dialect dialect;
    double time_scale = 1; // seconds per unit of the time column
    double time_offset_s = 0;
    bool from_zero = false;  // the first row becomes t = 0
    double row_period_s = 0; // with no time column: seconds from row to row; 0: rows are trials, one second apart
    std::map<std::string, std::string> header;
    std::vector<MapSignal> signals;
};

// Throws LogError with the line in the map.
Map read_map(const std::string &path);

// Throws LogError with the line in the log.
Log read_through_map(const FileBytes &bytes, const std::string &path, const Map &map, std::vector<Repair> &repairs,
                     const ReadLimits &limits);

// The second file of map.join, if there is one, read and put beside the first on one clock: by the given offset, or where two signals that
// see one motion agree best (correlation; sampled every 20 ms). Throws LogError where it is absent, or where the two never agree.
void join_second_file(Log &log, const Map &map, std::vector<Repair> &repairs, const ReadLimits &limits);

} // namespace traction::log
