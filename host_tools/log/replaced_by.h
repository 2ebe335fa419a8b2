// replaced_by.h - where a file that is written to a path will stand, by the rules of write_file.h.
#pragma once

#include <string>

namespace traction::log {

// What a file written to `path` will replace or become, links followed; empty where it is written to in place. Throws FileError.
std::string replaced_by(const std::string &path);

} // namespace traction::log
