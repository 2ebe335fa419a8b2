#include "semihosting.h"

#include <string.h>

// Operations of ARM's "Semihosting for AArch32 and AArch64", section 6.
enum { SYS_OPEN = 0x01, SYS_CLOSE = 0x02, SYS_WRITE = 0x05, SYS_READ = 0x06, SYS_EXIT_EXTENDED = 0x20 };
enum { ADP_STOPPED_APPLICATION_EXIT = 0x20026, PAGE = 4096 };

static int32_t call(int32_t operation, volatile uint32_t *block) {
    register int32_t r0 __asm__("r0") = operation;
    register volatile uint32_t *r1 __asm__("r1") = block;
    __asm__ volatile("svc 0x123456" : "+r"(r0) : "r"(r1) : "memory", "lr", "cc");
    return r0;
}

static uint32_t address(const void *pointer) { return (uint32_t)(uintptr_t)pointer; }

static void touch(const void *data, size_t length) {
    const volatile char *byte = data;
    for (size_t i = 0; i < length; i += PAGE / 4) {
        (void)byte[i];
    }
    if (length > 0) {
        (void)byte[length - 1];
    }
}

int32_t semihosting_open(const char *name, semihosting_mode_t mode) {
    volatile uint32_t block[3] = {address(name), (uint32_t)mode, (uint32_t)strlen(name)};
    touch(name, strlen(name) + 1);
    return call(SYS_OPEN, block);
}

void semihosting_close(int32_t handle) {
    volatile uint32_t block[1] = {(uint32_t)handle};
    (void)call(SYS_CLOSE, block);
}

int semihosting_write(int32_t handle, const void *data, size_t length) {
    const char *at = data;
    touch(data, length);
    while (length > 0) {
        volatile uint32_t block[3] = {(uint32_t)handle, address(at), (uint32_t)length};
        const int32_t left = call(SYS_WRITE, block); // bytes that were not written
        if (left < 0 || (size_t)left >= length) {
            return 0;
        }
        at += length - (size_t)left;
        length = (size_t)left;
    }
    return 1;
}

size_t semihosting_read_some(int32_t handle, void *data, size_t length) {
    memset(data, 0, length); // a page that was never written is the shared zero page: QEMU must not write that
    volatile uint32_t block[3] = {(uint32_t)handle, address(data), (uint32_t)length};
    const int32_t left = call(SYS_READ, block); // bytes that were not read
    return left < 0 || (size_t)left > length ? 0 : length - (size_t)left;
}

int semihosting_read(int32_t handle, void *data, size_t length) {
    char *at = data;
    while (length > 0) {
        const size_t got = semihosting_read_some(handle, at, length);
        if (got == 0) {
            return 0;
        }
        at += got;
        length -= got;
    }
    return 1;
}

void semihosting_exit(int32_t code) {
    volatile uint32_t block[2] = {ADP_STOPPED_APPLICATION_EXIT, (uint32_t)code};
    (void)call(SYS_EXIT_EXTENDED, block);
}
