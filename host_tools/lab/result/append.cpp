#include "append.h"

#include <cstdarg>
#include <cstdio>

namespace traction::lab {

void append(std::string &text, const char *pattern, ...) {
    char buffer[700];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(buffer, sizeof buffer, pattern, arguments);
    va_end(arguments);
    text += buffer;
}

} // namespace traction::lab
