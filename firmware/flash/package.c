#include "package.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char manifest_name[] = "manifest", signature_name[] = "manifest.sig", first_line[] = "traction.package 1\n";

void package_hex(const uint8_t *bytes, size_t length, char *text)
{
    static const char digits[] = "0123456789abcdef";
    for (size_t i = 0; i < length; i++) {
        text[2 * i] = digits[bytes[i] >> 4];
        text[2 * i + 1] = digits[bytes[i] & 15u];
    }
    text[2 * length] = '\0';
}

bool package_unhex(const char *text, size_t length, uint8_t *bytes)
{
    for (size_t i = 0; i < 2 * length; i++) {
        const char c = text[i];
        const int value = c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
        if (value < 0) {
            return false;
        }
        bytes[i / 2] = (uint8_t)(i % 2 == 0 ? value << 4 : bytes[i / 2] | value);
    }
    return true;
}

// --- the archive

size_t package_padding(uint32_t size) { return (PACKAGE_BLOCK - size % PACKAGE_BLOCK) % PACKAGE_BLOCK; }

// ustar of POSIX.1-1988: name 100, mode 8, uid 8, gid 8, size 12, mtime 12, sum 8, type 1, link 100, magic 6, version 2, ...
bool package_header(const char *name, uint32_t mode, uint32_t size, uint8_t block[PACKAGE_BLOCK])
{
    const size_t length = strlen(name);
    if (length >= 100) {
        return false;
    }
    char *text = (char *)block;
    memset(block, 0, PACKAGE_BLOCK);
    memcpy(text, name, length); // NOLINT(bugprone-not-null-terminated-result): the block is zero
    (void)snprintf(text + 100, 8, "%07" PRIo32, mode & 07777u);
    (void)snprintf(text + 108, 8, "%07o", 0u);
    (void)snprintf(text + 116, 8, "%07o", 0u);
    (void)snprintf(text + 124, 12, "%011" PRIo32, size);
    (void)snprintf(text + 136, 12, "%011o", 0u);
    static const char magic[8] = {'u', 's', 't', 'a', 'r', '\0', '0', '0'};
    memcpy(text + 257, magic, sizeof magic);
    memset(text + 148, ' ', 8);
    text[156] = '0';
    uint32_t sum = 0;
    for (size_t i = 0; i < PACKAGE_BLOCK; i++) {
        sum += block[i];
    }
    (void)snprintf(text + 148, 7, "%06" PRIo32, sum & 0777777u); // six digits, 0, blank
    return true;
}

static bool all_zero(const uint8_t *bytes, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        if (bytes[i] != 0) {
            return false;
        }
    }
    return true;
}

typedef struct {
    const uint8_t *bytes;
    size_t length, at;
} archive_t;

// The next file, which must be of this name, mode and (where it is known) size. Null: it is not.
static const uint8_t *next_file(archive_t *archive, const char *name, uint32_t mode, uint32_t limit, uint32_t *size)
{
    uint8_t expected[PACKAGE_BLOCK];
    char digits[12];
    if (archive->length - archive->at < PACKAGE_BLOCK) {
        return NULL;
    }
    const uint8_t *block = archive->bytes + archive->at;
    memcpy(digits, block + 124, sizeof digits);
    digits[11] = '\0';
    const unsigned long said = strtoul(digits, NULL, 8);
    if (said > limit || !package_header(name, mode, (uint32_t)said, expected) || memcmp(block, expected, PACKAGE_BLOCK) != 0) {
        return NULL;
    }
    *size = (uint32_t)said;
    const uint8_t *contents = block + PACKAGE_BLOCK;
    const size_t room = archive->length - archive->at - PACKAGE_BLOCK, padding = package_padding(*size);
    if (room < *size || room - *size < padding || !all_zero(contents + *size, padding)) {
        return NULL;
    }
    archive->at += PACKAGE_BLOCK + *size + padding;
    return contents;
}

// --- the manifest

static bool good_word(const char *word)
{
    const size_t length = strlen(word);
    for (size_t i = 0; i < length; i++) {
        if (word[i] < ' ' || word[i] > '~') {
            return false;
        }
    }
    return length > 0 && word[0] != ' ' && word[length - 1] != ' ';
}

