#include "open_replay.h"

#include "frames.h"
#include "replay_hal.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    replay_hal_t replay; // first: the HAL's context is this struct's address
    FILE *file;
    const char *path; // the caller's
    long line;
    char trouble[HAL_MESSAGE];
} recording_t;

static hal_result_t next_line(void *source, sensor_frame_t *frame, command_t *command) {
    recording_t *recording = source;
    char text[FRAMES_LINE];
    char why[FRAMES_WHY];
    while (fgets(text, sizeof text, recording->file) != NULL) {
        recording->line++;
        if (text[0] == '#' && strchr(text, '\n') != NULL) {
            continue;
        }
        if (frames_parse(text, frame, command, why)) {
            return HAL_OK;
        }
        (void)snprintf(recording->trouble, sizeof recording->trouble, "%.160s:%ld: %s", recording->path, recording->line, why);
        return HAL_ERR_IO;
    }
    if (ferror(recording->file) != 0) {
        (void)snprintf(recording->trouble, sizeof recording->trouble, "%.160s: cannot be read: %.80s", recording->path, strerror(errno));
        return HAL_ERR_IO;
    }
    return HAL_END;
}

static void command(void *context, const sensor_frame_t *frame, command_t *out) {
    (void)frame;
    *out = ((recording_t *)context)->replay.command;
}

static const char *trouble(void *context) { return ((recording_t *)context)->trouble; }

static void close_recording(void *context) {
    recording_t *recording = context;
    (void)fclose(recording->file);
    free(recording);
}

hal_result_t hal_open_replay(int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]) {
    if (count != 1) {
        (void)snprintf(message, HAL_MESSAGE, "--hal replay: got %d arguments; give one file of frames", count);
        return HAL_ERR_CONFIG;
    }
    FILE *file = fopen(argument[0], "r");
    recording_t *recording = file != NULL ? calloc(1, sizeof *recording) : NULL;
    if (recording == NULL) {
        (void)snprintf(message, HAL_MESSAGE, "%.200s: cannot be read: %.80s", argument[0], strerror(errno));
        if (file != NULL) {
            (void)fclose(file);
        }
        return HAL_ERR_IO;
    }
    recording->file = file;
    recording->path = argument[0];
    recording->replay.source = recording;
    recording->replay.next = next_line;
    *opened = (hal_opened_t){.hal = replay_hal(&recording->replay), .command = command, .trouble = trouble, .close = close_recording};
    return HAL_OK;
}
