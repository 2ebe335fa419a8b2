#include "sysfs.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool sysfs_path(char path[SYSFS_PATH], const char *root, const char *folder, const char *name) {
    const int length = snprintf(path, SYSFS_PATH, "%s/%s/%s", root, folder, name);
    return length > 0 && length < SYSFS_PATH;
}

int sysfs_open(const char *path, bool writable) {
    const int fd = open(path, (writable ? O_RDWR : O_RDONLY) | O_CLOEXEC);
    return fd < 0 ? -errno : fd;
}

static int put_text(int fd, const char *text) {
    const size_t length = strlen(text);
    const ssize_t written = pwrite(fd, text, length, 0);
    if (written < 0) {
        return -errno;
    }
    return (size_t)written == length ? 0 : -EIO;
}

int sysfs_write(const char *path, const char *text) {
    const int fd = open(path, O_WRONLY | O_CLOEXEC | O_TRUNC);
    if (fd < 0) {
        return -errno;
    }
    const int result = put_text(fd, text);
    return close(fd) != 0 && result == 0 ? -errno : result;
}

static int get_text(int fd, char text[SYSFS_TEXT]) {
    const ssize_t got = pread(fd, text, SYSFS_TEXT - 1, 0);
    if (got < 0) {
        return -errno;
    }
    text[got] = '\0';
    text[strcspn(text, "\n")] = '\0';
    return 0;
}

int sysfs_read(const char *path, char text[SYSFS_TEXT]) {
    const int fd = sysfs_open(path, false);
    if (fd < 0) {
        return fd;
    }
    const int result = get_text(fd, text);
    (void)close(fd);
    return result;
}

int sysfs_put(int fd, int64_t value) {
    char text[SYSFS_TEXT];
    (void)snprintf(text, sizeof text, "%" PRId64 "\n", value);
    return put_text(fd, text);
}

int sysfs_get(int fd, int64_t *value) {
    char text[SYSFS_TEXT];
    const int result = get_text(fd, text);
    if (result < 0) {
        return result;
    }
    char *end = NULL;
    errno = 0;
    const long long number = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0) {
        return -EINVAL;
    }
    *value = number;
    return 0;
}

void sysfs_close(int *fd) {
    if (*fd >= 0) {
        (void)close(*fd);
    }
    *fd = -1;
}
