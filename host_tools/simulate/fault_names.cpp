#include "fault_names.h"

#include "firmware/core/signals.h"

#include <iterator>

namespace traction {

std::string fault_names(std::uint32_t faults) {
    static const char *const name[] = {"emergency stop",     "command timeout",
                                       "encoder lost",       "current lost",
                                       "accelerometer lost", "radar lost",
                                       "battery lost",       "low battery",
                                       "over-current",       "stall",
                                       "missed ticks",       "speeds disagree",
                                       "over-temperature",   "gyro lost",
                                       "absurd sensor",      "bridge",
                                       "motor open",         "encoder against its motor",
                                       "brown-out",          "speed beyond the radar's band"};
    static_assert(std::size(name) == FAULT_COUNT);
    std::string text;
    for (std::size_t bit = 0; bit < std::size(name); ++bit)
        if ((faults >> bit & 1U) != 0) text += std::string(text.empty() ? "" : ", ") + name[bit];
    return text;
}

} // namespace traction
