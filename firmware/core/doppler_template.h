// doppler_template.h - the spectra of the radars of table II (Lhomme-Desages), generated at build time from their geometry.
#ifndef TRACTION_FIRMWARE_CORE_DOPPLER_TEMPLATE_H
#define TRACTION_FIRMWARE_CORE_DOPPLER_TEMPLATE_H

#include "doppler.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const doppler_template_t doppler_template_mdu1130; // 9.9 GHz, 36 x 72 deg

#ifdef __cplusplus
}
#endif

#endif
