// lean.h - how much of gravity the gyros have turned into the accelerometer's axis: slopes and bumps, as they begin.
//
//   f' = (w_z f_y - w_y g,  w_x g - w_z f_x)    (1)
//   lean = sum of the changes of f_x            (2)
//
// (1) f: the part of gravity's reaction along x and y, a vector that rests in the world, seen from a body that turns (x forward, y left,
// z up); cosines of slopes taken as 1. (2) 0 at the start: what the slope is there is the bias of ground_speed.h.
// (3) w is less its mean while the rover stands, and about y less what the estimator has told since, (16) of ground_speed.h. Until it has
// stood for a second, less its mean over calm stretches, 0.64 s each in which no gyro leaves the first sample's neighbourhood of 2 deg/s:
// no slope begins so. And then only where that is more than 3 deg/s: a slope that begins, no offset and no mean that a slope has moved.
// Before the first calm stretch nothing is taken, and three that differ by more are no slope.
// (4) f follows the accelerometer within 2.6 s: a rover's own accelerations have no mean, what a gyro about x or y reads too much has.
// Below a slope of 3 deg it is left out of (1): it may be the device's own offset. Whole numbers only. Derived here.
#ifndef TRACTION_FIRMWARE_CORE_LEAN_H
#define TRACTION_FIRMWARE_CORE_LEAN_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    int32_t turn_q52;   // radians a tick per 2^-8 count of a gyro [2^-52]
    int32_t gravity_q8; // g [2^-8 accelerometer count], at most 2^24
    int32_t sudden_q8;  // of (3) [2^-8 gyro count]
    int32_t calm_count; // of (3)
    int32_t steep_q8;   // of (4), of |f_x| + |f_y|
} lean_config_t;        // gravity_q8 0: the gyros are not looked at

typedef struct {
    int32_t gyro_count[3];  // x, y, z
    int32_t accel_count[2]; // x, y, less their offsets
    bool accel;             // the last two are there
    bool standing;
    int32_t moved_q8;       // of the gyro about y: its offset, since the rover stood, |.| <= 2^22 [2^-8 count]
    uint32_t elapsed_ticks; // since the call before, 1..1000
} lean_input_t;

typedef struct {
    int32_t rest_q8[3];  // mean of (3) [2^-8 count]
    int32_t felt_q8[2];  // f [2^-8 count]
    int32_t lean_q8;     // (2) [2^-8 count]
    int32_t ticks;       // that the mean is of,
    int32_t log2_ticks;  // and the whole part of their logarithm
    int32_t stood_ticks; // it has stood for, at most a second
    int32_t calm_ticks, calm_count[3],
        calm_sum[3];     // of the stretch under way: its samples, the first of them, and the sum of the others less it
    int32_t calms_apart; // stretches in a row that differed
    bool calm_known;     // there was one
} lean_state_t;          // zeroed = reset

// Any counts of 16 bits and their offsets. |lean_q8| stays below 2^26 - 2^17.
void lean_step(const lean_config_t *config, lean_state_t *state, const lean_input_t *input);

#ifdef __cplusplus
}
#endif

#endif
