// file_tree.h - a file system in memory: what an image is made of (jffs2.h). The board's own code writes its slots into one (storage.h).
//
// A path has no '/' before or behind; "" is the root, which is always there. Owner and group of everything are root, 0.
#pragma once

#include "firmware/flash/storage.h"

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::flash {

struct TreeNode {
    std::uint32_t mode = 0;   // S_IFMT and permission bits of <sys/stat.h>
    std::string bytes;        // of a file; of a symbolic link its target
    std::uint32_t device = 0; // of a device node: major << 8 | minor, 0 to 65535
};

using FileTree = std::map<std::string, TreeNode>;

// The folder and those above it, mode 0755, where they are missing. Throws std::runtime_error where one of them is no folder.
void add_folder(FileTree &tree, const std::string &path);

// Everything below a folder of this machine: files, folders, links, device nodes, FIFOs, with their permission bits. Throws
// std::runtime_error, with the path, for what cannot be read, for sockets, and for names of more than 254 bytes.
FileTree read_tree(const std::string &folder);

// The tree as the installer's file system; paths begin with '/'. `room_bytes` is what it says is free [byte]. One thread; the tree outlives
// it.
class TreeStorage {
  public:
    TreeStorage(FileTree &files, std::uint64_t room_bytes) : tree(files), room(room_bytes) {}
    storage_t storage();

    FileTree &tree;
    std::uint64_t room;
    std::vector<std::string> opened; // paths, by handle
};

} // namespace traction::flash
