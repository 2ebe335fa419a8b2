// sha256.h - the SHA-256 of FIPS 180-4, in plain C: the board has no library for it.
#ifndef TRACTION_FIRMWARE_FLASH_SHA256_H
#define TRACTION_FIRMWARE_FLASH_SHA256_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SHA256_BYTES = 32, SHA256_BLOCK = 64 };

typedef struct {
    uint32_t state[8];
    uint64_t length; // [byte] so far
    uint8_t block[SHA256_BLOCK];
} sha256_t;

void sha256_begin(sha256_t *hash);
void sha256_add(sha256_t *hash, const void *bytes, size_t length); // any number of times; length may be 0
void sha256_end(sha256_t *hash, uint8_t out[SHA256_BYTES]);        // *hash is then of no use

void sha256(const void *bytes, size_t length, uint8_t out[SHA256_BYTES]); // all at once

#ifdef __cplusplus
}
#endif

#endif
