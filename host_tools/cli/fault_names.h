// fault_names.h - the firmware's faults in words.
#pragma once

#include <cstdint>
#include <string>

namespace traction::cli {

// "stall, low battery" of the bits of fault_t (firmware/core/signals.h); "" of none.
std::string fault_names(std::uint32_t faults);

} // namespace traction::cli
