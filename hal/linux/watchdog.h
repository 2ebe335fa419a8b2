// watchdog.h - the board's hardware watchdog (/dev/watchdogN): resets the board, and with it every pin, unless kicked.
#ifndef TRACTION_HAL_LINUX_WATCHDOG_H
#define TRACTION_HAL_LINUX_WATCHDOG_H

#ifdef __cplusplus
extern "C" {
#endif

// Starts it with this time-out: from here on it must be kicked. A descriptor, or -errno (-EINVAL: not this time-out). A driver whose
// time-out is fixed is taken as it is.
int watchdog_open(const char *path, int timeout_s);
void watchdog_kick(int fd);

// Stopped, where the driver allows that; a program that dies does not come here, and the board is reset.
void watchdog_close(int *fd);

#ifdef __cplusplus
}
#endif

#endif
