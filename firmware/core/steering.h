// steering.h - wheels that steer by Ackermann's geometry: the curvature that a command asks for, and how fast each wheel rolls round it.
//
//   k = psi*/v*, |k| <= k_max                                    curvature of the middle's path; at v* = 0 the bound, on psi*'s side (1)
//   u = sqrt((v -+ b psi)^2 + (d psi)^2), sign of v -+ b psi     rim speed of a wheel that rolls without scrub                     (2)
//   v -+ b psi = sqrt(u^2 - (d psi)^2), sign of u                and back, 0 where |u| is less                                     (3)
// d: how far the wheel's axle lies ahead of the line on which the rover turns, which is the axle that does not steer (0 there). The wheel's
// angle is the servo's to make: tan delta = d k/(1 -+ b k). Its order is k (signals.h), which needs no trigonometry here.
// Derived here: a rigid body in a plane whose wheels move along their heading (Ackermann 1818).
#ifndef TRACTION_FIRMWARE_CORE_STEERING_H
#define TRACTION_FIRMWARE_CORE_STEERING_H

#include "fixed.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float front_m;   // d of the front wheels; 0: they do not steer
    float rear_m;    // of the rear ones, <= 0
    float limit_1_m; // k_max; 0: nothing steers, and every function below is the identity
} steering_config_t;

// Compared as a whole number: it is asked in every tick, of rovers that do not steer too.
static inline bool steering_there(const steering_config_t *config) { return (int32_t)fixed_bits(config->limit_1_m) > 0; }

// (1). References that are no numbers count as 0.
float steering_curvature(const steering_config_t *config, float speed_ref_m_s, float yaw_rate_ref_rad_s);

// (2) and (3) for wheel i (signals.h). forward_m_s: of the ground under the wheel's centre, along the body.
float steering_rim(const steering_config_t *config, int32_t wheel, float forward_m_s, float yaw_rate_rad_s);
float steering_forward(const steering_config_t *config, int32_t wheel, float rim_m_s, float yaw_rate_rad_s);

#ifdef __cplusplus
}
#endif

#endif
