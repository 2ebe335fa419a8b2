#define _POSIX_C_SOURCE 200809L // O_CLOEXEC, O_NOFOLLOW
#include "key.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

enum { DIGITS = 2 * KEY_BYTES };

static bool fail(char message[KEY_MESSAGE], const char *path, const char *what)
{
    (void)snprintf(message, KEY_MESSAGE, "%.140s: %s", path, what);
    return false;
}

static int digit_of(char c)
{
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const char lower = (char)(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

bool key_read(const char *path, uint8_t key[KEY_BYTES], char message[KEY_MESSAGE])
{
    char text[DIGITS + 3];
    struct stat about;
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); // a pipe that nobody writes does not hold us up
    message[0] = '\0';
    if (file < 0 || fstat(file, &about) != 0) {
        const int why = errno;
        if (file >= 0) {
            (void)close(file);
        }
        (void)snprintf(message, KEY_MESSAGE, "%.140s: cannot be read: %.60s; traction drive --new-key makes one", path, strerror(why));
        return false;
    }
    const ssize_t length = S_ISREG(about.st_mode) ? read(file, text, sizeof text) : -1;
    (void)close(file);
    if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
        (void)snprintf(message, KEY_MESSAGE, "%.140s: mode %03o: others may read the key; chmod 600, and make a new one if they did", path,
                       (unsigned)(about.st_mode & 0777));
        return false;
    }
    const bool ended = length == DIGITS || (length == DIGITS + 1 && text[DIGITS] == '\n');
    for (int i = 0; ended && i < KEY_BYTES; i++) {
        const int high = digit_of(text[2 * i]), low = digit_of(text[2 * i + 1]);
        if (high < 0 || low < 0) {
            return fail(message, path, "no key: something else than hex digits; traction drive --new-key makes one");
        }
        key[i] = (uint8_t)(high * 16 + low);
    }
    return ended || fail(message, path, "no key: give 64 hex digits on one line; traction drive --new-key makes one");
}

bool key_make(const char *path, char message[KEY_MESSAGE])
{
    uint8_t key[KEY_BYTES];
    char text[DIGITS + 2];
    message[0] = '\0';
    if (getrandom(key, sizeof key, 0) != (ssize_t)sizeof key) {
        return fail(message, path, "the kernel gave no random numbers; try again");
    }
    for (int i = 0; i < KEY_BYTES; i++) {
        (void)snprintf(text + 2 * i, 3, "%02x", key[i]);
    }
    text[DIGITS] = '\n';
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (file < 0) {
        return fail(message, path, errno == EEXIST ? "is there already; a key is never overwritten: remove it first" : strerror(errno));
    }
    const bool written = write(file, text, DIGITS + 1) == DIGITS + 1 && fsync(file) == 0;
    if (close(file) != 0 || !written) {
        (void)unlink(path);
        return fail(message, path, "could not be written whole; is the disk full?");
    }
    return true;
}
