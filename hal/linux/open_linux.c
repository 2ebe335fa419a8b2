#include "open_linux.h"

#include "linux_hal.h"

#include "hal/replay/frames.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    linux_hal_t devices; // first: the HAL's context is this struct's address
    FILE *commands;      // null: none, or over
    const char *path;
    long line;
    bool noted; // what is not permitted was told
} rover_t;

// The next recorded command. What is not one ends the plan, and the rover stands.
static void command(void *context, const sensor_frame_t *frame, command_t *out) {
    (void)frame;
    rover_t *rover = context;
    char text[FRAMES_LINE], why[FRAMES_WHY];
    sensor_frame_t recorded;
    if (!rover->noted && rover->devices.note[0] != '\0') {
        (void)fprintf(stderr, "tractiond: %s\n", rover->devices.note);
    }
    rover->noted = true;
    while (rover->commands != NULL) {
        const bool have = fgets(text, sizeof text, rover->commands) != NULL;
        rover->line++;
        if (have && text[0] == '#') {
            continue;
        }
        if (have && frames_parse(text, &recorded, out, why)) {
            return;
        }
        if (have) {
            (void)fprintf(stderr, "tractiond: %.160s:%ld: %s; the rover stands\n", rover->path, rover->line, why);
        }
        (void)fclose(rover->commands);
        rover->commands = NULL;
    }
    const command_t stop = {.mode = MODE_STOP};
    *out = stop;
}

static const char *trouble(void *context) { return ((rover_t *)context)->devices.trouble; }

// What the bus and the converter lost on the way, where they did.
static void tell_losses(const linux_hal_t *devices) {
    const can_master_counts_t *counts = &devices->master.counts;
    const can_socket_t *bus = &devices->bus;
    if ((counts->refused_crc | counts->refused_age | bus->bus_offs | bus->overflows | devices->lost_writes | devices->overruns) != 0u) {
        (void)fprintf(stderr,
                      "tractiond: late ticks %" PRIu32 ", lost orders %" PRIu32 "; bus: refused by checksum %" PRIu32 ", by age %" PRIu32
                      ", bus-offs %" PRIu32 ", restarts %" PRIu32 ", overflows %" PRIu32 "\n",
                      devices->overruns, devices->lost_writes, counts->refused_crc, counts->refused_age, bus->bus_offs, bus->restarts,
                      bus->overflows);
    }
    const uint32_t samples = counts->radar_lost + devices->radar.lost;
    if (samples != 0u) {
        (void)fprintf(stderr, "tractiond: radar samples lost: %" PRIu32 "\n", samples);
    }
}

static void close_rover(void *context) {
    rover_t *rover = context;
    tell_losses(&rover->devices);
    if (rover->commands != NULL) {
        (void)fclose(rover->commands);
    }
    free(rover);
}

// The arguments after the description; false after telling what is wrong.
static hal_result_t take_arguments(int count, const char *const *argument, rover_t *rover, const char **root, char *message) {
    for (int i = 1; i < count; i++) {
        if (strncmp(argument[i], "root=", 5) == 0) {
            *root = argument[i] + 5;
        } else if (strncmp(argument[i], "commands=", 9) == 0 && rover->commands == NULL) {
            rover->path = argument[i] + 9;
            rover->commands = fopen(rover->path, "r");
            if (rover->commands == NULL) {
                (void)snprintf(message, HAL_MESSAGE, "%.200s: cannot be read: %.80s", rover->path, strerror(errno));
                return HAL_ERR_IO;
            }
        } else {
            (void)snprintf(message, HAL_MESSAGE,
                           "--hal linux: %.200s: unknown, or given twice; after the description come commands=FRAMES and root=FOLDER",
                           argument[i]);
            return HAL_ERR_CONFIG;
        }
    }
    return HAL_OK;
}

hal_result_t hal_open_linux(int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]) {
    if (count < 1) {
        (void)snprintf(message, HAL_MESSAGE, "--hal linux: no description; give the rover's file, which has [hardware]");
        return HAL_ERR_CONFIG;
    }
    rover_t *rover = calloc(1, sizeof *rover);
    if (rover == NULL) {
        (void)snprintf(message, HAL_MESSAGE, "--hal linux: %.80s", strerror(errno));
        return HAL_ERR_IO;
    }
    hardware_t hardware;
    char why[HARDWARE_MESSAGE];
    const char *root = "";
    hal_result_t result = take_arguments(count, argument, rover, &root, message);
    if (result == HAL_OK && !hardware_read(argument[0], &hardware, why)) {
        (void)snprintf(message, HAL_MESSAGE, "%s", why);
        result = HAL_ERR_IO;
    }
    if (result != HAL_OK) {
        close_rover(rover);
        return result;
    }
    linux_hal_begin(&rover->devices, &hardware, root);
    *opened =
        (hal_opened_t){.hal = linux_hal(&rover->devices), .command = command, .trouble = trouble, .devices = true, .close = close_rover};
    return HAL_OK;
}
