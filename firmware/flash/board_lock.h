// board_lock.h - who is at work on the slots: record locks on one file, which end with their process and with the power.
#ifndef TRACTION_FIRMWARE_FLASH_BOARD_LOCK_H
#define TRACTION_FIRMWARE_FLASH_BOARD_LOCK_H

#include "package.h"

#include <sys/types.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    BOARD_STARTER,   // traction-slot run, as long as it runs
    BOARD_INSTALLER, // one at a time
    BOARD_STATE,     // while the state is read and written anew
} board_lock_t;

// The file FOLDER/lock, made where it is not there. Negative: message says why. One per process: closing it gives back every lock.
int board_lock_open(const char *folder, char message[PACKAGE_MESSAGE]);

bool board_lock_take(int file, board_lock_t which, bool wait);
bool board_lock_give(int file, board_lock_t which);

// The process that has it; 0: none, or this one.
pid_t board_lock_holder(int file, board_lock_t which);

#ifdef __cplusplus
}
#endif

#endif
