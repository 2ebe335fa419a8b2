#include "lms.h"

#include <string.h>

enum { PUBLIC_KEY = 0x8080, MESSAGE = 0x8181, LEAF = 0x8282, INNER = 0x8383 }; // D_PBLC, D_MESG, D_LEAF, D_INTR

lms_type_t lms_type(uint32_t tree, uint32_t once)
{
    static const lms_type_t one_time[4] = {{0, 1, 265, 7}, {0, 2, 133, 6}, {0, 4, 67, 4}, {0, 8, 34, 0}}; // table 1
    const lms_type_t none = {0, 0, 0, 0};
    if (tree < 5u || tree > 9u || once < 1u || once > 4u) {
        return none;
    }
    lms_type_t type = one_time[once - 1u];
    type.height = 5u * (tree - 4u); // table 2
    return type;
}

size_t lms_signature_bytes(const lms_type_t *type)
{
    return 4u + 4u + SHA256_BYTES * (1u + type->chains) + 4u + SHA256_BYTES * type->height;
}

static uint32_t get_u32(const uint8_t *at) { return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3]; }

static void put_u32(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(value >> (24 - 8 * i));
    }
}

// A hash that begins with I | u32 number | u16 kind.
static void begin(sha256_t *hash, const uint8_t *id, uint32_t number, uint32_t kind)
{
    uint8_t head[LMS_ID + 6];
    memcpy(head, id, LMS_ID);
    put_u32(head + LMS_ID, number);
    head[LMS_ID + 4] = (uint8_t)(kind >> 8);
    head[LMS_ID + 5] = (uint8_t)kind;
    sha256_begin(hash);
    sha256_add(hash, head, sizeof head);
}

// Digit i of base 2^w of a string (3.1.3).
static uint32_t digit(const uint8_t *string, uint32_t i, uint32_t width)
{
    const uint32_t bit = i * width;
    return (uint32_t)string[bit / 8u] >> (8u - width - bit % 8u) & ((1u << width) - 1u);
}

// Q and its checksum behind it (4.4): what the chains spell.
static void spell(const lms_type_t *type, const uint8_t *id, uint32_t q, const uint8_t *random, const void *message, size_t length,
                  uint8_t text[SHA256_BYTES + 2])
{
    sha256_t hash;
    begin(&hash, id, q, MESSAGE);
    sha256_add(&hash, random, SHA256_BYTES);
    sha256_add(&hash, message, length);
    sha256_end(&hash, text);
    uint32_t sum = 0;
    for (uint32_t i = 0; i < 8u * SHA256_BYTES / type->width; i++) {
        sum += (1u << type->width) - 1u - digit(text, i, type->width);
    }
    sum <<= type->shift;
    text[SHA256_BYTES] = (uint8_t)(sum >> 8);
    text[SHA256_BYTES + 1] = (uint8_t)sum;
}

// Steps from..to-1 of chain i.
static void walk(const uint8_t *id, uint32_t q, uint32_t i, uint32_t from, uint32_t to, uint8_t value[SHA256_BYTES])
{
    for (uint32_t j = from; j < to; j++) {
        const uint8_t step = (uint8_t)j;
        sha256_t hash;
        begin(&hash, id, q, i);
        sha256_add(&hash, &step, 1);
        sha256_add(&hash, value, SHA256_BYTES);
        sha256_end(&hash, value);
    }
}

static void leaf_of(const uint8_t *id, uint32_t node, const uint8_t *one_time_key, uint8_t out[SHA256_BYTES])
{
    sha256_t hash;
    begin(&hash, id, node, LEAF);
    sha256_add(&hash, one_time_key, SHA256_BYTES);
    sha256_end(&hash, out);
}

static void parent_of(const uint8_t *id, uint32_t node, const uint8_t *left, const uint8_t *right, uint8_t out[SHA256_BYTES])
{
    sha256_t hash;
    begin(&hash, id, node, INNER);
    sha256_add(&hash, left, SHA256_BYTES);
    sha256_add(&hash, right, SHA256_BYTES);
    sha256_end(&hash, out);
}

uint32_t lms_index(const uint8_t *signature, size_t signature_length) { return signature_length >= 4u ? get_u32(signature) : UINT32_MAX; }

