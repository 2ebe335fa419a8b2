// storage.h - what the installer asks of the board's file system: every write goes through here, so that a test can cut the power in each.
//
// Paths are whole. Every function but `list` returns 0 or more when it did what was asked, otherwise a negative errno. What a power cut
// leaves is only promised by sync (a file's bytes) and sync_folder (which names a folder has); rename is atomic: the old or the new.
#ifndef TRACTION_FIRMWARE_FLASH_STORAGE_H
#define TRACTION_FIRMWARE_FLASH_STORAGE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { STORAGE_PATH = 400 };

typedef struct {
    void *context;
    // At most `room` bytes from `offset` on; how many there were.
    long (*read)(void *context, const char *path, long offset, void *bytes, size_t room);
    int (*create)(void *context, const char *path, uint32_t mode); // empty, whether it was there or not; a handle for the next three
    int (*write)(void *context, int file, const void *bytes, size_t length);
    int (*sync)(void *context, int file);
    int (*close)(void *context, int file);
    int (*sync_folder)(void *context, const char *path);
    int (*rename)(void *context, const char *from, const char *to);
    int (*unlink)(void *context, const char *path);
    int (*make_folder)(void *context, const char *path); // 0 too where it is there already
    // Calls `each` with the name and size of every entry until it returns non-zero, which is then the result; 0 at the end.
    int (*list)(void *context, const char *path, int (*each)(void *visitor, const char *name, uint64_t size), void *visitor);
    int (*room)(void *context, const char *path, uint64_t *bytes); // free for us
} storage_t;

// The real one.
storage_t storage_posix(void);

#ifdef __cplusplus
}
#endif

#endif
