#include "iio.h"

#include "sysfs.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SAMPLE_BITS = 10, STAMP_AT = 8, BUFFER_SAMPLES = 256 };

static bool say(char *message, const char *what, const char *name, int result) {
    (void)snprintf(message, IIO_MESSAGE, "%s %.80s: %.60s", what, name, strerror(-result));
    return false;
}

// "le:u12/16>>4": order, sign, bits, bits in store, shift.
static bool parse_type(const char *text, iio_capture_t *capture) {
    unsigned bits = 0, stored = 0, shift = 0;
    char order = 0, sign = 0;
    if (sscanf(text, "%ce:%c%u/%u>>%u", &order, &sign, &bits, &stored, &shift) != 5) { // NOLINT(cert-err34-c): the ranges follow
        return false;
    }
    capture->big_endian = order == 'b';
    capture->is_signed = sign == 's';
    capture->bits = (uint8_t)bits;
    capture->bytes = (uint8_t)(stored / 8);
    capture->shift = (uint8_t)shift;
    return (order == 'b' || order == 'l') && (sign == 's' || sign == 'u') && (stored == 8 || stored == 16 || stored == 32) && bits > 0 &&
           bits + shift <= stored;
}

// Everything but the channel and the time stamp is left out of the scan, so that its layout is known.
static int choose_channel(const char *folder, const char *root, const char *channel) {
    char path[SYSFS_PATH], wanted[SYSFS_PATH];
    if (!sysfs_path(path, root, folder, "scan_elements") || snprintf(wanted, sizeof wanted, "%s_en", channel) >= (int)sizeof wanted) {
        return -ENAMETOOLONG;
    }
    DIR *elements = opendir(path);
    if (elements == NULL) {
        return -errno;
    }
    bool found = false, stamped = false;
    int result = 0;
    for (const struct dirent *entry = readdir(elements); entry != NULL && result == 0; entry = readdir(elements)) {
        const size_t length = strlen(entry->d_name);
        if (length < 3 || strcmp(entry->d_name + length - 3, "_en") != 0) {
            continue;
        }
        const bool mine = strcmp(entry->d_name, wanted) == 0, stamp = strcmp(entry->d_name, "in_timestamp_en") == 0;
        char file[SYSFS_PATH];
        found = found || mine;
        stamped = stamped || stamp;
        if (snprintf(file, sizeof file, "%.300s/%.90s", path, entry->d_name) < (int)sizeof file) {
            result = sysfs_write(file, mine || stamp ? "1" : "0");
        }
    }
    (void)closedir(elements);
    if (result != 0) {
        return result;
    }
    return found && stamped ? 0 : -ENOENT;
}

static int put(const iio_config_t *config, const char *folder, const char *name, const char *text) {
    char path[SYSFS_PATH];
    return sysfs_path(path, config->root, folder, name) ? sysfs_write(path, text) : -ENAMETOOLONG;
}

// The rate where the device, or a trigger of its own, lets it be set; read back, within 1 %, which is what the firmware bears.
static bool set_rate(const iio_config_t *config, const char *folder, char message[IIO_MESSAGE]) {
    char path[SYSFS_PATH], text[SYSFS_TEXT];
    if (!sysfs_path(path, config->root, folder, "sampling_frequency") || access(path, F_OK) != 0) {
        return true; // the trigger's matter
    }
    (void)snprintf(text, sizeof text, "%d", (int)config->rate_Hz);
    (void)sysfs_write(path, text); // some are fixed
    const int result = sysfs_read(path, text);
    const double rate_Hz = result == 0 ? strtod(text, NULL) : 0;
    if (rate_Hz < 0.99 * config->rate_Hz || rate_Hz > 1.01 * config->rate_Hz) {
        (void)snprintf(message, IIO_MESSAGE, "its sampling_frequency stays at %.20s Hz; give a rate that it has",
                       result == 0 ? text : "none");
        return false;
    }
    return true;
}