bool lms_verify(const uint8_t key[LMS_PUBLIC], const void *message, size_t length, const uint8_t *signature, size_t signature_length)
{
    const uint32_t tree = get_u32(key), once = get_u32(key + 4);
    const lms_type_t type = lms_type(tree, once);
    const uint8_t *id = key + 8;
    if (type.height == 0u || signature_length != lms_signature_bytes(&type)) {
        return false;
    }
    const uint32_t q = get_u32(signature);
    const uint8_t *random = signature + 8, *chain = random + SHA256_BYTES, *after = chain + (size_t)type.chains * SHA256_BYTES;
    if (get_u32(signature + 4) != once || get_u32(after) != tree || q >> type.height != 0u) {
        return false;
    }
    uint8_t text[SHA256_BYTES + 2], node[SHA256_BYTES], one_time_key[SHA256_BYTES];
    sha256_t hash;
    spell(&type, id, q, random, message, length, text);
    begin(&hash, id, q, PUBLIC_KEY);
    for (uint32_t i = 0; i < type.chains; i++) {
        memcpy(node, chain + (size_t)i * SHA256_BYTES, SHA256_BYTES);
        walk(id, q, i, digit(text, i, type.width), (1u << type.width) - 1u, node);
        sha256_add(&hash, node, SHA256_BYTES);
    }
    sha256_end(&hash, one_time_key);
    uint32_t number = (1u << type.height) + q;
    leaf_of(id, number, one_time_key, node);
    const uint8_t *beside = after + 4;
    for (; number > 1u; number /= 2u, beside += SHA256_BYTES) {
        const bool right = number % 2u == 1u;
        uint8_t above[SHA256_BYTES];
        parent_of(id, number / 2u, right ? beside : node, right ? node : beside, above);
        memcpy(node, above, SHA256_BYTES);
    }
    return memcmp(node, key + 8 + LMS_ID, SHA256_BYTES) == 0;
}

// --- the signer's side

// x[i] of one-time key q.
static void secret_start(const lms_secret_t *secret, uint32_t q, uint32_t i, uint8_t out[SHA256_BYTES])
{
    static const uint8_t mark = 0xff;
    sha256_t hash;
    begin(&hash, secret->id, q, i);
    sha256_add(&hash, &mark, 1);
    sha256_add(&hash, secret->seed, SHA256_BYTES);
    sha256_end(&hash, out);
}

bool lms_grow(const lms_secret_t *secret, uint8_t (*nodes)[SHA256_BYTES], uint8_t key[LMS_PUBLIC])
{
    const lms_type_t type = lms_type(secret->tree, secret->once);
    if (type.height == 0u || type.height > 15u) {
        return false;
    }
    const uint32_t leaves = 1u << type.height;
    for (uint32_t q = 0; q < leaves; q++) {
        sha256_t hash;
        uint8_t value[SHA256_BYTES];
        begin(&hash, secret->id, q, PUBLIC_KEY);
        for (uint32_t i = 0; i < type.chains; i++) {
            secret_start(secret, q, i, value);
            walk(secret->id, q, i, 0, (1u << type.width) - 1u, value);
            sha256_add(&hash, value, SHA256_BYTES);
        }
        sha256_end(&hash, value);
        leaf_of(secret->id, leaves + q, value, nodes[leaves + q]);
    }
    for (uint32_t r = leaves - 1u; r > 0u; r--) {
        parent_of(secret->id, r, nodes[2u * r], nodes[2u * r + 1u], nodes[r]);
    }
    put_u32(key, secret->tree);
    put_u32(key + 4, secret->once);
    memcpy(key + 8, secret->id, LMS_ID);
    memcpy(key + 8 + LMS_ID, nodes[1], SHA256_BYTES);
    return true;
}

size_t lms_sign(const lms_secret_t *secret, uint8_t (*nodes)[SHA256_BYTES], uint32_t q, const uint8_t random[SHA256_BYTES],
                const void *message, size_t length, uint8_t signature[LMS_SIGNATURE])
{
    const lms_type_t type = lms_type(secret->tree, secret->once);
    if (type.height == 0u || q >> type.height != 0u) {
        return 0;
    }
    uint8_t text[SHA256_BYTES + 2];
    spell(&type, secret->id, q, random, message, length, text);
    put_u32(signature, q);
    put_u32(signature + 4, secret->once);
    memcpy(signature + 8, random, SHA256_BYTES);
    uint8_t *at = signature + 8 + SHA256_BYTES;
    for (uint32_t i = 0; i < type.chains; i++, at += SHA256_BYTES) {
        secret_start(secret, q, i, at);
        walk(secret->id, q, i, 0, digit(text, i, type.width), at);
    }
    put_u32(at, secret->tree);
    at += 4;
    for (uint32_t number = (1u << type.height) + q; number > 1u; number /= 2u, at += SHA256_BYTES) {
        memcpy(at, nodes[number ^ 1u], SHA256_BYTES);
    }
    return lms_signature_bytes(&type);
}
