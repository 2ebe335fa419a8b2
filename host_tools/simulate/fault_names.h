// fault_names.h - the firmware's faults in words.
#pragma once

#include <cstdint>
#include <string>

namespace traction {

// "stall, low battery": bits of fault_t (firmware/core/signals.h); empty for none.
std::string fault_names(std::uint32_t faults);

} // namespace traction
