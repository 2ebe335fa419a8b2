#define _POSIX_C_SOURCE 200809L // dirent, fsync
#include "storage.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

static int told(int result) { return result >= 0 ? result : -errno; }

static long posix_read(void *context, const char *path, long offset, void *bytes, size_t room)
{
    (void)context;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0) {
        return -errno;
    }
    size_t got = 0;
    ssize_t part = 1;
    while (got < room && part > 0) {
        part = pread(file, (char *)bytes + got, room - got, (off_t)offset + (off_t)got);
        got += part > 0 ? (size_t)part : 0u;
    }
    const int error = errno;
    (void)close(file);
    return part < 0 ? -error : (long)got;
}

static int posix_create(void *context, const char *path, uint32_t mode)
{
    (void)context;
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, (mode_t)mode);
    if (file >= 0 && fchmod(file, (mode_t)mode) != 0) { // whatever the umask
        const int error = errno;
        (void)close(file);
        return -error;
    }
    return told(file);
}

static int posix_write(void *context, int file, const void *bytes, size_t length)
{
    (void)context;
    for (size_t done = 0; done < length;) {
        const ssize_t part = write(file, (const char *)bytes + done, length - done);
        if (part < 0 && errno != EINTR) {
            return -errno;
        }
        done += part > 0 ? (size_t)part : 0u;
    }
    return 0;
}

static int posix_sync(void *context, int file)
{
    (void)context;
    return told(fsync(file));
}

static int posix_close(void *context, int file)
{
    (void)context;
    return told(close(file));
}

static int posix_sync_folder(void *context, const char *path)
{
    (void)context;
    const int folder = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) {
        return -errno;
    }
    const int result = told(fsync(folder));
    (void)close(folder);
    return result;
}

static int posix_rename(void *context, const char *from, const char *to)
{
    (void)context;
    return told(rename(from, to));
}

static int posix_unlink(void *context, const char *path)
{
    (void)context;
    return told(unlink(path));
}

static int posix_make_folder(void *context, const char *path)
{
    (void)context;
    struct stat about;
    if (mkdir(path, 0755) == 0) {
        return 0;
    }
    const int error = errno;
    return error == EEXIST && lstat(path, &about) == 0 && S_ISDIR(about.st_mode) ? 0 : -error;
}

static int posix_list(void *context, const char *path, int (*each)(void *visitor, const char *name, uint64_t size), void *visitor)
{
    (void)context;
    DIR *folder = opendir(path);
    if (folder == NULL) {
        return -errno;
    }
    int result = 0;
    for (const struct dirent *entry = readdir(folder); entry != NULL && result == 0; entry = readdir(folder)) {
        struct stat about;
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) {
            continue;
        }
        const bool known = fstatat(dirfd(folder), entry->d_name, &about, AT_SYMLINK_NOFOLLOW) == 0;
        result = each(visitor, entry->d_name, known ? (uint64_t)about.st_size : 0u);
    }
    (void)closedir(folder);
    return result;
}

static int posix_room(void *context, const char *path, uint64_t *bytes)
{
    (void)context;
    struct statvfs about;
    if (statvfs(path, &about) != 0) {
        return -errno;
    }
    *bytes = (uint64_t)about.f_bavail * about.f_frsize;
    return 0;
}

storage_t storage_posix(void)
{
    const storage_t storage = {.read = posix_read,
                               .create = posix_create,
                               .write = posix_write,
                               .sync = posix_sync,
                               .close = posix_close,
                               .sync_folder = posix_sync_folder,
                               .rename = posix_rename,
                               .unlink = posix_unlink,
                               .make_folder = posix_make_folder,
                               .list = posix_list,
                               .room = posix_room};
    return storage;
}
