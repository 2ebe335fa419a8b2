#include "file_tree.h"

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace traction::flash {

namespace {

constexpr std::size_t longest_name = 254; // of JFFS2

std::string bytes_at(const std::filesystem::path &path) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file.is_open() || file.bad()) throw std::runtime_error(path.string() + ": cannot be read: " + std::strerror(errno));
    return bytes;
}

TreeNode node_of(const std::filesystem::path &path) {
    struct stat at {};
    if (::lstat(path.c_str(), &at) != 0) throw std::runtime_error(path.string() + ": cannot be read: " + std::strerror(errno));
    if (path.filename().string().size() > longest_name) throw std::runtime_error(path.string() + ": JFFS2 takes names of up to 254 bytes");
    TreeNode node{.mode = at.st_mode, .bytes = {}, .device = 0};
    if (S_ISREG(at.st_mode)) node.bytes = bytes_at(path);
    if (S_ISLNK(at.st_mode)) node.bytes = std::filesystem::read_symlink(path).string();
    if (S_ISSOCK(at.st_mode)) throw std::runtime_error(path.string() + ": a socket; programs make theirs, remove it");
    if (S_ISCHR(at.st_mode) || S_ISBLK(at.st_mode)) {
        if (major(at.st_rdev) > 255 || minor(at.st_rdev) > 255)
            throw std::runtime_error(path.string() + ": a device number above 255, 255; remove it");
        node.device = static_cast<std::uint32_t>(major(at.st_rdev) << 8 | minor(at.st_rdev));
    }
    return node;
}

TreeStorage &self(void *context) { return *static_cast<TreeStorage *>(context); }

std::string key_of(const char *path) {
    const std::string text(path);
    return text.substr(std::min(text.find_first_not_of('/'), text.size()));
}

bool is_folder(const FileTree &tree, const std::string &path) {
    const auto at = tree.find(path);
    return path.empty() || (at != tree.end() && S_ISDIR(at->second.mode));
}

long read(void *context, const char *path, long offset, void *bytes, size_t room) {
    const FileTree &tree = self(context).tree;
    const auto at = tree.find(key_of(path));
    if (at == tree.end()) return -ENOENT;
    const std::string part = at->second.bytes.substr(std::min(static_cast<std::size_t>(offset), at->second.bytes.size()), room);
    std::memcpy(bytes, part.data(), part.size());
    return static_cast<long>(part.size());
}

int create(void *context, const char *path, std::uint32_t mode) {
    TreeStorage &storage = self(context);
    const std::string key = key_of(path);
    const std::size_t slash = key.rfind('/');
    if (!is_folder(storage.tree, slash == std::string::npos ? "" : key.substr(0, slash))) return -ENOENT;
    storage.tree[key] = {.mode = S_IFREG | mode, .bytes = {}, .device = 0};
    storage.opened.push_back(key);
    return static_cast<int>(storage.opened.size()) - 1;
}

int write(void *context, int file, const void *bytes, size_t length) {
    TreeStorage &storage = self(context);
    storage.tree[storage.opened[static_cast<std::size_t>(file)]].bytes.append(static_cast<const char *>(bytes), length);
    return 0;
}

int rename(void *context, const char *from, const char *to) {
    FileTree &tree = self(context).tree;
    auto moved = tree.extract(key_of(from));
    if (moved.empty()) return -ENOENT;
    tree[key_of(to)] = std::move(moved.mapped());
    return 0;
}

int list(void *context, const char *path, int (*each)(void *visitor, const char *name, std::uint64_t size), void *visitor) {
    const FileTree tree = self(context).tree; // who visits may remove
    const std::string before = key_of(path) + '/';
    for (auto at = tree.lower_bound(before); at != tree.end() && at->first.compare(0, before.size(), before) == 0; ++at) {
        const std::string name = at->first.substr(before.size());
        if (name.find('/') != std::string::npos) continue;
        if (const int result = each(visitor, name.c_str(), at->second.bytes.size()); result != 0) return result;
    }
    return 0;
}

} // namespace

void add_folder(FileTree &tree, const std::string &path) {
    for (std::size_t end = 0; end < path.size();) {
        end = std::min(path.find('/', end + 1), path.size());
        const TreeNode &node =
            tree.try_emplace(path.substr(0, end), TreeNode{.mode = S_IFDIR | 0755, .bytes = {}, .device = 0}).first->second;
        if (!S_ISDIR(node.mode)) throw std::runtime_error(path.substr(0, end) + ": is no folder in this system");
    }
}

FileTree read_tree(const std::string &folder) {
    FileTree tree;
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) throw std::runtime_error(folder + ": no such folder");
    try {
        for (const auto &entry : std::filesystem::recursive_directory_iterator(folder))
            tree[entry.path().lexically_relative(folder).generic_string()] = node_of(entry.path());
    } catch (const std::filesystem::filesystem_error &wrong) {
        throw std::runtime_error(wrong.path1().string() + ": cannot be read: " + wrong.code().message());
    }
    return tree;
}

storage_t TreeStorage::storage() {
    return {.context = this,
            .read = read,
            .create = create,
            .write = write,
            .sync = [](void *, int) { return 0; },
            .close = [](void *, int) { return 0; },
            .sync_folder = [](void *, const char *) { return 0; },
            .rename = rename,
            .unlink = [](void *context, const char *path) { return self(context).tree.erase(key_of(path)) > 0 ? 0 : -ENOENT; },
            .make_folder =
                [](void *context, const char *path) {
                    self(context).tree.try_emplace(key_of(path), TreeNode{.mode = S_IFDIR | 0755, .bytes = {}, .device = 0});
                    return 0;
                },
            .list = list,
            .room =
                [](void *context, const char *, std::uint64_t *bytes) {
                    *bytes = self(context).room;
                    return 0;
                }};
}

} // namespace traction::flash
