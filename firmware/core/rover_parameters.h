// rover_parameters.h - what a rover is, as primary numbers: everything else that the firmware knows of it is computed from these.
//
// One row of the list below is one key: of this struct, of the parameter file (firmware/app/parameters.h) and of the check. A row marked
// OWN is a number of the machine and holds as the reference rover has it unless it is given. A row marked SCALED is a choice (a gain, a
// limit) that follows from the machine: unless it is given, rover_parameters_scale makes it from the rover's own numbers, by laws under
// which the reference rover keeps its own value bit for bit (each is reference value times x/x_reference). Adding a key is adding a row,
// and using it in rover_config.c.
//
//   I_grip = (mu M g/4 R + t0)/KG, mu = 0.8                                    current of a wheel held by full traction     (1)
//   k = V KG/(Ra J), p = KG ke/(Ra J) + b/J                                     gain and pole of a free wheel                (2)
//   w0 = V/ke                                                                   no-load speed                                (3)
//   stall ~ the lesser of I_grip and V/Ra; continuous ~ the lesser of I_grip and sqrt(rise_max/(Ra R_th)); I^2 t ~ continuous^2 (4) Kp ~
//   1/k, Ki ~ Kp p, slew ~ k; slip: Kp_s ~ Kp/R, Ki_s ~ Ki/R; platform: Kv, Ki ~ 1/R                                    (5) the templates
//   hold at 20 deg of depression; beside it the scale is 1 + g (deg - 20), g by the radar's beam             (7) wheel speeds ~ w0; speed ~
//   w_max R, at most 0.95 of what the radar hears; yaw ~ speed/b; disagreement ~ speed            (6)
//
// Derived here; why each: docs/rover_format.md. g: 0.4 % per deg of the wide beam as measured (docs/firmware.md), tan 20 deg of a narrow
// one.
#ifndef TRACTION_FIRMWARE_CORE_ROVER_PARAMETERS_H
#define TRACTION_FIRMWARE_CORE_ROVER_PARAMETERS_H

