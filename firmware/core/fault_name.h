// fault_name.h - a fault's words, for messages and telemetry.
#ifndef TRACTION_FIRMWARE_CORE_FAULT_NAME_H
#define TRACTION_FIRMWARE_CORE_FAULT_NAME_H

#include "signals.h"

#ifdef __cplusplus
extern "C" {
#endif

// Of bit 0..FAULT_COUNT-1 of fault_t: "emergency stop". Any other: "unknown fault".
const char *fault_name(int32_t bit);

#ifdef __cplusplus
}
#endif

#endif
