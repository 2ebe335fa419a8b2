// starter.h - what a version is to the board, and who starts it: `traction-slot run`.
//
// A version has one program that the board knows, `start`:
//   start check   the self-test on this board: moves nothing, takes no device; 0 passes. At most STARTER_CHECK_S.
//   start run     becomes the rover's daemon. It tells its health on descriptor 3, a line each: "healthy", or why it is not.
// Both run in the version's folder. A trial is confirmed when it says "healthy" within the trial's time; it is over when it ends before, or
// the time does. Then the good version is started, at once.
//
// A version that ends is started again after a second; one that ends with 2 or 3 (wrong command line, bad input) is not: the same would
// happen. A board without a version waits for its first one. SIGTERM and SIGINT stop it and the starter; SIGHUP stops it and starts what is
// then the right one.
#ifndef TRACTION_FIRMWARE_FLASH_STARTER_H
#define TRACTION_FIRMWARE_FLASH_STARTER_H

#include "slots.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { STARTER_CHECK_S = 120, STARTER_STOP_S = 3, STARTER_HEALTH_FD = 3 };

// Debian's word for what this program was built for.
const char *starter_architecture(void);

// For slots_t: runs `start check`.
int starter_self_test(void *context, const char *folder, char why[SLOTS_NOTE]);

// Stays until it is asked to stop; an exit code of traction-slot.
int starter_run(const slots_t *slots, uint32_t trial_s);

#ifdef __cplusplus
}
#endif

#endif
