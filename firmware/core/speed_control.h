// speed_control.h - wheel-speed references that hold the rover's ground speed, slip or not.
//
//   w_i* = (v* -+ b psi*)/R + Kv (v* - v) + I                    (22), with a yaw rate: minus on the left, plus on the right
//   I[k] = clamp(I[k-1] + Ki T (v* - v), -I_max, I_max)          (1)
//
// Source: (22) Lhomme-Desages, which has neither yaw nor I: Ki = 0 gives the paper's law. The integral removes the error that
// a proportional law leaves when a wheel is blocked (derived in docs/firmware.md). It is frozen while the drive is saturated.
#ifndef TRACTION_FIRMWARE_CORE_SPEED_CONTROL_H
#define TRACTION_FIRMWARE_CORE_SPEED_CONTROL_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float per_radius_1_m;        // 1/R
    float half_track_per_radius; // b/R
    float kv_rad_m;              // Kv [rad/s per m/s]
    float ki_T_rad_m;            // Ki*T [rad/s per m/s]
    float integral_max_rad_s;    // I_max
    float speed_max_m_s;         // |v*| limit
    float yaw_rate_max_rad_s;    // |psi*| limit
    float wheel_max_rad_s;       // |w*| limit
} speed_control_config_t;

typedef struct {
    float integral_rad_s;
} speed_control_state_t; // zeroed = reset

typedef struct {
    float speed_ref_m_s;      // v*
    float yaw_rate_ref_rad_s; // psi*
    float speed_m_s;          // v, estimated
    bool saturated;           // a wheel had no duty left in the last tick
} speed_control_input_t;

typedef struct {
    float left_rad_s;
    float right_rad_s;
} speed_control_output_t;

// Any value is accepted; NaN in a reference counts as 0, a NaN speed as v = v*.
speed_control_output_t speed_control_step(const speed_control_config_t *config, speed_control_state_t *state,
                                          const speed_control_input_t *input);

#ifdef __cplusplus
}
#endif

#endif
