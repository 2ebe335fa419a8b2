// sense.h - raw counts to SI, with the age of every sensor and what is absurd about it.
//
//   w[k]  = q (c[k] - c[k-n]) / (t[k] - t[k-n])                                  (1)  delay T/2, noise q/(T sqrt 6) for n = 1
//   dw[k] = q (c[k] - 2 c[k-4] + c[k-8]) / (4T)^2                                (2)  delay 4T,  noise q sqrt(6/12)/(4T)^2
//
// q = wheel angle per pulse. With 6000 pulses and T = 10 ms: (1) 5 ms, 0.043 rad/s; (2) 40 ms, 0.46 rad/s^2 (derived here from
// a uniform rounding error of one pulse). n: ticks since the last good count; what was missed in between lies on the line between the two
// counts. Time is the frame's own clock where it has one. A silent encoder is extrapolated at its last speed. A step that another part
// refuses (sense_replace) leaves neither speed nor derivative behind, nor does an absurd one.
#ifndef TRACTION_FIRMWARE_CORE_SENSE_H
#define TRACTION_FIRMWARE_CORE_SENSE_H

#include "lean.h"
#include "signals.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { SENSE_RING = 16 }; // counts kept, a power of two beyond the 8 of (2)

typedef struct {
    float encoder_rad_per_count;  // q
    float speed_rad_s_per_count;  // q/T of (1)
    float accel_rad_s2_per_count; // q/(4T)^2 of (2)
    float current_A_per_count;
    float battery_V_per_count;
    float accel_m_s2_per_count;
    float gyro_rad_s_per_count;
    float level_m_s2_per_q8; // of the accelerometer less the lean
    lean_config_t lean;
    int32_t encoder_sign[WHEEL_COUNT];         // 1, or -1 where the count falls as the wheel drives forward
    int32_t current_offset_count[WHEEL_COUNT]; // 0 A
    int32_t battery_offset_count;              // 0 V
    int32_t accel_offset_count;                // 0 m/s^2
    int32_t gyro_offset_count;                 // 0 rad/s
    int32_t current_max_count;                 // the converter's rail
    int32_t battery_max_count;
    int32_t radar_max_count;
    int32_t encoder_step_max; // more pulses in one tick than any wheel can make
    int32_t encoder_jump_max; // a greater change of the pulses a tick than the motor can make of a free wheel
} sense_config_t;

typedef struct {
    int32_t count[WHEEL_COUNT][SENSE_RING]; // ring of past counts, what was refused left out
    int32_t raw[WHEEL_COUNT];               // the encoder's last count
    int32_t place[WHEEL_COUNT];             // its place in the ring's counting
    uint32_t silent_ticks[WHEEL_COUNT];     // ticks since then, this one not counted
    uint32_t silent_us[WHEEL_COUNT];
    int32_t head; // slot of the last tick
    float speed_rad_s[WHEEL_COUNT];
    int32_t step[WHEEL_COUNT]; // pulses a tick of the last good count
    float current_A[WHEEL_COUNT];
    float battery_V;
    float accel_x_m_s2;
    float level_m_s2;
    float gyro_z_rad_s;
    lean_state_t lean;
    bool standing;         // told by the estimator after the tick before,
    int32_t gyro_q8;       // and what the gyro about y reads too much [2^-8 count]
    uint32_t encoder_seen; // bit i: wheel i has had a first count
    uint32_t stepped;      // bit i: and a speed since, so that a jump of it can be told
    uint32_t last_tick;
    uint32_t last_time_us;
    bool timed;  // last_time_us is a time
} sense_state_t; // zeroed = reset

typedef struct {
    float speed_rad_s[WHEEL_COUNT];
    float accel_rad_s2[WHEEL_COUNT];
    float current_A[WHEEL_COUNT];
    float battery_V;
    float accel_x_m_s2;
    float level_m_s2; // the same less what the gyro says of slopes since the start
    float gyro_z_rad_s;
    int32_t lean_q8;        // that, in units of level_m_s2_per_q8
    uint32_t elapsed_ticks; // since the frame before: 1, and what was missed; at most 1000
    uint32_t jumped;        // bit i: the speed of wheel i changed by more than encoder_jump_max: believe it only for another reason
    uint32_t usable;        // FRAME_* bits that are present and sane
    uint32_t absurd;        // FRAME_* bits that are present and impossible
} sense_output_t;

// Any frame is accepted. A part that is absent or absurd keeps its last value.
sense_output_t sense_measure(const sense_config_t *config, sense_state_t *state, const sensor_frame_t *frame);

// The speed that wheel i has instead of the encoder's in the tick just measured; mends (1) and (2) of state and *out. NaN counts as 0.
void sense_replace(const sense_config_t *config, sense_state_t *state, sense_output_t *out, int wheel, float speed_rad_s);

#ifdef __cplusplus
}
#endif

#endif
