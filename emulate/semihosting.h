// semihosting.h - calls from a user program on the emulated board to QEMU (ARM semihosting, userspace=on): files of the host.
//
// QEMU reads and writes the caller's memory without faulting pages in, so every page is touched first. ARM state, not Thumb.
#ifndef TRACTION_EMULATE_SEMIHOSTING_H
#define TRACTION_EMULATE_SEMIHOSTING_H

#include <stddef.h>
#include <stdint.h>

typedef enum { SEMIHOSTING_READ = 1, SEMIHOSTING_WRITE = 5 } semihosting_mode_t; // "rb", "wb"

// A handle, or -1. The name is relative to the folder that QEMU was started in.
int32_t semihosting_open(const char *name, semihosting_mode_t mode);
void semihosting_close(int32_t handle);

// All of it, or false. Blocks the whole machine as long as the host does.
int semihosting_write(int32_t handle, const void *data, size_t length);
int semihosting_read(int32_t handle, void *data, size_t length);

// What there is, at most `length`; 0 at the end.
size_t semihosting_read_some(int32_t handle, void *data, size_t length);

// Ends QEMU with this exit code.
void semihosting_exit(int32_t code);

#endif
