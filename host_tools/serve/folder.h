// folder.h - the folder that `traction serve` shows: what lies in it, and the only names by which a browser reaches anything.
//
// A name is one that the last look listed, letter for letter: no path, no link that leads elsewhere and no device can be asked for. What
// is shipped with the program stands beside it as "shipped/NAME" and is only read.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace traction::serve {

enum class Kind { log, foreign, model, scenario, map };
const char *kind_name(Kind kind);

struct File {
    std::string name; // "run.csv", "shipped/rover_sand.toml"
    std::filesystem::path path;
    Kind kind = Kind::log;
    std::uint64_t bytes = 0;
    std::int64_t changed_ms = 0; // since 1970
    bool growing = false;        // larger than at the look before
    nlohmann::json about;        // a model: name, effects, ladder, or what is wrong with it
};

class Folder {
  public:
    // root: must be a folder that can be written to. data: where scenarios/ and models/ of the program lie; empty: nothing is shipped.
    // Throws log::FileError.
    Folder(const std::filesystem::path &root, const std::filesystem::path &data);

    // Looks again. True when something is other than before.
    bool look();

    const std::vector<File> &files() const { return files_; }
    const std::string &trouble() const { return trouble_; } // why the last look saw less than there is; empty: it saw all
    const std::filesystem::path &root() const { return root_; }
    std::filesystem::path own() const { return root_ / "traction_serve"; } // history, results, token

    // Null when there is no such file of that kind.
    const File *find(const std::string &name, Kind kind) const;

    // "stem.csv", or "stem_2.csv" and so on: a name that nothing has.
    std::string free_name(const std::string &stem, const std::string &extension) const;

    nlohmann::json json() const;

  private:
    void add(const std::filesystem::directory_entry &entry, const std::string &before, std::map<std::string, File> &known);
    std::filesystem::path root_, data_;
    std::vector<File> files_;
    std::string trouble_;
};

} // namespace traction::serve
