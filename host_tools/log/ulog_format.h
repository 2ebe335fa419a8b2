// ulog_format.h - the frame of a ULog file, version 1 (PX4 user guide, "ULog File Format"): messages of 2 bytes of size, 1 of kind and the
// payload, after a head of 16 bytes; little endian. Shared by the reader of the rover's own log (host_tools/board) and by our own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace traction::log {

constexpr std::string_view ulog_magic{"ULog\x01\x12\x35", 7};
constexpr std::size_t ulog_head_bytes = 16; // magic, version, time of the first message

std::uint64_t little_endian(std::string_view bytes); // at most 8

struct UlogField {
    std::string name, type;                  // a basic type
    std::size_t at = 0, size = 0, count = 1; // [byte] in the payload, of one element; elements
};

// "uint64_t timestamp;float[4] duty;" as fields in their order; nothing where a type is not basic.
std::optional<std::vector<UlogField>> ulog_fields(std::string_view format);

enum class UlogEnd {
    whole,
    within_a_message, // the file was cut
    no_message,       // what follows is none
};
struct UlogStop {
    UlogEnd how = UlogEnd::whole;
    std::size_t at = 0; // [byte] of the file
};

// Calls `each` with kind and payload of every message of a file's bytes.
UlogStop for_each_ulog_message(std::string_view file, const std::function<void(char kind, std::string_view payload)> &each);

} // namespace traction::log
