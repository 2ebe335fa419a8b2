#include "fault_names.h"

#include "firmware/core/fault_name.h"
#include "firmware/core/signals.h"

namespace traction {

std::string fault_names(std::uint32_t faults) {
    std::string text;
    for (std::int32_t bit = 0; bit < FAULT_COUNT; ++bit)
        if ((faults >> static_cast<unsigned>(bit) & 1U) != 0) text += std::string(text.empty() ? "" : ", ") + fault_name(bit);
    return text;
}

} // namespace traction
