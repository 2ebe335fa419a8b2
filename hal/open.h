// open.h - a HAL by its name, for a program that learns at its start which world it drives (tractiond --hal NAME).
//
// Which names there are depends on the build: `sim` needs the simulator and so the host; `replay` is everywhere.
#ifndef TRACTION_HAL_OPEN_H
#define TRACTION_HAL_OPEN_H

#include "hal.h"

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { HAL_MESSAGE = 1500 }; // [byte] room for one line, the list of all effects in it

// An opened HAL. All functions take hal.context.
typedef struct {
    hal_t hal;
    // What is asked for in the tick that `frame` was read in: the recorded command, the scenario's drive plan.
    void (*command)(void *context, const sensor_frame_t *frame, command_t *command);
    // Why the HAL ended the run with an error, one line; "" when it did not.
    const char *(*trouble)(void *context);
    bool devices; // what fails while it runs is a device, not an input
    // Gives back what hal_open took. Call safe_stop first (daemon_run does).
    void (*close)(void *context);
} hal_opened_t;

typedef struct {
    const char *name, *arguments, *about; // for messages and help; one line each
    // Null: known, but not in this build; `about` says where it is. Errors as hal_open's.
    hal_result_t (*open)(int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]);
} hal_entry_t;

// Every HAL there is a name for; *count of them.
const hal_entry_t *hal_list(size_t *count);

// Opens the HAL `name` with its `count` arguments. HAL_OK, with a note in message or ""; HAL_ERR_CONFIG (no such name, wrong
// arguments) or HAL_ERR_IO (a file or a device does not open), with one line in message: what is wrong and the mend.
hal_result_t hal_open(const char *name, int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]);

#ifdef __cplusplus
}
#endif

#endif
