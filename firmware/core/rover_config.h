// rover_config.h - every number of the rover of table I (Lhomme-Desages) and of its sensors, in one place.
//
// The scalings in .sense and .doppler are also what hal/sim uses to make raw counts, so both sides read one struct.
#ifndef TRACTION_FIRMWARE_CORE_ROVER_CONFIG_H
#define TRACTION_FIRMWARE_CORE_ROVER_CONFIG_H

#include "control.h"

#ifdef __cplusplus
extern "C" {
#endif

// The rover as this project drives it.
control_config_t rover_config_default(void);

// The same rover with the paper's own estimator and gains, for its figures and for comparison.
control_config_t rover_config_paper(void);

#ifdef __cplusplus
}
#endif

#endif
