#define _POSIX_C_SOURCE 200809L // fcntl's locks
#include "board_lock.h"

#include "storage.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int board_lock_open(const char *folder, char message[PACKAGE_MESSAGE])
{
    char path[STORAGE_PATH];
    (void)snprintf(path, sizeof path, "%.330s/lock", folder);
    const int file = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
    if (file < 0) {
        (void)snprintf(message, PACKAGE_MESSAGE, "%.200s: %.60s; traction-slot init makes the folder, and it needs the rights of its owner",
                       path, strerror(errno));
    }
    return file;
}

static struct flock byte_of(board_lock_t which, short type)
{
    const struct flock lock = {.l_type = type, .l_whence = SEEK_SET, .l_start = (off_t)which, .l_len = 1};
    return lock;
}

bool board_lock_take(int file, board_lock_t which, bool wait)
{
    struct flock lock = byte_of(which, F_WRLCK);
    int result = -1;
    do {
        result = fcntl(file, wait ? F_SETLKW : F_SETLK, &lock);
    } while (wait && result != 0 && errno == EINTR);
    return result == 0;
}

bool board_lock_give(int file, board_lock_t which)
{
    struct flock lock = byte_of(which, F_UNLCK);
    return fcntl(file, F_SETLK, &lock) == 0;
}

pid_t board_lock_holder(int file, board_lock_t which)
{
    struct flock lock = byte_of(which, F_WRLCK);
    return fcntl(file, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK ? lock.l_pid : 0;
}
