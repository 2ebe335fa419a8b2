// image.h - a board's first flash as one file: a JFFS2 with the slots, a package in slot a as the good version, and, if wanted, the system
// that starts them. The slots are written by the board's own installer (firmware/flash/slots.h) into a tree in memory; it refuses what it
// refuses there.
#pragma once

#include "jffs2.h"
#include "pack.h"

#include <cstdint>
#include <stdexcept>
#include <string>

namespace traction::flash {

struct ImageOptions {
    std::string rover;                    // the name of the rover that the image is for; empty: the package's
    std::string architecture = "armel";   // of the board, Debian's word
    std::string system;                   // folder with the board's root file system; empty: the slots alone
    std::string mount = "/";              // where the board mounts this file system
    std::string folder = "/opt/traction"; // of the slots on the board, below `mount`
    FlashGeometry flash;
};

struct Image {
    Jffs2Image flash;
    std::size_t entries = 0; // files, folders, links
    std::string sha;         // SHA-256 of the bytes, hexadecimal
};

// The package's bytes become the good version: an image has no older one to go back to; the next flash is on trial against it. Throws
// std::runtime_error with `path` for a package that the board would refuse (corrupt, unsigned, foreign, of another rover or architecture),
// and for a system without /usr/sbin/traction-slot of that architecture or with slots of its own; and what read_tree and jffs2_image throw.
Image make_image(const std::string &path, const std::string &bytes, const PublicKey &key, const ImageOptions &options);

} // namespace traction::flash
