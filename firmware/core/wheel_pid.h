// wheel_pid.h - hold one wheel's speed: PID with feed-forward, slewed reference, anti-windup and bumpless start.
//
//   r[k] = r[k-1] + clamp(ref - r[k-1], -slew T, slew T)                          (1)  reference the loop can follow
//   p[k] = Kp (r[k] - w[k]) - Kd dw[k] + ff(r[k])                                 (2)  derivative on the measurement
//   I[k] = I[k-1] + Ki T (r[k] - w[k]), but never further beyond the limit that u already meets     (3)
//   u[k] = clamp(p[k] + I[k], -u_max, u_max)                                      (4)
//
// (3): while p + I is beyond u_max, only an error of the sign that brings it back is integrated. State: 8 bytes.
#ifndef TRACTION_FIRMWARE_CORE_WHEEL_PID_H
#define TRACTION_FIRMWARE_CORE_WHEEL_PID_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float kp_s;         // Kp   [duty per rad/s] >= 0
    float ki_T_s;       // Ki*T [duty per rad/s] >= 0
    float kd_s2;        // Kd   [duty per rad/s^2] >= 0
    float slew_T_rad_s; // largest change of the reference in one tick, >= 0
    float integral_max; // bound of |I| [duty]
    float duty_max;     // u_max [1], 0..1
} wheel_pid_config_t;

typedef struct {
    float integral;        // I [duty]
    float reference_rad_s; // r
} wheel_pid_state_t;       // zeroed = reset

typedef struct {
    float speed_rad_s;
    float accel_rad_s2;
    float feed_forward; // ff at the slewed reference [duty]
} wheel_pid_input_t;

typedef struct {
    float duty;
    bool saturated;
} wheel_pid_output_t;

// The reference after (1), and advances it. Call once a tick before wheel_pid_step, to evaluate ff there. NaN counts as 0.
float wheel_pid_slew(const wheel_pid_config_t *config, wheel_pid_state_t *state, float reference_rad_s);

// (2)-(4) at the slewed reference. Any value is accepted; a NaN speed gives duty 0 and leaves the state alone.
// Ensures |duty| <= duty_max.
wheel_pid_output_t wheel_pid_step(const wheel_pid_config_t *config, wheel_pid_state_t *state, const wheel_pid_input_t *input);

// Bumpless start: the next output starts at `duty`, the reference at the present speed.
void wheel_pid_preset(const wheel_pid_config_t *config, wheel_pid_state_t *state, float duty, float speed_rad_s, float feed_forward);

#ifdef __cplusplus
}
#endif

#endif
