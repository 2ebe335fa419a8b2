// parameters.h - a rover's own numbers from a text file, over those of the reference rover (firmware/core/rover_parameters.h).
//
//   # a comment
//   format = "traction.firmware/1"
//   wheel_radius_m = 0.0571        # SI; one `key = value` a line, any order, each key once
//   radar = "MDU1130"              # MDU1130, DJ Radar II, DJ Radar III, DRS1000; "own": its template follows (template_text.h)
//
// Written by `traction rover`, `traction export --firmware`, `traction calibrate` and `traction tune`. Keys: every row of
// ROVER_PARAMETER_LIST, told in docs/rover_format.md. What is not given is the reference rover's, or follows from the rover's own numbers
// (SCALED). Everything that follows from a number is computed by control_config_build, so that a file cannot contradict itself.
#ifndef TRACTION_FIRMWARE_APP_PARAMETERS_H
#define TRACTION_FIRMWARE_APP_PARAMETERS_H

#include "template_text.h"

#include "firmware/core/rover_config.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { PARAMETERS_MESSAGE = 320, PARAMETERS_TEXT = 8192 + TEMPLATE_TEXT };

typedef struct {
    rover_parameters_t rover;          // complete: what was not given is the reference's, or scaled
    bool given[ROVER_PARAMETER_COUNT]; // by the file
    bool radar_given;
} parameters_t;

// Reads the file at `path` over *config, which is replaced by what control_config_build makes of it. Returns true, or false with *config
// untouched and one line in message: file, line, key, value and the mend. What control_config_check refuses is refused. `beam` holds the
// template of an own radar as long as the config is used; where it is 0, such a file is refused.
bool parameters_read(const char *path, control_config_t *config, doppler_template_t *beam, char message[PARAMETERS_MESSAGE]);

// The same; the primary numbers too where `rover` is not null.
bool parameters_read_whole(const char *path, control_config_t *config, rover_parameters_t *rover, doppler_template_t *beam,
                           char message[PARAMETERS_MESSAGE]);

// The same as parameters_read from text of `length` bytes; `name` is for messages.
bool parameters_parse(const char *text, size_t length, const char *name, control_config_t *config, doppler_template_t *beam,
                      char message[PARAMETERS_MESSAGE]);

// The primary numbers alone.
bool parameters_parse_rover(const char *text, size_t length, const char *name, parameters_t *out, doppler_template_t *beam,
                            char message[PARAMETERS_MESSAGE]);

// Index of the parameter of this name, or -1.
int32_t parameters_find(const char *key);

// The file's text for these numbers, at most PARAMETERS_TEXT bytes with the closing 0; what is not given and scaled stands as a comment,
// so that it keeps following. An own template is written out. `about` is one line for the head. Returns the length; parsed again it gives
// the same bits.
size_t parameters_write(const parameters_t *parameters, const char *about, char text[PARAMETERS_TEXT]);

#ifdef __cplusplus
}
#endif

#endif
