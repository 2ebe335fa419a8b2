// motor.h - wheel torque and traction from bridge current, wheel speed and its derivative.
//
//   Gamma = KG I                                     (17)
//   Gr(w) = b w + t0 sgn(w)                          (18)  opposes motion in both directions
//   Ft    = (KG I - Gr(w) - J dw/dt) / R             (19)
//
// and the electrical side (assumed: permanent-magnet motor, bridge as an ideal transformer)
//   duty V = Ra I + ke w                             (a)
//
// Source: (17)-(19) Lhomme-Desages. Around w = 0 the sign of (18) is unknown from w: within +-w_dry it is w/w_dry (continuous).
#ifndef TRACTION_FIRMWARE_CORE_MOTOR_H
#define TRACTION_FIRMWARE_CORE_MOTOR_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    float torque_constant_Nm_A; // KG, at the wheel
    float volt_per_speed_Vs;    // Ra b/KG + ke: steady voltage per wheel speed
    float volt_dry_V;           // Ra t0/KG: voltage that overcomes dry friction
    float back_emf_Vs;          // ke, at the wheel
    float resistance_ohm;       // Ra, > 0
    float viscous_Nms;          // b of (18)
    float dry_Nm;               // t0 of (18)
    float per_dry_speed_s;      // 1/w_dry
    float inertia_kg_m2;        // J
    float per_radius_1_m;       // 1/R
} motor_config_t;

typedef struct {
    float torque_Nm;
    float traction_N;
} motor_output_t;

// NaN or infinity in any measurement counts as 0.
motor_output_t motor_measure(const motor_config_t *config, float current_A, float speed_rad_s, float accel_rad_s2);

// Gr(w) of (18).
float motor_loss_Nm(const motor_config_t *config, float speed_rad_s);

// 1/V of a supply, or 0 when it is unusable: a wire is broken. Once a tick, because a division is dear on the target.
float motor_per_supply(float supply_V);

// Duty that turns the wheel at a steady speed with nothing but Gr as load, by (a), limited to -1..1.
float motor_duty_for_speed(const motor_config_t *config, float speed_rad_s, float per_supply_1_V);

// Duty limited so that by (a) the winding current stays within +-limit_A at the present speed.
float motor_duty_limited(const motor_config_t *config, float duty, float speed_rad_s, float per_supply_1_V, float limit_A);

#ifdef __cplusplus
}
#endif

#endif
