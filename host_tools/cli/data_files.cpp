#include "data_files.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace traction::cli {

namespace fs = std::filesystem;

namespace {

bool holds_data(const fs::path &folder) {
    std::error_code none;
    return fs::is_directory(folder / "scenarios", none) && fs::is_directory(folder / "models", none);
}

fs::path program_folder() {
    std::error_code none;
    return fs::read_symlink("/proc/self/exe", none).parent_path();
}

} // namespace

fs::path data_root() {
    if (const char *root = std::getenv("TRACTION_ROOT"); root != nullptr && *root != '\0') return root;
    const fs::path here = program_folder(), installed = here.parent_path() / "share/traction";
    if (!here.empty() && holds_data(installed)) return installed;
    for (fs::path folder = here; folder.has_relative_path(); folder = folder.parent_path()) // build/host/host_tools/cli in a source tree
        if (holds_data(folder)) return folder;
    for (const char *prefix : {"/usr/local/share/traction", "/usr/share/traction"}) // without /proc nothing tells where the program is
        if (holds_data(prefix)) return prefix;
    return holds_data(fs::current_path()) ? fs::current_path() : fs::path();
}

fs::path need_data_root() {
    const fs::path root = data_root();
    if (root.empty())
        throw std::runtime_error(
            "scenarios/ and models/ are neither beside this program nor in share/traction of its prefix; name the folder "
            "that holds them in TRACTION_ROOT");
    if (!holds_data(root))
        throw std::runtime_error("TRACTION_ROOT=" + root.string() +
                                 ": there are no scenarios/ and models/ in it; name the folder that holds them");
    return root;
}

std::string data_file(const std::string &path, const std::string &folder) {
    std::error_code none;
    const bool here = fs::exists(path, none) && !fs::is_directory(path, none); // a folder of the same name is another thing
    if (path.empty() || here || fs::path(path).is_absolute()) return path;
    const fs::path root = data_root();
    if (root.empty()) return path;
    if (fs::exists(root / path, none)) return (root / path).string();
    const bool bare = path.find_first_of("/.") == std::string::npos;
    const fs::path named = root / folder / (path + ".toml");
    return bare && fs::exists(named, none) ? named.string() : path;
}

std::vector<std::string> data_names(const std::string &folder) {
    std::vector<std::string> names;
    std::error_code none;
    const fs::path root = data_root();
    if (root.empty()) return names;
    for (const auto &entry : fs::directory_iterator(root / folder, none))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

} // namespace traction::cli
