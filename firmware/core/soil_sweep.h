// soil_sweep.h - drive the front wheels through every slip while the rear wheels hold the rover's speed.
//
//   w_front(t) = dw_a t,   dw_a = (v*/R) / t_zero                (15): blocked at t = 0, rolling freely at t_zero
//   w_rear* = v*/R + Kv (v* - v)                                 (16): speed_control of control.c
//
// Source: (15)-(16) Lhomme-Desages. After `duration` the ramp holds its last value.
#ifndef TRACTION_FIRMWARE_CORE_SOIL_SWEEP_H
#define TRACTION_FIRMWARE_CORE_SOIL_SWEEP_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float ramp_1_m; // T / (R t_zero): dw_a T per unit of v*
    uint32_t duration_ticks;
    float wheel_max_rad_s;
} soil_sweep_config_t;

typedef struct {
    uint32_t elapsed_ticks;
} soil_sweep_state_t; // zeroed = reset

typedef struct {
    float front_rad_s;
    bool done;
} soil_sweep_output_t;

// NaN speed counts as 0.
soil_sweep_output_t soil_sweep_step(const soil_sweep_config_t *config, soil_sweep_state_t *state, float speed_ref_m_s);

#ifdef __cplusplus
}
#endif

#endif
