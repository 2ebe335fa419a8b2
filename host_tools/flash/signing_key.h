// signing_key.h - the key that packages are signed with: an LMS tree of 1024 one-time keys (firmware/flash/lms.h) in a file, mode 0600.
//
//   traction-signing-key 1
//   id 0123...      32 hex digits, random
//   seed 0123...    64 hex digits, random: the secret
//   next 17         the first index that has signed nothing
//
// Each index signs once. So the next one is on the disk before a signature leaves this file: who loses the power loses an index, no more.
// A copy of the file, or an old one brought back, would sign with indices that were used; never use two.
#pragma once

#include "firmware/flash/lms.h"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace traction::flash {

using PublicKey = std::array<std::uint8_t, LMS_PUBLIC>;

// Makes `path` and `path`.pub (112 hex digits). Neither may be there. Throws log::FileError.
PublicKey make_key(const std::string &path);

// The public key of a file, of either kind. Throws log::FileError, std::runtime_error.
PublicKey read_public(const std::string &path);

// A key that signs; others wait or are refused meanwhile (log::Claim).
class Signer {
  public:
    explicit Signer(const std::string &path); // throws log::FileError, std::runtime_error

    // The index that the next signature will have: a package's number.
    std::uint32_t next() const { return next_; }
    const std::uint8_t *id() const { return secret_.id; }
    std::uint32_t left() const;
    const PublicKey &key() const { return key_; }

    // Uses up next(). Throws where the file cannot be written, or no index is left.
    std::string sign(const std::string &message);

  private:
    void write() const;
    std::string path_;
    lms_secret_t secret_{};
    std::uint32_t next_ = 0;
    PublicKey key_{};
    std::vector<std::array<std::uint8_t, SHA256_BYTES>> nodes_;
};

} // namespace traction::flash
