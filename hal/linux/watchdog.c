#include "watchdog.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <unistd.h>

int watchdog_open(const char *path, int timeout_s) {
    const int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0) {
        return -errno;
    }
    int asked_s = timeout_s;
    if (ioctl(fd, WDIOC_SETTIMEOUT, &asked_s) != 0 && errno == EINVAL) {
        const int result = -errno;
        (void)write(fd, "V", 1);
        (void)close(fd);
        return result;
    }
    return fd;
}

void watchdog_kick(int fd) {
    if (write(fd, "\0", 1) != 1) { // what cannot be kicked resets the board, as it should
        return;
    }
}

void watchdog_close(int *fd) {
    if (*fd < 0) {
        return;
    }
    if (write(*fd, "V", 1) == 1) {
        (void)close(*fd);
    }
    *fd = -1;
}
