// sysfs.h - attributes of the kernel's sysfs: written and read as text, kept open where that happens every tick.
#ifndef TRACTION_HAL_LINUX_SYSFS_H
#define TRACTION_HAL_LINUX_SYSFS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { SYSFS_PATH = 400, SYSFS_TEXT = 64 };

// Joined by '/': root, folder, name. false: longer than SYSFS_PATH.
bool sysfs_path(char path[SYSFS_PATH], const char *root, const char *folder, const char *name);

// -errno, or 0.
int sysfs_write(const char *path, const char *text);

// Without the newline at its end.
int sysfs_read(const char *path, char text[SYSFS_TEXT]);

// Kept open: a descriptor, or -errno.
int sysfs_open(const char *path, bool writable);
int sysfs_put(int fd, int64_t value);
int sysfs_get(int fd, int64_t *value); // -EINVAL: not a whole number
void sysfs_close(int *fd);

#ifdef __cplusplus
}
#endif

#endif
