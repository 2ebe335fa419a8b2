// data_files.h - where scenarios and models lie, from whatever folder the program is called.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::cli {

// The folder that holds scenarios/ and models/: $TRACTION_ROOT; else the source tree of the build that this program stands in; else
// share/traction of the prefix it is installed in, of /usr/local or of /usr. Empty when none of them is there.
std::filesystem::path data_root();

// data_root(), or a message (std::runtime_error) that says where was looked.
std::filesystem::path need_data_root();

// `path` when it can be reached as it is, or when data_root() has none either; else `path` under data_root(): "scenarios/cruise.toml"
// works from any folder. A bare name ("cruise") is looked for in `folder` ("scenarios"), with ".toml".
std::string data_file(const std::string &path, const std::string &folder);

// The names ("cruise") of the TOML files in a folder of data_root(), sorted.
std::vector<std::string> data_names(const std::string &folder);

} // namespace traction::cli
