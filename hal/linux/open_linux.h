// open_linux.h - the HAL `linux`: the rover's own devices as hal_open opens them.
#ifndef TRACTION_HAL_LINUX_OPEN_LINUX_H
#define TRACTION_HAL_LINUX_OPEN_LINUX_H

#include "hal/open.h"

#ifdef __cplusplus
extern "C" {
#endif

// Arguments: the rover's description with [hardware] (hardware.h); then commands=FRAMES, whose recorded commands are asked for tick by tick
// (hal/replay/frames.h; after the last, MODE_STOP), and root=FOLDER before /sys and /dev. Without commands the rover stands.
hal_result_t hal_open_linux(int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]);

#ifdef __cplusplus
}
#endif

#endif
