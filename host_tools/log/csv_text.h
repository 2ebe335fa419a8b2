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
inline constexpr std::size_t number_room = 32;           // bytes that put_number may use
char *put_number(char *to, double value);                // the same, written there; its end
char *put_millionths(char *to, std::int32_t millionths); // put_number of millionths/1e6

// The lines above the rows: names, format, header. Throws LogError with `path` where a key, a value or a name cannot be written.
std::string csv_head(const std::map<std::string, std::string> &header, const std::vector<std::string> &names, const std::string &path);

// A sample in a row of its signal: throws LogError unless both are finite and t_s comes after previous_s.
void check_sample(const std::string &name, std::size_t index, double previous_s, double t_s, double value, const std::string &path);

} // namespace traction::log
