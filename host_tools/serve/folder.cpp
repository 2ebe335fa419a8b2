#include "folder.h"

#include "host_tools/lab/model/model.h"
#include "host_tools/log/ulog.h"
#include "host_tools/log/write_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

namespace traction::serve {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

constexpr std::size_t most_files = 1000;

std::string lower(std::string text) {
    for (char &c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

constexpr std::string_view log_format = "# format: traction-log";

// The second line of a file whose first is longer than what was read of it.
bool second_line_is_format(std::ifstream &file) {
    constexpr std::streamsize longest_line = 1 << 20;
    std::array<char, log_format.size()> bytes{};
    file.clear();
    file.seekg(0);
    file.ignore(longest_line, '\n').read(bytes.data(), bytes.size());
    return std::string_view(bytes.data(), static_cast<std::size_t>(file.gcount())) == log_format;
}

// By what the file begins with; nothing where it is of no kind that is shown.
std::optional<Kind> kind_of(const fs::path &path) {
    const std::string extension = lower(path.extension().string());
    if (extension != ".csv" && extension != ".ulg" && extension != ".toml") return std::nullopt;
    std::array<char, 8192> bytes{};
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), bytes.size());
    const std::string_view text(bytes.data(), static_cast<std::size_t>(file.gcount()));
    const auto holds = [&](std::string_view word) { return text.find(word) != std::string_view::npos; };
    if (extension == ".ulg") return log::is_own_ulog(path.string()) ? std::optional(Kind::log) : std::nullopt;
    if (extension == ".csv") {
        const bool names_alone = text.find('\n') == std::string_view::npos;
        return holds(log_format) || (names_alone && second_line_is_format(file)) ? Kind::log : Kind::foreign;
    }
    if (holds("traction.model/")) return Kind::model;
    if (holds("traction-map")) return Kind::map;
    if (holds("[[drive]]")) return Kind::scenario;
    return std::nullopt;
}

json about_model(const fs::path &path) {
    try {
        const lab::Model model = lab::read_model(path.string());
        json about = {{"title", model.name}, {"effects", json::array()}, {"ladder", json::array()}};
        for (const lab::EffectUse &use : model.effects) about["effects"].push_back({{"name", use.name}, {"wheel", use.wheel}});
        for (const lab::LineageEntry &entry : model.lineage)
            about["ladder"].push_back(
                {{"label", entry.label}, {"log", entry.log}, {"heldout", std::isfinite(entry.heldout) ? json(entry.heldout) : json()}});
        return about;
    } catch (const std::exception &error) {
        return {{"trouble", error.what()}};
    }
}

} // namespace

const char *kind_name(Kind kind) {
    switch (kind) {
    case Kind::log:
        return "log";
    case Kind::foreign:
        return "foreign";
    case Kind::model:
        return "model";
    case Kind::scenario:
        return "scenario";
    case Kind::map:
        return "map";
    }
    return "";
}

Folder::Folder(const fs::path &root, const fs::path &data) : data_(data) {
    std::error_code error;
    root_ = fs::canonical(root, error);
    if (error) throw log::FileError(root.string(), 0, 0, "cannot be served: " + error.message(), "give a folder that is there");
    if (!fs::is_directory(root_)) throw log::FileError(root.string(), 0, 0, "is no folder", "give the folder that holds the logs");
    if (fs::is_symlink(own(), error))
        throw log::FileError(own().string(), 0, 0, "is a link, and what the page keeps must lie in the folder", "take the link away");
    fs::create_directory(own(), error);
    if (error || !fs::is_directory(own()))
        throw log::FileError(own().string(), 0, 0,
                             "cannot be made, and results are kept there: " + (error ? error.message() : "a file has that name"),
                             "give a folder that can be written to");
    look();
}

void Folder::add(const fs::directory_entry &entry, const std::string &before, std::map<std::string, File> &known) {
    std::error_code error;
    if (fs::symlink_status(entry.path(), error).type() != fs::file_type::regular) return; // a link may lead out of the folder
    File file;
    file.name = before + entry.path().filename().string();
    if (nlohmann::json(file.name).dump(-1, ' ', false, nlohmann::json::error_handler_t::ignore).find(file.name) == std::string::npos)
        return; // quotes, control characters, no UTF-8: cannot be shown as it is
    file.path = entry.path();
    struct stat status {};
    if (lstat(file.path.c_str(), &status) != 0) return;
    file.bytes = static_cast<std::uint64_t>(status.st_size);
    file.changed_ms = status.st_mtim.tv_sec * 1000LL + status.st_mtim.tv_nsec / 1000000;
    const auto old = known.find(file.name);
    if (old != known.end() && old->second.bytes == file.bytes && old->second.changed_ms == file.changed_ms) {
        file = std::move(old->second);
        file.growing = false;
    } else {
        const std::optional<Kind> kind = kind_of(file.path);
        if (!kind) return;
        file.kind = *kind;
        file.growing = old != known.end() && file.bytes > old->second.bytes;
        if (file.kind == Kind::model) file.about = about_model(file.path);
    }
    files_.push_back(std::move(file));
}

bool Folder::look() {
    std::map<std::string, File> known;
    const nlohmann::json before = json();
    const std::string trouble = std::exchange(trouble_, "");
    for (File &file : files_) known.emplace(file.name, std::move(file));
    files_.clear();
    std::error_code error;
    const auto all = [&](const fs::path &folder, const std::string &prefix, std::size_t most) {
        std::vector<fs::directory_entry> entries;
        for (fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end; !error && it != end;
             it.increment(error))
            if (it->path().filename().string().rfind('.', 0) != 0) entries.push_back(*it);
        std::sort(entries.begin(), entries.end());
        for (const fs::directory_entry &entry : entries) {
            if (files_.size() >= most) {
                trouble_ = "only the first " + std::to_string(most_files) + " files are shown";
                break;
            }
            add(entry, prefix, known);
        }
    };
    all(root_, "", most_files);
    if (error) trouble_ = root_.string() + ": cannot be read any more: " + error.message();
    if (!data_.empty())
        for (const char *folder : {"models", "models/maps", "scenarios"}) all(data_ / folder, "shipped/", most_files + 500);
    return json() != before || trouble_ != trouble;
}

const File *Folder::find(const std::string &name, Kind kind) const {
    for (const File &file : files_)
        if (file.name == name && file.kind == kind) return &file;
    return nullptr;
}

std::string Folder::free_name(const std::string &stem, const std::string &extension) const {
    for (int i = 1;; ++i) {
        std::string name = stem + (i == 1 ? "" : "_" + std::to_string(i)) + extension;
        std::error_code error;
        if (fs::symlink_status(root_ / name, error).type() == fs::file_type::not_found) return name;
    }
}

json Folder::json() const {
    nlohmann::json out = nlohmann::json::array();
    for (const File &file : files_) {
        nlohmann::json one = {{"name", file.name},
                              {"kind", kind_name(file.kind)},
                              {"bytes", file.bytes},
                              {"changed_ms", file.changed_ms},
                              {"growing", file.growing}};
        if (!file.about.is_null()) one["about"] = file.about;
        out.push_back(std::move(one));
    }
    return out;
}

} // namespace traction::serve
