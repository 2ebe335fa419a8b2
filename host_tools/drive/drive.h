// drive.h - what an operator does over the link: drives for a while, watches, or drives by hand with a dead-man's key.
//
// Whoever drives repeats the command every 20 ms; 80 ms after the last one the rover stops by itself. So a program that ends, hangs or
// loses the network stops the rover; to hold it going, this one must live and be heard.
#pragma once

#include "operator.h"
#include "words.h"

#include <cstdint>
#include <functional>
#include <string>

namespace traction::drive {

struct Drive {
    double seconds = 0;         // that it was driven
    std::size_t statuses = 0;   // that came meanwhile
    double mean_speed_m_s = 0;  // as estimated on board, over the second half
    double first_motion_s = -1; // when the rover was first in command; -1: never
    std::uint32_t faults = 0;   // seen meanwhile
    bool stopped = false;       // at the end the rover said that it is in mode stop
    std::string trouble;        // why it ended early; "" if it did not
};

// Waits for the rover's first words. Throws log::FileError when none come, or none that the key is good for, or, where `to_command`, the
// rover has no key.
void meet(Operator &link, bool to_command);
void must_be_heard(const Operator &link, bool to_command); // the same of what has come until now, without waiting

// Stops the rover, clears what is latched, drives for `seconds`, stops again. `told` is called with every status, `stopped` asks whether to
// end early. A latched fault ends the drive.
Drive drive_for(Operator &link, const Order &order, double seconds, const std::function<void()> &told,
                const std::function<bool()> &stopped);

// Sends stop until the rover says that it is in mode stop, a second at most.
bool stop(Operator &link);

// Shows what comes, for `seconds`; calls `told` every `every_s`.
void watch(Operator &link, double seconds, double every_s, const std::function<void()> &told, const std::function<bool()> &stopped);

// By hand, in the terminal of standard input. Returns when the user leaves; the rover is stopped then.
void by_hand(Operator &link, bool may_command, const std::function<bool()> &stopped);

// "0.30 m/s +-0.01 | slip 0.02 0.02 - - | ...": one line, without a line's end.
std::string line_of(const Operator &link);

} // namespace traction::drive
