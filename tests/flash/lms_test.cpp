// SHA-256 and LMS against what FIPS 180-4 and RFC 8554 print, and against every byte that is changed.
#include "rfc8554.h"

#include "firmware/flash/lms.h"
#include "firmware/flash/package.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace {

constexpr bool emulated = sizeof(void *) == 4; // the target under qemu-arm, thirty times as slow

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string &hex) {
    Bytes bytes(hex.size() / 2);
    EXPECT_TRUE(package_unhex(hex.c_str(), bytes.size(), bytes.data()));
    return bytes;
}

std::string hex_of(const std::uint8_t *bytes, std::size_t length) {
    std::string text(2 * length + 1, '\0');
    package_hex(bytes, length, text.data());
    text.pop_back();
    return text;
}

std::string sha_of(const std::string &text) {
    std::uint8_t sha[SHA256_BYTES];
    sha256(text.data(), text.size(), sha);
    return hex_of(sha, sizeof sha);
}

lms_secret_t secret_of(const std::string &key, const std::string &seed) {
    lms_secret_t secret{};
    const Bytes k = bytes_of(key), s = bytes_of(seed);
    secret.tree = k[3];
    secret.once = k[7];
    std::memcpy(secret.id, k.data() + 8, LMS_ID);
    std::memcpy(secret.seed, s.data(), SHA256_BYTES);
    return secret;
}

struct Grown {
    explicit Grown(const lms_secret_t &from) : secret(from), nodes(std::size_t{2} << lms_type(from.tree, from.once).height) {
        EXPECT_TRUE(lms_grow(&secret, reinterpret_cast<std::uint8_t(*)[SHA256_BYTES]>(nodes.data()), key));
    }
    Bytes sign(std::uint32_t q, const std::string &message) {
        Bytes signature(LMS_SIGNATURE);
        std::uint8_t random[SHA256_BYTES] = {1, 2, 3};
        signature.resize(lms_sign(&secret, reinterpret_cast<std::uint8_t(*)[SHA256_BYTES]>(nodes.data()), q, random, message.data(),
                                  message.size(), signature.data()));
        return signature;
    }
    bool verifies(const Bytes &signature, const std::string &message) const {
        return lms_verify(key, message.data(), message.size(), signature.data(), signature.size());
    }
    lms_secret_t secret;
    std::vector<std::array<std::uint8_t, SHA256_BYTES>> nodes;
    std::uint8_t key[LMS_PUBLIC] = {};
};

} // namespace

