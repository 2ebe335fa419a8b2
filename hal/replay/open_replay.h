// open_replay.h - the HAL `replay`: a file of recorded frames as hal_open opens it.
#ifndef TRACTION_HAL_REPLAY_OPEN_REPLAY_H
#define TRACTION_HAL_REPLAY_OPEN_REPLAY_H

#include "hal/open.h"

#ifdef __cplusplus
extern "C" {
#endif

// One argument: the file (frames.h), read line by line as the run goes. A line that is not a frame ends the run with HAL_ERR_IO;
// trouble then says file, line, field, value and the mend.
hal_result_t hal_open_replay(int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]);

#ifdef __cplusplus
}
#endif

#endif
