// slip_pi.h - trim a wheel's drive so that its slip settles at a set point.
//
//   e[k] = s_ref - s[k]                                       (1)
//   I[k] = I[k-1] + Ki*T*g*e[k], never further beyond the limit that u already meets   (2)
//   u[k] = clamp(Kp*g*e[k] + I[k], -u_max, u_max)             (3)
//
// g = clamp(|v|/v0, g_min, g_max) schedules the gain: a slip error e means a wheel-speed error of about e |v|/(R (1-s)^2), so
// with g the loop keeps one bandwidth at every speed (derived in docs/firmware.md). g_min = g_max = 1 is the paper's servo.
// Source: (23) Lhomme-Desages. Cost: O(1), no division. State: 4 bytes.
#ifndef TRACTION_FIRMWARE_CORE_SLIP_PI_H
#define TRACTION_FIRMWARE_CORE_SLIP_PI_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float kp;            // Kp   [duty per unit slip] >= 0
    float ki_T;          // Ki*T [duty per unit slip] >= 0, T = control period
    float duty_max;      // u_max [1], 0..1
    float per_speed_s_m; // 1/v0 [s/m] >= 0
    float gain_min;      // g_min [1] >= 0
    float gain_max;      // g_max [1] >= g_min
} slip_pi_config_t;      // constant while running

typedef struct {
    float integral;
} slip_pi_state_t; // zeroed = reset

typedef struct {
    float slip_ref;
    float slip;
    float speed_m_s; // v, for the schedule alone
} slip_pi_input_t;

typedef struct {
    float duty;
    bool saturated;
} slip_pi_output_t;

// Any slip and any state are accepted, NaN included (then duty = 0 and the state is left alone).
// Ensures |duty| <= duty_max.
slip_pi_output_t slip_pi_step(const slip_pi_config_t *config, slip_pi_state_t *state, const slip_pi_input_t *input);

// Bumpless start: the next output is near `duty` at the present error.
void slip_pi_preset(const slip_pi_config_t *config, slip_pi_state_t *state, float duty, const slip_pi_input_t *input);

#ifdef __cplusplus
}
#endif

#endif