// FIPS 180-4's own examples (csrc.nist.gov, SHA256.pdf), and one of a million bytes in uneven parts
TEST(sha256, gives_the_standards_examples) {
    EXPECT_EQ(sha_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    const std::string million(1000000, 'a');
    sha256_t hash;
    sha256_begin(&hash);
    for (std::size_t at = 0, part = 1; at < million.size(); part = part * 7 % 1009 + 1) {
        const std::size_t length = std::min(part, million.size() - at);
        sha256_add(&hash, million.data() + at, length);
        at += length;
    }
    std::uint8_t sha[SHA256_BYTES];
    sha256_end(&hash, sha);
    EXPECT_EQ(hex_of(sha, sizeof sha), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// The hash of the hashes of n bytes, byte i of them 7 i + n, n = 0 to 199: each place of the padding in a block. By Python's hashlib
// (OpenSSL): h = sha256(); for n in range(200): h.update(sha256(bytes((7 * i + n) % 256 for i in range(n))).digest())
TEST(sha256, of_every_length_up_to_three_blocks_is_that_of_another_library) {
    sha256_t all;
    sha256_begin(&all);
    std::uint8_t sha[SHA256_BYTES];
    for (std::size_t n = 0; n < 200; ++n) {
        Bytes bytes(n);
        for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::uint8_t>(7 * i + n);
        sha256(bytes.data(), n, sha);
        sha256_add(&all, sha, sizeof sha);
    }
    sha256_end(&all, sha);
    EXPECT_EQ(hex_of(sha, sizeof sha), "8c7c9ff69da76fc28823a1cb97268672663e628e1ea955868b16db46bab0545d");
}

TEST(lms, verifies_the_rfcs_signature_and_none_with_a_byte_changed) {
    const Bytes key = bytes_of(rfc8554::case1_key), message = bytes_of(rfc8554::case1_message);
    Bytes signature = bytes_of(rfc8554::case1_signature);
    ASSERT_TRUE(lms_verify(key.data(), message.data(), message.size(), signature.data(), signature.size()));
    EXPECT_EQ(lms_index(signature.data(), signature.size()), 5u);
    for (std::size_t i = 0; i < signature.size(); i += emulated ? 211 : 7) { // every chain, the index, both types, the path
        signature[i] ^= 0x10u;
        EXPECT_FALSE(lms_verify(key.data(), message.data(), message.size(), signature.data(), signature.size())) << i;
        signature[i] ^= 0x10u;
    }
    Bytes changed = message;
    for (std::size_t i = 0; i < changed.size(); i += emulated ? 11 : 1) {
        changed[i] ^= 1u;
        EXPECT_FALSE(lms_verify(key.data(), changed.data(), changed.size(), signature.data(), signature.size())) << i;
        changed[i] ^= 1u;
    }
    Bytes other = key;
    for (std::size_t i = 0; i < other.size(); i += emulated ? 11 : 1) {
        other[i] ^= 1u;
        EXPECT_FALSE(lms_verify(other.data(), message.data(), message.size(), signature.data(), signature.size())) << i;
        other[i] ^= 1u;
    }
    for (std::size_t length = 0; length < signature.size(); length += 41) {
        EXPECT_FALSE(lms_verify(key.data(), message.data(), message.size(), signature.data(), length)) << length;
    }
}

TEST(lms, grows_the_rfcs_trees) {
    const Grown lower(secret_of(rfc8554::case2_lower_key, rfc8554::case2_lower_seed));
    EXPECT_EQ(hex_of(lower.key, LMS_PUBLIC), rfc8554::case2_lower_key);
    if (emulated) return;                                                              // a million hashes
    const Grown upper(secret_of(rfc8554::case2_upper_key, rfc8554::case2_upper_seed)); // the type that packages are signed with
    EXPECT_EQ(hex_of(upper.key, LMS_PUBLIC), rfc8554::case2_upper_key);
    EXPECT_EQ(upper.secret.tree, static_cast<std::uint32_t>(LMS_TREE_OURS));
    EXPECT_EQ(upper.secret.once, static_cast<std::uint32_t>(LMS_ONCE_OURS));
}

TEST(lms, what_is_signed_is_verified_with_every_one_time_type_and_index) {
    for (std::uint32_t once = 1; once <= 4; once++) {
        lms_secret_t secret = secret_of(rfc8554::case2_lower_key, rfc8554::case2_lower_seed);
        secret.once = once;
        Grown key(secret);
        for (const std::uint32_t q : {0u, 1u, 15u, 31u}) {
            const Bytes signature = key.sign(q, "forward");
            EXPECT_TRUE(key.verifies(signature, "forward")) << once << ' ' << q;
            EXPECT_FALSE(key.verifies(signature, "Forward")) << once << ' ' << q;
        }
        EXPECT_TRUE(key.sign(32, "forward").empty()); // one more than the tree has
    }
}

TEST(lms, unknown_types_are_refused) {
    Bytes key = bytes_of(rfc8554::case1_key);
    const Bytes signature = bytes_of(rfc8554::case1_signature);
    for (int type = 0; type < 256; type++) {
        key[3] = static_cast<std::uint8_t>(type);
        if (type != 5) {
            EXPECT_FALSE(lms_verify(key.data(), "", 0, signature.data(), signature.size())) << type;
        }
    }
    EXPECT_EQ(lms_type(4, 1).height, 0u);
    EXPECT_EQ(lms_type(10, 1).height, 0u);
    EXPECT_EQ(lms_type(5, 0).height, 0u);
    EXPECT_EQ(lms_type(5, 5).height, 0u);
}
