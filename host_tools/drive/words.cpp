#include "words.h"

#include "firmware/core/fault_name.h"
#include "firmware/core/signals.h"

#include <array>
#include <cstddef>

namespace traction::drive {

std::string fault_words(std::uint32_t faults) {
    std::string text;
    for (std::int32_t bit = 0; bit < FAULT_COUNT; bit++)
        if ((faults >> static_cast<unsigned>(bit) & 1u) != 0) text += std::string(text.empty() ? "" : ", ") + fault_name(bit);
    return text.empty() ? "none" : text;
}

const char *mode_words(int mode) {
    static const std::array<const char *, MODE_COUNT> words{"stop", "open loop", "wheel speed", "platform speed", "slip", "soil sweep"};
    return mode >= 0 && mode < MODE_COUNT ? words[static_cast<std::size_t>(mode)] : "unknown";
}

const char *bridge_words(int drive) {
    static const std::array<const char *, 4> words{"off", "coast", "brake", "drive"};
    return drive >= 0 && drive < static_cast<int>(words.size()) ? words[static_cast<std::size_t>(drive)] : "unknown";
}

} // namespace traction::drive
