// store.h - what must survive a restart, in a small file: how warm each motor's winding is.
//
// Text, so that it can be read: a line of format, the four rises above ambient as the hex digits of their float bits, and a checksum over
// all before it. Written to a temporary beside it, brought to the disk and renamed: after a loss of power the file is the old one or the
// new.
#ifndef TRACTION_FIRMWARE_APP_STORE_H
#define TRACTION_FIRMWARE_APP_STORE_H

#include "firmware/core/signals.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { STORE_MESSAGE = 300 };

typedef struct {
    float rise_K[WHEEL_COUNT]; // of the winding above ambient
} store_t;

// false: nothing can be trusted, and message says why in one line (no file, not of this format, checksum); *store is then untouched.
bool store_read(const char *path, store_t *store, char message[STORE_MESSAGE]);

// false: the file is as it was, and message says why.
bool store_write(const char *path, const store_t *store, char message[STORE_MESSAGE]);

#ifdef __cplusplus
}
#endif

#endif
