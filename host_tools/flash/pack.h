// pack.h - makes a package (firmware/flash/package.h) of a rover's program and description, and reads one.
#pragma once

#include "firmware/flash/package.h"
#include "signing_key.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace traction::flash {

struct Contents {
    std::string program;    // path of tractiond for the board
    std::string rover;      // path of its description
    std::string parameters; // path of the firmware's parameters (traction export --firmware); empty: those of the description
    std::string start;      // path of the version's start script (firmware/flash/start)
    std::string check;      // path of the scenario whose first seconds are the self-test
    std::string version, commit;
};

// A package's words, without its bytes.
struct Summary {
    std::string version, commit, architecture, rover, key; // key: its identifier
    std::uint32_t number = 0;
    std::size_t bytes = 0;
    std::vector<std::pair<std::string, std::uint32_t>> files; // name, size
};

// The whole archive. Computes what the self-test must give on the board: the hash over the traces of a recorded drive, in process.
// Throws log::FileError, std::runtime_error (what is wrong with which file), sim::ScenarioError.
std::string pack(const Contents &contents, Signer &signer, Summary &summary);

// What a package's bytes say; with a key, whether they are to be believed. Throws std::runtime_error with `path` where they are not.
Summary look(const std::string &path, const std::string &bytes, const PublicKey *key);

// Debian's word for what an ELF file runs on. Throws std::runtime_error where it is none, or of a machine that is not known here.
std::string architecture_of(const std::string &path, const std::string &bytes);

// The whole file. Throws log::FileError.
std::string bytes_of(const std::string &path);

} // namespace traction::flash
