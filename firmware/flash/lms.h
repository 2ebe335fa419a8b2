// lms.h - Leighton-Micali signatures, RFC 8554 (NIST SP 800-208): a package is signed with SHA-256 alone, and the board needs no library.
//
//   Q     = H(I | u32 q | 0x8181 | C | message)                                     what one-time key q signs        (4.5)
//   y[i]  = H^a(x[i]), a = digit i of Q and its checksum, in base 2^w               the signature's chains           (4.5)
//   K     = H(I | u32 q | 0x8080 | H^(2^w - 1 - a)(y[0]) | ...)                     the one-time key, from them      (4.6)
//   T[r]  = H(I | u32 r | 0x8282 | K) for a leaf, H(I | u32 r | 0x8383 | T[2r] | T[2r+1]) above; T[1] is the public key (5.3)
//
// Numbers in brackets: sections of RFC 8554. A key signs 2^h messages, each with a one-time key of its own: who signs twice with one lets
// others forge, so the signer's file keeps its index (host_tools/flash/signing_key.h). The signature's index is also the package's number.
#ifndef TRACTION_FIRMWARE_FLASH_LMS_H
#define TRACTION_FIRMWARE_FLASH_LMS_H

#include "sha256.h"

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    LMS_ID = 16,                                                       // [byte] I: tells keys apart
    LMS_PUBLIC = 56,                                                   // [byte] u32 tree, u32 one-time type, I, T[1]
    LMS_CHAINS = 265,                                                  // at most, w = 1
    LMS_HEIGHT = 25,                                                   // at most
    LMS_SIGNATURE = 4 + 4 + 32 + LMS_CHAINS * 32 + 4 + LMS_HEIGHT * 32 // [byte] at most
};

// LMS_SHA256_M32_H10 with LMOTS_SHA256_N32_W4: 1024 packages a key, signatures of 2508 bytes, about 600 hashes to verify.
enum { LMS_TREE_OURS = 6, LMS_ONCE_OURS = 3, LMS_OURS_HEIGHT = 10 };

// What a tree of `tree` (5 to 9) and a one-time type of `once` (1 to 4) are; all zero for any other number.
typedef struct {
    uint32_t height, width, chains, shift; // h; w, p, ls
} lms_type_t;
lms_type_t lms_type(uint32_t tree, uint32_t once);

// The length of this type's signatures. [byte]
size_t lms_signature_bytes(const lms_type_t *type);

// true: who has the secret key of `key` signed exactly these bytes. Any bytes are taken.
bool lms_verify(const uint8_t key[LMS_PUBLIC], const void *message, size_t length, const uint8_t *signature, size_t signature_length);

// The index that a signature says it has; UINT32_MAX where there is none.
uint32_t lms_index(const uint8_t *signature, size_t signature_length);

// --- the signer's side. Secret: seed; x[i] of key q is H(I | u32 q | u16 i | 0xff | seed), appendix A.
typedef struct {
    uint32_t tree, once;
    uint8_t id[LMS_ID];
    uint8_t seed[SHA256_BYTES];
} lms_secret_t;

// Computes the whole tree: 2^h one-time keys. `nodes` has room for 2 << height hashes. false: no such type, a height above 15 (longer than
// one wants to wait).
bool lms_grow(const lms_secret_t *secret, uint8_t (*nodes)[SHA256_BYTES], uint8_t key[LMS_PUBLIC]);

// Signs with one-time key q, which must never sign again; `random` is C, fresh random bytes. The length written, 0 where q is not of the
// tree.
size_t lms_sign(const lms_secret_t *secret, uint8_t (*nodes)[SHA256_BYTES], uint32_t q, const uint8_t random[SHA256_BYTES],
                const void *message, size_t length, uint8_t signature[LMS_SIGNATURE]);

#ifdef __cplusplus
}
#endif

#endif
