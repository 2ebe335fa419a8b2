// append.h - formatted text onto the end of a string.
#pragma once

#include <string>

namespace traction::lab {

// As printf; a piece of 700 characters or more is cut there.
__attribute__((format(printf, 2, 3))) void append(std::string &text, const char *pattern, ...);

} // namespace traction::lab
