// csv_text.h - how a log's head and numbers are written as text; shared by whoever writes rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace traction::log {

constexpr double never = std::numeric_limits<double>::infinity(); // the time of a sample that is not there

// The shortest text that reads back to the same double.
void append_number(std::string &text, double value);
inline constexpr std::size_t number_room = 32; // bytes that put_number may use
char *put_number(char *to, double value);      // the same, written there; its end

// What a whole number of 32 bits stands for: millionths of the unit; a count; the bits of a count from 0 to 2^32; the bits of a finite
// float, as the double whose shortest text reads back to it.
enum class Unit : std::uint8_t { millionth, count, natural, exact };
double value_of(Unit unit, std::int32_t whole);
char *put_whole(char *to, Unit unit, std::int32_t whole); // put_number of value_of

// The lines above the rows: names, format, header. Throws LogError with `path` where a key, a value or a name cannot be written.
std::string csv_head(const std::map<std::string, std::string> &header, const std::vector<std::string> &names, const std::string &path);

// A sample in a row of its signal: throws LogError unless both are finite and t_s comes after previous_s.
void check_sample(const std::string &name, std::size_t index, double previous_s, double t_s, double value, const std::string &path);

} // namespace traction::log