static bool good_name(const char *name)
{
    static const char known[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-";
    return name[0] != '\0' && name[0] != '.' && name[0] != '-' && strspn(name, known) == strlen(name) && strcmp(name, manifest_name) != 0 &&
           strcmp(name, signature_name) != 0;
}

static bool good_contents(const package_t *package)
{
    bool good = good_word(package->version) && good_word(package->commit) && good_word(package->architecture) &&
                good_word(package->rover) && package->count >= 1u && package->count <= PACKAGE_FILES;
    uint64_t sum = 0;
    for (uint32_t i = 0; good && i < package->count; i++) {
        const package_file_t *file = &package->file[i];
        sum += file->size;
        good = good_name(file->name) && (file->mode == 0644u || file->mode == 0755u) && sum <= PACKAGE_BYTES;
        for (uint32_t j = 0; good && j < i; j++) {
            good = strcmp(file->name, package->file[j].name) != 0;
        }
    }
    return good;
}

size_t package_print_manifest(const package_t *package, char text[PACKAGE_TEXT])
{
    char hex[2 * SHA256_BYTES + 1];
    if (!good_contents(package)) {
        return 0;
    }
    package_hex(package->key, LMS_ID, hex);
    int used = snprintf(text, PACKAGE_TEXT,
                        "%sversion %s\ncommit %s\narchitecture %s\nrover %s\nkey %s\nnumber %" PRIu32 "\nfiles %" PRIu32 "\n", first_line,
                        package->version, package->commit, package->architecture, package->rover, hex, package->number, package->count);
    for (uint32_t i = 0; i < package->count; i++) {
        const package_file_t *file = &package->file[i];
        package_hex(file->sha, SHA256_BYTES, hex);
        used += snprintf(text + used, PACKAGE_TEXT - (size_t)used, "file %" PRIo32 " %" PRIu32 " %s %s\n", file->mode, file->size, hex,
                         file->name); // 12 files of at most 130 bytes, and 500 before them: it fits
    }
    return (size_t)used;
}

// The rest of a line that begins with `word` and a blank, into `out`; *at goes to the next line.
static bool take_line(const char **at, const char *word, char *out, size_t room)
{
    const size_t length = strlen(word);
    const char *end = strchr(*at, '\n');
    if (end == NULL || strncmp(*at, word, length) != 0 || (*at)[length] != ' ') {
        return false;
    }
    const size_t rest = (size_t)(end - *at) - length - 1;
    if (rest >= room) {
        return false;
    }
    memcpy(out, *at + length + 1, rest);
    out[rest] = '\0';
    *at = end + 1;
    return true;
}

static bool take_number(const char **at, const char *word, uint32_t *number)
{
    char text[12];
    char *end = NULL;
    const bool taken = take_line(at, word, text, sizeof text);
    const unsigned long long value = taken ? strtoull(text, &end, 10) : 0;
    *number = (uint32_t)value;
    return taken && *end == '\0' && value <= UINT32_MAX;
}

static bool take_file(const char **at, package_file_t *file)
{
    char text[160], hex[2 * SHA256_BYTES + 1];
    int used = 0;
    memset(file, 0, sizeof *file);
    return take_line(at, "file", text, sizeof text) &&
           // NOLINTNEXTLINE(cert-err34-c): four and ten digits; the whole manifest is printed again and compared
           sscanf(text, "%4" SCNo32 " %10" SCNu32 " %64[0-9a-f] %39s%n", &file->mode, &file->size, hex, file->name, &used) == 4 &&
           text[used] == '\0' && strlen(hex) == sizeof hex - 1 && package_unhex(hex, SHA256_BYTES, file->sha);
}

bool package_parse_manifest(const char *text, size_t length, package_t *package)
{
    char own[PACKAGE_TEXT], again[PACKAGE_TEXT], hex[2 * LMS_ID + 1];
    memset(package, 0, sizeof *package);
    if (length >= sizeof own || memchr(text, '\0', length) != NULL) {
        return false;
    }
    memcpy(own, text, length);
    own[length] = '\0';
    const char *at = own + sizeof first_line - 1;
    bool good = strncmp(own, first_line, sizeof first_line - 1) == 0 && take_line(&at, "version", package->version, PACKAGE_WORD) &&
                take_line(&at, "commit", package->commit, PACKAGE_WORD) &&
                take_line(&at, "architecture", package->architecture, PACKAGE_WORD) &&
                take_line(&at, "rover", package->rover, PACKAGE_WORD) && take_line(&at, "key", hex, sizeof hex) &&
                strlen(hex) == sizeof hex - 1 && package_unhex(hex, LMS_ID, package->key) && take_number(&at, "number", &package->number) &&
                take_number(&at, "files", &package->count) && package->count <= PACKAGE_FILES;
    for (uint32_t i = 0; good && i < package->count; i++) {
        good = take_file(&at, &package->file[i]);
    }
    // what was read must be what it is written as: nothing else can be in the text
    return good && package_print_manifest(package, again) == length && memcmp(again, own, length) == 0;
}

// --- all of it

static package_verdict_t corrupt(char message[PACKAGE_MESSAGE], const char *what)
{
    (void)snprintf(message, PACKAGE_MESSAGE,
                   "the package is cut, changed or none at all (%s); send it again, or make it again with traction flash --pack", what);
    return PACKAGE_CORRUPT;
}

package_verdict_t package_read(const uint8_t *bytes, size_t length, const uint8_t key[LMS_PUBLIC], package_t *package,
                               char message[PACKAGE_MESSAGE])
{
    archive_t archive = {bytes, length, 0};
    uint32_t manifest_bytes = 0, signature_bytes = 0, size = 0;
    char signer[2 * LMS_ID + 1], trusted[2 * LMS_ID + 1];
    message[0] = '\0';
    const uint8_t *manifest = next_file(&archive, manifest_name, 0644, PACKAGE_TEXT - 1, &manifest_bytes);
    if (manifest == NULL || !package_parse_manifest((const char *)manifest, manifest_bytes, package)) {
        return corrupt(message, manifest_name);
    }
    const uint8_t *signature = next_file(&archive, signature_name, 0644, LMS_SIGNATURE, &signature_bytes);
    if (signature == NULL) {
        return corrupt(message, signature_name);
    }
    if (signature_bytes == 0) {
        (void)snprintf(message, PACKAGE_MESSAGE, "the package is not signed; make it with traction flash --pack --key FILE");
        return PACKAGE_UNSIGNED;
    }
    package_hex(package->key, LMS_ID, signer);
    package_hex(key + 8, LMS_ID, trusted);
    if (memcmp(package->key, key + 8, LMS_ID) != 0) {
        (void)snprintf(message, PACKAGE_MESSAGE,
                       "the package is signed by the key %s, and this rover obeys the key %s; sign it with that one", signer, trusted);
        return PACKAGE_FOREIGN;
    }
    if (package->number != lms_index(signature, signature_bytes) ||
        !lms_verify(key, manifest, manifest_bytes, signature, signature_bytes)) {
        (void)snprintf(message, PACKAGE_MESSAGE,
                       "the package's signature is not by the key %s; it was changed, or another key has this name", trusted);
        return PACKAGE_FOREIGN;
    }
    for (uint32_t i = 0; i < package->count; i++) {
        package_file_t *file = &package->file[i];
        uint8_t sha[SHA256_BYTES];
        file->bytes = next_file(&archive, file->name, file->mode, file->size, &size);
        if (file->bytes == NULL || size != file->size) {
            return corrupt(message, file->name);
        }
        sha256(file->bytes, size, sha);
        if (memcmp(sha, file->sha, SHA256_BYTES) != 0) {
            return corrupt(message, file->name);
        }
    }
    if (length - archive.at != 2 * PACKAGE_BLOCK || !all_zero(bytes + archive.at, 2 * PACKAGE_BLOCK)) {
        return corrupt(message, "its end");
    }
    package->manifest = manifest;
    package->signature = signature;
    package->manifest_bytes = manifest_bytes;
    package->signature_bytes = signature_bytes;
    return PACKAGE_GOOD;
}
