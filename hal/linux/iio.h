// iio.h - a converter's samples through the kernel's industrial I/O: buffered capture of one channel at a trigger's rate.
//
//   lost = round((t[k] - t[k-1]) f) - 1        samples that the buffer or the bus dropped between two, from their time stamps     (1)
//
// Every sample has a number, which (1) keeps true over what was lost. A channel of more than 10 bits gives its upper 10.
#ifndef TRACTION_HAL_LINUX_IIO_H
#define TRACTION_HAL_LINUX_IIO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { IIO_SCAN = 16, IIO_MESSAGE = 200 }; // [byte] one sample and its time stamp

typedef struct {
    const char *root;    // "" or, in tests, the folder of a made-up /sys and /dev
    const char *device;  // "iio:device0"
    const char *channel; // "in_voltage0"
    const char *trigger; // "" leaves the device's own
    int32_t rate_Hz;
} iio_config_t;

typedef struct {
    int fd; // -1: closed
    uint8_t bytes, bits, shift;
    bool big_endian, is_signed, seen;
    int64_t period_ns, last_ns;
    uint32_t next; // number of the next sample
    uint32_t lost; // by (1), since open
    uint8_t part[IIO_SCAN];
    size_t held;
    char enable[400]; // of the buffer, to end it
} iio_capture_t;

typedef enum { IIO_DEVICE, IIO_CHANNEL, IIO_TRIGGER, IIO_RATE } iio_part_t;

// Sets trigger, channel, rate and buffer, and opens the device. false: what part does not do, and why in message.
bool iio_capture_open(iio_capture_t *capture, const iio_config_t *config, iio_part_t *part, char message[IIO_MESSAGE]);

// Takes what waits, at most `room` samples in one run without a gap: the newest run. Returns how many, *first being the number of the
// first; 0: none; -errno: the device is lost.
int iio_capture_read(iio_capture_t *capture, uint16_t *sample, int room, uint32_t *first);

void iio_capture_close(iio_capture_t *capture);

#ifdef __cplusplus
}
#endif

#endif