#include "doppler.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// X(key, OWN or SCALED, reference value, lowest, highest): beyond lowest..highest is a mistake of unit. Sources: rovers/lhomme_desages.toml
#define ROVER_PARAMETER_LIST(X)                                                                                                            \
    X(wheel_radius_m, OWN, 0.057f, 0.01f, 0.5f)                                                                                            \
    X(half_wheelbase_m, OWN, 0.083f, 0.02f, 2.0f)                                                                                          \
    X(half_track_m, OWN, 0.12f, 0.02f, 2.0f)                                                                                               \
    X(mass_kg, OWN, 2.88f, 0.1f, 200.0f)                                                                                                   \
    X(torque_constant_Nm_A, OWN, 0.265f, 0.001f, 20.0f)                                                                                    \
    X(back_emf_Vs_rad, SCALED, 0.265f, 0.001f, 20.0f) /* KG: equal in SI */                                                                \
    X(resistance_ohm, OWN, 3.24f, 0.01f, 100.0f)                                                                                           \
    X(inertia_kg_m2, OWN, 5e-3f, 1e-5f, 1.0f)                                                                                              \
    X(viscous_Nms, OWN, 1.6e-3f, 0.0f, 1.0f)                                                                                               \
    X(coulomb_Nm, OWN, 0.03f, 0.0f, 5.0f)                                                                                                  \
    X(battery_voltage_V, OWN, 7.2f, 1.0f, 60.0f)                                                                                           \
    X(encoder_counts_per_turn, OWN, 6000.0f, 10.0f, 1e6f)                                                                                  \
    X(encoder_sign_0, OWN, 1.0f, -1.0f, 1.0f)                                                                                              \
    X(encoder_sign_1, OWN, 1.0f, -1.0f, 1.0f)                                                                                              \
    X(encoder_sign_2, OWN, 1.0f, -1.0f, 1.0f)                                                                                              \
    X(encoder_sign_3, OWN, 1.0f, -1.0f, 1.0f)                                                                                              \
    X(current_A_per_count, OWN, 0.002f, 1e-5f, 1.0f)                                                                                       \
    X(current_offset_count_0, OWN, 2048.0f, 0.0f, 65535.0f)                                                                                \
    X(current_offset_count_1, OWN, 2048.0f, 0.0f, 65535.0f)                                                                                \
    X(current_offset_count_2, OWN, 2048.0f, 0.0f, 65535.0f)                                                                                \
    X(current_offset_count_3, OWN, 2048.0f, 0.0f, 65535.0f)                                                                                \
    X(current_max_count, OWN, 4095.0f, 255.0f, 65535.0f)                                                                                   \
    X(battery_V_per_count, OWN, 0.004f, 1e-5f, 1.0f)                                                                                       \
    X(battery_offset_count, OWN, 0.0f, -32768.0f, 32767.0f)                                                                                \
    X(battery_max_count, OWN, 4095.0f, 255.0f, 65535.0f)                                                                                   \
    X(accel_m_s2_per_count, OWN, 0.004f, 1e-5f, 1.0f)                                                                                      \
    X(accel_offset_count, OWN, 0.0f, -32767.0f, 32767.0f)                                                                                  \
    X(gyro_rad_s_per_count, OWN, 0.0005f, 1e-6f, 1.0f)                                                                                     \
    X(gyro_offset_count, OWN, 0.0f, -32767.0f, 32767.0f)                                                                                   \
    X(radar_depression_deg, OWN, 20.0f, 5.0f, 45.0f)                                                                                       \
    X(radar_rate_Hz, OWN, 512.0f, 202.0f, 6400.0f)                                                                                         \
    X(radar_offset_count, OWN, 512.0f, 0.0f, 1023.0f)                                                                                      \
    X(radar_max_count, OWN, 1023.0f, 255.0f, 1023.0f)                                                                                      \
    X(radar_quiet_count2, OWN, 2.0f, 0.0f, 1e5f)                                                                                           \
    X(doppler_scale, SCALED, 1.0f, 0.5f, 2.0f)                                                                                             \
    X(current_continuous_A, SCALED, 1.5f, 0.01f, 100.0f)                                                                                   \
    X(current_peak_A2s, SCALED, 8.0f, 1e-3f, 1e5f)                                                                                         \
    X(stall_current_A, SCALED, 1.4f, 0.01f, 100.0f)                                                                                        \
    X(stall_speed_rad_s, SCALED, 0.3f, 1e-3f, 100.0f)                                                                                      \
    X(stall_s, OWN, 1.0f, 0.02f, 60.0f)                                                                                                    \
    X(winding_K_W, OWN, 12.0f, 1e-3f, 1000.0f)                                                                                             \
    X(winding_J_K, OWN, 5.0f, 1e-2f, 1e5f)                                                                                                 \
    X(winding_rise_max_K, OWN, 95.0f, 10.0f, 200.0f)                                                                                       \
    X(battery_min_V, SCALED, 5.4f, 0.5f, 60.0f)                                                                                            \
    X(battery_low_s, OWN, 0.5f, 0.02f, 60.0f)                                                                                              \
    X(encoder_absurd_rad_s, SCALED, 60.0f, 0.1f, 1000.0f)                                                                                  \
    X(wheel_max_rad_s, SCALED, 25.0f, 0.1f, 500.0f)                                                                                        \
    X(speed_max_m_s, SCALED, 1.0f, 0.05f, 9.0f)                                                                                            \
    X(yaw_rate_max_rad_s, SCALED, 4.0f, 0.05f, 20.0f)                                                                                      \
    X(disagree_m_s, SCALED, 0.15f, 0.01f, 5.0f)                                                                                            \
    X(disagree_ratio, OWN, 1.5f, 1.0f, 10.0f)                                                                                              \
    X(disagree_s, OWN, 1.0f, 0.02f, 60.0f)                                                                                                 \
    X(slip_valid_m_s, OWN, 0.05f, 0.001f, 1.0f)                                                                                            \
    X(still_m_s, SCALED, 0.006f, 1e-5f, 0.1f)                                                                                              \
    X(dry_speed_rad_s, SCALED, 0.2f, 1e-3f, 10.0f)                                                                                         \
    X(wheel_kp_s, SCALED, 0.2f, 0.0f, 10.0f)                                                                                               \
    X(wheel_ki_1, SCALED, 0.9f, 0.0f, 200.0f)                                                                                              \
    X(wheel_slew_rad_s2, SCALED, 60.0f, 0.1f, 1e4f)                                                                                        \
    X(slip_kp_1, SCALED, 2.0f, 0.0f, 100.0f)                                                                                               \
    X(slip_ki_1_s, SCALED, 9.0f, 0.0f, 1000.0f)                                                                                            \
    X(slip_gain_speed_m_s, OWN, 0.2f, 0.01f, 10.0f)                                                                                        \
    X(speed_kv_rad_m, SCALED, 17.5f, 0.0f, 1000.0f)                                                                                        \
    X(speed_ki_rad_m_s, SCALED, 35.0f, 0.0f, 1e4f)                                                                                         \
    X(speed_integral_max_rad_s, SCALED, 6.0f, 0.0f, 500.0f)                                                                                \
    X(sweep_zero_s, OWN, 10.0f, 1.0f, 600.0f)                                                                                              \
    X(sweep_duration_s, OWN, 20.0f, 1.0f, 3600.0f)                                                                                         \
    X(wheel_mask, OWN, 15.0f, 1.0f, 15.0f)  /* bit i: the rover has wheel i */                                                             \
    X(steer_front_m, OWN, 0.0f, 0.0f, 4.0f) /* these three: steering.h; 0: nothing steers */                                               \
    X(steer_rear_m, OWN, 0.0f, -4.0f, 0.0f)                                                                                                \
    X(steer_limit_1_m, OWN, 0.0f, 0.0f, 50.0f)

