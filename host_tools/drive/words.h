// words.h - what a rover tells in numbers, in words. Also for who does not speak over the link.
#pragma once

#include <cstdint>
#include <string>

namespace traction::drive {

// The words of latched faults, "stall, low battery"; "none".
std::string fault_words(std::uint32_t faults);
const char *mode_words(int mode);    // of control_mode_t
const char *bridge_words(int drive); // of drive_state_t: what the bridges do

} // namespace traction::drive
