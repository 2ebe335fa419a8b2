// jffs2.h - a JFFS2 file system as the bytes of a NOR flash, for a boot loader or `flashcp` to write. Same tree, same bytes.
//
//   erase block:  a cleanmarker of 12 bytes, then nodes, each at a multiple of 4 bytes and none across the block's end; the rest erased
//   (0xff) node:         0x1985, type, length, CRC of these; then a directory entry or up to 4096 bytes of a file, each with its own CRCs
//   CRC:          CRC-32 of IEEE 802.3, begun with 0 and not inverted                                                                 (1)
//
// As Linux reads it (jffs2.h of its uapi headers, and its scan), little-endian, contents as they are, not compressed. Times are
// 2024-01-01.
#pragma once

#include "file_tree.h"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace traction::flash {

struct FlashGeometry {
    std::uint32_t erase_bytes = 256 * 1024; // of one erase block [byte], a multiple of 4096, 8192 or more: /proc/mtd says it on the board
    std::uint64_t size_bytes = 0;           // of the whole partition [byte], a multiple of erase_bytes; 0: no more blocks than it takes
};

struct Jffs2Image {
    std::string bytes;
    std::uint32_t blocks = 0, used_blocks = 0; // erase blocks; of these, those with nodes
};

// Throws std::runtime_error for a geometry that is none, and, where a size is given, for a tree that leaves less than `spare_bytes` [byte]
// beside what JFFS2 keeps for itself: the message tells what is needed.
Jffs2Image jffs2_image(const FileTree &tree, const FlashGeometry &geometry, std::uint64_t spare_bytes);

// What Linux leaves free in any case, so that it can collect garbage [byte] (jffs2_calc_trigger_levels: two blocks, then 2 % of the size
// and 100 bytes a block, rounded up), and one block that is being written.
std::uint64_t jffs2_reserve_bytes(const FlashGeometry &geometry);

} // namespace traction::flash
