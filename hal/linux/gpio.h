// gpio.h - the rover's lines (emergency stop, its presence, motor enable, brake, LED, directions) through the kernel's GPIO character
// device.
//
// Straight to the kernel's interface, version 2 (Linux 5.10), and version 1 (4.8) where it has no 2. libgpiod 1.6 and 2.x are wrappers of
// just these calls with two interfaces that exclude each other; the rover's program links libc alone and runs under either's kernel. A line
// has one owner in the kernel: gpioset of libgpiod cannot move it meanwhile.
#ifndef TRACTION_HAL_LINUX_GPIO_H
#define TRACTION_HAL_LINUX_GPIO_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    // As ioctl(2), replaced in tests. Null: ioctl.
    int (*ioctl)(int fd, unsigned long request, void *argument);
    int chip; // descriptor of /dev/gpiochipN, -1: closed
} gpio_chip_t;

typedef struct {
    int fd; // -1: not asked for
    bool version_1;
} gpio_line_t;

// -errno, or 0. `ioctl` of *chip is kept.
int gpio_open(gpio_chip_t *chip, const char *path);
void gpio_close(gpio_chip_t *chip);

// Takes a line; an output begins inactive (0). active_low: the line's level is turned round. -errno (EBUSY: somebody has it), or 0.
int gpio_take(const gpio_chip_t *chip, uint32_t offset, bool output, bool active_low, gpio_line_t *line);

// 0 or 1, or -errno.
int gpio_get(const gpio_chip_t *chip, const gpio_line_t *line);
int gpio_set(const gpio_chip_t *chip, const gpio_line_t *line, bool active);

void gpio_release(gpio_line_t *line);

#ifdef __cplusplus
}
#endif

#endif
