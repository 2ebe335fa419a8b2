#include "gpio.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/gpio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

static const char consumer[] = "traction";

static int real_ioctl(int fd, unsigned long request, void *argument) { return ioctl(fd, request, argument); }

static int call(const gpio_chip_t *chip, int fd, unsigned long request, void *argument) {
    return (chip->ioctl != NULL ? chip->ioctl : real_ioctl)(fd, request, argument) < 0 ? -errno : 0;
}

int gpio_open(gpio_chip_t *chip, const char *path) {
    chip->chip = open(path, O_RDWR | O_CLOEXEC);
    return chip->chip < 0 ? -errno : 0;
}

void gpio_close(gpio_chip_t *chip) {
    if (chip->chip >= 0) {
        (void)close(chip->chip);
    }
    chip->chip = -1;
}

static int take_version_1(const gpio_chip_t *chip, uint32_t offset, bool output, bool active_low, gpio_line_t *line) {
    struct gpiohandle_request request;
    memset(&request, 0, sizeof request);
    request.lineoffsets[0] = offset;
    request.lines = 1;
    request.flags = (output ? GPIOHANDLE_REQUEST_OUTPUT : GPIOHANDLE_REQUEST_INPUT) | (active_low ? GPIOHANDLE_REQUEST_ACTIVE_LOW : 0u);
    memcpy(request.consumer_label, consumer, sizeof consumer);
    const int result = call(chip, chip->chip, GPIO_GET_LINEHANDLE_IOCTL, &request);
    *line = (gpio_line_t){.fd = result == 0 ? request.fd : -1, .version_1 = true};
    return result;
}

int gpio_take(const gpio_chip_t *chip, uint32_t offset, bool output, bool active_low, gpio_line_t *line) {
    struct gpio_v2_line_request request;
    memset(&request, 0, sizeof request);
    request.offsets[0] = offset;
    request.num_lines = 1;
    request.config.flags = (output ? GPIO_V2_LINE_FLAG_OUTPUT : GPIO_V2_LINE_FLAG_INPUT) | (active_low ? GPIO_V2_LINE_FLAG_ACTIVE_LOW : 0u);
    memcpy(request.consumer, consumer, sizeof consumer);
    const int result = call(chip, chip->chip, GPIO_V2_GET_LINE_IOCTL, &request);
    if (result == -ENOTTY || result == -EINVAL) { // what a kernel without version 2 says
        return take_version_1(chip, offset, output, active_low, line);
    }
    *line = (gpio_line_t){.fd = result == 0 ? request.fd : -1, .version_1 = false};
    return result;
}

int gpio_get(const gpio_chip_t *chip, const gpio_line_t *line) {
    if (line->version_1) {
        struct gpiohandle_data data;
        memset(&data, 0, sizeof data);
        const int result = call(chip, line->fd, GPIOHANDLE_GET_LINE_VALUES_IOCTL, &data);
        return result < 0 ? result : data.values[0] != 0;
    }
    struct gpio_v2_line_values values = {.bits = 0, .mask = 1};
    const int result = call(chip, line->fd, GPIO_V2_LINE_GET_VALUES_IOCTL, &values);
    return result < 0 ? result : (int)(values.bits & 1u);
}

int gpio_set(const gpio_chip_t *chip, const gpio_line_t *line, bool active) {
    if (line->version_1) {
        struct gpiohandle_data data;
        memset(&data, 0, sizeof data);
        data.values[0] = active ? 1 : 0;
        return call(chip, line->fd, GPIOHANDLE_SET_LINE_VALUES_IOCTL, &data);
    }
    struct gpio_v2_line_values values = {.bits = active ? 1u : 0u, .mask = 1};
    return call(chip, line->fd, GPIO_V2_LINE_SET_VALUES_IOCTL, &values);
}

void gpio_release(gpio_line_t *line) {
    if (line->fd >= 0) {
        (void)close(line->fd);
    }
    line->fd = -1;
}
