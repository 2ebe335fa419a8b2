// part.h - the format of "LOG.part": what a log that is being made has so far, so that whatever ends its program leaves it (recover.h).
//
//   "traction-part 1\n"                          16 bytes
//   blocks, each BlockHead and then its payload  appended whole, in the order in which they come
//
// Numbers lie as in memory (little-endian). Both checks are CRC-32C: of a payload, and of the head's first 16 bytes; so a block that was
// cut is told from one that was damaged. A block is written when it is needed: names and patterns before the rows that refer to them, by
// the order in which they came, from 0.
#pragma once

#include "csv_text.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace traction::log::part {

inline constexpr std::string_view magic = "traction-part 1\n";

enum class Kind : std::uint32_t {
    header = 1,  // text, a line "key: value" each: what is known of the log at its beginning
    columns = 2, // text, a line each: "-", or "0" (left out where it never held anything but 0); a letter of the unit; the name
    pattern = 3, // uint32 each: the columns of a row
    rows = 4, // uint32 lanes, uint32 bytes of each, then their rows (row_spool.h), to be merged by time; a column goes on from what it held
    samples = 5, // uint32 columns; of each uint32 its number, uint32 count; then of each its times and its values, double
    filling = 6, // zeros, and nothing said: what comes next begins where the file system's pages do
};

struct BlockHead {
    std::uint32_t kind, size, payload_check, unused, check;
};

// A row: this, the columns that changed to whole numbers of their unit, their values (int32), the other ones, theirs (double). Columns are
// uint16 each, or bytes. Rows of a clock: this, a Clock, and `whole` values (int32) of their pattern's one column, each a row.
struct RowHead {
    static constexpr std::uint32_t in_bytes = 1u << 31u, by_clock = 1u << 30u;
    double t_s;                   // of the first
    std::uint32_t marked_pattern; // in_bytes: its columns are; by_clock: it is rows of a clock
    std::uint16_t whole, changed;
    std::uint32_t pattern() const { return marked_pattern & ~(in_bytes | by_clock); }
    bool is_by_clock() const { return (marked_pattern & by_clock) != 0; }
    std::size_t column_size() const { return (marked_pattern & in_bytes) != 0 ? 1 : sizeof(std::uint16_t); }
    inline std::size_t size() const;
};
struct Clock {
    double rate_Hz;
    std::uint32_t first, unused; // the number of the first sample
    double t_s(std::size_t i) const { return static_cast<double>(first + static_cast<std::uint32_t>(i)) / rate_Hz; } // of the i-th from it
};
std::size_t RowHead::size() const {
    if (is_by_clock()) return sizeof *this + sizeof(Clock) + whole * sizeof(std::int32_t);
    return sizeof *this + whole * (column_size() + sizeof(std::int32_t)) + changed * (column_size() + sizeof(double));
}

// CRC-32C (Castagnoli, reflected 0x82f63b78) of bytes that follow others, whose it is; 0 at the beginning.
std::uint32_t crc_after(std::uint32_t crc, const void *bytes, std::size_t size);
std::uint32_t crc_by_bytes(std::uint32_t crc, const void *bytes, std::size_t size); // the same, on any processor

inline std::uint32_t head_check(const BlockHead &head) { return crc_after(0, &head, offsetof(BlockHead, check)); }

std::string header_text(const std::map<std::string, std::string> &header);
inline constexpr std::string_view unit_letters = " cne"; // by Unit
std::string column_line(const std::string &name, bool absent_is_zero, Unit unit);
template <typename Number> std::string_view bytes_of(const std::vector<Number> &numbers) {
    return {reinterpret_cast<const char *>(numbers.data()), numbers.size() * sizeof(Number)};
}

inline bool begins_as_part(std::string_view bytes) { return bytes.starts_with(magic); }

} // namespace traction::log::part
