// vocabulary.h - the names a log may use, as data: object, quantity, unit, meaning. docs/log_format.md prints the same table.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace traction::log {

enum class Kind {
    raw,      // counts, as a device gives them
    measured, // scaled to SI
    estimate, // what the firmware makes of it
    command,  // what was asked for
    truth,    // what the simulator knows; nothing in the lab may read it
};

struct Quantity {
    std::string_view object;   // "wheel<i>" stands for wheel0, wheel1, ...
    std::string_view quantity; // without object and unit
    std::string_view unit;     // the suffix of the name; empty: dimensionless, no suffix
    Kind kind;
    std::string_view meaning;
};

std::span<const Quantity> vocabulary();

// The entry of a column name such as "wheel2.current_A"; nullptr for a name outside the vocabulary.
const Quantity *find_quantity(std::string_view name);

// Index of the wheel in "wheel2.current_A"; -1 for other objects.
int wheel_of(std::string_view name);

// A known quantity in another unit, such as "wheel0.speed_rpm": gives its name in SI and the factor. False when it is none.
bool convert_unit(std::string_view name, std::string &si_name, double &factor);

std::string_view kind_name(Kind kind);

} // namespace traction::log
