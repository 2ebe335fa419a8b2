#include "part.h"

#include <array>
#include <cstring>

namespace traction::log::part {

std::uint32_t crc_by_bytes(std::uint32_t crc, const void *bytes, std::size_t size) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> made{};
        for (std::uint32_t i = 0; i < made.size(); ++i) {
            made[i] = i;
            for (int bit = 0; bit < 8; ++bit) made[i] = (made[i] & 1u) != 0 ? made[i] >> 1u ^ 0x82f63b78u : made[i] >> 1u;
        }
        return made;
    }();
    const auto *from = static_cast<const unsigned char *>(bytes);
    crc = ~crc;
    for (std::size_t i = 0; i < size; ++i) crc = crc >> 8u ^ table[(crc ^ from[i]) & 0xffu];
    return ~crc;
}

#if defined(__x86_64__)

namespace {

__attribute__((target("sse4.2"))) std::uint32_t crc_by_words(std::uint32_t crc, const unsigned char *from, std::size_t size) {
    std::uint64_t sum = ~crc;
    for (; size >= 8; from += 8, size -= 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, from, sizeof word);
        sum = __builtin_ia32_crc32di(sum, word);
    }
    return crc_by_bytes(~static_cast<std::uint32_t>(sum), from, size);
}

} // namespace

std::uint32_t crc_after(std::uint32_t crc, const void *bytes, std::size_t size) {
    static const bool has_words = __builtin_cpu_supports("sse4.2");
    return has_words ? crc_by_words(crc, static_cast<const unsigned char *>(bytes), size) : crc_by_bytes(crc, bytes, size);
}

#else

std::uint32_t crc_after(std::uint32_t crc, const void *bytes, std::size_t size) { return crc_by_bytes(crc, bytes, size); }

#endif

std::string header_text(const std::map<std::string, std::string> &header) {
    std::string text;
    for (const auto &[key, value] : header) text.append(key).append(": ").append(value).append(1, '\n');
    return text;
}

std::string column_line(const std::string &name, bool absent_is_zero, Unit unit) {
    return std::string(1, absent_is_zero ? '0' : '-') + unit_letters[static_cast<std::size_t>(unit)] + name + '\n';
}

} // namespace traction::log::part
