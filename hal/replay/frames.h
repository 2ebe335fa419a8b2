// frames.h - one tick as a line of text: the frame and the command, every bit of them. The same line on every machine.
//
// Fields separated by one blank, the line ended by a newline; '#' starts a comment line:
//   tick elapsed time_us present enc[4] cur[4] battery accel[3] gyro[3] estop bridge[4] radar_sequence n radar[n]
//   mode v yaw w[4] duty[4] slip slip_wheels age
// Counts are decimal, `present` is hexadecimal without prefix; v, yaw, w, duty and slip are the bits of the float in hexadecimal.
// Written by `traction simulate --frames` and `traction replay --frames`, read by the HAL `replay`.
#ifndef TRACTION_HAL_REPLAY_FRAMES_H
#define TRACTION_HAL_REPLAY_FRAMES_H

#include "firmware/core/signals.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { FRAMES_LINE = 1024, FRAMES_WHY = 200 }; // [byte] the longest line has 694; room for one reason

// Writes the line with its newline and a final 0; returns its length without the 0.
size_t frames_print(const sensor_frame_t *frame, const command_t *command, char line[FRAMES_LINE]);

// Reads a line (ended by a newline). false: field, value and mend in why; *frame and *command then hold nothing of use.
// A mode that this firmware does not know is refused, as is a count beyond its field's type.
bool frames_parse(const char *line, sensor_frame_t *frame, command_t *command, char why[FRAMES_WHY]);

#ifdef __cplusplus
}
#endif

#endif