bool iio_capture_open(iio_capture_t *capture, const iio_config_t *config, iio_part_t *part, char message[IIO_MESSAGE]) {
    *capture = (iio_capture_t){.fd = -1, .period_ns = 1000000000 / config->rate_Hz};
    char folder[SYSFS_PATH], path[SYSFS_PATH], name[SYSFS_TEXT * 2], text[SYSFS_TEXT];
    *part = IIO_DEVICE;
    (void)snprintf(folder, sizeof folder, "sys/bus/iio/devices/%.80s", config->device);
    int result = put(config, folder, "buffer/enable", "0");
    if (result != 0) {
        return say(message, "no buffered capture:", "buffer/enable", result);
    }
    *part = IIO_TRIGGER;
    if (config->trigger[0] != '\0' && (result = put(config, folder, "trigger/current_trigger", config->trigger)) != 0) {
        return say(message, "is not taken by", "trigger/current_trigger", result);
    }
    *part = IIO_CHANNEL;
    if ((result = choose_channel(folder, config->root, config->channel)) != 0) {
        return say(message, "no such channel with a time stamp in", "scan_elements", result);
    }
    (void)snprintf(name, sizeof name, "scan_elements/%.60s_type", config->channel);
    if (!sysfs_path(path, config->root, folder, name) || (result = sysfs_read(path, text)) != 0 || !parse_type(text, capture)) {
        (void)snprintf(message, IIO_MESSAGE, "its type \"%.40s\" is none that is known; 8 to 32 bits",
                       result == 0 ? text : strerror(-result));
        return false;
    }
    *part = IIO_RATE;
    if (!set_rate(config, folder, message)) {
        return false;
    }
    *part = IIO_DEVICE;
    (void)snprintf(text, sizeof text, "%d", BUFFER_SAMPLES);
    (void)put(config, folder, "buffer/length", text);
    (void)put(config, folder, "buffer/watermark", "1");
    if ((result = put(config, folder, "buffer/enable", "1")) != 0) {
        return say(message, "cannot be started:", "buffer/enable", result);
    }
    if (!sysfs_path(capture->enable, config->root, folder, "buffer/enable") || !sysfs_path(path, config->root, "dev", config->device)) {
        return say(message, "its path:", config->device, -ENAMETOOLONG);
    }
    capture->fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    return capture->fd >= 0 || say(message, "cannot be opened:", path, -errno);
}

static uint16_t sample_of(const iio_capture_t *capture, const uint8_t *scan) {
    uint32_t stored = 0;
    for (uint32_t i = 0; i < capture->bytes; i++) {
        stored = stored << 8u | scan[capture->big_endian ? i : capture->bytes - 1u - i];
    }
    const uint32_t mask = capture->bits < 32 ? (1u << capture->bits) - 1u : UINT32_MAX;
    uint32_t value = stored >> capture->shift & mask;
    if (capture->is_signed) {
        value ^= 1u << (capture->bits - 1u); // offset binary, as the firmware has it
    }
    return (uint16_t)(capture->bits > SAMPLE_BITS ? value >> (capture->bits - SAMPLE_BITS) : value);
}

// How many samples are missing before one of this time stamp.
static uint32_t missing(iio_capture_t *capture, int64_t stamp_ns) {
    const int64_t step_ns = stamp_ns - capture->last_ns;
    const bool seen = capture->seen;
    capture->seen = true;
    capture->last_ns = stamp_ns;
    if (!seen || step_ns <= 0) {
        return 0;
    }
    const int64_t steps = (step_ns + capture->period_ns / 2) / capture->period_ns;
    return steps > 1 ? (uint32_t)(steps - 1 < UINT32_MAX ? steps - 1 : UINT32_MAX) : 0u;
}

int iio_capture_read(iio_capture_t *capture, uint16_t *sample, int room, uint32_t *first) {
    int count = 0;
    *first = capture->next;
    for (int scans = 0; scans < BUFFER_SAMPLES;) {
        const ssize_t got = read(capture->fd, capture->part + capture->held, IIO_SCAN - capture->held);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) {
            return got == 0 || errno == EAGAIN || errno == EWOULDBLOCK ? count : -errno;
        }
        capture->held += (size_t)got;
        if (capture->held < IIO_SCAN) {
            continue;
        }
        capture->held = 0;
        scans++;
        int64_t stamp_ns = 0;
        memcpy(&stamp_ns, capture->part + STAMP_AT, sizeof stamp_ns);
        const uint32_t gap = missing(capture, stamp_ns);
        capture->lost += gap;
        capture->next += gap;
        if (count == 0 || gap > 0u) {
            *first = capture->next;
            count = 0;
        }
        if (count == room) { // the oldest goes
            memmove(sample, sample + 1, (size_t)(room - 1) * sizeof *sample);
            *first += 1;
            count--;
        }
        sample[count++] = sample_of(capture, capture->part);
        capture->next++;
    }
    return count;
}

void iio_capture_close(iio_capture_t *capture) {
    if (capture->fd >= 0) {
        (void)close(capture->fd);
        (void)sysfs_write(capture->enable, "0");
    }
    capture->fd = -1;
}
