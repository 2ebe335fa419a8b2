#include "jffs2.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

namespace traction::flash {

namespace {

// jffs2.h of the uapi headers of Linux
constexpr std::uint16_t magic = 0x1985, type_dirent = 0xe001, type_inode = 0xe002, type_cleanmarker = 0x2003;
constexpr std::uint32_t header_bytes = 12, dirent_bytes = 40, inode_bytes = 68, page_bytes = 4096, root_inode = 1;
constexpr std::uint32_t made_at_s = 1704067200; // 2024-01-01

// (1)
std::uint32_t crc_of(const std::string &bytes) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> made{};
        for (std::uint32_t i = 0; i < made.size(); i++) {
            made[i] = i;
            for (int bit = 0; bit < 8; bit++) made[i] = made[i] >> 1 ^ ((made[i] & 1u) != 0u ? 0xedb88320u : 0u);
        }
        return made;
    }();
    std::uint32_t crc = 0;
    for (const char c : bytes) crc = crc >> 8 ^ table[(crc ^ static_cast<std::uint8_t>(c)) & 0xffu];
    return crc;
}

class Bytes {
  public:
    Bytes &put(std::uint32_t value, unsigned length) {
        for (unsigned i = 0; i < length; i++) text += static_cast<char>(value >> 8 * i & 0xffu);
        return *this;
    }
    Bytes &u8(std::uint32_t value) { return put(value, 1); }
    Bytes &u16(std::uint32_t value) { return put(value, 2); }
    Bytes &u32(std::uint32_t value) { return put(value, 4); }
    std::string text;
};

Bytes header(std::uint16_t type, std::size_t length) {
    Bytes head;
    head.u16(magic).u16(type).u32(static_cast<std::uint32_t>(length));
    return head.u32(crc_of(head.text));
}

// Nodes into erase blocks.
class Flash {
  public:
    explicit Flash(std::uint32_t erase_bytes) : erase_bytes_(erase_bytes) {}
    void add(const std::string &node) {
        const std::size_t left = erase_bytes_ - bytes.size() % erase_bytes_;
        if (left < node.size()) bytes.append(left, '\xff');
        if (bytes.size() % erase_bytes_ == 0) bytes += header(type_cleanmarker, header_bytes).text;
        bytes += node;
        bytes.append((4 - node.size() % 4) % 4, '\xff');
    }
    // Erased blocks up to a size; at least to the end of the last one.
    void fill(std::uint64_t size) {
        bytes.append((erase_bytes_ - bytes.size() % erase_bytes_) % erase_bytes_, '\xff');
        const std::string marker = header(type_cleanmarker, header_bytes).text;
        while (bytes.size() < size) bytes += marker + std::string(erase_bytes_ - marker.size(), '\xff');
    }
    std::string bytes;

  private:
    std::uint32_t erase_bytes_;
};

std::string dirent(std::uint32_t parent, std::uint32_t version, std::uint32_t inode, std::uint32_t mode, const std::string &name) {
    Bytes node = header(type_dirent, dirent_bytes + name.size());
    node.u32(parent).u32(version).u32(inode).u32(made_at_s).u8(static_cast<std::uint32_t>(name.size())).u8((mode & S_IFMT) >> 12); // DT_
    node.u16(0);
    node.u32(crc_of(node.text)).u32(crc_of(name));
    return node.text + name;
}

// One page of a file, or what there is of anything else.
std::string inode(std::uint32_t number, std::uint32_t version, std::uint32_t mode, std::size_t size, std::size_t offset,
                  const std::string &part) {
    Bytes node = header(type_inode, inode_bytes + part.size());
    node.u32(number).u32(version).u32(mode).u16(0).u16(0).u32(static_cast<std::uint32_t>(size));
    node.u32(made_at_s).u32(made_at_s).u32(made_at_s).u32(static_cast<std::uint32_t>(offset));
    node.u32(static_cast<std::uint32_t>(part.size())).u32(static_cast<std::uint32_t>(part.size())).u8(0).u8(0).u16(0);
    const std::uint32_t crc = crc_of(node.text);
    return node.u32(crc_of(part)).u32(crc).text + part;
}

void add_inode(Flash &flash, std::uint32_t number, const TreeNode &node) {
    std::string bytes = node.bytes;
    if (S_ISCHR(node.mode) || S_ISBLK(node.mode)) bytes = Bytes().u16(node.device).text;
    std::uint32_t version = 1;
    std::size_t offset = 0;
    do {
        const std::string part = bytes.substr(offset, page_bytes);
        flash.add(inode(number, version++, node.mode, bytes.size(), offset, part));
        offset += part.size();
    } while (offset < bytes.size());
}

void check(const FlashGeometry &geometry) {
    const std::string erase = std::to_string(geometry.erase_bytes);
    if (geometry.erase_bytes < 2 * page_bytes || geometry.erase_bytes % page_bytes != 0)
        throw std::runtime_error("an erase block of " + erase +
                                 " bytes: 8192 or more, and a multiple of 4096; /proc/mtd on the board says it");
    if (geometry.size_bytes % geometry.erase_bytes != 0 || geometry.size_bytes > UINT32_MAX)
        throw std::runtime_error("a flash of " + std::to_string(geometry.size_bytes) + " bytes: a multiple of the erase block, " + erase +
                                 " bytes, and less than 4 GB; /proc/mtd on the board says it");
}

} // namespace

std::uint64_t jffs2_reserve_bytes(const FlashGeometry &geometry) {
    const std::uint64_t blocks = geometry.size_bytes / geometry.erase_bytes;
    const std::uint64_t kept = geometry.size_bytes / 50 + 100 * blocks + geometry.erase_bytes - 1;
    return (2 + kept / geometry.erase_bytes + 1) * geometry.erase_bytes;
}

Jffs2Image jffs2_image(const FileTree &tree, const FlashGeometry &geometry, std::uint64_t spare_bytes) {
    check(geometry);
    Flash flash(geometry.erase_bytes);
    std::map<std::string, std::uint32_t> number = {{"", root_inode}}, version; // inodes; the last entry of each folder
    add_inode(flash, root_inode, {.mode = S_IFDIR | 0755, .bytes = {}, .device = 0});
    for (const auto &[path, node] : tree) { // a folder comes before what is in it
        const std::size_t slash = path.rfind('/');
        const std::string parent = slash == std::string::npos ? "" : path.substr(0, slash), name = path.substr(slash + 1);
        const auto own = static_cast<std::uint32_t>(number.size() + 1);
        number[path] = own;
        flash.add(dirent(number.at(parent), 2 + version[parent]++, own, node.mode, name)); // 1 is the folder's own node
        add_inode(flash, own, node);
    }
    const std::uint64_t used = flash.bytes.size();
    flash.fill(geometry.size_bytes);
    Jffs2Image image{.bytes = std::move(flash.bytes), .blocks = 0, .used_blocks = 0};
    image.blocks = static_cast<std::uint32_t>(image.bytes.size() / geometry.erase_bytes);
    image.used_blocks = static_cast<std::uint32_t>((used + geometry.erase_bytes - 1) / geometry.erase_bytes);
    const std::uint64_t needed = std::uint64_t{image.used_blocks} * geometry.erase_bytes + spare_bytes + jffs2_reserve_bytes(geometry);
    if (geometry.size_bytes != 0 && needed > geometry.size_bytes)
        throw std::runtime_error("a flash of " + std::to_string(geometry.size_bytes / 1024) +
                                 " kB: " + std::to_string((needed + 1023) / 1024) +
                                 " kB are needed for the files, the next version beside this one, and what JFFS2 keeps free");
    return image;
}

} // namespace traction::flash
