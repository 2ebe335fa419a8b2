// doppler_template.h - the spectra of the radars of table II (Lhomme-Desages), generated at build time from their geometry.
#ifndef TRACTION_FIRMWARE_CORE_DOPPLER_TEMPLATE_H
#define TRACTION_FIRMWARE_CORE_DOPPLER_TEMPLATE_H

#include "doppler.h"

#ifdef __cplusplus
extern "C" {
#endif

extern const doppler_template_t doppler_template_mdu1130;    // 9.9 GHz, 36 x 72 deg: the paper's
extern const doppler_template_t doppler_template_dj_radar_2; // 24.13 GHz, 15 deg
extern const doppler_template_t doppler_template_dj_radar_3; // 24.13 GHz, 20 x 16 deg
extern const doppler_template_t doppler_template_drs1000;    // 35.5 GHz, 12 deg

// The template of a rover_radar_t; 0 when none is linked.
const doppler_template_t *doppler_template_of(int32_t radar);

#ifdef __cplusplus
}
#endif

#endif
