// terminal.h - prints a verb's words, with colour where standard output is a terminal that has it.
#pragma once

#include <string>

namespace traction::cli {

// Standard output is a terminal, TERM is not "dumb", and NO_COLOR (no-color.org) is not set to anything.
bool terminal_has_colour();

// The same text with the questions and headings bold, what was found green, notes dim. Every letter stays.
std::string painted(const std::string &text);

// To standard output, painted where terminal_has_colour().
void print(const std::string &text);

} // namespace traction::cli
