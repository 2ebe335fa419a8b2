// package.h - a package: everything that makes one version of a rover's software, its manifest, and the signature over the manifest.
//
// The file is a tar archive (POSIX ustar), which any tar lists: `manifest`, `manifest.sig`, then the files in the manifest's order. There
// is one archive of given contents: owner 0, time 0, no name but the manifest's, zeros between and behind. Anything else is refused, so
// that no byte of a package can be changed unseen. The manifest is text, a line each, in this order:
//
//   traction.package 1
//   version 0.2.0                      of the sources
//   commit f486e7d123
//   architecture armel                 Debian's word for what the programs run on
//   rover Lhomme-Desages               the description's name
//   key 0123...                        identifier of the signer's key, 32 hex digits
//   number 17                          the signature's index (lms.h): the later a package was signed, the higher
//   files 5
//   file 755 812345 0123... tractiond  mode, size [byte], SHA-256, name
//
// The signature covers the manifest, the manifest covers the files.
#ifndef TRACTION_FIRMWARE_FLASH_PACKAGE_H
#define TRACTION_FIRMWARE_FLASH_PACKAGE_H

#include "lms.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
    PACKAGE_FILES = 12,
    PACKAGE_NAME = 40,   // [byte] with the closing 0, as all below
    PACKAGE_WORD = 80,   // version, commit, architecture, rover
    PACKAGE_TEXT = 4096, // the manifest
    PACKAGE_BLOCK = 512,
    PACKAGE_BYTES = 24 << 20, // a whole package: it is read into memory before anything is written
    PACKAGE_MESSAGE = 400,
};

typedef struct {
    char name[PACKAGE_NAME]; // letters, digits, '.', '_', '-'; not first a '.'; neither manifest nor manifest.sig
    uint32_t mode;           // 0644 or 0755
    uint32_t size;           // [byte]
    uint8_t sha[SHA256_BYTES];
    const uint8_t *bytes; // within the package; null where only the manifest was read
} package_file_t;

typedef struct {
    char version[PACKAGE_WORD], commit[PACKAGE_WORD], architecture[PACKAGE_WORD], rover[PACKAGE_WORD]; // printable ASCII, not empty
    uint8_t key[LMS_ID];
    uint32_t number;
    uint32_t count;
    package_file_t file[PACKAGE_FILES];
    const uint8_t *manifest, *signature; // within the package
    size_t manifest_bytes, signature_bytes;
} package_t;

// What is wrong with a package, for exit codes and tests.
typedef enum {
    PACKAGE_GOOD,
    PACKAGE_CORRUPT,  // cut, changed, or no package
    PACKAGE_UNSIGNED, // its signature is empty
    PACKAGE_FOREIGN,  // signed by another key
} package_verdict_t;

// Takes `length` bytes apart and believes them only if `key` signed them. Not good: message says in one line what is wrong and the mend;
// *package is then of no use. Any bytes are taken.
package_verdict_t package_read(const uint8_t *bytes, size_t length, const uint8_t key[LMS_PUBLIC], package_t *package,
                               char message[PACKAGE_MESSAGE]);

// The manifest's text alone, without a signature: what a slot keeps. false: not such a text, to the byte.
bool package_parse_manifest(const char *text, size_t length, package_t *package);

// The manifest's text for what is in *package. Its length; 0 where a word or a name is not as told above.
size_t package_print_manifest(const package_t *package, char text[PACKAGE_TEXT]);

// The 512 bytes before an archived file's contents; false where the name is too long.
bool package_header(const char *name, uint32_t mode, uint32_t size, uint8_t block[PACKAGE_BLOCK]);

// Zeros that follow `size` bytes, up to a whole block. [byte]
size_t package_padding(uint32_t size);

// Lower-case hex digits and a closing 0: 2 * length + 1 bytes.
void package_hex(const uint8_t *bytes, size_t length, char *text);
bool package_unhex(const char *text, size_t length, uint8_t *bytes); // `length` bytes from twice as many digits

#ifdef __cplusplus
}
#endif

#endif
