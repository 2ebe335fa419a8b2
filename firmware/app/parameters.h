// parameters.h - the rover's own numbers from a text file, over those of rover_config.c.
//
//   # a comment
//   format = "traction.firmware/1"
//   wheel_radius_m = 0.0571        # SI; one `key = value` a line, any order, each key once
//
// Written by `traction export --firmware`, `traction calibrate` and `traction tune`. Everything that follows from a number (a
// reciprocal, a voltage per speed) is derived here, so that a file cannot contradict itself.
#ifndef TRACTION_FIRMWARE_APP_PARAMETERS_H
#define TRACTION_FIRMWARE_APP_PARAMETERS_H

#include "firmware/core/control.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { PARAMETERS_MESSAGE = 320 };

// Reads the file at `path` over *config. Returns true, or false with *config untouched and one line in message: file, line, key,
// value and the mend. Keys: see `known` in parameters.c.
bool parameters_read(const char *path, control_config_t *config, char message[PARAMETERS_MESSAGE]);

// The same from text of `length` bytes; `name` is for messages.
bool parameters_parse(const char *text, size_t length, const char *name, control_config_t *config, char message[PARAMETERS_MESSAGE]);

#ifdef __cplusplus
}
#endif

#endif
