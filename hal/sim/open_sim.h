// open_sim.h - the HAL `sim`: a scenario's rover and its drive plan as hal_open opens it. C++ behind a C interface.
#ifndef TRACTION_HAL_SIM_OPEN_SIM_H
#define TRACTION_HAL_SIM_OPEN_SIM_H

#include "hal/open.h"

#ifdef __cplusplus
extern "C" {
#endif

// Arguments: the scenario's file, then any of seed=N (instead of the scenario's) and effect=NAME:PARAMETER=VALUE (beside its own).
// Its [firmware] is not used: the caller has a configuration of its own; a note in message says so where it asks for another.
hal_result_t hal_open_sim(int count, const char *const *argument, hal_opened_t *opened, char message[HAL_MESSAGE]);

#ifdef __cplusplus
}
#endif

#endif