typedef enum {
#define ROVER_PARAMETER_INDEX(key, kind, value, low, high) ROVER_##key,
    ROVER_PARAMETER_LIST(ROVER_PARAMETER_INDEX)
#undef ROVER_PARAMETER_INDEX
        ROVER_PARAMETER_COUNT
} rover_parameter_t;

// Radars whose template is linked (table II, Lhomme-Desages), and any other, whose template comes as data.
typedef enum {
    ROVER_RADAR_MDU1130 = 0,
    ROVER_RADAR_DJ_2,
    ROVER_RADAR_DJ_3,
    ROVER_RADAR_DRS1000,
    ROVER_RADAR_LINKED,
    ROVER_RADAR_OWN = ROVER_RADAR_LINKED,
    ROVER_RADAR_COUNT
} rover_radar_t;

typedef struct {
    float value[ROVER_PARAMETER_COUNT]; // by ROVER_<key>, in the unit that the key's name ends with
    int32_t radar;                      // rover_radar_t
    const doppler_template_t *beam;     // of this very radar at this rate and depression; must outlive the config. 0: the linked one
} rover_parameters_t;

// The reference rover: table I (Lhomme-Desages), as this project drives it.
void rover_parameters_reference(rover_parameters_t *parameters);

// Sets every SCALED number that is not given, by (1)-(6), in the order of the list: a given one counts in what follows from it.
void rover_parameters_scale(rover_parameters_t *parameters, const bool given[ROVER_PARAMETER_COUNT]);

// A key's name, and where it may lie; index 0..ROVER_PARAMETER_COUNT-1.
const char *rover_parameter_name(int32_t index);
float rover_parameter_low(int32_t index);
float rover_parameter_high(int32_t index);
bool rover_parameter_scaled(int32_t index);

// What `parameters` name: their own template, or the linked one of their radar, or 0.
const doppler_template_t *rover_template(const rover_parameters_t *parameters);

// A radar's name as descriptions write it ("MDU1130", "own"), index 0..ROVER_RADAR_COUNT-1.
const char *rover_radar_name(int32_t radar);

#ifdef __cplusplus
}
#endif

#endif
