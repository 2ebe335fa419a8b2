// forward.h - a HAL that hands every call on to the HAL inside it: what a wrapper starts from, and changes where it differs.
//
// For a context whose first member is the inner hal_t. C++ wrappers: hal/sim/forwarding.h.
#ifndef TRACTION_HAL_FORWARD_H
#define TRACTION_HAL_FORWARD_H

#include "hal.h"

#ifdef __cplusplus
extern "C" {
#endif

// `context`: a struct that begins with a hal_t, which is the inner HAL; it must outlive what is returned.
hal_t hal_forward(void *context);

#ifdef __cplusplus
}
#endif

#endif
