// key.h - the key of the supervision link: 32 bytes as 64 hex digits in a file that only its owner may read.
//
// `traction drive --new-key FILE` makes one. A ground station that asks for a passphrase uses its SHA-256:
// printf %s PASSPHRASE | sha256sum | cut -c-64 >FILE; chmod 600 FILE.
#ifndef TRACTION_FIRMWARE_LINK_KEY_H
#define TRACTION_FIRMWARE_LINK_KEY_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { KEY_BYTES = 32, KEY_MESSAGE = 300 };

// false: message says in one line what is wrong with the file and the mend (cannot be read, others may read it, not 64 hex digits).
bool key_read(const char *path, uint8_t key[KEY_BYTES], char message[KEY_MESSAGE]);

// A new key from the kernel's random numbers into a file that is not there yet, mode 0600.
bool key_make(const char *path, char message[KEY_MESSAGE]);

#ifdef __cplusplus
}
#endif

#endif
